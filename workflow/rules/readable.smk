# The configuration that the Snakefile names is a file that can be read.

if workflow.is_main_process and os.path.exists("config/config.yaml"):
    from bouncing_ball.pipeline.yaml_files import read_yaml

    try:
        read_yaml("config/config.yaml")
    except ConfigurationError as error:
        sys.exit(f"config/config.yaml: {error}")
