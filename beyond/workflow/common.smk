# Names and functions shared by the rules. The Snakefile names before it includes them ARTIFACTS and
# BUDGETS of the package.

import os
import sys
from importlib.util import find_spec
from pathlib import Path

from bouncing_ball_beyond.inherited.pipeline.run import remove_reports
from bouncing_ball_beyond.inherited.pipeline.yaml_files import ConfigurationError, read_yaml

# The folder with the configuration and the accepted record.
HOUSE = os.path.abspath(Path(str(workflow.current_basedir), ".."))
# The package may belong to another checkout whose environment is active.
NAME = "bouncing_ball_beyond"
HERE = Path(HOUSE, "src", NAME)
found = Path(getattr(find_spec(NAME), "origin", "nowhere/at/all")).parent
if found.resolve() != HERE.resolve():
    sys.exit(
        f"{NAME} is imported from {found}, not from {HERE}: use the .venv of {HOUSE} (make setup)"
    )

# A link to a folder that does not exist is no folder either.
if os.path.lexists("results") and not os.path.isdir("results"):
    sys.exit("results is no folder, but the run writes its files there: move it away")

# Snakemake writes these lines before and after every job, and they do not name what it makes.
IDLE = ("Select jobs", "Execute ", "Finished jobid")
logger.addFilter(lambda record: not str(record.msg).startswith(IDLE))


# A file in `config`: that of the working directory if there is one, otherwise that of the house, so
# that `--directory` makes a run of its own beside others. Snakemake reads it next, and a file that is
# no text of YAML would give a traceback.
def here(path):
    if not os.path.exists(path):
        return os.path.relpath(Path(HOUSE, path))
    try:
        read_yaml(path)
    except ConfigurationError as error:
        remove_reports()
        sys.exit(f"{path}: {error}")
    return path


# The configuration is checked before any rule reads it, against its type. Jobs do not check it again.
def check(model):
    from bouncing_ball_beyond.inherited.pipeline.configuration_check import check_configuration

    try:
        check_configuration(map(os.path.relpath, workflow.configfiles), config, model)
    except ConfigurationError as error:
        from bouncing_ball_beyond.inherited.pipeline.diff.causes import code_in_place_of

        remove_reports()
        typed = workflow.config_settings.config
        sys.exit(f"{'' if typed else code_in_place_of(workflow.configfiles)}{error}")


# What the dataset of an artifact says of itself.
def about(name):
    artifact = ARTIFACTS[name]
    return {
        "title": artifact.title,
        "drawing": artifact.drawing,
        "budgets": BUDGETS.get(name, {}),
    }


# The one input that stands for the code of a job: its note, see the module `sources`, with the digests
# of the script of the house, of what the script imports, and of other files that it reads. It is found
# when the job is planned. `--touch` leaves it as it is, so that a digest that has changed is written
# by the next run.
def code(script, *files):
    def note(wildcards):
        path = Path("results", "code", Path(script).stem)
        if path.exists() and (workflow.touch or not workflow.is_main_process):
            return str(path)
        from bouncing_ball_beyond.inherited.pipeline.sources import sources, write_note

        read = [Path(file).resolve() for file in (Path(HOUSE, "workflow/scripts", script), *files)]
        try:
            write_note(path, sources(read), os.path.relpath(HOUSE))
        except OSError as error:
            sys.exit(f"{path} cannot be written: {error.strerror}")
        return str(path)

    return note


# Run the script of a job. The processes that run scripts belong to that of Snakemake, so that the
# profile has `force-use-threads`: without it, Snakemake starts itself again for each job with `run`.
def work(script, rule, input, output, params, log):
    from bouncing_ball_beyond.inherited.pipeline.workers import run_script
    from snakemake.exceptions import SpawnedJobError
    from snakemake.script import Snakemake

    path = Path(HOUSE, "workflow/scripts", script)
    folder = str(path.parent)
    job = Snakemake(input, output, params, None, 1, None, log, config, rule, None, folder)
    if not run_script(path, job):
        raise SpawnedJobError()
