"""Compare two runs, and make results the reference.

The reference is a folder `figures` and some texts beside it; a run writes the same files into a
folder of its own. Records say what made a file: datasets, code, versions of libraries, and the hash
of the file. A run has a record for each job in its folder `records`. The reference has one for all
its files, `figures/accepted.json`, with the code and the versions that gave them last.

Each side of a file is checked by itself first (`side`): whether it is present, readable, named by a
record, as the record says, and fresh. Then both sides are compared:

- Numbers of datasets agree within the tolerances that the first run declares (`of_dataset`).
- All other files are functions of datasets, and are compared byte for byte (`of_product`). If one
  of their datasets differs, they follow from it; of a text the changed sentences are listed.
- Another processor rounds numbers differently. Then a picture, a table or a page of one dataset
  agrees if today's code makes the file of the reference again.

A difference comes with all that differs in what made both sides: parameters, files of code and
versions of libraries. Which of them is the cause is not known.
"""

import argparse
import base64
import json
import re
import shutil
import sys
from collections.abc import Callable, Collection, Iterable, Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, field, replace
from difflib import SequenceMatcher
from functools import cache
from io import BytesIO
from itertools import chain, takewhile, zip_longest
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any, NamedTuple, TextIO, cast
from xml.etree import ElementTree

import numpy as np
import xarray as xr
import yaml
from PIL import Image, ImageColor

from paper_replication.configuration import SHOWN_BY, entries
from paper_replication.datasets import (
    Project,
    attributes,
    common_attributes,
    plain,
    read,
    to_netcdf,
    words,
    write,
)
from paper_replication.judgements import raised
from paper_replication.provenance import (
    PACKAGES,
    blob,
    content,
    contents_in,
    git,
    main_branch,
    relative,
    tree,
    uncommitted,
    versions,
)
from paper_replication.templates import environment

ACCEPTED = "figures/accepted.json"
BEGUN = "figures/.accepted.part.json"
"""While an acceptance writes: the hashes of its files, before and after. Git ignores this file."""
RECORD = ("made", "data", "code", "versions", "entries")
"""What a record has. `made`, `data` and `code` are hashes of files by path: those that were made,
and those they were made of. `versions` are by library. `entries` are the parameters of a text; a
dataset has its own. The record of the reference has no `data`, and no time `made_at`.
"""
PROVENANCE = {"title", "parameters", "code", "versions", "computed_on", "source", "license"}
"""Attributes of a dataset that say how it was made, and how it may be used."""
MISSING, UNREADABLE, UNNAMED = "missing", "cannot be compared", "no record names"
EDITED, STALE = "edited by hand", "stale, remove it and run again; changed since"
LEFT = "no rule makes it, remove it"
CONFLICT = "has the marks of a conflict"
"""What may be wrong with a file of one run."""
SAME: Mapping[str, Sequence[str]] = {"made by": ["the same parameters, code and versions"]}
STATUS = dict.fromkeys(("agrees", "follows", "drawn elsewhere"), 0)
STATUS |= {"differs": 1, "missing": 1, "not comparable": 2}
"""The exit status of each verdict. A file is missing if only one run has it, and nothing else is
wrong. It follows if one of its datasets has another verdict. A picture is drawn elsewhere if the
same code, or that of the main branch, drew it with another matplotlib.
"""
ON_PAGE = STATUS.keys() - {"agrees", "missing"}
"""The verdicts on files that the page shows."""
ROWS = 10
"""How many differences of a file a report prints. The page has all."""
ONLY = ("#b34700", "#0072b2")
"""Colours of what only the first of two pictures draws, and only the second."""


# Runs


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


# What differs in the contents of a file


def content_of(path: Path) -> Any:
    """A dataset, or the lines of a text; nothing of a picture.

    Raises an error if a file is damaged, or is not what its name says. An example is a pointer of
    Git LFS.
    """
    if path.suffix == ".nc":
        return read(path)
    if path.suffix == ".svg":
        ElementTree.parse(path)
        return None
    if path.suffix == ".png":
        with Image.open(path) as picture:
            return picture.verify()
    return path.read_bytes().replace(b"\r\n", b"\n").decode().split("\n")


class Difference(NamedTuple):
    """What differs in a file. For a variable it is the largest change, with its place.

    Attributes
    ----------
    what
        The variable or attribute of a dataset, or the line of a text.
    change, where
        The change, and the coordinates at which it is.
    differing, size
        How many values differ, and how many were compared; 0 for an attribute or a text.
    tolerance, long_name
        Those of the variable, if it has some.
    """

    what: str
    change: str
    where: str = ""
    differing: int = 0
    size: int = 0
    tolerance: str = ""
    long_name: str = ""

    def __str__(self) -> str:
        tolerance = f" (tolerance {self.tolerance})" if self.tolerance else ""
        others = f", and {self.differing - 1} more of {self.size} values"
        return f"{self.what} {self.columns[2]}{tolerance}{others * (self.differing > 1)}"

    @property
    def columns(self) -> tuple[str, str, str]:
        """The row of a report: what differs, how many values, and the largest change."""
        at = f" at {self.where}" * bool(self.where)
        return self.what, f"{self.differing} of {self.size}" * bool(self.size), self.change + at


