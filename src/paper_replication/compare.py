"""Compare two runs, and make results the reference.

The reference is a folder `figures` and some texts beside it; a run writes the same files into a
folder of its own. Records say what made a file: datasets, code, versions of libraries, and the hash
of the file. A run has a record for each job in its folder `records`. The reference has one for all
its files, `figures/accepted.json`, with the code and the versions that gave them last.

Each side of a file is asked by itself first (`Comparison.side`): whether it is present, readable,
named by a record, as the record says, and fresh. Then `Comparison.finding` compares both sides:

- Numbers of datasets agree within the tolerances that the first run declares.
- All other files are functions of datasets, and are compared byte for byte. If one of their
  datasets differs, this is what is reported; of a text the changed sentences are listed.
- Another processor rounds numbers differently. Then a picture, a table or a page of one dataset
  agrees if today's code makes the file of the reference again.

A difference has a cause: an edit by hand, parameters, files of code, or versions of libraries. A
file of code is a cause only if the results have it neither as accepted nor as on the main branch.
"""

import argparse
import base64
import json
import os
import re
import shutil
import subprocess
import sys
from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import dataclass, field
from difflib import SequenceMatcher
from functools import cache, partial
from itertools import takewhile, zip_longest
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any, TextIO, cast
from xml.etree import ElementTree

import numpy as np
import xarray as xr
import yaml
from PIL import Image

from paper_replication.configuration import SHOWN_BY, entries, shown_as
from paper_replication.datasets import Project, attributes, plain, read, write
from paper_replication.provenance import PACKAGES, content, contents
from paper_replication.templates import environment

ACCEPTED = "figures/accepted.json"
PROVENANCE = {"title", "parameters", "code", "versions", "computed_on"}
"""Attributes of a dataset that are causes of a difference, or are not compared."""
PICTURES = (".png", ".svg")
MISSING, UNREADABLE, UNNAMED = "missing", "cannot be compared", "no record names"
EDITED, STALE = "edited by hand", "stale, remove it and run again; changed since"
"""What may be wrong with a file of one run."""
NOTHING: Mapping[str, Sequence[str]] = {
    "cause": ["no parameter, code or version that is recorded has changed"]
}


