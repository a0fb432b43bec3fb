# Whether the results still say what the accepted record says. Without outputs
# that Snakemake knows of: so it compares at each call, and the
# reports stay where they are when a difference ends the job with status 1. The
# record is read in place and is not an input, as nothing here is made from it.


rule diff:
    message:
        "Comparing the results with the record; reports in results/diff/"
    input:
        rules.all.input,
        tolerances="config/tolerances.yaml",
    params:
        record=ROOT,
    log:
        "results/logs/diff.log",
    script:
        "../scripts/diff.py"
