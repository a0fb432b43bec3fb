# The accepted record in git: figures/, paper.md and supplement.md. Its history is
# `git log figures/`.
# Both rules have no outputs, so that Snakemake runs them at each call.

from bouncing_ball.pipeline.jobs import begin, concluded


# ONLY='fig08 table1' snakemake --cores 1 accept; without ONLY, all artifacts that have moved.
rule accept:
    localrule: True
    message:
        "Copying the results over the record"
    params:
        record=ROOT,
        files=lambda wildcards: sorted({str(file) for file in rules.all.input}),
    log:
        "results/logs/accept.log",
    script:
        "../scripts/accept.py"


# The targets requested together with `diff`, as in `snakemake --cores 2 fig14 diff`. Snakemake
# knows its targets only after it has read all rules.
def requested():
    names = sorted({*workflow.dag_settings.targets} - {"diff"})
    return [name for name in names if workflow.is_rule(name)]


# The artifacts of the requested targets: the files that such a rule makes, or that it lists.
def requested_files(wildcards):
    found = map(workflow.get_rule, requested())
    files = [str(file) for rule in found for file in (rule.output or rule.input)]
    texts = ("results/paper.md", "results/supplement.md")
    return [file for file in files if file.startswith("results/figures/") or file in texts]


# A local rule, because the jobs of a cluster do not know what else was requested.
rule diff:
    """The results against the record; `fig14 diff` makes and compares this artifact alone."""
    localrule: True
    message:
        "Comparing the results with the record"
    input:
        lambda wildcards: requested_files(wildcards) or rules.all.input,
    params:
        record=ROOT,
        artifacts=lambda wildcards: sorted({Path(file).stem for file in requested_files(wildcards)}),
        name=lambda wildcards: "-".join(requested()),
    log:
        "results/logs/diff.log",
    script:
        "../scripts/diff.py"


# Each job that makes a file prints how many of these jobs are done.
# The limit of jobs per second is off: with it, each job that starts or ends makes Snakemake examine
# all waiting jobs again every second until the run ends.
onstart:
    workflow.scheduler.job_rate_limiter = None
    begin(sum(bool(job.is_script and job.output) for job in workflow.dag.needrun_jobs()))


# A difference or a refusal is not a failure of the job: it gives one line, and exit status 1.
onsuccess:
    if conclusion := concluded():
        sys.exit(conclusion)