def differences(name: str, old: Any, new: Any) -> list[Difference]:
    """What differs in the contents of a file, which are those of `content_of`."""
    if isinstance(old, xr.Dataset):
        described = [Difference(*difference) for difference in changed(about(old), about(new))]
        sizes, *both = aligned(old, new)
        return described + sizes + values_that_differ(*both)
    if old is None:
        return [Difference("the picture", "differs")]
    # An empty line follows the last line feed.
    number = common(old, new)
    pair = [[*lines, "the end of the text"][number] or "an empty line" for lines in (old, new)]
    return [Difference(f"{name}, line {number + 1}:", excerpt(*pair))]


def changes(old: Mapping, new: Mapping) -> list[str]:
    """What differs between two mappings, and of lists only the elements that do.

    >>> changes({"grid": {"max": 10.0}, "n": [1, 2]}, {"grid": {"max": 20.0}, "n": [1, 2, 3]})
    ['grid.max 10.0 → 20.0', 'n 3 is new']
    """
    return [" ".join(difference) for difference in changed(old, new)]


def changed(old: Mapping, new: Mapping, above: str = "") -> Iterator[tuple[str, str]]:
    """Yield what differs between two mappings: the key and the change."""
    for key in sorted({*old, *new}):
        before, after = (mapping.get(key, "absent") for mapping in (old, new))
        nested = [isinstance(value, Mapping) for value in (before, after)]
        if all(nested):
            yield from changed(before, after, f"{above}{key}.")
        elif before != after:
            what = "is missing" if nested[0] else "is new" if nested[1] else ""
            if not what and isinstance(before, list) and isinstance(after, list):
                what = elements(before, after)
            yield f"{above}{key}", what or f"{words(before)} → {words(after)}"


def elements(old: list, new: list) -> str:
    """The elements of two lists that only one has; empty if both have the same ones.

    >>> elements([0.5, 0.65], [0.5, 0.7]), elements([1, 2, 5], [1, 3]), elements([1, 2], [2, 1])
    ('0.65 → 0.7', '3 is new, 2, 5 are missing', '')
    """
    came = [x for x in new if x not in old]
    went = [x for x in old if x not in new]
    if came and len(old) == len(new) and len(came) == len(went):
        return f"{words(went)} → {words(came)}"
    return ", ".join(
        f"{words(some[:8])}{f' and {len(some) - 8} more' * (len(some) > 8)} "
        f"{'is' if len(some) == 1 else 'are'} {kind}"
        for some, kind in ((came, "new"), (went, "missing"))
        if some
    )


def about(data: xr.Dataset) -> dict:
    """What a dataset has apart from numbers: attributes, and types and dimensions of variables."""
    attributes = {key: value for key, value in data.attrs.items() if key not in PROVENANCE}
    variables = {
        str(name): variable.attrs
        | {
            "role": "coordinate" if name in data.coords else "variable",
            "type": "text" if variable.dtype.kind in "UO" else str(variable.dtype),
            "dimensions": [*variable.dims],
        }
        for name, variable in data.variables.items()
    }
    return plain(attributes | variables)


def labels(data: xr.Dataset, dim: str) -> list[str]:
    """The coordinates of the values along a dimension, or their positions if it has none.

    >>> orbits = xr.Dataset(coords={"n": ("orbit", [1, 2]), "restitution": ("orbit", [0.5, 0.65])})
    >>> labels(orbits, "orbit"), labels(orbits.swap_dims(orbit="n"), "n")
    (['n = 1, restitution = 0.5', 'n = 2, restitution = 0.65'], ['n = 1', 'n = 2'])
    """
    texts = [[f"{name} = {shown(x)}" for x in data[name].values] for name in along(data, dim)]
    return [", ".join(parts) for parts in zip(*texts, strict=True)]


def along(data: xr.Dataset, dim: str) -> list[str]:
    """The names of the coordinates that tell the values along a dimension apart: its own, or all
    others, or else the dimension, whose values are positions.
    """
    others = [str(name) for name, coordinate in data.coords.items() if coordinate.dims == (dim,)]
    return [dim] if dim in data.coords else others or [dim]


def aligned(old: xr.Dataset, new: xr.Dataset) -> tuple[list[Difference], xr.Dataset, xr.Dataset]:
    """What only one of two datasets has along its dimensions, and the parts that both have.

    Along a dimension of another size, and along one with other texts, values belong together if
    their coordinates agree within the tolerance.

    >>> old, new = (xr.Dataset(coords={"claim": names}) for names in (["high"], ["high", "low"]))
    >>> [str(each) for one, other in ((old, new), (new, old)) for each in aligned(one, other)[0]]
    ['claim low is new', 'claim low is missing']
    """
    differing = []
    for dim in sorted({*map(str, old.dims)} & {*map(str, new.dims)}):
        is_as_long = old.sizes[dim] == new.sizes[dim]
        if is_as_long and old[dim].dtype.kind not in "UO":
            continue
        same = np.ones((old.sizes[dim], new.sizes[dim]), bool)
        for name in {*along(old, dim)} & {*along(new, dim)}:
            y, x = (data[name].values for data in (old, new))
            same &= far(x[None, :], y[:, None], old[name].attrs) <= 1
        # Of several equal coordinates, the first of both belong together.
        same &= np.cumsum(same, 0) == np.cumsum(same, 1)
        kept = same.any(1), same.any(0)
        if is_as_long and all(map(np.all, kept)):
            continue
        only = [
            [text.removeprefix(f"{dim} = ") for text in np.array(labels(data, dim))[~both]]
            for data, both in zip((old, new), kept, strict=True)
        ]
        differing.append(Difference(dim, elements(*only)))
        places = np.nonzero(same)
        old, new = (data.isel({dim: place}) for data, place in zip((old, new), places, strict=True))
    return differing, old, new


