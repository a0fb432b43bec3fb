"""Runs, their records, and each of their files checked by itself.

The reference is a folder `figures` and some texts beside it; a run writes the same files into a
folder of its own. Records say what made a file: datasets, code, versions of libraries, and the hash
of the file. A run has a record for each job in its folder `records`. The reference has one for all
its files, `figures/accepted.json`, with the code and the versions that gave them last.
"""

import json
import shutil
from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import xarray as xr
import yaml

from paper_replication.configuration import SHOWN_BY, entries
from paper_replication.datasets import Project, attributes, common_attributes, plain
from paper_replication.differences import changes, content_of
from paper_replication.provenance import content, contents_in, relative

ACCEPTED = "figures/accepted.json"
RECORD = ("made", "data", "code", "versions", "entries")
"""What a record has. `made`, `data` and `code` are hashes of files by path: those that were made,
and those they were made of. `versions` are by library. `entries` are the parameters of a text; a
dataset has its own. The record of the reference has no `data`, and no time `made_at`.
"""
MISSING, UNREADABLE, UNNAMED = "missing", "cannot be compared", "no record names"
EDITED, STALE = "edited by hand", "stale, remove it and run again; changed since"
LEFT = "no rule makes it, remove it"
CONFLICT = "has the marks of a conflict"
"""What may be wrong with a file of one run."""


@dataclass(frozen=True)
class Run:
    """A folder with results, and the records of what made them.

    Attributes
    ----------
    label
        The name of the run in a report.
    folder
        The folder with `figures` and the texts.
    records
        The record of each file.
    damaged
        Records that cannot be read, with the reasons.
    """

    label: str
    folder: Path
    records: Mapping[str, dict]
    damaged: Sequence[str] = ()

    def record(self, file: str, data: Any) -> dict[str, Any]:
        """What made a file, as far as it is known.

        A dataset has its parameters; those of a text are the entries of the configuration.
        """
        known = self.records.get(file, {key: {} for key in RECORD})
        given = known["entries"]
        if isinstance(data, xr.Dataset):
            given = json.loads(data.attrs["parameters"])
            # The titles of claims and choices are code.
            given |= {"title": data.attrs["title"]} if given else {}
        return known | {"parameters": given}

    def newer(self, record: Mapping) -> list[str]:
        """The datasets of a file that were made again after it. One that was overwritten before
        is wrong itself.
        """
        now = {file: known["made"][file] for file, known in self.records.items()}
        newer = [file for file, used in record["data"].items() if now.get(file, used) != used]
        there = contents_in(self.folder, newer)
        return [file for file in newer if there.get(file) != record["data"][file]]

    def uses(self, file: str, made: str) -> bool:
        """Whether a file was made from a dataset with this hash."""
        return any(record["data"].get(file) == made for record in self.records.values())

    def named(self) -> set[str]:
        """The files that the records name."""
        return {*self.records}.union(*(record["data"] for record in self.records.values()))


def run_in(folder: Path, label: str) -> Run:
    """The run in a folder, with its records."""
    records: dict[str, dict] = {}
    damaged = []
    for path in [*sorted(folder.glob("records/*.json")), *folder.glob(ACCEPTED)]:
        name = path.relative_to(folder).as_posix()
        text = b""
        try:
            text = path.read_bytes()
            known = {"data": {}} | json.loads(text)
            record = {key: dict(known[key]) for key in RECORD}
            record["made_at"] = known.get("made_at")
            records |= dict.fromkeys(record["made"], record)
        except Exception as error:  # Whatever the reader raises for a damaged file.
            is_merged = b"\n<<<<<<< " in b"\n" + text
            why = CONFLICT if is_merged else f"cannot be read: {one_line(error)}"
            damaged.append(f"{name} {why}")
    return Run(label, folder, records, damaged)


def configuration(project: Project) -> dict:
    """The configuration of the checkout."""
    with (project.top / "config/config.yaml").open("rb") as file:
        return yaml.safe_load(file)


def one_line(error: Exception) -> str:
    """The message of an error without line ends, with its kind if it may need one."""
    kind = "" if isinstance(error, ValueError) else f"{type(error).__name__}: "
    return kind + " ".join(str(error).split())


