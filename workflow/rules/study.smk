# Parameters in, a dataset out. Each stage of the paper uses this rule with the names of its
# artifacts; the rule itself makes none. The docstring of a study says which variables its dataset
# has and over which dimensions. All values are dimensionless: times Ωt, lengths Ω²y/g, velocities
# Ωẏ/g, with phases in radians.
rule study:
    message:
        "{wildcards.artifact}: {params.title}"
    input:
        data=lambda w: [
            ACCEPTED.get(x, f"results/figures/{x}.nc") for x in READS.get(w.artifact, [])
        ],
        source=lambda wildcards: modules(STUDIES[wildcards.artifact].rpartition(".")[0]),
    output:
        data="results/figures/{artifact}.nc",
    wildcard_constraints:
        artifact="(?!)",
    params:
        study=lambda wildcards: STUDIES[wildcards.artifact],
        title=lambda wildcards: TITLES.get(wildcards.artifact, wildcards.artifact),
        arguments=lambda w: arguments(STUDIES[w.artifact], w.artifact, config),
    log:
        "results/logs/stages/{artifact}.log",
    benchmark:
        "results/benchmarks/stages/{artifact}.tsv"
    script:
        "../scripts/study.py"