RECORD = ("made", "data", "code", "versions", "entries")
"""What a record has."""
STATUS = {"agrees": 0, "follows": 0, "drawn elsewhere": 0, "differs": 1, "not comparable": 2}
"""The exit status of each verdict. A file follows if one of its datasets has another verdict. A
picture is drawn elsewhere if the same code drew it with another matplotlib.
"""


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
        The record of each file, and each record by its own name.
    damaged
        Records that cannot be read, with the reasons.
    """

    label: str
    folder: Path
    records: Mapping[str, dict]
    damaged: Sequence[str] = ()

    def record(self, file: str, data: Any = None) -> dict[str, Any]:
        """What made a file, as far as it is known. A dataset has its own parameters and code.

        The parameters of a text are the entries of the configuration.
        """
        found = dict(self.records.get(file, {key: {} for key in RECORD}))
        found["parameters"] = found["entries"]
        if isinstance(data, xr.Dataset):
            found |= {
                key: json.loads(data.attrs[key]) for key in ("parameters", "code", "versions")
            }
            # The titles of claims and choices are code.
            found["parameters"] |= {"title": data.attrs["title"]} if found["parameters"] else {}
        return found | self.records.get(ACCEPTED, {})

    def older(self, record: Mapping) -> list[str]:
        """The datasets of a file that were made again after it."""
        made = {name: self.record(name)["made"].get(name) for name in record["data"]}
        return [name for name, known in record["data"].items() if made[name] not in (known, None)]


def run_in(folder: Path, label: str) -> Run:
    """The run in a folder, with its records."""
    records: dict[str, dict] = {}
    damaged = []
    for path in [*folder.glob("records/*.json"), *folder.glob(ACCEPTED)]:
        name = path.relative_to(folder).as_posix()
        try:
            known = {"data": {}} | json.loads(path.read_text("utf-8"))
            record = {key: dict(known[key]) for key in RECORD}
            records |= dict.fromkeys([name, *record["made"]], record)
        except Exception as error:  # Whatever the reader raises for a damaged file.
            damaged.append(f"{name} cannot be read: {error!r}")
    return Run(label, folder, records, damaged)


def files_of(project: Project, runs: Sequence[Run], config: Mapping) -> list[str]:
    """What is compared: the files that a configuration and the records of runs register, and
    whatever else is in their folders `figures`. Datasets are first, and what is made of them last.
    """
    records = [record for run in runs for record in run.records.values()]
    found = {file for record in records for file in (*record["made"], *record["data"])}
    for known in (entries(config), *(record["entries"] for record in records)):
        found |= {f"figures/{name}.{kind}" for name in known for kind in shown_as(known[name])}
    for run in runs:
        found |= {f"figures/{path.name}" for path in run.folder.glob("figures/[!.]*")}
    following = {file for record in records if record["data"] for file in record["made"]}
    return sorted(
        {file for file in found if file.startswith("figures/") or file in project.texts}
        - {ACCEPTED},
        key=lambda file: (file[-3:] != ".nc", file in following, file),
    )


def configuration(project: Project) -> dict:
    """The configuration of the checkout."""
    return yaml.safe_load((project.top / "config/config.yaml").read_text("utf-8"))


@dataclass(frozen=True)
class Side:
    """A file of one run, asked by itself.

    Attributes
    ----------
    wrong
        What is wrong with the file: details by kind, from `MISSING` to `STALE`.
    contents, hash
        Its contents, as `content_of` reads them, and their hash.
    record
        What made it.
    """

    wrong: Mapping[str, Sequence[str]]
    contents: Any = None
    hash: str = ""
    record: dict[str, Any] = field(default_factory=dict)


@dataclass(frozen=True)
class Finding:
    """The verdict on a file, and why.

    Attributes
    ----------
    verdict
        One of `STATUS`.
    wrong
        What is wrong with the file of the new run by itself.
    differences
        What differs, the furthest first.
    causes
        Why, or what is wrong with one side, by the kind of the cause.
    sentences
        The lines of a text that changed, the old and the new one.
    """

    verdict: str
    wrong: Mapping[str, Sequence[str]]
    differences: Sequence[str] = ()
    causes: Mapping[str, Sequence[str]] = field(default_factory=dict)
    sentences: Sequence[tuple[str, str]] = ()

    def __str__(self) -> str:
        causes = [f"{what}: {', '.join(which)}" for what, which in self.causes.items()]
        return "; ".join([*self.differences[:1], *causes])


# Datasets


def changes(old: Mapping, new: Mapping, above: str = "") -> list[str]:
    """What differs between two mappings.

    >>> changes({"grid": {"max": 10.0}, "n": 1}, {"grid": {"max": 20.0}, "n": 1})
    ['grid.max 10.0 → 20.0']
    """
    found = []
    for key in sorted({*old, *new}):
        before = old.get(key, "absent")
        after = new.get(key, "absent")
        if isinstance(before, Mapping) and isinstance(after, Mapping):
            found += changes(before, after, f"{above}{key}.")
        elif isinstance(before, Mapping):
            found.append(f"{above}{key} is missing")
        elif isinstance(after, Mapping):
            found.append(f"{above}{key} is new")
        elif before != after:
            found.append(f"{above}{key} {before} → {after}")
    return found


def about(data: xr.Dataset) -> dict:
    """What a dataset has apart from numbers: attributes, and types and dimensions of variables."""
    found = {key: value for key, value in data.attrs.items() if key not in PROVENANCE}
    for name, variable in data.variables.items():
        found[str(name)] = variable.attrs | {
            "role": "coordinate" if name in data.coords else "variable",
            "type": "text" if variable.dtype.kind in "UO" else str(variable.dtype),
            "sizes": str(dict(variable.sizes)),
        }
    return plain(found)


def differences(file: str, old: Any, new: Any) -> list[str]:
    """What differs in the contents of a file, which are those of `content_of`."""
    if file.endswith(".nc"):
        return changes(about(old), about(new)) or values_that_differ(old, new)
    if file.endswith(PICTURES):
        return ["the picture differs"]
    # An empty line follows the last line feed.
    number = common(old, new)
    pair = [[*side, "the end of the text"][number] or "an empty line" for side in (old, new)]
    return [f"{Path(file).name}, line {number + 1}: {excerpt(*pair)}"]


def values_that_differ(old: xr.Dataset, new: xr.Dataset) -> list[str]:
    """Where numbers and texts of a dataset differ: a line for each variable, the furthest first.

    Both datasets have the same variables.
    """
    far = []
    for name in map(str, old.variables):
        distance = distances(name, old, new)
        count = np.count_nonzero(distance > 1)
        if count:
            worst = np.unravel_index(np.argmax(distance), distance.shape)
            text = f"{name} {excerpt(old[name].values[worst], new[name].values[worst])}"
            at = [
                f"{dim} = {shown(old[dim].values[index])}"
                for dim, index in zip(old[name].dims, worst, strict=True)
            ]
            text += f" at {', '.join(at)}" if at else ""
            text += (
                f" (tolerance {old[name].attrs['tolerance']:g})"
                if "tolerance" in old[name].attrs
                else ""
            )
            text += f", and {count - 1} more of {distance.size} values" if count > 1 else ""
            far.append((distance[worst], text))
    return [text for _, text in sorted(far, key=lambda each: -each[0])]


def distances(name: str, old: xr.Dataset, new: xr.Dataset) -> np.ndarray:
    """How far a variable is from the reference, in multiples of the tolerance declared there.

    A text, NaN or infinity is infinitely far from another.
    """
    x = new[name].values
    y = old[name].values
    missing = new[name].isnull().values & old[name].isnull().values
    unequal = np.where((x != y) & ~missing, np.inf, 0.0)
    if y.dtype.kind != "f":
        return unequal
    given = old[name].attrs
    scale = np.maximum(abs(y), given["floor"])
    if "tolerance_scale" in given:
        scale = abs(old[given["tolerance_scale"]].values)
    with np.errstate(all="ignore"):
        ratio = abs(x - y) / (given["tolerance"] * scale)
    return np.where(np.isnan(ratio), unequal, ratio)


def excerpt(old: object, new: object) -> str:
    """Print two values as "old → new"; long texts from 30 characters before the first difference.

    >>> excerpt(82.177, 83.0), excerpt(1.0, 1.000000001)
    ('82.177 → 83', '1.0 → 1.000000001')
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
    pairs = zip(one, other, strict=False)
    return len([*takewhile(lambda pair: pair[0] == pair[1], pairs)])