def values_that_differ(old: xr.Dataset, new: xr.Dataset) -> list[Difference]:
    """The largest change of each variable of two datasets that both have with the same dimensions.

    Single values, such as a threshold, are first, then the variables that changed most.
    """
    distances = {
        str(name): distance(str(name), old, new)
        for name, variable in old.variables.items()
        if name in new.variables and variable.dims == new[name].dims
    }
    ordered = sorted(
        (name for name, far in distances.items() if (far > 1).any()),
        key=lambda name: (distances[name].ndim > 0, -distances[name].max()),
    )
    return [largest_change(old, new, name, distances[name]) for name in ordered]


def largest_change(old: xr.Dataset, new: xr.Dataset, name: str, far: np.ndarray) -> Difference:
    """The value of a variable that changed most, of those that are numbers in both datasets if
    there are some.
    """
    finite = np.where(np.isfinite(far), far, 0.0)
    worst = np.unravel_index(np.argmax(finite if (finite > 1).any() else far), far.shape)
    given = old[name].attrs
    places = zip(map(str, old[name].dims), worst, strict=True)
    return Difference(
        name,
        excerpt(old[name].values[worst], new[name].values[worst]),
        where=", ".join(labels(old, dim)[index] for dim, index in places),
        differing=int(np.count_nonzero(far > 1)),
        size=far.size,
        tolerance=f"{given['tolerance']:g}" if "tolerance" in given else "",
        long_name=given.get("long_name", ""),
    )


def distance(name: str, old: xr.Dataset, new: xr.Dataset) -> np.ndarray:
    """How far a variable is from the reference, as `far` says."""
    given = old[name].attrs
    other = given.get("tolerance_scale")
    scale = abs(old[other].values) if other else None
    return far(new[name].values, old[name].values, given, scale)


def far(x: np.ndarray, y: np.ndarray, given: Mapping, scale: Any = None) -> np.ndarray:
    """How far values x are from y, in multiples of the tolerance that the attributes of y declare.

    Whole numbers that differ are further than their tolerance, one half. A text, NaN or infinity is
    infinitely far from another.
    """
    if x.dtype.kind not in "fi" or y.dtype.kind not in "fi":
        return np.where(x.astype(object) != y.astype(object), np.inf, 0.0)
    unequal = np.where((x != y) & ((x == x) | (y == y)), np.inf, 0.0)
    if y.dtype.kind == "i":
        tolerance: Any = 0.5
    else:
        if scale is None:
            scale = np.maximum(abs(y), given["floor"])
        tolerance = given["tolerance"] * scale
    with np.errstate(all="ignore"):
        ratio = abs(x - y) / tolerance
    return np.where(np.isnan(ratio), unequal, ratio)


def excerpt(old: object, new: object) -> str:
    """Print two values as "old → new"; long texts from 30 characters before the first difference.

    >>> excerpt(82.177, 83.0), excerpt(1.0, 1.000000001)
    ('82.177 → 83', '1.0 → 1.000000001')
    >>> long = "The first 80 characters of this sentence are the same in both texts, and it is "
    >>> excerpt(f"{long}82.", f"{long}83.")
    'ame in both texts, and it is 82. → ame in both texts, and it is 83.'
    """
    texts = [shown(old), shown(new)]
    if texts[0] == texts[1]:
        texts = [str(old), str(new)]
    if max(map(len, texts)) > 80:
        start = max(0, common(*texts) - 30)
        texts = [text[start : start + 80] for text in texts]
    return " → ".join(texts)


def common(one: Sequence, other: Sequence) -> int:
    """How many elements two sequences have in common before the first difference."""
    return len([*takewhile(lambda pair: pair[0] == pair[1], zip(one, other, strict=False))])


def shown(value: object) -> str:
    """A number with six digits; a text with its invisible characters escaped.

    >>> shown(2 / 3), shown("5\N{NO-BREAK SPACE}%")
    ('0.666667', '5\\\\xa0%')
    """
    if isinstance(value, float | np.floating):
        return f"{value:.6g}"
    return "".join(char if char.isprintable() else ascii(char)[1:-1] for char in str(value))


