# The error law on 10⁵ random orbits under each release rule. Not part of a run, as
# it takes minutes; accepted by hand, `cp results/error_law.csv config/`, and the
# article takes its numbers from there.


rule error_law:
    message:
        "Error law on random orbits: some minutes"
    input:
        source=modules("studies.law_distribution", "datasets.files", "figures.tables.formats"),
    output:
        summary="results/error_law.csv",
    params:
        size=100_000,
        seed=RUN["extensions"]["ext_orders"]["random"]["seed"],
        span=RUN["extensions"]["ext_orders"]["frequency_ratio"],
    log:
        "results/logs/error_law.log",
    benchmark:
        "results/benchmarks/error_law.tsv"
    script:
        "../scripts/error_law.py"
