# The replication article, every number from a dataset, and the tally of the claims.

ARTICLE = Path(ROOT, "workflow/report/paper")


rule paper:
    message:
        "Writing results/paper.md"
    input:
        templates=sorted(os.path.relpath(path) for path in ARTICLE.glob("*.md.j2")),
        error_law="config/error_law.csv",
        atlas="config/atlas.nc",
        references=os.path.relpath(ARTICLE / "references.yaml"),
        data=datasets(DATASETS),
        tables=expand("results/figures/{table}.md", table=TABLES),
        source=modules(
            "figures.article.render",
            "figures.atlas.tables",
            "figures.tables.error_law",
            "claims.tally",
            "datasets.files",
            "datasets.netcdf",
            "configuration.yaml_file",
        ),
    output:
        paper="results/paper.md",
        tally="results/tally.txt",
    params:
        figures=len(names(Kind.FIGURE)),
    log:
        "results/logs/paper.log",
    benchmark:
        "results/benchmarks/paper.tsv"
    script:
        "../scripts/paper.py"


# Not part of a run: pandoc and Typst are needed for nothing else.
rule paper_pdf:
    name:
        "paper.pdf"
    message:
        "Setting results/paper.pdf"
    input:
        paper=rules.paper.output.paper,
        figures=expand("results/figures/{figure}.svg", figure=FIGURES),
        source=modules("figures.article.pdf", "datasets.atomic"),
    output:
        pdf="results/paper.pdf",
    log:
        "results/logs/paper_pdf.log",
    benchmark:
        "results/benchmarks/paper_pdf.tsv"
    script:
        "../scripts/paper_pdf.py"
