# Parameters in, datasets out: one rule for all stages. What each is made from
# is in src/bouncing_ball/configuration/stages.py.


rule stage:
    message:
        "{wildcards.artifact}: {params.title}"
    input:
        data=lambda wildcards: datasets(stage_of(wildcards).reads),
        source=lambda wildcards: modules(stage_of(wildcards).module),
    output:
        data="results/figures/{artifact}.nc",
    wildcard_constraints:
        artifact="|".join(DATASETS),
    params:
        study=lambda wildcards: stage_of(wildcards).study,
        title=lambda wildcards: stage_of(wildcards).title,
        parameters=lambda wildcards: stage_of(wildcards).parameters(RUN),
        settings=lambda wildcards: stage_of(wildcards).settings(RUN),
    log:
        "results/logs/stages/{artifact}.log",
    benchmark:
        "results/benchmarks/stages/{artifact}.tsv"
    script:
        "../scripts/stage.py"
