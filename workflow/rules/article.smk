# The replication article with its supplement, in which every number comes from a dataset of the
# paper, and the page of the claims.

ARTICLE = os.path.relpath(Path(ROOT, "workflow/report/paper"))
TEMPLATES = sorted(map(str, Path(ARTICLE).glob("*.md.j2")))


rule set_claims:
    message:
        "Setting claims"
    input:
        # The page begins with words.
        code=code(
            "set_claims.py", f"{ARTICLE}/claims_head.md.j2", f"{ARTICLE}/claims_columns.md.j2"
        ),
        data="results/figures/claims.nc",
    output:
        csv=report(
            "results/figures/claims.csv",
            caption="../report/title.rst",
            category="Claims",
            labels={"table": "claims"},
        ),
        md="results/figures/claims.md",
    params:
        words=f"{ARTICLE}/claims_head.md.j2",
        title=ARTIFACTS["claims"].title,
    log:
        "results/logs/set_claims.log",
    run:
        work("set_claims.py", rule, input, output, params, log)


rule claims:
    """The verdicts on the claims with their dataset."""
    localrule: True
    input:
        "results/figures/claims.nc",
        rules.set_claims.output,


rule paper:
    message:
        "Writing results/paper.md and results/supplement.md"
    input:
        code=code("paper.py", *TEMPLATES, f"{ARTICLE}/references.yaml", f"{ARTICLE}/numbered.csl"),
        citation=os.path.relpath(Path(ROOT, "CITATION.cff")),
        data=[
            rules.compute_fig02.output,
            rules.compute_fig03.output,
            rules.compute_fig05.output,
            rules.compute_fig06.output,
            rules.compute_fig07.output,
            rules.compute_fig08.output,
            rules.compute_fig09.output,
            rules.compute_fig10.output,
            rules.compute_fig11.output,
            rules.compute_fig12.output,
            rules.compute_fig13.output,
            rules.compute_fig14.output,
            rules.compute_fig15.output,
            rules.compute_fig16.output,
            rules.compute_table1.output,
            rules.compute_thresholds.output,
            rules.compute_lowest_doubling.output,
            rules.compute_three_balls.output,
            rules.compute_formulas.output,
            rules.compute_forensics.output,
            rules.compute_witness.output,
            rules.compute_claims.output,
        ],
        tables=[
            rules.set_table1.output.md,
            rules.set_thresholds.output.md,
            rules.set_formulas.output.md,
            rules.set_forensics.output.md,
            rules.set_witness.output.md,
        ],
    output:
        # The supplement is the first, because the article refers to its sections.
        supplement="results/supplement.md",
        paper="results/paper.md",
    params:
        templates=[f"{ARTICLE}/supplement.md.j2", f"{ARTICLE}/article.md.j2"],
        shared=None,
        artifacts=ARTIFACTS,
    log:
        "results/logs/paper.log",
    run:
        work("paper.py", rule, input, output, params, log)


# The PDFs are not part of a run, because only they need Typst.
rule paper_pdf:
    name:
        "paper.pdf"
    message:
        "Setting results/paper.pdf and results/supplement.pdf"
    input:
        code=code("paper_pdf.py", f"{ARTICLE}/article.typ"),
        texts=[
            rules.paper.output.paper,
            rules.paper.output.supplement,
        ],
        # A picture has a script.
        figures=[
            f"results/figures/{name}.svg"
            for name in ARTIFACTS
            if os.path.exists(Path(ROOT, "workflow", "scripts", f"draw_{name}.py"))
        ],
    output:
        "results/paper.pdf",
        "results/supplement.pdf",
    params:
        template=f"{ARTICLE}/article.typ",
    log:
        "results/logs/paper_pdf.log",
    run:
        work("paper_pdf.py", rule, input, output, params, log)
