"""The adapter around a job: log, one-line errors, files.

Scripts of the workflow are three lines on top of this; ``snakemake`` is the
object that Snakemake gives them.
"""

import gc
import signal
import sys
import traceback
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import xarray as xr

from bouncing_ball.configuration.study import load, typed
from bouncing_ball.datasets.emptiness import statement
from bouncing_ball.datasets.files import write_text
from bouncing_ball.datasets.netcdf import (
    CONVENTIONS,
    DatasetError,
    parameter_attributes,
    read_dataset,
    write_dataset,
)
from bouncing_ball.record.carriers import CARRIERS
from bouncing_ball.record.job_log import is_as_written, log_lines
from bouncing_ball.record.provenance import PREFIX, Provenance
from bouncing_ball.record.recipe import Recipe, Run, gather

REFERENCE = (
    "Carbonelli, Perret-Liaudet, Rigaud and Feki, Investigation of restitution coefficient "
    "and spring-damper models for the bouncing ball problem, DETC2011-47870 (2011)"
)

HISTORY = "computed from the equations; the attributes provenance_* say by what and from what"

LOGS = "results/logs/stages"
"""Logs of the jobs that make datasets."""
ARTICLE = ("results/paper.md", "results/tally.txt")
"""What is made from all datasets and tables."""


@contextmanager
def logged(snakemake: Any) -> Iterator[list[str]]:
    """Collect lines for the job's log; on failure say in one line what failed.

    The log holds the traceback, the terminal the sentence.
    """
    # Ctrl-C ends the job at once. As an exception it can arrive while a netCDF
    # file is locked, whose closing then waits for ever; files are written whole
    # or not at all, so nothing is lost.
    signal.signal(signal.SIGINT, signal.SIG_DFL)
    # What has been imported stays: it is not looked through for garbage again.
    gc.freeze()
    # With every dataset xarray asks whether its values are quantities of pint, and to import
    # pint takes longer than to read. Those of a job are plain numbers.
    without_pint = sys.modules.setdefault("pint", None) is None  # type: ignore[arg-type]
    name = "/".join([snakemake.rule, *snakemake.wildcards])
    lines: list[str] = []
    log = Path(snakemake.log[0])
    try:
        yield lines
        # What a job wrote is known by its checksum, so that a file changed by hand is
        # seen, and what from by its own words or, for a text or a table, by the log's.
        outputs = list(snakemake.output)
        silent = outputs and not any(Path(path).suffix in CARRIERS for path in outputs)
        lines += log_lines(outputs, provenance(snakemake) if silent else None)
        write_text(log, "".join(f"{line}\n" for line in lines))
        if outputs:
            print("made", *outputs, flush=True)
    except Exception as error:
        kind = "" if isinstance(error, ValueError) else f"{type(error).__name__}: "
        sys.exit(f"{name}: {kind}{' '.join(str(error).split())} ({_details(log)})")
    finally:
        if without_pint:
            del sys.modules["pint"]


def _details(log: Path) -> str:
    """Where the traceback of the error at hand is; a full disk may not take it."""
    try:
        write_text(log, traceback.format_exc())
    except OSError as error:
        return f"no details: {log}: {error.strerror}"
    return f"details in {log}"


def withdraw() -> None:
    """Remove the article and the tally, as a job is about to change what they say.

    A run that fails then leaves neither beside new datasets and tables.
    """
    for path in ARTICLE:
        Path(path).unlink(missing_ok=True)


def read_input(path: str, log: str | Path = "") -> xr.Dataset:
    """A dataset that another job has made for this one, and whose log is that of a stage or given.

    Raises
    ------
    DatasetError
        If it is not what its job wrote, or is that of another artifact.
    """
    again = f"make it again, snakemake --cores 2 --force {path}"
    log = Path(log or Path(LOGS, f"{Path(path).stem}.log"))
    if not is_as_written(path, log):
        raise DatasetError(f"{path} is not what its job wrote, which {log} says: {again}")
    dataset = read_dataset(path)
    target = dataset.attrs.get(PREFIX + "target")
    if target != path:
        raise DatasetError(f"{path} is the dataset of {target}: {again}")
    return dataset


def provenance(snakemake: Any) -> Provenance:
    """The provenance of what the job writes, its inputs' parameters included.

    Gathered as a file is written: as a parameter of the job, a commit would run
    everything again.
    """
    # The scripts are in workflow/scripts of the repository, the run may be anywhere;
    # Snakemake runs a copy, to which it gives the script's name.
    scripts = Path(snakemake.scriptdir).resolve()
    script = scripts / Path(str(sys.modules["__main__"].__file__)).name
    recipe = Recipe.of(snakemake, script)
    return gather(recipe, Run.of(scripts.parents[1], snakemake.config))


def make_dataset(snakemake: Any) -> None:
    """Run the study of the job and write its dataset.

    The parameters and the settings of the run become global attributes, unless
    the study says itself what is worth recording, and so do the provenance and
    what the study found nothing for.
    """
    with logged(snakemake) as lines:
        withdraw()
        job = snakemake.params
        data = {Path(path).stem: read_input(path) for path in snakemake.input.data}
        inputs = [data] if data else []
        dataset = typed(load(job.study))(*inputs, job.parameters, *job.settings.values())
        parameters = dataset.attrs or parameter_attributes(job.parameters | job.settings)
        publish(snakemake, dataset, {**parameters, **statement(dataset)})
        sizes = ", ".join(f"{name} {size}" for name, size in dataset.sizes.items())
        lines.append(f"{snakemake.output.data}: {sizes}")
        if "end_reason" in dataset:
            lines += [str(reason) for reason in dataset.end_reason.values.ravel()]


def publish(
    snakemake: Any, dataset: xr.Dataset, parameters: Mapping[str, Any], *, compressed: bool = False
) -> None:
    """Write the job's dataset, with its title, parameters and provenance as attributes."""
    dataset.attrs = {
        "Conventions": CONVENTIONS,
        "title": snakemake.params.title,
        "references": REFERENCE,
        "history": HISTORY,
        **parameters,
        **provenance(snakemake).attributes(),
    }
    write_dataset(dataset, snakemake.output.data, compressed=compressed)
