# Parameters in, a dataset out: a rule for each stage of the paper, which makes the datasets of its
# artifacts. All values are dimensionless: times Ωt, lengths Ω²y/g, velocities Ωẏ/g, with phases in
# radians.
for stage, entries in STAGES.items():

    rule:
        name:
            stage
        message:
            "{wildcards.artifact}: {params.title}"
        input:
            data=lambda w: [
                ACCEPTED.get(x, f"results/figures/{x}.nc")
                for x in TABLE[w.artifact].get("reads", [])
            ],
            source=lambda w: modules(STUDIES[w.artifact].rpartition(".")[0]),
        output:
            data="results/figures/{artifact}.nc",
        wildcard_constraints:
            artifact="|".join(name for name in entries if name in STUDIES),
        params:
            study=lambda w: STUDIES[w.artifact],
            title=lambda w: TABLE[w.artifact].get("title", w.artifact),
            arguments=lambda w: arguments(STUDIES[w.artifact], w.artifact, config),
        log:
            "results/logs/stages/{artifact}.log",
        benchmark:
            "results/benchmarks/stages/{artifact}.tsv"
        script:
            "../scripts/study.py"
