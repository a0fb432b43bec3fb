"""Save and read datasets, with the descriptions of their variables and their provenance.

Every figure and table has one netCDF file. A number x agrees with the number y of the reference if

    |x - y| <= tolerance · max(|y|, floor).

Texts, integers and booleans agree only if they are equal.
"""

import json
import os
import platform
from collections.abc import Callable, Hashable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass
from datetime import UTC, datetime
from inspect import signature
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import xarray as xr

from paper_replication.provenance import contents_in, relative


@dataclass(frozen=True)
class Variable:
    """Description of a variable, and the tolerance within which its numbers agree.

    Attributes
    ----------
    long_name, symbol, equation, units
        What the variable is, as text; the equation is that of the paper.
    tolerance, floor
        See the module. They apply to floating-point numbers only.
    tolerance_scale
        Another variable of the dataset, whose value replaces max(|y|, floor).
    """

    long_name: str
    symbol: str = ""
    equation: str = ""
    units: str = "1"
    tolerance: float = 1e-9
    floor: float = 1e-3
    tolerance_scale: str = ""


Describe = Callable[[str], Mapping[str, Variable]]
"""Returns the descriptions of the variables of a dataset, by its name."""
Datasets = Mapping[str, xr.Dataset]
"""Datasets by the names of their figures and tables."""


@dataclass(frozen=True)
class Project:
    """The replication of a paper: where it lies, and what its records and comparisons need.

    Attributes
    ----------
    top
        The folder with the configuration and the reference.
    checkout
        The folder of the repository, from which records name files of code.
    code
        Folders and files of code, from the checkout.
    texts
        Files of the reference beside its folder `figures`.
    references
        The paper, as its datasets cite it.
    source, license
        The software that computes the datasets, with its version, and the licence of the datasets.
    describe
        Today's descriptions of the variables of a dataset, by its name.
    described_in
        Files of code with the descriptions, from the checkout. No dataset records them.
    side_by_side
        Draws a figure by its name for several datasets, with the same axes. Returns PNG files.
    make
        Writes the files that follow from one dataset into a folder: pictures, tables and pages. It
        takes their name, the dataset, or none for a picture without data, and the folder.
    """

    top: Path
    checkout: Path
    code: tuple[str, ...]
    texts: tuple[str, ...]
    references: str
    source: str
    license: str
    describe: Describe
    described_in: tuple[str, ...]
    side_by_side: Callable[[str, list[xr.Dataset]], list[bytes]]
    make: Callable[[str, Any, Path], None]


def grid(limits: Mapping, spaced: Callable[..., np.ndarray] = np.geomspace) -> np.ndarray:
    """Return the values of a range of the configuration, by default at equal steps of their
    logarithm.

    Raises ValueError if the range is empty.

    >>> grid({"min": 1.0, "max": 100.0, "samples": 3}).tolist()
    [1.0, 10.0, 100.0]
    >>> grid({"min": 2.0, "max": 2.0, "samples": 3})
    Traceback (most recent call last):
    ValueError: min = 2 must be less than max = 2
    """
    if not limits["min"] < limits["max"]:
        raise ValueError(f"min = {limits['min']:g} must be less than max = {limits['max']:g}")
    return spaced(limits["min"], limits["max"], limits["samples"])


def save(
    dataset: xr.Dataset,
    path: str | Path,
    title: str,
    parameters: Mapping,
    sources: Mapping[str, Mapping],
    project: Project,
) -> None:
    """Save a dataset as netCDF, atomically, with descriptions and provenance.

    Parameters
    ----------
    dataset
        Its variables get the attributes of their descriptions.
    path
        The name of the file, without its ending, is the name of the dataset.
    title
        What the dataset shows.
    parameters
        The parameters with which it was computed, and the settings of the run.
    sources
        What its job reads; the dataset records the code and the versions.
    project
        What describes its variables, and the checkout with its code.

    Raises
    ------
    ValueError
        If a variable has no description.
    """
    path = Path(path)
    variables = project.describe(path.stem)
    unknown = [str(name) for name in dataset.variables if name not in variables]
    if unknown:
        where = ", ".join(project.described_in)
        raise ValueError(f"{path.name}: describe {', '.join(unknown)} in {where}")
    complete = dataset.drop_encoding().assign_attrs(
        common_attributes(project),
        title=title,
        parameters=json.dumps(plain(parameters), sort_keys=True, ensure_ascii=False),
        code=json.dumps(below(project.checkout, sources["code"])),
        versions=json.dumps(sources["versions"]),
        computed_on=computed_on(),
    )
    for name, variable in complete.variables.items():
        variable.attrs = attributes(variables[str(name)], variable.dtype)
    with whole(path) as unfinished:
        to_netcdf(complete, unfinished)