def shown(value: object) -> str:
    """A number with six digits; a text with its invisible characters escaped.

    >>> shown(2 / 3), shown("5\N{NO-BREAK SPACE}%")
    ('0.666667', '5\\\\xa0%')
    """
    if isinstance(value, float | np.floating):
        return f"{value:.6g}"
    return "".join(each if each.isprintable() else ascii(each)[1:-1] for each in str(value))


# Causes


def git(checkout: Path, *arguments: str) -> str:
    """What git answers about a repository; empty without git.

    A hook has variables that name the repository and the index of its commit. They are dropped, as
    git advises for another repository.
    """
    run = partial(subprocess.run, capture_output=True, check=True, text=True)
    try:
        names = run(["git", "rev-parse", "--local-env-vars"]).stdout.split()
        environment = {name: value for name, value in os.environ.items() if name not in names}
        command = ["git", "-C", str(checkout), "-c", "core.quotePath=off", *arguments]
        return run(command, env=environment).stdout.strip()
    except (OSError, subprocess.CalledProcessError):
        return ""


def tree(checkout: Path, commit: str, *paths: str) -> dict[str, str]:
    """The hashes of the files of a commit."""
    listed = git(checkout, "ls-tree", "-r", commit, *paths)
    return {line.partition("\t")[2]: line.split()[2] for line in listed.splitlines()}


