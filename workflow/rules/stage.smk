# What all stages have in common. A stage computes the datasets of some artifacts; its module in the
# package has the name of its rule. All values are dimensionless: times Ωt, lengths Ω²y/g,
# velocities Ωẏ/g, with phases in radians.


rule shard:
    """Some of the places of a study that has `shards` in its parameters."""
    message:
        "{wildcards.artifact}: shard {wildcards.shard}"
    input:
        code=lambda w: code(
            f"{w.artifact}-shards",
            "shard.py",
            ARTIFACTS[w.artifact].module,
        ),
    output:
        data="results/shards/{artifact}/{shard}.nc",
    params:
        module=lambda w: ARTIFACTS[w.artifact].module,
        places=lambda w: ARTIFACTS[w.artifact].places,
        title=lambda w: f"{ARTIFACTS[w.artifact].title}: the places of one shard",
        arguments=lambda w: arguments_of(ARTIFACTS[w.artifact]),
    log:
        "results/logs/shards/{artifact}/{shard}.log",
    conda:
        ENVIRONMENT
    script:
        "../scripts/shard.py"


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
        shards=shards_of,
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
        # An accepted sample is in the repository.
        compressed=lambda w: ARTIFACTS[w.artifact].accepted is not None,
    log:
        "results/logs/stages/{artifact}.log",
    conda:
        ENVIRONMENT
    script:
        # The rules of another house, in its folder, use this one.
        f"{SCRIPTS}/study.py"
