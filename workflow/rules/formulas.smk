# Stage: every printed formula against a second computation.


rule formulas_stage:
    message:
        "Checking the printed formulas"
    input:
        source=modules("audit.formulas"),
    output:
        data="results/figures/formulas.nc",
    params:
        parameters=config["studies"]["formulas"],
    log:
        "results/logs/formulas_stage.log",
    benchmark:
        "results/benchmarks/formulas_stage.tsv"
    script:
        "../scripts/formulas.py"
