# What all stages have in common. A stage computes the datasets of some artifacts; its module in the
# package has the name of its rule. All values are dimensionless: times Ωt, lengths Ω²y/g,
# velocities Ωẏ/g, with phases in radians.


rule study:
    """What all stages have in common. It makes nothing itself."""
    message:
        "{wildcards.artifact}: {params.title}"
    input:
        code=lambda w: code(
            w.artifact,
            "study.py",
            ARTIFACTS[w.artifact].module,
            data=[ARTIFACTS[name].dataset for name in ARTIFACTS[w.artifact].reads],
        ),
        data=lambda w: [ARTIFACTS[name].dataset for name in ARTIFACTS[w.artifact].reads],
    output:
        data="results/figures/{artifact}.nc",
    wildcard_constraints:
        # No name matches this.
        artifact="(?!)",
    params:
        module=lambda w: ARTIFACTS[w.artifact].module,
        study=lambda w: ARTIFACTS[w.artifact].study,
        title=lambda w: ARTIFACTS[w.artifact].title,
        drawing=lambda w: ARTIFACTS[w.artifact].drawn_by,
        arguments=lambda w: arguments_of(ARTIFACTS[w.artifact]),
        budgets=lambda w: budgets_of(ARTIFACTS[w.artifact]),
    log:
        "results/logs/stages/{artifact}.log",
    conda:
        ENVIRONMENT
    script:
        # The rules of another house, in its folder, use this one.
        f"{SCRIPTS}/study.py"
