# The stages, which are the sections of config.yaml. Each has a rule `compute_STAGE`, which computes its
# datasets by the script of its name, and a rule `STAGE`, which draws its figures from these datasets,
# in one job, because most of its time is that for the imports.

for stage in COMPUTED:

    rule:
        name:
            f"compute_{stage}"
        input:
            **READS.get(stage, {}),
            code=code(stage),
        output:
            **datasets(stage),
        params:
            stage=stage,
            entries=titled_parameters(stage),
            settings=settings(stage),
        log:
            f"results/logs/compute_{stage}.log",
        benchmark:
            f"results/benchmarks/compute_{stage}.tsv"
        conda:
            "../envs/environment.yaml"
        script:
            "../scripts/{params.stage}.py"


for stage in DRAWN:

    rule:
        name:
            stage
        input:
            data=figure_datasets(stage),
            code=code("draw"),
        output:
            **pictures(stage),
        log:
            f"results/logs/{stage}.log",
        conda:
            "../envs/environment.yaml"
        script:
            "../scripts/draw.py"
