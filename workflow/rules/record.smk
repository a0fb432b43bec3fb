# The accepted record: figures/ and paper.md, which git holds, with accepted.csv,
# which says why it moved. Only this target writes there:
#     snakemake --cores 1 accept --config reason="…"
# It has no output and no benchmark, so that it looks at the record each time.


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
        reason=config.get("reason", ""),
    log:
        "results/logs/accept.log",
    script:
        "../scripts/accept.py"
