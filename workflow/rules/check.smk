# The configuration is checked before anything runs, against the studies of all stages.

# Jobs do not check the configuration again.
if workflow.is_main_process:
    from bouncing_ball.pipeline.configuration import check_configuration
    from whole_configuration import configuration_type

    try:
        check_configuration(
            map(os.path.relpath, workflow.configfiles),
            config,
            configuration_type(ARTIFACTS.values()),
        )
    except ConfigurationError as error:
        sys.exit(error)


rule config_docs:
    message:
        "Writing config/README.md and config/schema.json"
    params:
        artifacts=list(ARTIFACTS.values()),
    log:
        "results/logs/config_docs.log",
    conda:
        ENVIRONMENT
    script:
        "../scripts/config_docs.py"


# From the accepted record, so that it has no inputs that a run makes.
rule readme:
    message:
        "Writing the generated parts of README.md, and the pages of figures/"
    params:
        artifacts=ARTIFACTS,
    log:
        "results/logs/readme.log",
    conda:
        ENVIRONMENT
    script:
        "../scripts/readme.py"
