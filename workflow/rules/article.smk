# The replication article with its supplement, in which every number comes from a dataset, and the
# tally of the claims.

ARTICLE = os.path.relpath(Path(ROOT, "workflow/report/paper"))


rule paper:
    message:
        "Writing results/paper.md and results/supplement.md"
    input:
        templates=sorted(map(str, Path(ARTICLE).glob("*.md.j2"))),
        atlas="config/atlas.nc",
        references=[f"{ARTICLE}/references.yaml", f"{ARTICLE}/numbered.csl"],
        data=map(dataset, STUDIES),
        tables=expand("results/figures/{table}.md", table=TABLES),
        source=modules(
            *("pipeline.article", "beyond.atlas.figures", "paper.claims.tables"),
            "paper.claims.claims",
        ),
    output:
        paper="results/paper.md",
        supplement="results/supplement.md",
        tally="results/tally.txt",
    log:
        "results/logs/paper.log",
    script:
        "../scripts/paper.py"


# The PDFs are not part of a run, because only they need Typst.
rule paper_pdf:
    name:
        "paper.pdf"
    message:
        "Setting results/paper.pdf and results/supplement.pdf"
    input:
        texts=[rules.paper.output.paper, rules.paper.output.supplement],
        template=f"{ARTICLE}/article.typ",
        figures=expand("results/figures/{figure}.svg", figure=DRAWINGS),
        source=modules("pipeline.article", "datasets.files"),
    output:
        "results/paper.pdf",
        "results/supplement.pdf",
    log:
        "results/logs/paper_pdf.log",
    script:
        "../scripts/paper_pdf.py"
