# Tables, claims and the article are written from the datasets.


rule table:
    """Writes a table as text, from its dataset"""
    input:
        data=["results/figures/{table}.nc"],
        code=code("tables"),
    output:
        md=["results/figures/{table}.md"],
        csv=[report("results/figures/{table}.csv", category="Tables", labels={"table": "{table}"})],
    log:
        "results/logs/{table}.log",
    conda:
        "../envs/environment.yaml"
    script:
        "../scripts/tables.py"


rule claims:
    """The claims of the paper and their verdicts"""
    input:
        **PRINTED,
        data=expand("results/figures/{name}.nc", name=DATASETS),
        code=code("claims"),
    output:
        nc="results/figures/claims.nc",
        md="results/figures/claims.md",
        csv=report("results/figures/claims.csv", category="Tables", labels={"table": "claims"}),
    log:
        "results/logs/claims.log",
    conda:
        "../envs/environment.yaml"
    script:
        "../scripts/claims.py"


rule article:
    """The article, its supplement, the list of figures and the page results/index.html"""
    input:
        data=expand("results/figures/{name}.nc", name=[*DATASETS, "claims"]),
        templates=[
            checkout(f"workflow/templates/{name}.j2")
            for name in (
                "paper.md",
                "supplement.md",
                "findings.yaml",
                "figures.md",
                "figures.html",
            )
        ],
        code=code("article"),
    output:
        paper="results/paper.md",
        supplement="results/supplement.md",
        figures="results/figures/README.md",
        index="results/index.html",
    params:
        entries=ENTRIES,
    log:
        "results/logs/article.log",
    conda:
        "../envs/environment.yaml"
    script:
        "../scripts/article.py"