def code_of_main(checkout: Path) -> dict[str, str]:
    """The hashes of the files on the main branch where this one left it; empty if no main branch is
    known, as in a shallow checkout, or if git has other hashes than records, as SHA-256.
    """
    known = ("origin/HEAD", "origin/main", "main")
    bases = (git(checkout, "merge-base", "HEAD", name) for name in known)
    forks = [base for base in bases if len(base) == 40]
    return tree(checkout, forks[0]) if forks else {}


def causes(before: Mapping, after: Mapping, main: Mapping) -> Mapping[str, Sequence[str]]:
    """What differs between the records of a file, by kind. `main` has the code on the main branch.

    Parameters count if both records have some.
    """
    code = [file for file, known in after["code"].items() if before["code"].get(file) != known]
    old, new = ({name: each["versions"].get(name) for name in PACKAGES} for each in (before, after))
    given = (before["parameters"], after["parameters"])
    since = "changed since the last acceptance"
    found: dict[str, Sequence[str]] = {
        "changed parameter": changes(*given) if all(given) else [],
        "changed": [file for file in code if main and main.get(file) != after["code"][file]],
        "other versions": changes(old, new),
    }
    if not main:
        found[f"{since} (the main branch is not known here)"] = code
    elif not any(found.values()):
        # The main branch itself differs from its reference.
        found[since] = code
    return {what: which for what, which in found.items() if which} or NOTHING


# All files


