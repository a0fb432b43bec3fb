"""The job of datasets: studies compute them, and they are written with their provenance.

``snakemake`` is the object that Snakemake provides for its scripts.
"""

from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import xarray as xr

from bouncing_ball.datasets import DRAWING
from bouncing_ball.datasets.files import (
    CONVENTIONS,
    parameter_attributes,
    read_dataset,
    write_dataset,
)
from bouncing_ball.datasets.variables import budgeted
from bouncing_ball.errors import ModelError
from bouncing_ball.pipeline.configuration import arguments, typed
from bouncing_ball.pipeline.provenance import PREFIX, gather
from bouncing_ball.pipeline.sources import parts_of_note

REFERENCE = (
    "Carbonelli, Perret-Liaudet, Rigaud and Feki, Investigation of restitution coefficient "
    "and spring-damper models for the bouncing ball problem, DETC2011-47870 (2011)"
)
HISTORY = "computed from the equations; the attributes provenance_* say by what and from what"


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


def recorded(arguments: Mapping[str, Any]) -> dict[str, Any]:
    """The arguments of a study as the attributes of its dataset, the parameters by their names.

    Examples
    --------
    >>> recorded({"parameters": {"n": 1, "amplitude": 1.2}, "release": "force"})
    {'n': 1, 'amplitude': 1.2, 'release': 'force'}
    """
    others = {name: value for name, value in arguments.items() if name != "parameters"}
    return parameter_attributes({**arguments.get("parameters", {}), **others})


def make_datasets(snakemake: Any, **studies: Callable[..., xr.Dataset]) -> None:
    """Run the studies of the job, each named by its artifact, and write their datasets.

    The parameters of the job have the parameters of each artifact, and the settings of the run that
    its studies take, in the form that the configuration has. The variables get the budgets of the
    artifact. The provenance becomes global attributes, and so do the parameters and the settings,
    unless the study itself sets attributes.
    """
    data = {Path(path).stem: read_input(path) for path in snakemake.input.get("data", [])}
    for name, study in studies.items():
        try:
            given = arguments(study, name, snakemake.params)
            dataset = typed(study)(**given, **({"data": data} if data else {}))
            publish(snakemake, name, dataset, dataset.attrs or recorded(given))
        except Exception as error:
            error.add_note(name)
            raise


def publish(snakemake: Any, name: str, dataset: xr.Dataset, parameters: Mapping[str, Any]) -> None:
    """Write the dataset of an artifact, with its title, parameters and provenance as attributes.

    Raises
    ------
    ModelError
        If a variable has no unit.
    """
    for variable in dataset.variables:
        if "units" not in dataset[variable].attrs:
            raise ModelError(f"{variable} has no unit: the study ends with described(...)")
    about = snakemake.params.artifacts[name]
    dataset = budgeted(dataset, about["budgets"])
    path = snakemake.output[name]
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
