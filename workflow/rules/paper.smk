# Rendering: the replication article, every number from a dataset.


rule paper:
    message:
        "Writing results/paper.md"
    input:
        template="workflow/report/paper.md.j2",
        data=[
            f"results/figures/{name}.nc"
            for name in [*(f for f in FIGURES if f not in SCHEMATICS), *TABLES]
        ],
        tables=expand("results/figures/{table}.md", table=TABLES),
        source=modules("pipeline.files", "datasets.netcdf"),
    output:
        paper="results/paper.md",
    log:
        "results/logs/paper.log",
    benchmark:
        "results/benchmarks/paper.tsv"
    script:
        "../scripts/paper.py"
