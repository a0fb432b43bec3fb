# The accepted record, figures/ and paper.md, which git holds; its log is `git log figures/`.
# Both look at the results of a whole run, and at the record at each call: they have no outputs
# that Snakemake knows of.

from bouncing_ball.pipeline.conclusion import concluded


# ONLY='fig08 table1' snakemake --cores 1 accept; without ONLY, what has moved.
rule accept:
    localrule: True
    message:
        "Copying the results over the record in figures/ and paper.md"
    input:
        rules.all.input,
    params:
        record=ROOT,
    log:
        "results/logs/accept.log",
    script:
        "../scripts/accept.py"


rule diff:
    message:
        "Comparing the results with the record"
    input:
        rules.all.input,
    params:
        record=ROOT,
    log:
        "results/logs/diff.log",
    script:
        "../scripts/diff.py"


# A difference and a refusal are no failures of their jobs: one line, and exit status 1.
onsuccess:
    if conclusion := concluded():
        sys.exit(conclusion)
