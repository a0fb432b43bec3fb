# The accepted record: figures/ and paper.md, which git holds. Only this target
# writes there.


rule accept:
    message:
        "Copying the results over the record in figures/ and paper.md"
    input:
        rules.all.input,
        data=[
            f"results/figures/{name}.nc"
            for name in [*(f for f in FIGURES if f not in SCHEMATICS), *TABLES]
        ],
    params:
        record=workflow.basedir,
    log:
        "results/logs/accept.log",
    benchmark:
        "results/benchmarks/accept.tsv"
    script:
        "../scripts/accept.py"
