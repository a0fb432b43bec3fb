# Names and functions shared by the rules.

import os
import shlex
import sys
from importlib.util import find_spec
from pathlib import Path

# Snakemake starts jobs with the path of Python without quotes.
if shlex.quote(sys.executable) != sys.executable:
    sys.exit(
        f"{sys.executable}: a path of Python with a space or a quote in it; put the .venv elsewhere"
    )

# The repository, for both Snakefiles.
ROOT = os.path.abspath(Path(str(workflow.current_basedir), "..", ".."))
# The folder with the configuration and the accepted record; the Snakefile of another house names its
# own before it includes these rules.
HOUSE = globals().get("HOUSE", ROOT)
# The section of the configuration with the parameters of the studies, and the module with the budgets
# of single artifacts.
SECTION = globals().get("SECTION", "paper")
BUDGETS = globals().get("BUDGETS", "bouncing_ball.paper.exhibits.budgets")
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

# Each process of a run imports these; what only some need is imported where they do.
from bouncing_ball.pipeline.artifacts import Artifact
from bouncing_ball.pipeline.yaml_files import ConfigurationError

sys.path.append(str(SCRIPTS))

from adapter import function

# Snakemake writes these lines before and after every job, and they do not name what it makes; and
# once that the environments for `--sdm conda` are not used.
IDLE = ("Select jobs", "Execute ", "Finished jobid", "Conda environments: ignored")
logger.addFilter(lambda record: not str(record.msg).startswith(IDLE))


# A file in `config`: that of the working directory if there is one, otherwise that of the house, so
# that `--directory` makes a run of its own beside others.
def here(path):
    return path if os.path.exists(path) else os.path.relpath(Path(HOUSE, path))


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
        given = {"module": module, "figures": figures or f"{module}_figures", **given}
        ARTIFACTS[name] = Artifact(name=name, section=SECTION, **given)
    return "|".join(artifacts)


# The values that a study takes from the configuration.
def arguments_of(artifact):
    from bouncing_ball.pipeline.configuration import arguments

    return arguments(
        function(artifact.module, artifact.study), artifact.section, artifact.name, config
    )


# The budgets of single artifacts stand with the studies, in the module `budgets` beside them.
def budgets_of(artifact):
    return function(BUDGETS, "BUDGETS").get(artifact.name, {})


# The one input that stands for the code of a job: its note, see the module `sources`. `--touch` leaves
# it as it is, so that a digest that has changed is written by the next run.
def code(job, script, *modules, files=(), data=()):
    path = Path("results", "code", job)
    if path.exists() and (workflow.touch or not workflow.is_main_process):
        return str(path)
    from bouncing_ball.pipeline.sources import recall, sources, write_note

    recall(path.parent)

    # An accepted dataset counts as code, because no job makes it.
    accepted = [file for file in data if file in ACCEPTED and os.path.isfile(file)]
    read = [SCRIPTS / "adapter.py", SCRIPTS / script, *files, *accepted]
    read = [Path(file).resolve() for file in read]
    try:
        found = sources(modules, read)
        write_note(path, found, os.path.relpath(HOUSE))
    except OSError as error:
        sys.exit(f"{path} cannot be written: {error.strerror}")
    return str(path)