def sentences(old: Sequence[str], new: Sequence[str]) -> list[tuple[str, str]]:
    """The lines of a text that changed, in pairs. A line is a sentence or a row of a table.

    >>> sentences(["At 82.18.", "So it is."], ["At 83.1.", "New.", "So it is."])
    [('At 82.18.', 'At 83.1.'), ('', 'New.')]
    """
    # Sentences that differ in numbers only belong together.
    before, after = ([re.sub(r"\d[\d.]*", "#", line) for line in lines] for lines in (old, new))
    pairs = [
        pair
        for _, i, j, k, m in SequenceMatcher(None, before, after, autojunk=False).get_opcodes()
        for pair in zip_longest(old[i:j], new[k:m], fillvalue="")
    ]
    return [(one, other) for one, other in pairs if one != other]


# The verdict on a file


@dataclass(frozen=True)
class Finding:
    """The verdict on a file, and why.

    Attributes
    ----------
    verdict
        One of `STATUS`.
    differences
        What differs, the furthest first.
    causes
        What is wrong with one side, or what differs in what made both, by kind.
    sentences
        The lines of a text that changed, the old and the new one.
    """

    verdict: str
    differences: Sequence[Difference] = ()
    causes: Mapping[str, Sequence[str]] = field(default_factory=dict)
    sentences: Sequence[tuple[str, str]] = ()

    def lines(self, name: str) -> tuple[str, ...]:
        """The finding on a file of this name: a line, and a table of several differences, of which
        the first `ROWS` have a row.
        """
        several = len(self.differences) > 1
        told = [f"{len(self.differences)} differences"] * several or [*map(str, self.differences)]
        told += [f"{kind}: {', '.join(details)}" for kind, details in self.causes.items()]
        rows = self.differences[: ROWS * several]
        others = self.differences[ROWS:]
        widths = [
            max(map(len, texts)) for texts in zip(*(row.columns for row in rows), strict=True)
        ]
        lines = ["  ".join(["", *map(str.ljust, row.columns, widths)]).rstrip() for row in rows]
        if others:
            lines.append(f"  and {', '.join(row.what for row in others)}")
        return f"{name}: {'; '.join(told)}", *lines


def finding(old: Side, new: Side, checkout: Checkout | None, differing: Collection[str]) -> Finding:
    """The verdict on a file: each side by itself decides first, and then both are compared.

    `differing` are the datasets of the run that differ.
    """
    kinds = {**old.wrong, **new.wrong}
    wrong = {kind: [*old.wrong.get(kind, ()), *new.wrong.get(kind, ())] for kind in kinds}
    if wrong.keys() & {UNREADABLE, UNNAMED, LEFT} or len(wrong.get(MISSING, ())) == 2:
        return Finding("not comparable", causes=wrong)
    if MISSING in wrong:
        return Finding("missing" if len(wrong) == 1 else "differs", causes=wrong)
    is_data = isinstance(new.contents, xr.Dataset)
    try:
        lines = (
            differences(new.path.name, old.contents, new.contents) if old.hash != new.hash else []
        )
        # A dataset with other bytes than its record says, but with numbers that agree, was written
        # anew and not edited. That is no excuse for the reference, whose bytes were accepted, nor
        # for a copy of the other side, or for a file from which others were made since.
        is_copy = any(
            EDITED in one.wrong and (one.is_used or one.hash in other.record["made"].values())
            for one, other in ((old, new), (new, old))
        )
        is_anew = is_data and not lines and not is_copy and not (checkout and old.wrong)
        if wrong and not (is_anew and wrong.keys() == {EDITED}):
            return Finding("differs", lines if EDITED in wrong else (), wrong)
        of_contents = of_dataset if is_data else of_product
        return of_contents(lines, old, new, checkout, differing)
    except Exception as error:  # Whatever damaged attributes, or drawing again, raise.
        return Finding(
            "not comparable", causes={UNREADABLE: [f"{new.path.name}: {one_line(error)}"]}
        )


def of_dataset(
    lines: list[Difference],
    old: Side,
    new: Side,
    checkout: Checkout | None,
    differing: Collection[str],
) -> Finding:
    """The verdict on a dataset, in which these lines differ."""
    if not lines and old.record["parameters"] == new.record["parameters"]:
        return Finding("agrees")
    return Finding("differs", lines, what_differs(old, new, checkout, differing))


def of_product(
    lines: list[Difference],
    old: Side,
    new: Side,
    checkout: Checkout | None,
    differing: Collection[str],
) -> Finding:
    """The verdict on a picture, a table, a text or a page."""
    if not lines:
        return Finding("agrees")
    # A text with another title is another text.
    is_text = new.path.suffix == ".md" and old.contents[0] == new.contents[0]
    pairs = sentences(old.contents, new.contents) if is_text else []
    if new.record["data"].keys() & {*differing}:
        return Finding("follows", sentences=pairs)
    if old.contents is None and drawn_elsewhere(old.record, new.record, checkout):
        return Finding("drawn elsewhere")
    if rounded(old, new, checkout):
        return Finding("agrees")
    return Finding("differs", lines, what_differs(old, new, checkout, differing), pairs)


