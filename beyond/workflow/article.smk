# The article of what goes past the paper, from the results of its studies and the accepted verdicts
# on the paper.

PAPER = os.path.relpath(Path(ROOT, "workflow/report/paper"))
TEMPLATES = os.path.relpath(Path(HOUSE, "report"))
SHOWN = [
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
        "claims",
    )
]


rule beyond_article:
    message:
        "Writing results/article.md"
    input:
        code=lambda wildcards: code(
            "beyond_article",
            "paper.py",
            files=[
                *sorted(map(str, Path(TEMPLATES).glob("*.md.j2"))),
                f"{TEMPLATES}/references.yaml",
                f"{PAPER}/macros.md.j2",
                f"{PAPER}/front_matter.md.j2",
                f"{PAPER}/references.yaml",
                f"{PAPER}/numbered.csl",
            ],
            data=[each.dataset for each in SHOWN],
        ),
        citation=os.path.relpath(Path(ROOT, "CITATION.cff")),
        data=[each.dataset for each in SHOWN],
        tables=[f"results/{each.place}.md" for each in SHOWN if each.table],
    output:
        "results/article.md",
    params:
        templates=[f"{TEMPLATES}/article.md.j2"],
        shared=PAPER,
        artifacts=ARTIFACTS,
    log:
        "results/logs/article.log",
    conda:
        ENVIRONMENT
    script:
        f"{SCRIPTS}/paper.py"
