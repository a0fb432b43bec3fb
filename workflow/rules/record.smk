# The accepted record: figures/ and paper.md, which git holds, with accepted.csv,
# which says why it moved. Only this target writes there:
#     REASON="…" snakemake --cores 1 accept
# It has no output and no benchmark, so that it looks at the record each time.

from bouncing_ball.record.recipe import Recipe


def recipes(dag):
    """What every file is made from by this workflow, to be compared with what it was."""
    return [
        Recipe.of(job, Path(str(job.rule.snakefile)).parent / job.rule.script)
        for job in dag.jobs
        if job.output
    ]


rule accept:
    message:
        "Copying the results over the record in figures/ and paper.md"
    input:
        artifacts=rules.all.input.artifacts,
        paper=rules.paper.output.paper,
    params:
        record=workflow.basedir,
        recipes=lambda wildcards: recipes(workflow.dag),
    log:
        "results/logs/accept.log",
    script:
        "../scripts/accept.py"
