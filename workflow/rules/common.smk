# Names and functions shared by the rules.

import gc
import os
import shlex
import sys
from contextlib import suppress
from importlib.util import cache_from_source, find_spec
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
# The environment of all rules for `--sdm conda`; otherwise a job has the Python of Snakemake itself.
ENVIRONMENT = f"{ROOT}/environment.yml"
# The package may belong to another checkout whose environment is active.
HERE = Path(ROOT, "src", "bouncing_ball")
found = Path(getattr(find_spec("bouncing_ball"), "origin", "nowhere/at/all")).parent
if found.resolve() != HERE.resolve():
    sys.exit(
        f"bouncing_ball is imported from {found}, not from {HERE}: use this checkout's .venv (make setup)"
    )

# A link to a folder that does not exist is no folder either.
if os.path.lexists("results") and not os.path.isdir("results"):
    sys.exit("results is no folder, but the run writes its files there: move it away")

SCRIPTS = Path(ROOT, "workflow", "scripts")

# Python runs bytecode without reading the source if the size and the time of the source are those
# of the last compilation, and both may be restored after an edit. The time of the last change that
# the file system itself keeps cannot: bytecode that is older is removed. Another run that was
# started at the same time may have removed it in between.
for path in (*HERE.rglob("*.py"), *SCRIPTS.glob("*.py")):
    bytecode = Path(cache_from_source(path))
    with suppress(FileNotFoundError):
        if path.stat().st_ctime_ns > bytecode.stat().st_mtime_ns:
            bytecode.unlink()

from bouncing_ball.pipeline.artifacts import Artifact
from bouncing_ball.pipeline.configuration import arguments
from bouncing_ball.pipeline.yaml_files import ConfigurationError
from bouncing_ball.pipeline.sources import digests, keep_digests, lines_of_versions, sources

sys.path.append(str(SCRIPTS))

from adapter import function

# Snakemake writes these lines before and after every job, and they do not name what it makes; and
# once that the environments for `--sdm conda` are not used.
IDLE = ("Select jobs", "Execute ", "Finished jobid", "Conda environments: ignored")
logger.addFilter(lambda record: not str(record.msg).startswith(IDLE))


# A file in `config`: that of the working directory if there is one, otherwise that of the
# repository, so that `--directory` makes a run of its own beside others.
def here(path):
    return path if os.path.exists(path) else os.path.relpath(Path(ROOT, path))


# All artifacts by name, as the stages list them.
ARTIFACTS = {}
# The files of the datasets that are accepted by hand.
ACCEPTED = set()


# The artifacts of a stage: its module in the package, with the studies, and the module of its
# figures and tables, which has the same name with `_figures`, unless another one is given. The
# result is a pattern of their names.
def stage(module, figures=None, **artifacts):
    for name, given in artifacts.items():
        if accepted := given.get("accepted"):
            given = {**given, "accepted": here(accepted)}
            ACCEPTED.add(given["accepted"])
        ARTIFACTS[name] = Artifact(
            name=name, module=module, figures=figures or f"{module}_figures", **given
        )
    return "|".join(artifacts)


# The values that a study takes from the configuration.
def arguments_of(artifact):
    return arguments(
        function(artifact.module, artifact.study), artifact.part, artifact.name, config
    )


# The shards that a study merges, if it has several. The dataset is that of one job, byte for byte,
# and a run that was interrupted goes on with the next shard.
def shards_of(wildcards):
    from bouncing_ball.datasets.shards import shard_names

    given = arguments_of(ARTIFACTS[wildcards.artifact])
    count = given.get("parameters", {}).get("shards", 1)
    names = shard_names(count) if count > 1 else []
    return expand(rules.shard.output.data, shard=names, **wildcards)


# The one input that stands for the code of a job: a file with the digests of its script, of the
# named modules, of all modules and data that these import and read, and of the accepted datasets
# among its data, which no job makes; and with the versions of the libraries. It is written only if
# one of these changes, and the job then runs again. `--touch` leaves it as it is, so that a digest
# that has changed is written by the next run.
def code(job, script, *modules, files=(), data=()):
    path = Path("results", "code", job)
    if path.exists() and (workflow.touch or not workflow.is_main_process):
        return str(path)
    accepted = [file for file in data if file in ACCEPTED and os.path.isfile(file)]
    read = [SCRIPTS / "adapter.py", SCRIPTS / script, *files, *accepted]
    read = [Path(file).resolve() for file in read]
    found = sources([f"bouncing_ball.{module}" for module in modules], read)
    try:
        keep_digests(path, f"{digests(found)}\n{lines_of_versions()}")
    except OSError as error:
        sys.exit(f"{path} cannot be written: {error.strerror}")
    return str(path)
