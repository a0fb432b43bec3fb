# The replication article with its supplement, in which every number comes from a dataset of the
# paper, and the page and the tally of the claims.

ARTICLE = os.path.relpath(Path(ROOT, "workflow/report/paper"))
TEMPLATES = sorted(map(str, Path(ARTICLE).glob("*.md.j2")))
# The words before the table of the claims.
WORDS = [f"{ARTICLE}/claims_head.md.j2", f"{ARTICLE}/claims_columns.md.j2"]


rule set_claims:
    message:
        "Setting claims"
    input:
        code=lambda wildcards: code(
            "set_claims",
            "claims.py",
            files=WORDS,
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
        tally="results/tally.txt",
    params:
        words=WORDS[0],
        title=ARTIFACTS["claims"].title,
    log:
        "results/logs/tables/claims.log",
    conda:
        ENVIRONMENT
    script:
        "../scripts/claims.py"


# The artifacts of the paper, from which its article is made.
OF_PAPER = list(ARTIFACTS.values())


rule paper:
    message:
        "Writing results/paper.md and results/supplement.md"
    input:
        code=lambda wildcards: code(
            "paper",
            "paper.py",
            files=[*TEMPLATES, f"{ARTICLE}/references.yaml", f"{ARTICLE}/numbered.csl"],
        ),
        citation=os.path.relpath(Path(ROOT, "CITATION.cff")),
        data=[each.dataset for each in OF_PAPER if each.dataset],
        tables=[f"results/{each.place}.md" for each in OF_PAPER if each.table],
    output:
        # The supplement is the first, because the article refers to its sections.
        supplement="results/supplement.md",
        paper="results/paper.md",
    params:
        templates=[f"{ARTICLE}/supplement.md.j2", f"{ARTICLE}/article.md.j2"],
        shared=None,
        artifacts={each.name: each for each in OF_PAPER},
    log:
        "results/logs/paper.log",
    conda:
        ENVIRONMENT
    script:
        "../scripts/paper.py"


# The PDFs are not part of a run, because only they need Typst.
rule paper_pdf:
    name:
        "paper.pdf"
    message:
        "Setting results/paper.pdf and results/supplement.pdf"
    input:
        code=lambda wildcards: code(
            "paper_pdf",
            "paper_pdf.py",
            files=[f"{ARTICLE}/article.typ"],
        ),
        texts=[
            rules.paper.output.paper,
            rules.paper.output.supplement,
        ],
        figures=[f"results/{each.place}.svg" for each in OF_PAPER if each.drawing],
    output:
        "results/paper.pdf",
        "results/supplement.pdf",
    params:
        template=f"{ARTICLE}/article.typ",
    log:
        "results/logs/paper_pdf.log",
    conda:
        ENVIRONMENT
    script:
        "../scripts/paper_pdf.py"
