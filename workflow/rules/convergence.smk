# How far numbers move with tolerances, grids and rounding: what the budgets in
# config/tolerances.yaml are made from. Not part of a run; accepted by hand,
# `cp results/convergence.csv config/`, and then a test says which budgets change.


rule convergence:
    message:
        "Convergence study of all stages: about a minute"
    input:
        tolerances="config/tolerances.yaml",
        source=modules(
            "audit.convergence",
            "compare.budgets",
            "compare.pictures",
            "figures.style",
            "datasets.files",
            "compare.tolerance_file",
            "figures.tables.formats",
            *(f"figures.{DRAWINGS[name]}".rpartition(".")[0] for name in FIGURES),
            *(stage.module for stage in studied()),
        ),
    output:
        changes="results/convergence.csv",
    params:
        run={key: part for key, part in RUN.items() if key != "ledger"},
        figures=FIGURES,
    log:
        "results/logs/convergence.log",
    benchmark:
        "results/benchmarks/convergence.tsv"
    script:
        "../scripts/convergence.py"
