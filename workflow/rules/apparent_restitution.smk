# Stage: apparent restitution coefficient along the frequency ratio (Eq. 17).


rule apparent_restitution:
    message:
        "Apparent restitution for {wildcards.figure}"
    input:
        source=modules("studies.frequency_sweeps"),
    output:
        data="results/figures/{figure}.nc",
    wildcard_constraints:
        figure="fig05|fig06",
    params:
        parameters=figure_parameters,
        release=config["release"],
    log:
        "results/logs/apparent_restitution/{figure}.log",
    benchmark:
        "results/benchmarks/apparent_restitution/{figure}.tsv"
    script:
        "../scripts/apparent_restitution.py"
