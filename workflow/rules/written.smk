# Pages about the replication that are in git. They have no outputs, so that Snakemake makes them at
# each call.


rule config_docs:
    message:
        "Writing config/README.md and config/schema.json"
    log:
        "results/logs/config_docs.log",
    run:
        work(f"{ROOT}/workflow/scripts/config_docs.py", rule, input, output, params, log)


# From the accepted record, so that it has no inputs that a run makes.
rule readme:
    message:
        "Writing the generated parts of README.md, and figures/README.md"
    log:
        "results/logs/readme.log",
    run:
        work(f"{ROOT}/workflow/scripts/readme.py", rule, input, output, params, log)
