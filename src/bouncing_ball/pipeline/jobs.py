"""A run of the workflow and its jobs: logs, errors of one line, and datasets.

The scripts of the workflow are a few lines that call this module; ``snakemake`` is the object that
Snakemake provides for them.
"""

import signal
import sys
import traceback
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Any

import xarray as xr

from bouncing_ball.datasets import DRAWING
from bouncing_ball.datasets.files import (
    CONVENTIONS,
    parameter_attributes,
    read_dataset,
    write_dataset,
    write_text,
)
from bouncing_ball.datasets.variables import budgeted
from bouncing_ball.errors import ModelError
from bouncing_ball.pipeline.provenance import PREFIX, gather
from bouncing_ball.pipeline.run import CONCLUSION
from bouncing_ball.pipeline.sources import parts_of_note

REFERENCE = (
    "Carbonelli, Perret-Liaudet, Rigaud and Feki, Investigation of restitution coefficient "
    "and spring-damper models for the bouncing ball problem, DETC2011-47870 (2011)"
)
HISTORY = "computed from the equations; the attributes provenance_* say by what and from what"


def conclude(sentence: str) -> None:
    """End the run with this sentence, which replaces an earlier one, see :mod:`.run`."""
    write_text(CONCLUSION, sentence)


@contextmanager
def logged(snakemake: Any) -> Iterator[list[str]]:
    """Collect lines for the log of the job; on failure print one line about the failure.

    The traceback is then in the log, whose last line is the same, and the process exits with status
    1.
    """
    # Ctrl-C ends the job at once. An exception could be raised while a netCDF file is locked, and
    # closing the file would then wait forever. Because files are written completely or not at all,
    # no file is damaged.
    signal.signal(signal.SIGINT, signal.SIG_DFL)
    lines: list[str] = []
    log = Path(snakemake.log[0])
    log.unlink(missing_ok=True)
    with _without_pint():
        try:
            yield lines
            write_text(log, "".join(f"{line}\n" for line in lines))
            if snakemake.output:
                print("made", *snakemake.output, flush=True)
        except Exception as error:
            name = "/".join([snakemake.rule, *snakemake.wildcards])
            kind = "" if isinstance(error, ValueError) else f"{type(error).__name__}: "
            message = f"{name}: {kind}{' '.join(str(error).split())}"
            # For example, writing the log fails if the disk is full.
            with suppress(OSError):
                write_text(log, f"{traceback.format_exc()}{message}\n")
            sys.exit(f"{message} (details in {log})")


@contextmanager
def _without_pint() -> Iterator[None]:
    # For every dataset xarray checks whether its values are quantities of pint. The values of a
    # job are plain numbers, and importing pint takes longer than reading them.
    if "pint" in sys.modules:
        yield
        return
    sys.modules["pint"] = None  # type: ignore[assignment]
    try:
        yield
    finally:
        del sys.modules["pint"]


def read_input(path: str) -> xr.Dataset:
    """A dataset that another job has made for this job.

    Raises
    ------
    ModelError
        If the file is damaged; the message has the command that makes it again.
    """
    try:
        return read_dataset(path)
    except ModelError as error:
        raise ModelError(f"{error}: {_again(path)}") from error


def _again(path: str) -> str:
    """What to type for a file that is missing or wrong; no rule makes the files in ``config``."""
    if Path(path).parent.name == "config":
        return f"restore it, git checkout -- {path}"
    return f"make it again, snakemake --cores 2 --force {path}"


@contextmanager
def using(*paths: str) -> Iterator[None]:
    """A context for the use of datasets, in which a file with other content is named.

    Raises
    ------
    ModelError
        If a variable, a coordinate or an attribute is missing.
    """
    try:
        yield
    except (AttributeError, KeyError) as error:
        names = ", ".join(paths)
        text = " ".join(str(error).split())
        raise ModelError(
            f"{names} has not the content that is needed ({text}): {_again(paths[0])}"
        ) from error


def provenance(snakemake: Any) -> dict[str, str]:
    """The provenance of the files that the job writes, with the digests of its code.

    It is gathered when a file is written and is not a parameter of the job, because Snakemake
    would then run every job again after each commit.
    """
    code = snakemake.input.code
    inputs = [str(path) for path in snakemake.input if path != code]
    lines, house = parts_of_note(Path(code).read_text(encoding="utf-8"))
    gathered = gather(str(snakemake.output[0]), inputs, Path(house).resolve(), snakemake.config)
    return gathered | {f"{PREFIX}code": lines}


def recorded(arguments: Mapping[str, Any]) -> dict[str, Any]:
    """The arguments of a study as the attributes of its dataset, the parameters by their names.

    Examples
    --------
    >>> recorded({"parameters": {"n": 1, "amplitude": 1.2}, "release": "force"})
    {'n': 1, 'amplitude': 1.2, 'release': 'force'}
    """
    others = {name: value for name, value in arguments.items() if name != "parameters"}
    return parameter_attributes({**arguments.get("parameters", {}), **others})


def make_dataset(snakemake: Any, study: Callable[..., xr.Dataset]) -> list[str]:
    """Run the study of the job, which takes the parameters in the form that the configuration has,
    and write its dataset.

    The variables get the budgets of the artifact. The provenance becomes global attributes, and so
    do the parameters and the settings of the run, unless the study itself sets attributes.

    Returns
    -------
    list of str
        Lines for the log: the dimensions of the dataset, and where continuations ended.
    """
    given = dict(snakemake.params.arguments)
    from_other_jobs: dict[str, Any] = {}
    if paths := snakemake.input.get("data"):
        from_other_jobs["data"] = {Path(path).stem: read_input(path) for path in paths}
    dataset = study(**given, **from_other_jobs)
    for name, variable in dataset.variables.items():
        if "units" not in variable.attrs:
            raise ModelError(f"{name} has no unit: the study ends with described(...)")
    dataset = budgeted(dataset, snakemake.params.get("budgets", {}))
    parameters = dataset.attrs or recorded(given)
    publish(snakemake, dataset, parameters)
    sizes = ", ".join(f"{name} {size}" for name, size in dataset.sizes.items())
    lines = [f"{snakemake.output.data}: {sizes}"]
    if "end_reason" in dataset:
        lines += [str(reason) for reason in dataset.end_reason.values.ravel()]
    return lines


def publish(snakemake: Any, dataset: xr.Dataset, parameters: Mapping[str, Any]) -> None:
    """Write the job's dataset, with its title, parameters and provenance as attributes."""
    drawing = snakemake.params.get("drawing")
    dataset.attrs = {
        "Conventions": CONVENTIONS,
        "title": snakemake.params.title,
        **({DRAWING: drawing} if drawing else {}),
        "references": REFERENCE,
        "history": HISTORY,
        **parameters,
        **provenance(snakemake),
    }
    write_dataset(dataset, snakemake.output.data)