def to_netcdf(dataset: xr.Dataset, path: Path) -> None:
    """Write a dataset with all its attributes; coordinates have no fill value, as CF demands."""
    encoding: dict[Hashable, dict] = {name: {"_FillValue": None} for name in dataset.coords}
    for name, variable in dataset.variables.items():
        # Small variables grow when compressed, because compression stores them in chunks.
        if variable.nbytes > 8192 and variable.dtype.kind in "fib":
            encoding.setdefault(name, {})["zlib"] = True
    dataset.to_netcdf(path, engine="netcdf4", encoding=encoding)


def common_attributes(project: Project) -> dict[str, str]:
    """The attributes that all datasets of a project have."""
    return {
        "Conventions": "CF-1.11",
        "references": project.references,
        "source": project.source,
        "license": project.license,
    }


def computed_on() -> str:
    """Describe the platform and the library of linear algebra, which decide last digits.

    The text is for the reader of a dataset, and is not compared.
    """
    blas = np.show_config(mode="dicts")["Build Dependencies"]["blas"]
    return f"{platform.platform()}, {blas['name']} {blas['version']}"


@contextmanager
def whole(path: Path) -> Iterator[Path]:
    """Write a file atomically: yield a temporary path, and move it to `path` on success."""
    path.parent.mkdir(parents=True, exist_ok=True)
    unfinished = path.with_name(f".{path.name}.part.{os.getpid()}")
    try:
        yield unfinished
        os.replace(unfinished, path)
    finally:
        unfinished.unlink(missing_ok=True)


def write(path: Path, content: bytes) -> None:
    """Write a file atomically."""
    with whole(path) as unfinished:
        unfinished.write_bytes(content)


def save_stage(
    stage: Mapping[str, Callable[..., xr.Dataset]],
    snakemake: Any,
    sources: Mapping[str, Mapping],
    project: Project,
) -> None:
    """Compute and save the datasets of a stage, for the job of its rule.

    `stage` has the function of each dataset. It takes the parameters of the entry in the
    configuration, and the settings of the run that it names as further arguments; the dataset
    records these. The name of a dataset is a note of a ValueError of its function.
    """
    for name in snakemake.params.entries:
        entry = dict(snakemake.params.entries[name])
        title = entry.pop("title")
        settings = {key: snakemake.params.settings[key] for key in settings_of(stage[name])}
        try:
            dataset = computed(stage[name], entry | settings)
        except ValueError as error:
            error.add_note(name)
            raise
        save(dataset, snakemake.output[name], title, parameters(dataset), sources, project)
    save_record(snakemake, sources, project)


def computed(function: Callable[..., xr.Dataset], given: Mapping) -> xr.Dataset:
    """Compute a dataset from its parameters, and record them in it.

    The parameters are those of the entry, and the settings of the run that the function takes.
    """
    settings = {key: given[key] for key in settings_of(function)}
    entry = {key: value for key, value in given.items() if key not in settings}
    dataset = function(entry, **settings)
    return dataset.assign_attrs(parameters=json.dumps(plain(given), ensure_ascii=False))


def settings_of(function: Callable[..., xr.Dataset]) -> list[str]:
    """Return the settings of the run that a function takes: its arguments after the entry.

    >>> settings_of(lambda entry, release: xr.Dataset())
    ['release']
    """
    return list(signature(function).parameters)[1:]


def save_record(snakemake: Any, sources: Mapping[str, Mapping], project: Project) -> None:
    """Record what a job made, and from what, in its output `record`: a file of JSON.

    Paths are those from the folder of the results, and files of code those from the checkout. Each
    has the hash of its content. A comparison reads the record.
    """
    path = Path(snakemake.output.record)
    results = path.parents[1]
    files = [relative(results, file) for file in {*snakemake.output} - {snakemake.output.record}]
    record = {
        "made": contents_in(results, files),
        "data": below(results, sources["data"]),
        "code": below(project.checkout, sources["code"]),
        "versions": sources["versions"],
        "entries": plain(getattr(snakemake.params, "entries", {})),
        "made_at": datetime.now(UTC).isoformat(),
    }
    write(path, f"{json.dumps(record, indent=1, sort_keys=True)}\n".encode())


