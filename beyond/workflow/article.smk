# The article, from the results of the studies that it is about.

TEMPLATES = os.path.relpath(Path(HOUSE, "report"))
SHARED = f"{TEMPLATES}/shared"


rule beyond_article:
    message:
        "Writing results/article.md"
    input:
        code=code(
            "article.py",
            *sorted(map(str, Path(TEMPLATES).glob("*.md.j2"))),
            f"{TEMPLATES}/references.yaml",
            f"{SHARED}/macros.md.j2",
            f"{SHARED}/front_matter.md.j2",
            f"{SHARED}/references.yaml",
            f"{SHARED}/numbered.csl",
        ),
        citation=os.path.relpath(Path(HOUSE, "CITATION.cff")),
        # What the paper says, in numbers that are frozen.
        replicated=os.path.relpath(Path(HOUSE, "config/replicated.yaml")),
        data=[
            rules.compute_ext_instant.output,
            rules.compute_ext_orders.output,
            rules.compute_ext_map.output,
            rules.compute_ext_laws.output,
        ],
    output:
        "results/article.md",
    params:
        template=f"{TEMPLATES}/article.md.j2",
        shared=SHARED,
        artifacts=ARTIFACTS,
    log:
        "results/logs/article.log",
    run:
        work("article.py", rule, input, output, params, log)
