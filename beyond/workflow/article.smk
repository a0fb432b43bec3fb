# The article, from the results of the studies that it is about and the accepted verdicts on the
# paper.

PAPER = os.path.relpath(Path(ROOT, "workflow/report/paper"))
TEMPLATES = os.path.relpath(Path(HOUSE, "report"))


rule beyond_article:
    message:
        "Writing results/article.md"
    input:
        code=code(
            f"{ROOT}/workflow/scripts/paper.py",
            *sorted(map(str, Path(TEMPLATES).glob("*.md.j2"))),
            f"{TEMPLATES}/references.yaml",
            f"{PAPER}/macros.md.j2",
            f"{PAPER}/front_matter.md.j2",
            f"{PAPER}/references.yaml",
            f"{PAPER}/numbered.csl",
            "../figures/claims.nc",
        ),
        citation=os.path.relpath(Path(ROOT, "CITATION.cff")),
        data=[
            rules.compute_ext_instant.output,
            rules.compute_ext_orders.output,
            rules.compute_ext_map.output,
            rules.compute_ext_laws.output,
            "../figures/claims.nc",
        ],
        tables=[],
    output:
        "results/article.md",
    params:
        templates=[f"{TEMPLATES}/article.md.j2"],
        shared=PAPER,
        artifacts=ARTIFACTS,
    log:
        "results/logs/article.log",
    run:
        work(f"{ROOT}/workflow/scripts/paper.py", rule, input, output, params, log)