def below(top: Path, contents: Mapping[str, str]) -> dict[str, str]:
    """The contents of files, by their paths from a folder."""
    return {relative(top, file): git_hash for file, git_hash in contents.items()}


def attributes(variable: Variable, dtype: np.dtype) -> dict[str, str | float]:
    """Attributes of a variable, unless empty; only floating-point numbers have a tolerance."""
    names = ["long_name", "units", "symbol", "equation"]
    if dtype.kind == "f":
        names += ["tolerance", "floor", "tolerance_scale"]
    values = {name: getattr(variable, name) for name in names}
    return {name: value for name, value in values.items() if value != ""}


def read(path: str | Path) -> xr.Dataset:
    """Read a netCDF file into memory, and close it."""
    return xr.load_dataset(path, engine="netcdf4")


def parameters(dataset: xr.Dataset) -> dict:
    """Return the parameters with which a dataset was computed; empty if it records none."""
    return json.loads(dataset.attrs.get("parameters", "{}"))


def plain(value: Any) -> Any:
    """Convert mappings, sequences and numpy's numbers to those of JSON."""
    if isinstance(value, Mapping):
        return {str(key): plain(part) for key, part in value.items()}
    if isinstance(value, list | tuple | np.ndarray):
        return [plain(part) for part in value]
    return value.item() if isinstance(value, np.generic) else value


# Parameters


class Among(NamedTuple):
    """Values that a list must have, in any order and among others.

    Attributes
    ----------
    dimension
        The dimension of the dataset along which the values of the list lie.
    values
        The values.
    """

    dimension: str
    values: list


def selected(data: xr.Dataset, needed: Mapping) -> xr.Dataset:
    """Select of each list the needed values, in the order in which they are needed.

    A value is found by its coordinate, which has the name of the list or of the dimension. The
    result has the parameters of what is left.

    >>> data = xr.Dataset({"height": ("ratio", [3.0, 2.0, 1.0])}, {"ratio": [5.0, 10.0, 20.0]})
    >>> part = selected(data, {"ratio": Among("ratio", [20.0, 5.0])})
    >>> part.height.values.tolist(), parameters(part)
    ([1.0, 3.0], {'ratio': [20.0, 5.0]})
    """
    given = parameters(data)
    for key, value in needed.items():
        if isinstance(value, Among):
            name = key if key in data.coords else value.dimension
            places = []
            for wanted in value.values:
                labels = wanted if isinstance(wanted, Mapping) else {name: wanted}
                there = [data[label].values == number for label, number in labels.items()]
                places.append(np.flatnonzero(np.all(there, axis=0))[0])
            data = data.isel({value.dimension: places})
            given[key] = value.values
    return data.assign_attrs(parameters=json.dumps(given, ensure_ascii=False))


def other_parameters(name: str, data: xr.Dataset, needed: Mapping) -> str:
    """Name the parameters of a dataset that differ from the needed ones; empty if none does.

    Of a range only the needed keys count, and a list may have more than is needed `Among` others.
    """
    return "; ".join(others(name, parameters(data), needed))


def others(name: str, given, needed) -> Iterator[str]:
    """Yield what differs, with the name of its key.

    >>> list(others("fig14", {"n": 2, "frequency_ratio": {"min": 2.0}}, {"n": 1}))
    ['fig14.n is 2 instead of 1']
    >>> list(others("tolerances", [0.1], Among("tolerance", [0.02, 0.1, 0.01])))
    ['tolerances lacks 0.02, 0.01']
    >>> list(others("frequency_ratio", None, {"min": 1.0}))
    ['frequency_ratio is None instead of (min 1.0)']
    """
    if isinstance(needed, Mapping) and isinstance(given, Mapping):
        for key, value in needed.items():
            yield from others(f"{name}.{key}", given.get(key), value)
    elif isinstance(needed, Among):
        if missing := [wanted for wanted in needed.values if wanted not in (given or ())]:
            yield f"{name} lacks {words(missing)}"
    elif given != needed:
        yield f"{name} is {words(given)} instead of {words(needed)}"


def words(value: Any) -> str:
    """Print a parameter, without square brackets, which would be those of a citation.

    >>> words([{"n": 1, "amplitude": 0.8}])
    '(amplitude 0.8, n 1)'
    """
    if isinstance(value, list):
        return ", ".join(map(words, value))
    if isinstance(value, Mapping):
        return f"({', '.join(f'{key} {part}' for key, part in sorted(value.items()))})"
    return str(value)
