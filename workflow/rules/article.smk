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
    conda:
        ENVIRONMENT
    script:
        "../scripts/set_claims.py"


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
            rules.restitution_model_study.output,
            rules.apparent_restitution_study.output,
            rules.frequency_sweeps_study.output,
            rules.time_histories_study.output,
            rules.orbit_branches_study.output,
            rules.both_domains_study.output,
            rules.stability_ranges_study.output,
            rules.permanent_contact_study.output,
            rules.height_error_study.output,
            rules.error_thresholds_study.output,
            rules.lowest_period_doubling_study.output,
            rules.kinds_of_motion_study.output,
            rules.formulas_study.output,
            rules.forensics_study.output,
            rules.witness_study.output,
            rules.claims_study.output,
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
        code=code("paper_pdf.py", f"{ARTICLE}/article.typ"),
        texts=[
            rules.paper.output.paper,
            rules.paper.output.supplement,
        ],
        figures=expand("results/figures/fig{number:02}.svg", number=range(1, 17)),
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
