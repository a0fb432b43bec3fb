# The article of what goes past the paper, from the results of its studies and the accepted verdicts
# on the paper.

BEYOND_ARTICLE = os.path.relpath(Path(ROOT, "beyond/report"))
OF_BEYOND = [
    ARTIFACTS[name]
    for name in (
        "ext_instant",
        "ext_orders",
        "ext_map",
        "ext_laws",
        "ext_release",
        "ext_impact",
        "ext_flights",
        "ext_proofs",
        "ext_verdicts",
    )
]
# The part of the accepted record that the article reads.
RECORDED = [os.path.relpath(Path(ROOT, "figures/claims.nc"))]


rule beyond_article:
    message:
        "Writing results/beyond/article.md"
    input:
        code=lambda wildcards: code(
            "beyond_article",
            "paper.py",
            files=[
                *sorted(map(str, Path(BEYOND_ARTICLE).glob("*.md.j2"))),
                f"{BEYOND_ARTICLE}/references.yaml",
                f"{ARTICLE}/macros.md.j2",
                f"{ARTICLE}/front_matter.md.j2",
                f"{ARTICLE}/references.yaml",
                f"{ARTICLE}/numbered.csl",
            ],
        ),
        citation=os.path.relpath(Path(ROOT, "CITATION.cff")),
        data=[*(each.dataset for each in OF_BEYOND), *RECORDED],
        tables=[f"results/{each.place}.md" for each in OF_BEYOND if each.table],
    output:
        "results/beyond/article.md",
    params:
        templates=[f"{BEYOND_ARTICLE}/article.md.j2"],
        shared=ARTICLE,
        artifacts=ARTIFACTS,
    log:
        "results/logs/beyond_article.log",
    conda:
        ENVIRONMENT
    script:
        "../scripts/paper.py"
