# Tables and the article with its appendices are written from the datasets.


rule table:
    """Writes a table as text"""
    input:
        data="results/figures/{table}.nc",
        code=code("tables"),
    output:
        md="results/figures/{table}.md",
        csv=report("results/figures/{table}.csv", category="Tables", labels={"table": "{table}"}),
    log:
        "results/logs/table_{table}.log",
    conda:
        ENVIRONMENT
    script:
        "../scripts/tables.py"


rule article:
    """The article, its appendices, a page on phases and the list of figures"""
    input:
        data=expand("results/figures/{name}.nc", name=DATASETS),
        templates=[package(f"workflow/templates/{name}.md.j2") for name in TEXTS],
        code=code("article"),
    output:
        article="results/article.md",
        appendix="results/appendix.md",
        phase="results/phase.md",
        figures="results/figures/README.md",
    log:
        "results/logs/article.log",
    conda:
        ENVIRONMENT
    script:
        "../scripts/article.py"


rule explorer:
    """A page to explore the models, with the orbits that it checks itself against"""
    input:
        data=datasets("explorer").values(),
        page=[package(path) for path in EXPLORER],
        code=code("explorer_page"),
    output:
        html="results/figures/explorer.html",
    log:
        "results/logs/explorer.log",
    conda:
        ENVIRONMENT
    script:
        "../scripts/explorer_page.py"
