# The results as an RO-Crate, results/ro-crate-metadata.json, from the provenance in
# the files. Without outputs, as `accept`: it describes the results as they are now.


rule crate:
    message:
        "Writing results/ro-crate-metadata.json"
    input:
        rules.all.input,
    params:
        record=ROOT,
        recipes=lambda wildcards: planned(workflow.dag),
    log:
        "results/logs/crate.log",
    script:
        "../scripts/crate.py"
