# The accepted record in git: figures/ of the house and the texts beside it. Its history is
# `git log figures/`.
# Both rules have no outputs, so that Snakemake runs them at each call.

from bouncing_ball_beyond.inherited.pipeline.run import (
    concluded,
    lines_by_reason,
    names_of_artifacts,
    not_made,
    requested,
)


# ONLY='fig08 table1' snakemake --cores 1 accept; without ONLY, all artifacts that have moved.
rule accept:
    localrule: True
    message:
        "Copying the results over the record"
    input:
        rules.all.input,
    params:
        house=HOUSE,
    log:
        "results/logs/accept.log",
    run:
        work("accept.py", rule, input, output, params, log)


# A local rule, because the jobs of a cluster do not know what else was requested.
rule diff:
    """The results against the record; `fig14 diff` makes and compares this artifact alone."""
    localrule: True
    message:
        "Comparing the results with the record"
    input:
        lambda wildcards: requested(workflow) or rules.all.input,
    params:
        house=HOUSE,
        artifacts=lambda wildcards: names_of_artifacts(requested(workflow)),
    log:
        "results/logs/diff.log",
    run:
        work("diff.py", rule, input, output, params, log)


# The limit of jobs per second is off: with it, each job that starts or ends makes Snakemake examine
# all waiting jobs again every second until the run ends.
onstart:
    workflow.scheduler.job_rate_limiter = None
    remove_reports()


# A difference or a refusal is not a failure of the job: it gives one line, and exit status 1.
onsuccess:
    if conclusion := concluded():
        sys.exit(conclusion)


# What can be made is made, although a job failed. The rest is listed, and `diff`, which the failed
# job has stopped, compares what is there.
onerror:
    unmade = not_made(workflow)
    if unmade and "diff" in workflow.dag_settings.targets:
        from bouncing_ball_beyond.inherited.pipeline.diff.report import write_reports

        sys.exit(write_reports(Path(HOUSE), names_of_artifacts(requested(workflow)), unmade))
    if unmade:
        sys.exit("\n".join(lines_by_reason(unmade)))