def drawn_elsewhere(old: Mapping, new: Mapping, checkout: Checkout | None) -> bool:
    """Whether another matplotlib drew a picture, with the same code or that of the main branch."""
    drawn_by = {made["versions"].get("matplotlib") for made in (old, new)} - {None}
    known = {*old["code"].items(), *(checkout.main.items() if checkout else ())}
    return len(drawn_by) == 2 and {*new["code"].items()} <= known


def rounded(old: Side, new: Side, checkout: Checkout | None) -> bool:
    """Whether files differ only because numbers of their dataset, which agree, are rounded
    differently: the same code made both files, or today's code makes that of the reference again.
    """
    data, other = (one.path.with_name(f"{new.shows}.nc") for one in (old, new))
    if not data.is_file() or read(data).equals(read(other)):
        return False
    if checkout is None:
        return what_differs(old, new, None, ()) == SAME
    again = remade(checkout.project.make, old.path.stem, data, content(data))
    return again.get(old.path.name) == old.hash


@cache
def remade(make: Callable, name: str, path: Path, _made: str) -> dict[str, str]:
    """The hashes of the files of a name that follow from a dataset, made again."""
    with TemporaryDirectory() as folder:
        try:
            make(name, read(path), Path(folder))
        except OSError as error:
            raise OSError(f"{folder}, TMPDIR names another folder: {error}") from error
        return {path.name: content(path) for path in Path(folder).iterdir()}


def what_differs(
    old: Side, new: Side, checkout: Checkout | None, differing: Collection[str]
) -> Mapping[str, Sequence[str]]:
    """What differs in what made both sides, by kind. Parameters count if both records have some.

    Code that the main branch has, too, is marked, if the checkout knows this branch.
    """
    code = new.record["code"]
    is_data = isinstance(new.contents, xr.Dataset)
    if checkout and is_data and about(old.contents) != about(new.contents):
        # Descriptions are not among the code that a dataset records.
        code = code | contents_in(checkout.project.checkout, checkout.project.described_in)
    main = checkout.main if checkout else {}
    marks = {file: " (also on main)" * (main.get(file) == code[file]) for file in code}
    parameters = [one.record["parameters"] for one in (old, new)]
    versions = [{key: one.record["versions"].get(key) for key in PACKAGES} for one in (old, new)]
    causes = {
        "follows from": [Path(file).stem for file in new.record["data"] if file in differing],
        "changed parameter": changes(parameters[0], parameters[1]) if all(parameters) else [],
        "changed code": [
            file + marks[file] for file in code if old.record["code"].get(file) != code[file]
        ],
        "other versions": changes(versions[0], versions[1]),
    }
    return {kind: details for kind, details in causes.items() if details} or SAME


# All files


@dataclass(frozen=True)
class Report:
    """Two runs, both sides of each file, and what was found."""

    old: Run
    new: Run
    sides: Mapping[str, tuple[Side, Side]]
    findings: Mapping[str, Finding]

    def those(self, *verdicts: str) -> dict[str, Finding]:
        """The files with one of these verdicts."""
        return {file: one for file, one in self.findings.items() if one.verdict in verdicts}

    @property
    def status(self) -> int:
        """The exit status: 1 if a file differs, else 2 if one is not comparable or none exists."""
        statuses = {STATUS[finding.verdict] for finding in self.findings.values()}
        return 1 if 1 in statuses else max(statuses, default=2)

    def names(self, verdict: str) -> list[str]:
        """The figures, tables and texts with a verdict."""
        return sorted({Path(file).stem for file in self.those(verdict)})

    def lines(self) -> list[str]:
        """What is wrong, by name. Both pictures of a figure have the same line."""
        files = self.those("differs", "not comparable").items()
        blocks = dict.fromkeys(finding.lines(Path(file).stem) for file, finding in files)
        return [*chain.from_iterable(blocks), *self.missing()]

    def on_page(self) -> dict[str, dict[str, Finding]]:
        """The files that the page shows, by name, datasets first."""
        by_name: dict[str, dict[str, Finding]] = {}
        for file, finding in self.those(*ON_PAGE).items():
            if finding.causes or finding.sentences or file.endswith(".png"):
                by_name.setdefault(Path(file).stem, {})[file] = finding
        return by_name

    def missing(self) -> list[str]:
        """A line for each run that lacks files which the other one has: a few, or how many."""
        lines = []
        for index, run in enumerate((self.old, self.new)):
            those = self.those("missing")
            files = [file for file in those if MISSING in self.sides[file][index].wrong]
            names = sorted({Path(file).stem for file in files})
            what = f"{len(files)} files of {', '.join(names)}" if files[3:] else ", ".join(files)
            lines += [f"missing in {run.label}: {what}"] * bool(files)
        return lines

    def printed(self, template: str, **more: Any) -> str:
        """The report as a template prints it, with invisible characters escaped."""
        printing = environment(Path(__file__).parent).overlay(finalize=shown)
        return printing.get_template(template).render(report=self, **more)