@dataclass(frozen=True)
class Checkout:
    """A checkout with its reference: results must be what it makes today.

    Two runs are compared without one. Code and descriptions are always checked, parameters only
    with `config`, and files that no rule makes only with `made`.

    Attributes
    ----------
    project
        The workflow.
    main
        The code on the main branch; empty if it is not known.
    config
        The configuration of the results; none if they have parameters of their own.
    made
        The files that the rules make; empty if this is not known.
    """

    project: Project
    main: Mapping[str, str]
    config: Mapping | None = None
    made: Collection[str] = ()

    def outdated(self, file: str, data: Any, record: Mapping) -> list[str]:
        """What changed since a file was made: parameters, attributes of a dataset, and code."""
        name = Path(file).stem if isinstance(data, xr.Dataset) else ""
        return [
            *self.other_parameters(name, record["parameters"]),
            *(self.other_attributes(name, data) if name else ()),
            *self.other_code(record["code"]),
        ]

    def other_parameters(self, name: str, recorded: Mapping) -> list[str]:
        """Parameters that the configuration has otherwise: those of the entry of a dataset and the
        settings that it takes, or, without a name, the entries that a text was made from.
        """
        if not self.config or not recorded:
            return []
        now = entries(self.config)
        if name:
            settings = {key: self.config[key] for key in recorded.keys() & self.config.keys()}
            entry = now.get(name, {})
            now = settings | {key: value for key, value in entry.items() if key not in SHOWN_BY}
        lines = changes(recorded, plain(now))
        return [f"{line} (config/config.yaml or the Snakefile)" for line in lines]

    def other_attributes(self, name: str, data: xr.Dataset) -> list[str]:
        """Attributes that a dataset and its variables would get today."""
        described = self.project.describe(name)
        variables = {str(key): one for key, one in data.variables.items() if key in described}
        now: dict[str, Any] = {**common_attributes(self.project)}
        then = {key: value for key, value in data.attrs.items() if key in now}
        now |= {key: attributes(described[key], one.dtype) for key, one in variables.items()}
        then |= {key: one.attrs for key, one in variables.items()}
        return changes(plain(then), plain(now))

    def other_code(self, recorded: Mapping[str, str]) -> list[str]:
        """Files of code whose contents are no longer those that a record has."""
        now = contents_in(self.project.checkout, recorded)
        return [path for path, made in recorded.items() if now.get(path) != made]


@dataclass(frozen=True)
class Side:
    """A file of one run, checked by itself.

    Attributes
    ----------
    path
        The file.
    wrong
        What is wrong with it: details by kind, from `MISSING` to `LEFT`.
    contents, hash
        Its contents, as `content_of` reads them, and their hash.
    record
        What made it.
    is_used
        Whether other files of the run were made from these contents.
    """

    path: Path
    wrong: Mapping[str, Sequence[str]]
    contents: Any = None
    hash: str = ""
    record: Mapping[str, Any] = field(default_factory=lambda: {key: {} for key in RECORD})
    is_used: bool = False

    @property
    def shows(self) -> str:
        """The name of the dataset that a picture or a table shows: its own, or the only one that
        it was made of.
        """
        used = [*self.record["data"]]
        has_own = self.path.with_suffix(".nc").is_file() or len(used) != 1
        return Path(self.path if has_own else used[0]).stem


def side(run: Run, file: str, checkout: Checkout | None = None) -> Side:
    """A file of one run, which a checkout, if there is one, must make today."""
    path = run.folder / file
    if checkout and checkout.made and file not in checkout.made and path.exists():
        return Side(path, {LEFT: [str(path)]})
    try:
        if checkout and path.resolve() == (checkout.project.top / file).resolve():
            raise ValueError("it is the file of the reference")
        data = content_of(path)
        record = run.record(file, data)
        stale = run.newer(record) + (checkout.outdated(file, data, record) if checkout else [])
        made = content(path)
    except FileNotFoundError:
        return Side(path, {MISSING: [f"{file} in {run.label}"]})
    except Exception as error:  # Whatever readers raise for a damaged file.
        return Side(path, {UNREADABLE: [f"{file} in {run.label}: {one_line(error)}"]})
    checked = {
        UNNAMED: [] if file in run.records else [f"{file} in {run.label}", *run.damaged],
        EDITED: [f"{file} of {run.label}"] if record["made"].get(file, made) != made else [],
        STALE: stale,
    }
    wrong = {kind: details for kind, details in checked.items() if details}
    return Side(path, wrong, data, made, record, run.uses(file, made))


def results_of(project: Project, path: Path, unpacked: Path) -> Path:
    """The folder of the results of a run: `results` in a folder, or the folder itself, or the same
    in a zip file, as continuous integration delivers it, which is unpacked. If there are results of
    several workflows, they are those of this one.

    Raises ValueError if there are none, as in a checkout that was not run, or another error if a
    zip file is damaged.
    """
    if path.is_file():
        shutil.unpack_archive(path, unpacked, "zip")
    top = unpacked if path.is_file() else path
    of_workflow = relative(project.checkout, project.top)
    for folder in (top / of_workflow / "results", top / "results", top):
        if (folder / "figures").is_dir() and not (folder / ACCEPTED).exists():
            return folder
    inner = [*top.glob("*.zip"), *(folder.parent for folder in top.glob("*/**/records"))]
    names = ", ".join(sorted(folder.relative_to(top).as_posix() for folder in inner))
    has = f", but it has {names}{': unpack it first' if path.is_file() else ''}" if names else ""
    raise ValueError(f"{path} has no results of a run{has}")
