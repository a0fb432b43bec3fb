# Stage: time histories of the orbits of both models.


rule time_histories:
    message:
        "Time histories for {wildcards.figure}"
    input:
        source=modules("studies.time_histories"),
    output:
        data="results/figures/{figure}.nc",
    wildcard_constraints:
        figure="fig07|fig12",
    params:
        parameters=figure_parameters,
        release=config["release"],
    log:
        "results/logs/time_histories/{figure}.log",
    benchmark:
        "results/benchmarks/time_histories/{figure}.tsv"
    script:
        "../scripts/time_histories.py"