@dataclass(frozen=True)
class Comparison:
    """Two runs, how they are compared, and what was found.

    Attributes
    ----------
    project
        The workflow.
    old, new
        The runs.
    config
        The configuration of the new run, if the old one is the reference; empty if it is not known.
        Then the new run must be what today's code makes. If it is None, both runs are judged by
        their records.
    main
        The code on the main branch, as in `causes`.
    found
        The verdict on each file.
    """

    project: Project
    old: Run
    new: Run
    config: Mapping | None
    main: Mapping
    found: dict[str, Finding] = field(default_factory=dict)

    def those(self, *verdicts: str) -> dict[str, Finding]:
        """The files with one of these verdicts."""
        return {file: each for file, each in self.found.items() if each.verdict in verdicts}

    @property
    def findings(self) -> dict[str, Finding]:
        """The files that differ or cannot be compared."""
        return self.those("differs", "not comparable")

    @property
    def status(self) -> int:
        """The exit status: 1 if a file differs, else 2 if one, or none at all, can be compared."""
        given = {STATUS[each.verdict] for each in self.found.values()}
        return next((status for status in (1, 2, 0) if status in given), 2)

    def names(self, verdict: str) -> list[str]:
        """The figures, tables and texts with a verdict."""
        return sorted({Path(file).stem for file in self.those(verdict)})

    def lines(self) -> list[str]:
        """What is wrong, by name. Both pictures of a figure have the same line."""
        found = self.findings.items()
        return list(dict.fromkeys(f"{Path(file).stem}: {each}" for file, each in found))

    def printed(self, template: str, **more: Any) -> str:
        """The report as a template prints it, with invisible characters escaped."""
        printing = environment(Path(__file__).parent).overlay(finalize=shown)
        return printing.get_template(template).render(report=self, **more)

    def finding(self, file: str) -> Finding:
        """The verdict on a file: each side is asked by itself first, and then both together."""
        is_data = file.endswith(".nc")
        old, new = (self.side(run, file) for run in (self.old, self.new))
        wrong = {
            kind: [*old.wrong.get(kind, ()), *new.wrong.get(kind, ())]
            for kind in {**old.wrong, **new.wrong}
        }
        unknown = wrong.keys() & {UNREADABLE, UNNAMED} or len(wrong.get(MISSING, ())) == 2
        if unknown or MISSING in wrong:
            return Finding("not comparable" if unknown else "differs", new.wrong, causes=wrong)
        found = [] if old.hash == new.hash else differences(file, old.contents, new.contents)
        # Results are judged by their numbers: a run may have a dataset that was written anew.
        by_bytes = not is_data or (self.config is not None and EDITED in old.wrong)
        if wrong and (found or by_bytes or wrong.keys() != {EDITED}):
            return Finding("differs", new.wrong, found if EDITED in wrong else (), wrong)
        if not found and (not is_data or old.record["parameters"] == new.record["parameters"]):
            return Finding("agrees", new.wrong)
        if is_data and self.config is not None and about(old.contents) != about(new.contents):
            # Descriptions are not among the code that a dataset records.
            described = map(self.project.checkout.joinpath, self.project.described_in)
            new.record["code"] |= contents(described, self.project.checkout)
        main = old.record["code"] if self.config is None else self.main
        why = causes(old.record, new.record, main)
        follows = [Path(each).stem for each in new.record["data"] if each in self.findings]
        drawn_by = {side.record["versions"].get("matplotlib") for side in (old, new)} - {None}
        if follows and not is_data:
            # A text with another title is another text.
            is_text = file.endswith(".md") and old.contents[0] == new.contents[0]
            changed = sentences(old.contents, new.contents) if is_text else []
            return Finding("follows", new.wrong, sentences=changed)
        if (
            file.endswith(PICTURES)
            and len(drawn_by) == 2
            and not [kind for kind in why if kind.startswith("changed")]
        ):
            return Finding("drawn elsewhere", new.wrong)
        if not is_data and self.rounded(file, why):
            return Finding("agrees", new.wrong)
        return Finding("differs", new.wrong, found, {"follows from": follows} if follows else why)

    def side(self, run: Run, file: str) -> Side:
        """A file of one run, asked by itself: is it present, readable, named by a record, what the
        record says, and fresh?
        """
        path = run.folder / file
        is_result = run is self.new and self.config is not None
        try:
            if is_result and path.resolve() == (self.old.folder / file).resolve():
                raise ValueError(f"it is the file of {self.old.label}")
            found = content_of(path)
            record = run.record(file, found)
            stale = run.older(record) + (self.outdated(file, found, record) if is_result else [])
            made = content(path)
        except FileNotFoundError:
            return Side({MISSING: [f"{file} in {run.label}"]})
        except Exception as error:  # Whatever readers raise for a damaged file.
            return Side({UNREADABLE: [f"{file} in {run.label}: {error!r}"]})
        named = file in run.records
        asked = {
            UNNAMED: [] if named else [f"{file} in {run.label}", *run.damaged],
            EDITED: [f"{file} of {run.label}"] if named and record["made"][file] != made else [],
            STALE: stale,
        }
        return Side({kind: each for kind, each in asked.items() if each}, found, made, record)

    def outdated(self, file: str, data: Any, record: Mapping) -> list[str]:
        """What changed in the checkout since a file was made: parameters of a dataset or a text,
        descriptions and code.
        """
        name = Path(file).stem
        config = self.config or {}
        known: Mapping = entries(config)
        variables: Mapping = {}
        if isinstance(data, xr.Dataset):
            entry = known.get(name, {}).items()
            known = {key: value for key, value in config.items() if key in record["parameters"]}
            known |= {key: value for key, value in entry if key not in SHOWN_BY}
            variables = data.variables
        found = [
            f"{line} (config/config.yaml or the Snakefile)"
            for line in changes(record["parameters"], plain(known))
            if record["parameters"] and config
        ]
        told = self.project.describe(name)
        variables = {key: each for key, each in variables.items() if key in told}
        today = {key: attributes(told[key], each.dtype) for key, each in variables.items()}
        found += changes({key: plain(each.attrs) for key, each in variables.items()}, plain(today))
        files = map(self.project.checkout.joinpath, record["code"])
        now = contents((path for path in files if path.is_file()), self.project.checkout)
        return found + [each for each, known in record["code"].items() if now.get(each) != known]

    def rounded(self, file: str, why: Mapping) -> bool:
        """Whether a file differs only because numbers of its dataset, which agree, are rounded
        otherwise: the same code made both files, or today's code makes both again.
        """
        paths = [(run.folder / file).with_suffix(".nc") for run in (self.old, self.new)]
        if not paths[0].is_file() or read(paths[0]).equals(read(paths[1])):
            return False
        if self.config is None:
            return why == NOTHING
        name = Path(file).name
        again = [remade(self.project.make, path, content(path)).get(name) for path in paths]
        return again == [content(path.with_name(name)) for path in paths]


