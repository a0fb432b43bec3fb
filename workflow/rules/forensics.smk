# Stage: Table 1 under readings of what the authors may have done.


rule forensics_stage:
    message:
        "Readings of Table 1 for forensics"
    input:
        source=modules("audit.forensics.study"),
    output:
        data="results/figures/forensics.nc",
    params:
        parameters=config["studies"]["forensics"] | {"printed": TABLE1},
    log:
        "results/logs/forensics_stage.log",
    benchmark:
        "results/benchmarks/forensics_stage.tsv"
    script:
        "../scripts/forensics.py"
