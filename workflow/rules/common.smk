# Names and functions shared by the rules.

import gc
import os
import shlex
import sys
from importlib.util import find_spec
from pathlib import Path

# The modules that Snakemake has imported remain in use. Excluding them from garbage collection
# saves half a second at each start.
gc.freeze()

# Snakemake starts jobs with the path of Python without quotes.
if shlex.quote(sys.executable) != sys.executable:
    sys.exit(
        f"{sys.executable}: a path of Python with a space or a quote in it; put the .venv elsewhere"
    )

# The repository, for both Snakefiles.
ROOT = os.path.abspath(Path(str(workflow.current_basedir), "..", ".."))
# The package may belong to another checkout whose environment is active.
HERE = Path(ROOT, "src", "bouncing_ball")
found = Path(getattr(find_spec("bouncing_ball"), "origin", "nowhere/at/all")).parent
if found.resolve() != HERE.resolve():
    sys.exit(
        f"bouncing_ball is imported from {found}, not from {HERE}: use this checkout's .venv (make setup)"
    )

from bouncing_ball.pipeline.configuration import arguments
from bouncing_ball.pipeline.configuration import ConfigurationError, read_yaml
from bouncing_ball.pipeline.sources import sources

# Snakemake writes these two lines before every job, and they do not name it.
logger.addFilter(lambda record: not str(record.msg).startswith(("Select jobs", "Execute ")))

# What the rules of the stages do not say about an artifact.
TABLE = read_yaml(Path(ROOT, "workflow/artifacts.yaml"))
# Datasets that are accepted by hand; a run reads them and does not make them.
ACCEPTED = {name: entry["accepted"] for name, entry in TABLE.items() if "accepted" in entry}


# The functions of the artifacts, as the rules of the stages list them.
STUDIES, DRAWINGS = {}, {}


# The artifacts of a stage, each with "study -> drawing", or its study alone if it has no figure.
def stage(**artifacts):
    for name, functions in artifacts.items():
        STUDIES[name], *drawing = functions.split(" -> ")
        DRAWINGS.update((name, draw) for draw in drawing)
    return "|".join(artifacts)


# The dataset from which figures, claims and the article are made.
def dataset(name):
    return ACCEPTED.get(name, f"results/figures/{name}.nc")


# Source files that a job uses: the named modules and all modules that they import. The paths are
# relative, so that a folder may be moved without running all jobs again.
def modules(*names):
    files = sources("bouncing_ball.pipeline.jobs", *(f"bouncing_ball.{name}" for name in names))
    return [os.path.relpath(file) for file in files]


# Inputs of the text before a table: its templates, and the modules that render them.
def words_before(wildcards):
    templates = (f"{ARTICLE}/{wildcards.table}_{part}.md.j2" for part in ("head", "columns"))
    needed = [*templates, *modules("pipeline.article")]
    return needed if wildcards.table == "claims" else []


# The shards that a study merges, if it has several. The dataset is that of one job, byte for byte,
# and a run that was interrupted goes on with the next shard.
def shards_of(wildcards):
    from bouncing_ball.datasets.shards import shard_names

    given = arguments(STUDIES[wildcards.artifact], wildcards.artifact, config)
    count = given.get("parameters", {}).get("shards", 1)
    names = shard_names(count) if count > 1 else []
    return expand(rules.shard.output.data, shard=names, **wildcards)