def compare(
    project: Project,
    old: Run,
    new: Run,
    checkout: Checkout | None = None,
    names: Collection[str] = (),
) -> Report:
    """Compare all files of two runs, or those of the figures and tables named.

    Two runs are judged by their records: today's code and configuration do not matter. If a
    checkout is given, the old run is its reference, and the new one must be what it makes today.
    """
    files = old.named().union((checkout and checkout.made) or new.named())
    for run in (old, new):
        files |= {f"figures/{path.name}" for path in run.folder.glob("figures/[!.]*")}
    sides = {
        file: (side(old, file), side(new, file, checkout))
        for file in sorted(files - {ACCEPTED})
        if (file.startswith("figures/") or file in project.texts)
        and (not names or Path(file).stem in names)
    }
    # The reference has no pages. Those of a run must be as its records say.
    for run in (old, new):
        for file in () if names else sorted(run.records.keys() - sides.keys()):
            page = side(run, file)
            if page.wrong:
                sides[file] = (replace(page, wrong={}), page)
    datasets = {file: pair for file, pair in sides.items() if file.endswith(".nc")}
    differing = [
        file for file, pair in datasets.items() if finding(*pair, checkout, ()).verdict != "agrees"
    ]
    # Datasets that are made of others come behind them, then what is made of datasets. What one run
    # does not have is last.
    order = sorted(
        sides,
        key=lambda file: (
            any(MISSING in one.wrong for one in sides[file]),
            file not in datasets,
            bool(sides[file][1].record["data"]),
            file,
        ),
    )
    findings = {file: finding(*sides[file], checkout, differing) for file in order}
    return Report(old, new, sides, findings)


def obstacles(project: Project, report: Report, checkout: Checkout | None) -> Iterator[str]:
    """Yield why two runs cannot be compared: the record of the reference has the marks of a merge,
    both are one run, or results of the checkout are of other versions of libraries.
    """
    if checkout and any(CONFLICT in line for line in report.old.damaged):
        files = " ".join(["figures", *project.texts])
        way = f"`git checkout HEAD -- {files}`, commit, and accept the results of the merge"
        yield f"{ACCEPTED} {CONFLICT}: {way}"
    old = report.old
    new = report.new
    is_copy = old.records == new.records and all(job["made_at"] for job in new.records.values())
    if old.folder.resolve() == new.folder.resolve() or (new.records and is_copy):
        yield f"{old.label} and {new.label} are the same run"
    if checkout and checkout.config is not None:
        yield from other_versions(report)


def other_versions(report: Report) -> Iterator[str]:
    """Yield with which versions the results of a run were made if these are not installed here."""
    here = versions()
    records = [new.record["versions"].items() for _, new in report.sides.values()]
    made = {pair for pairs in records for pair in pairs if pair[0] in PACKAGES} - {*here.items()}
    if made:
        lines = [f"{name} {version}, here is {here[name]}" for name, version in sorted(made)]
        yield f"{report.new.label}, made with {'; '.join(lines)}: remove them and run again"


@dataclass(frozen=True)
class Plan:
    """What an acceptance writes, decided before it writes the first file.

    Attributes
    ----------
    contents
        The new contents of each file of the reference that changes; none if it is removed.
    hashes
        Before and after: those of the file that is there, and of the one that will be.
    record
        The new record of the reference, if it changes.
    """

    contents: Mapping[str, bytes | None]
    hashes: Mapping[str, Sequence[str]]
    record: bytes | None


def accept(project: Project, results: Path, inputs: Iterable[str]) -> list[str]:
    """Make results the reference, and return the files that were written or removed.

    `inputs` are the files that the rules make, in the folder of the results. Each file is written
    atomically, and the record last: an acceptance that was interrupted can be repeated. Raises
    ValueError if a result may not be accepted, or if a file of the reference would be lost.
    """
    plan = planned(project, results, inputs)
    begun = project.top / BEGUN
    if plan.contents:
        write(begun, json.dumps(plan.hashes).encode())
    for file, contents in plan.contents.items():
        if contents is None:
            (project.top / file).unlink(missing_ok=True)
        else:
            write(project.top / file, contents)
    if plan.record:
        write(project.top / ACCEPTED, plan.record)
    begun.unlink(missing_ok=True)
    return [*plan.contents]