@cache
def remade(make: Callable, path: Path, _made: str) -> dict[str, str]:
    """The hashes of the files that follow from a dataset, made again."""
    with TemporaryDirectory() as folder:
        make(path.stem, read(path), Path(folder))
        return {each.name: content(each) for each in Path(folder).iterdir()}


def compare(
    project: Project,
    old: Run,
    new: Run,
    config: Mapping | None = None,
    names: Collection[str] = (),
) -> Comparison:
    """Compare all files of two runs, or those of the figures and tables named.

    If `config` is given, the old run is the reference, and the new run must be what today's code
    makes with this configuration. If it is empty, the new run has parameters of its own. If it is
    None, both runs are judged by their records.
    """
    main = {} if config is None else code_of_main(project.checkout)
    report = Comparison(project, old, new, config, main)
    for file in files_of(project, (old, new), config or {}):
        if not names or Path(file).stem in names:
            try:
                report.found[file] = report.finding(file)
            except Exception as error:  # Whatever damaged attributes, or drawing again, raise.
                wrong = {UNREADABLE: [f"{file}: {error!r}"]}
                report.found[file] = Finding("not comparable", wrong, causes=wrong)
    return report


def content_of(path: Path) -> Any:
    """A dataset, a picture, or the lines of a text.

    Raises an error if a file is damaged, or is not what its name says. An example is a pointer of
    Git LFS.
    """
    if path.suffix == ".nc":
        return read(path)
    if path.suffix == ".svg":
        return ElementTree.parse(path)
    if path.suffix == ".png":
        with Image.open(path) as picture:
            return picture.verify()
    return path.read_bytes().replace(b"\r\n", b"\n").decode().split("\n")


def sentences(old: Sequence[str], new: Sequence[str]) -> list[tuple[str, str]]:
    """The lines of a text that changed, in pairs. A line is a sentence or a row of a table.

    >>> sentences(["At 82.18.", "So it is."], ["At 83.1.", "New.", "So it is."])
    [('At 82.18.', 'At 83.1.'), ('', 'New.')]
    """
    # Sentences that differ in numbers only belong together.
    before, after = ([re.sub(r"\d[\d.]*", "#", line) for line in side] for side in (old, new))
    pairs = [
        pair
        for _, i, j, k, m in SequenceMatcher(None, before, after, autojunk=False).get_opcodes()
        for pair in zip_longest(old[i:j], new[k:m], fillvalue="")
    ]
    return [(one, other) for one, other in pairs if one != other]


def accept(project: Project, results: Path) -> list[str]:
    """Make results the reference, and return the files that were written or removed.

    Datasets that agree, and their pictures, stay as they are: only the code that gave them again is
    noted. Files that no rule makes any more are removed if git tracks them and the record of the
    reference names them. Raises ValueError if a result is not fresh and as recorded, if the results
    were made with several versions of libraries, or if their code is not committed.
    """
    committed = tree(project.checkout, "HEAD", "--", *project.code)
    if edited := git(
        project.checkout, "status", "--porcelain", "--untracked-files=all", "--", *project.code
    ):
        raise ValueError(f"nothing is accepted, commit first: {edited}")
    new = run_in(results, "the results")
    report = compare(project, run_in(project.top, "the reference"), new, configuration(project))
    for file, found in report.found.items():
        # A file that is missing, and that no record of the results names, is not made any more.
        if found.wrong and (file in new.records or MISSING not in found.wrong):
            why = "; ".join(f"{what}: {', '.join(which)}" for what, which in found.wrong.items())
            raise ValueError(f"nothing is accepted, run snakemake again first: {why}")
    records = [new.records[file] for file in report.found if file in new.records]
    if unknown := {file for record in records for file in record["code"]} - committed.keys():
        raise ValueError(f"nothing is accepted, commit first: git does not know {min(unknown)}")
    made_by = {json.dumps(record["versions"], sort_keys=True) for record in records}
    if len(made_by) != 1:
        raise ValueError(f"nothing is accepted, run from nothing first: {' and '.join(made_by)}")
    taken = [
        file
        for file, found in report.found.items()
        if not found.wrong and found.verdict != "agrees"
    ]
    removed = [
        file
        for file, found in report.found.items()
        if found.wrong
        and file in report.old.records
        and git(project.checkout, "ls-files", str(project.top / file))
    ]
    for file in taken:
        write(project.top / file, (results / file).read_bytes())
    for file in removed:
        (project.top / file).unlink(missing_ok=True)
    accepted = {
        "made": {file: content(project.top / file) for file in report.found if file in new.records},
        "code": contents(map(project.checkout.joinpath, committed), project.checkout),
        "versions": records[0]["versions"],
        "entries": new.record(project.texts[0])["entries"],
    }
    write(project.top / ACCEPTED, f"{json.dumps(accepted, indent=0)}\n".encode())
    return [*taken, *removed]


