"""A job of the workflow: its log, an error of one line, its datasets and their provenance.

Every script of the workflow runs in :func:`logged`. The script of a dataset calls
:func:`make_dataset` with its study, that of a table :func:`write_table` with its columns, and that
of a picture :func:`.pictures.draw` with its drawing. ``snakemake`` is the object that Snakemake
provides for its scripts.

The signature of a study declares what it takes, for example ``study(parameters, release,
continuation)``. ``parameters`` are those of its artifact, such as ``paper.fig08``; ``data`` holds
the datasets that the job reads; and each further argument is the setting of the run with that name.
"""

import inspect
import sys
import traceback
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Any

import xarray as xr

from bouncing_ball_beyond.inherited.datasets import DRAWING
from bouncing_ball_beyond.inherited.datasets.files import (
    CONVENTIONS,
    parameter_attributes,
    read_dataset,
    write_dataset,
    write_text,
)
from bouncing_ball_beyond.inherited.datasets.variables import budgeted
from bouncing_ball_beyond.inherited.drawing.tables import to_csv, to_markdown
from bouncing_ball_beyond.inherited.errors import ModelError
from bouncing_ball_beyond.inherited.pipeline.provenance import PREFIX, gather
from bouncing_ball_beyond.inherited.pipeline.run import CONCLUSION
from bouncing_ball_beyond.inherited.pipeline.sources import parts_of_note

REFERENCE = (
    "Carbonelli, Perret-Liaudet, Rigaud and Feki, Investigation of restitution coefficient "
    "and spring-damper models for the bouncing ball problem, DETC2011-47870 (2011)"
)
HISTORY = "computed from the equations; the attributes provenance_* say by what and from what"
# What to type for a file that is missing or wrong.
_AGAIN = "make it again, snakemake --cores 2 --force"


def conclude(sentence: str) -> None:
    """End the run with this sentence, which replaces an earlier one, see :mod:`.run`."""
    write_text(CONCLUSION, sentence)


@contextmanager
def logged(snakemake: Any) -> Iterator[list[str]]:
    """Collect lines for the log of the job; on failure print one line about the failure.

    The line begins with the name of the rule. The traceback is then in the log, whose last line is
    the same, and the process exits with status 1.
    """
    lines: list[str] = []
    log = Path(snakemake.log[0])
    log.unlink(missing_ok=True)
    try:
        yield lines
        write_text(log, "".join(f"{line}\n" for line in lines))
        if snakemake.output:
            print("made", *snakemake.output, flush=True)
    except Exception as error:
        kind = "" if isinstance(error, ValueError) else f"{type(error).__name__}: "
        message = f"{snakemake.rule}: {kind}{' '.join(str(error).split())}"
        # For example, writing the log fails if the disk is full.
        with suppress(OSError):
            write_text(log, f"{traceback.format_exc()}{message}\n")
        sys.exit(f"{message} (details in {log})")


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
        raise ModelError(f"{error}: {_AGAIN} {path}") from error


@contextmanager
def using(path: str) -> Iterator[None]:
    """A context for the use of a dataset, in which a file with other content is named.

    Raises
    ------
    ModelError
        If a variable, a coordinate or an attribute is missing.
    """
    try:
        yield
    except (AttributeError, KeyError) as error:
        text = " ".join(str(error).split())
        raise ModelError(
            f"{path} has not the content that is needed ({text}): {_AGAIN} {path}"
        ) from error


def provenance(snakemake: Any, target: str) -> dict[str, str]:
    """The provenance of a file that the job writes, with its rule and the digests of its code.

    It is gathered when a file is written and is not a parameter of the job, because Snakemake
    would then run every job again after each commit.
    """
    code = snakemake.input.code
    inputs = [str(path) for path in snakemake.input if path != code]
    lines, house = parts_of_note(Path(code).read_text(encoding="utf-8"))
    gathered = gather(target, inputs, Path(house).resolve(), snakemake.config)
    return gathered | {f"{PREFIX}code": lines, f"{PREFIX}rule": snakemake.rule}


def typed(study: Callable[..., Any]) -> Callable[..., Any]:
    """The study as a function of parameters in the form that the configuration has.

    It raises :class:`pydantic.ValidationError` if a parameter is not allowed.

    Examples
    --------
    >>> from bouncing_ball_beyond.inherited.datasets.parameters import Span
    >>> def study(parameters: Span):
    ...     return parameters.grid().tolist()
    >>> typed(study)({"min": 10.0, "max": 1000.0, "samples": 3})
    [10.0, 100.0, 1000.0]
    """
    # Imported here, because tables and pictures need no parameters.
    from pydantic import ConfigDict, validate_call

    return validate_call(config=ConfigDict(arbitrary_types_allowed=True))(study)


def arguments(study: Callable[..., Any], given: Mapping[str, Any]) -> dict[str, Any]:
    """Those of the given arguments that a study takes: its parameters, and settings of the run.

    Examples
    --------
    >>> def study(parameters, release):
    ...     pass
    >>> arguments(study, {"parameters": {"n": 1}, "release": "force", "continuation": {}})
    {'parameters': {'n': 1}, 'release': 'force'}
    """
    names = inspect.signature(study).parameters
    return {name: given[name] for name in names if name != "data"}


def recorded(arguments: Mapping[str, Any]) -> dict[str, Any]:
    """The arguments of a study as the attributes of its dataset, the parameters by their names.

    Examples
    --------
    >>> recorded({"parameters": {"n": 1, "amplitude": 1.2}, "release": "force"})
    {'n': 1, 'amplitude': 1.2, 'release': 'force'}
    """
    others = {name: value for name, value in arguments.items() if name != "parameters"}
    return parameter_attributes({**arguments.get("parameters", {}), **others})


def make_dataset(snakemake: Any, study: Callable[..., xr.Dataset]) -> None:
    """Run the study of the job, and write its dataset.

    The parameters of the job have those of the artifact and the settings of the run that the study
    takes, in the form that the configuration has. The variables get the budgets of the artifact.
    Its title and the provenance become global attributes, and so do the parameters and the
    settings, unless the study itself sets attributes.

    Raises
    ------
    ModelError
        If a variable has no unit.
    """
    given = arguments(study, snakemake.params)
    data = {Path(path).stem: read_input(path) for path in snakemake.input.get("data", [])}
    dataset = typed(study)(**given, **({"data": data} if data else {}))
    for variable in dataset.variables:
        if "units" not in dataset[variable].attrs:
            raise ModelError(f"{variable} has no unit: the study ends with described(...)")
    about = snakemake.params.artifact
    path = snakemake.output[0]
    parameters = dataset.attrs or recorded(given)
    dataset = budgeted(dataset, about["budgets"])
    dataset.attrs = {
        "Conventions": CONVENTIONS,
        "title": about["title"],
        **({DRAWING: about["drawing"]} if about["drawing"] else {}),
        "references": REFERENCE,
        "history": HISTORY,
        **parameters,
        **provenance(snakemake, path),
    }
    write_dataset(dataset, path)


def write_table(snakemake: Any, table: Callable[[xr.Dataset], Any]) -> None:
    """Write the table of the job, as CSV and in Markdown, with columns from its dataset."""
    columns = table(read_input(snakemake.input.data))
    write_text(snakemake.output.csv, to_csv(*columns))
    write_text(snakemake.output.md, to_markdown(*columns))
