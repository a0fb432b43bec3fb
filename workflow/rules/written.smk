# Pages about the replication that are in git. They have no outputs, so that Snakemake makes them at
# each call.


rule config_docs:
    message:
        "Writing config/README.md and config/schema.json"
    log:
        "results/logs/config_docs.log",
    conda:
        ENVIRONMENT
    script:
        "../scripts/config_docs.py"


# From the accepted record, so that it has no inputs that a run makes.
rule readme:
    message:
        "Writing the generated parts of README.md, and figures/README.md"
    log:
        "results/logs/readme.log",
    conda:
        ENVIRONMENT
    script:
        "../scripts/readme.py"
