# Stage: relative errors of the restitution model and their thresholds (Eqs. 37-38).


rule error_thresholds:
    message:
        "Error thresholds for {wildcards.figure}"
    input:
        source=modules("studies.error_thresholds"),
    output:
        data="results/figures/{figure}.nc",
    wildcard_constraints:
        figure="fig14|fig16|thresholds",
    params:
        parameters=figure_parameters,
        release=config["release"],
    log:
        "results/logs/error_thresholds/{figure}.log",
    benchmark:
        "results/benchmarks/error_thresholds/{figure}.tsv"
    script:
        "../scripts/error_thresholds.py"
