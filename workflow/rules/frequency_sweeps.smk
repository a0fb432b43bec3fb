# Stage: stable n-T orbits along the frequency ratio.


rule frequency_sweeps:
    message:
        "Orbits along the frequency ratio for {wildcards.figure}"
    input:
        source=modules("studies.frequency_sweeps"),
    output:
        data="results/figures/{figure}.nc",
    wildcard_constraints:
        figure="fig10|fig13",
    params:
        parameters=figure_parameters,
        release=config["release"],
    log:
        "results/logs/frequency_sweeps/{figure}.log",
    benchmark:
        "results/benchmarks/frequency_sweeps/{figure}.tsv"
    script:
        "../scripts/frequency_sweeps.py"
