# The configuration is checked before anything runs, against the studies of all stages.

from bouncing_ball.atlas.plan import AtlasParameters
from bouncing_ball.configuration.check import check, configuration_model
from bouncing_ball.configuration.yaml_file import ConfigurationError, read_yaml

try:
    # Snakemake has read these files already, and taken the last of equal keys.
    for where in map(os.path.relpath, workflow.configfiles):
        read_yaml(where)
    where = "configuration"
    if workflow.is_main_process:  # jobs need not look again
        CONFIGURATION = configuration_model(STUDIES, config, atlas=AtlasParameters)
        check(CONFIGURATION, config, release=config.get("release"))
except ConfigurationError as error:
    sys.exit(f"{where}: {error}")


rule config_docs:
    localrule: True
    message:
        "Writing config/README.md and config/schema.json"
    params:
        studies=STUDIES,
        folder=Path(ROOT, "config"),
    log:
        "results/logs/config_docs.log",
    script:
        "../scripts/config_docs.py"
