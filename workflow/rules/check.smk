# The configuration is checked before anything runs, against the studies of all stages.

if unknown := TABLE.keys() - {*STUDIES, *ACCEPTED}:
    sys.exit(f"workflow/artifacts.yaml: {min(unknown)} is in no stage of workflow/rules/study.smk")

# Jobs do not check the configuration again.
if workflow.is_main_process:
    from bouncing_ball.pipeline.configuration import check_configuration

    try:
        check_configuration(map(os.path.relpath, workflow.configfiles), config, STUDIES)
    except ConfigurationError as error:
        sys.exit(error)


rule config_docs:
    message:
        "Writing config/README.md and config/schema.json"
    params:
        studies=STUDIES,
    log:
        "results/logs/config_docs.log",
    script:
        "../scripts/config_docs.py"