def planned(project: Project, results: Path, inputs: Iterable[str]) -> Plan:
    """What `accept` has to write.

    If one file of a figure or a table is written, all files of its dataset are: then the reference
    agrees on processors that round numbers differently. If all agree, the numbers and the pictures
    stay as they are, datasets get the attributes of today, which name their code, and the code and
    the libraries that gave them again are noted. Files that no rule makes any
    more are removed if git tracks them and the record of the reference names them.
    """
    # Read before git says that it is committed, and before results are compared with it.
    committed = tree(project.checkout, "HEAD", "--", *project.code)
    code = contents_in(project.checkout, committed)
    made = [relative(results, file) for file in inputs]
    report = compare(
        project,
        run_in(project.top, "the reference"),
        run_in(results, "the results"),
        Checkout(project, {}, configuration(project), made),
    )
    for reason in refusals(project, report, made, committed):
        raise ValueError(f"nothing is accepted, {reason}")
    accepted = {file: report.sides[file] for file in report.findings if file in made}
    changed = {
        new.shows
        for file, (_, new) in accepted.items()
        if report.findings[file].verdict != "agrees"
    }
    after = {
        file: new.hash
        for file, (old, new) in accepted.items()
        if new.shows in changed and old.hash != new.hash
    }
    contents: dict[str, bytes | None] = {file: (results / file).read_bytes() for file in after}
    for file, (old, new) in accepted.items():
        if isinstance(new.contents, xr.Dataset) and new.shows not in changed:
            today = renewed(old.contents, new.contents)
            if today and blob(today) != old.hash:
                contents[file] = today
                after[file] = blob(today)
    removed = [
        file
        for file in report.old.records
        if file not in made and git(project.checkout, "ls-files", str(project.top / file))
    ]
    hashes = states(project, report, [*after, *removed], after)
    text = report.new.records[project.texts[0]]
    record = {
        "made": {file: after.get(file, old.hash) for file, (old, _) in accepted.items()},
        "code": code,
        "versions": text["versions"],
        "entries": text["entries"],
    }
    # Another Python alone is not noted.
    then = next(iter(report.old.records.values()), {})
    python = {"python": then.get("versions", {}).get("python")}
    now = record | {"versions": record["versions"] | python}
    is_new = any(then.get(key) != now[key] for key in now)
    noted = f"{json.dumps(record, indent=0)}\n".encode() if is_new else None
    return Plan(contents | dict.fromkeys(removed), hashes, noted)


def renewed(old: xr.Dataset, new: xr.Dataset) -> bytes | None:
    """The numbers of a dataset with the attributes of another one, in which they agree; none if it
    has them. What computed the numbers stays.
    """
    kept = old.attrs.keys() & {"computed_on", "versions"}
    attributes = new.attrs | {name: old.attrs[name] for name in kept}
    if old.attrs == attributes:
        return None
    with TemporaryDirectory() as folder:
        path = Path(folder, "renewed.nc")
        to_netcdf(old.drop_encoding().assign_attrs(attributes), path)
        return path.read_bytes()


def states(
    project: Project, report: Report, files: Collection[str], after: Mapping[str, str]
) -> dict[str, list[str]]:
    """The hashes of files of the reference before and after they change, and those of files that an
    interrupted acceptance was about to change.

    Raises ValueError if a file would be lost: git does not have it, and no acceptance wrote it.
    """
    begun = project.top / BEGUN
    interrupted = json.loads(begun.read_bytes()) if begun.exists() else {}
    head = tree(project.top, "HEAD")
    before = contents_in(project.top, files)
    lost = []
    for file, git_hash in before.items():
        recorded = report.old.records.get(file, {}).get("made", {}).get(file)
        if git_hash not in {head.get(file), recorded, after.get(file), *interrupted.get(file, [])}:
            lost.append(file)
    if edited := " ".join(file for file in lost if file in head):
        stash = f"move the edit to a template, or keep it by `git stash -- {edited}`"
        raise ValueError(f"nothing is accepted, edited by hand: {edited}: {stash}")
    if lost:
        raise ValueError(f"nothing is accepted, not made by a rule, move it: {' '.join(lost)}")
    now = {file: [hashes[file] for hashes in (before, after) if file in hashes] for file in files}
    return interrupted | now


def refusals(
    project: Project, report: Report, made: Collection[str], committed: Mapping[str, str]
) -> Iterator[str]:
    """Yield why results may not be accepted: the code is not committed, a claim's function raised
    an exception, a result is not fresh and as recorded, or it was made with other versions of
    libraries.

    Stop at the first: the later ones read records that exist only if no result is wrong.
    """
    if edited := uncommitted(project.checkout, *project.code):
        yield f"commit first: {', '.join(edited)}"
    wrong = [
        f"{kind}: {', '.join(details)}"
        for file, (_, new) in report.sides.items()
        if file in made or LEFT in new.wrong
        for kind, details in new.wrong.items()
    ]
    if wrong:
        yield f"run again or remove first: {'; '.join(dict.fromkeys(wrong))}"
    contents = [new.contents for _, new in report.sides.values()]
    datasets = [data for data in contents if isinstance(data, xr.Dataset)]
    if slips := [line for data in datasets for line in raised(data)]:
        yield f"correct first: {'; '.join(slips)}"
    records = [report.new.records[file] for file in report.findings if file in made]
    if unknown := {file for record in records for file in record["code"]} - committed.keys():
        yield f"commit first: git does not know {min(unknown)}"
    yield from other_versions(report)


# The command and the rule


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


