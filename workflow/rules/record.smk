# The accepted record: figures/ and paper.md, which git holds. Only this target
# writes there.


rule accept:
    message:
        "Copying the results over the record in figures/ and paper.md"
    input:
        rules.all.input,
        data=[f"results/figures/{name}.nc" for name in sorted({*DATASETS, "claims"})],
    params:
        record=workflow.basedir,
    log:
        "results/logs/accept.log",
    benchmark:
        "results/benchmarks/accept.tsv"
    script:
        "../scripts/accept.py"
