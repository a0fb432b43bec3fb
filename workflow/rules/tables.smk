# Datasets in, tables out: CSV, Markdown and LaTeX.

for name in TABLES:

    rule:
        name:
            f"set_{name}"
        message:
            f"Setting {name}"
        input:
            data=f"results/figures/{name}.nc",
            source=modules(
                f"figures.tables.{name}",
                "figures.tables.formats",
                "datasets.netcdf",
                "datasets.files",
            ),
        output:
            csv=f"results/figures/{name}.csv",
            md=f"results/figures/{name}.md",
            tex=f"results/figures/{name}.tex",
        log:
            f"results/logs/tables/{name}.log",
        benchmark:
            f"results/benchmarks/tables/{name}.tsv"
        script:
            "../scripts/table.py"