# The command and the rule


def results_of(path: Path, unpacked: Path) -> Path:
    """The folder of the results of a run: `results` in a folder, or the folder itself, or the same
    in a zip file, as continuous integration delivers it, which is unpacked.

    Raises ValueError if there are none, as in a checkout that was not run, or another error if a
    zip file is damaged.
    """
    if path.is_file():
        shutil.unpack_archive(path, unpacked, "zip")
    top = unpacked if path.is_file() else path
    for folder in (top / "results", top):
        if (folder / "figures").is_dir() and not (folder / ACCEPTED).exists():
            return folder
    raise ValueError(f"{path} has no results of a run")


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
    parser.add_argument("other", type=Path, nargs="?", help="compare this run with the first one")
    paths = [path for path in vars(parser.parse_args(arguments)).values() if path]
    with TemporaryDirectory() as unpacked:
        try:
            folders = [results_of(path, Path(unpacked, str(n))) for n, path in enumerate(paths)]
        except Exception as error:  # Whatever unpacking raises for a damaged file.
            parser.error(f"a run cannot be read: {error}")
        runs = [run_in(folder, str(path)) for folder, path in zip(folders, paths, strict=True)]
        config = None
        if len(runs) == 1:
            runs.insert(0, run_in(project.top, "the reference"))
            # A run in another folder has parameters of its own.
            config = (
                configuration(project)
                if folders[0].resolve() == (project.top / "results").resolve()
                else {}
            )
        beside = paths[-1] if paths[-1].is_dir() else paths[-1].parent
        return written(compare(project, runs[0], runs[1], config), beside / "diff", sys.stdout)


def report_of_run(project: Project, results: Path, config: Mapping, names: Collection[str]) -> int:
    """Compare the results of a run: the rule `diff`.

    Returns the exit status, as `main` does. If it is not 0, Snakemake prints the log at its end.
    """
    old = run_in(project.top, "the reference")
    report = compare(project, old, run_in(results, "the results"), config, names)
    return written(report, results / "diff", sys.stderr if report.status else sys.stdout)


def written(report: Comparison, folder: Path, stream: TextIO) -> int:
    """Print a report, and save it as a text and as a page with the pictures of both sides.

    Returns the exit status.
    """
    pictures = {
        file: [
            base64.b64encode(path.read_bytes()).decode()
            for path in (report.old.folder / file, report.new.folder / file)
            if path.is_file()
        ]
        for file, found in report.found.items()
        if file.endswith(".png") and found.verdict != "agrees"
    }
    page = folder.resolve() / "index.html"
    text = report.printed("diff.txt.j2")
    try:
        write(page, report.printed("diff.html.j2", pictures=pictures).encode())
        write(folder / "report.txt", f"{text}{page}\n".encode())
        print(f"{text}{page}", file=stream)
    except OSError as error:
        print(f"{text}The page cannot be written: {error}", file=stream)
    return report.status