def main(project: Project, arguments: list[str]) -> int:
    """Compare a run with the reference, or two runs: the command `compare.py`.

    Returns the exit status: 1 if something differs, 2 if it could not be compared.
    """
    # The encoding of a console may lack characters such as arrows.
    cast(Any, sys.stdout).reconfigure(errors="backslashreplace")
    parser = argparse.ArgumentParser(
        prog="compare.py",
        description="Compare a run with the reference in git, or two runs with each other.",
        epilog="The exit status is 1 if something differs, and 2 if it could not be compared. "
        "The last line is the path of a page.",
    )
    parser.add_argument("run", type=Path, help="a folder with results, or a zip file of it")
    parser.add_argument(
        "other",
        nargs="*",
        help="a second run, compared with the first; names of figures and tables",
    )
    given = parser.parse_args(arguments)
    is_second = bool(given.other) and Path(given.other[0]).exists()
    paths = [given.run, *map(Path, given.other[:is_second])]
    names = given.other[is_second:]
    with TemporaryDirectory() as unpacked:
        try:
            folders = [
                results_of(project, path, Path(unpacked, str(n))) for n, path in enumerate(paths)
            ]
            config = configuration(project)
        except Exception as error:  # Whatever unpacking raises for a damaged file.
            parser.error(f"a run cannot be read: {one_line(error)}")
        runs = [run_in(folder, str(path)) for folder, path in zip(folders, paths, strict=True)]
        old, new = [run_in(project.top, "the reference"), *runs][-2:]
        # A run in another folder has parameters of its own.
        is_own = new.folder.resolve() == (project.top / "results").resolve()
        checkout = Checkout(project, main_branch(project.checkout), config if is_own else None)
        judged_by = checkout if len(runs) == 1 else None
        report = compare(project, old, new, judged_by, names)
        if unknown := {*names} - {Path(file).stem for file in report.findings}:
            parser.error(f"{', '.join(sorted(unknown))}: neither a run nor a name in {old.label}")
        if lines := [*obstacles(project, report, judged_by)]:
            parser.error("; ".join(lines))
        # No file of somebody else lies there.
        is_zip = paths[-1].is_file()
        folder = paths[-1].with_suffix(".diff") if is_zip else folders[-1] / "diff"
        return save_report(project, report, folder, sys.stdout)


def report_of_run(project: Project, results: Path, snakemake: Any) -> int:
    """Compare the results of a run: the rule `diff`, whose inputs are what other rules make.

    Returns the exit status, as `main` does. If it is not 0, Snakemake prints the log at its end.
    """
    made = [relative(results, file) for file in snakemake.input]
    checkout = Checkout(project, main_branch(project.checkout), snakemake.params.config, made)
    report = compare(
        project,
        run_in(project.top, "the reference"),
        run_in(results, "the results"),
        checkout,
        snakemake.params.names,
    )
    if lines := [*obstacles(project, report, checkout)]:
        print(*lines, sep="\n", file=sys.stderr)
        return STATUS["not comparable"]
    stream = sys.stderr if report.status else sys.stdout
    return save_report(project, report, results / "diff", stream)


def drawn(project: Project, report: Report, file: str) -> list[bytes]:
    """The pictures of both sides as PNG, and one of both over each other. If it is the datasets
    that differ, they are drawn by today's code, with the same axes.
    """
    paths = [side.path for side in report.sides[file]]
    pictures = [path.read_bytes() for path in paths if path.is_file()]
    if report.findings[file].verdict == "follows":
        with suppress(Exception):  # Whatever reading and drawing a dataset of other code raises.
            shown = report.sides[file][1].shows
            data = [read(path.with_name(f"{shown}.nc")) for path in paths]
            pictures = project.side_by_side(paths[0].stem, data)
    return pictures + over_each_other(pictures)


def over_each_other(pictures: Sequence[bytes]) -> list[bytes]:
    """Two pictures of one size as one picture, as PNG; none if their sizes differ, or if one cannot
    be read.

    What both draw is grey. What only the first one draws has the first colour of `ONLY`, and what
    only the second one draws the second colour.
    """
    images: list[np.ndarray] = []
    with suppress(Exception):  # Whatever readers raise for a damaged picture.
        images = [np.asarray(Image.open(BytesIO(png)).convert("RGB"), float) for png in pictures]
    if len(images) != 2 or images[0].shape != images[1].shape:
        return []
    first, second = images
    both = 255 - 0.3 * (255 - np.maximum(first, second)).max(-1, keepdims=True)
    for gone, colour in zip((second - first, first - second), ONLY, strict=True):
        share = np.clip(gone / 255, 0, 1).max(-1, keepdims=True)
        both = (1 - share) * both + share * ImageColor.getrgb(colour)
    with BytesIO() as picture:
        Image.fromarray(both.astype(np.uint8)).save(picture, "PNG")
        return [picture.getvalue()]


def save_report(project: Project, report: Report, folder: Path, stream: TextIO) -> int:
    """Print a report, and save it as a text and as a page with the pictures of both sides.

    Returns the exit status.
    """
    pictures = {
        Path(file).stem: [base64.b64encode(png).decode() for png in drawn(project, report, file)]
        for file in report.those(*ON_PAGE)
        if file.endswith(".png")
    }
    page = folder.resolve() / "index.html"
    back = (page.parents[1] / "index.html").is_file()
    text = report.printed("diff.txt.j2")
    try:
        write(
            page, report.printed("diff.html.j2", pictures=pictures, only=ONLY, back=back).encode()
        )
        # Whoever gets the folder has it elsewhere.
        write(folder / "report.txt", text.encode())
        print(f"{text}{page}", file=stream)
    except OSError as error:
        print(f"{text}The page cannot be written: {error}", file=stream)
    return report.status
