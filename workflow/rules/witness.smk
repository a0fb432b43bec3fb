# Stage: three routes to every orbit and bifurcation that is shown.


rule witness_stage:
    message:
        "Comparing continuation, formula and simulation for witness"
    input:
        data=[f"results/figures/{name}.nc" for name in WITNESSED],
        source=modules("audit.cross_check", "datasets.netcdf"),
    output:
        data="results/figures/witness.nc",
    params:
        parameters=config["continuation"],
    log:
        "results/logs/witness_stage.log",
    benchmark:
        "results/benchmarks/witness_stage.tsv"
    script:
        "../scripts/witness.py"
