# Check the configuration before anything runs; names shared by the rules.

import gc
import os
import shlex
import sys
from importlib.util import find_spec
from pathlib import Path

# What Snakemake has imported stays. Not to look through it for garbage again and again saves
# half a second of each start.
gc.freeze()

# Snakemake starts jobs by the path of Python as it is.
if shlex.quote(sys.executable) != sys.executable:
    sys.exit(
        f"{sys.executable}: a path of Python with a space or a quote in it; put the .venv elsewhere"
    )

# The repository, whichever Snakefile was called.
ROOT = os.path.abspath(Path(str(workflow.current_basedir), "..", ".."))
# Not the code of another checkout, whose environment this may be.
HERE = Path(ROOT, "src", "bouncing_ball").resolve()
package = find_spec("bouncing_ball")
if package is None or Path(package.origin).resolve().parent != HERE:
    found = Path(package.origin).parent if package else "nowhere"
    sys.exit(
        f"bouncing_ball is imported from {found}, not from {HERE}: use this checkout's .venv (make setup)"
    )

from bouncing_ball.configuration.check import check_configuration, check_orbits
from bouncing_ball.configuration.stages import ENTRIES, STAGES, Kind, names, studied, tables
from bouncing_ball.errors import ModelError
from bouncing_ball.configuration.yaml_file import read_yaml
from bouncing_ball.pipeline.atlas import discard_damaged, shard_names
from bouncing_ball.pipeline.pieces import check_entries, check_pieces
from bouncing_ball.pipeline.sources import sources

# Two lines before every job, which say nothing of it.
logger.addFilter(lambda record: not str(record.msg).startswith(("Select jobs", "Execute ")))

FIGURES = names(Kind.FIGURE, Kind.EXTENSION)
TABLES = tables()
DATASETS = [stage.name for stage in studied()]

where = "stages"
try:
    check_entries(ENTRIES)
    # Snakemake has read these files already, and taken the last of equal keys.
    for where in map(os.path.relpath, workflow.configfiles):
        read_yaml(where)
    where = "configuration"
    check_configuration(config, read_yaml(Path(ROOT, "config/schema.yaml")))
    if workflow.is_main_process:  # jobs need not look again
        check_orbits(config)
    # All that parameters and settings of the stages are taken from.
    RUN = config
    where = "stages"
    if workflow.is_main_process:
        check_pieces(STAGES, RUN)
except ModelError as error:
    sys.exit(f"{where}: {error}")


def stage_of(wildcards):
    return STAGES[wildcards.artifact]


def datasets(artifacts):
    return [f"results/figures/{name}.nc" for name in artifacts]


def files(artifacts):
    """All that is published of artifacts: the dataset, and what is made from it."""
    return [
        f"results/figures/{name}.{kind}"
        for name in artifacts
        for kind in [
            *(["nc"] if STAGES[name].study else []),
            *(["png", "svg"] if name in FIGURES else []),
            *(["csv", "md", "tex"] if name in TABLES else []),
            *(["html"] if STAGES[name].kind is Kind.PAGE else []),
        ]
    ]


def captioned(name):
    return Path(ROOT, f"workflow/report/{name}.rst").is_file()


def modules(*names):
    """Source files that a job uses: those modules and all that they import.

    Relative paths, so that a folder may be moved without running all again.
    """
    files = sources("bouncing_ball.pipeline.job", *(f"bouncing_ball.{name}" for name in names))
    return [os.path.relpath(file) for file in files]


# What the shards of the atlas are made from.
ATLAS = {key: part for key, part in RUN["atlas"].items() if key != "summary"}


def shard_files(wildcards):
    """The shards of the atlas; one that is damaged is removed, and so made again."""
    paths = [f"results/atlas/shards/{name}.nc" for name in [*shard_names(ATLAS), "limits"]]
    if workflow.is_main_process:
        for path in discard_damaged(paths):
            logger.warning(f"{path} is damaged: it is made again")
    return paths
