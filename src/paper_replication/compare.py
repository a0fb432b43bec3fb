"""Compare two runs, and make results the reference.

The reference is a folder `figures` and some texts beside it; a run writes the same files into a
folder of its own. Numbers of datasets agree within the tolerances that the first run declares. All
other files are functions of datasets, and are compared byte for byte. If one of their datasets
differs, this is what is reported; of a text the sentences that changed are listed. Another
processor rounds numbers differently: then a picture, a table or a page of one dataset agrees if
today's code makes the file of the reference again.

Records say what made a file: datasets, code, versions of libraries, and the hash of the file.
A run has a record for each job in its folder `records`. The reference has one for all its files,
`figures/accepted.json`, with the code and the versions that gave them last.

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
from contextlib import suppress
from dataclasses import dataclass, field
from difflib import SequenceMatcher
from functools import partial
from itertools import takewhile, zip_longest
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any, TextIO
from xml.etree import ElementTree

import numpy as np
import xarray as xr
import yaml
from PIL import Image

from paper_replication.datasets import Variable, attributes, plain, read, write
from paper_replication.provenance import CHECKOUT, PACKAGES, content, contents, versions
from paper_replication.templates import TEMPLATES, environment

FOLLOWING = ("claims", "choices")
"""Datasets that are made of all others."""
ACCEPTED = "figures/accepted.json"
PROVENANCE = {"title", "parameters", "code", "versions", "computed_on"}
"""Attributes of a dataset that are causes of a difference, or are not compared."""
PICTURES = (".png", ".svg")
NOTHING: Mapping[str, Sequence[str]] = {
    "cause": ["no parameter, code or version that is recorded has changed"]
}


@dataclass(frozen=True)
class Project:
    """A workflow whose results are compared.

    Attributes
    ----------
    top
        The folder with the reference and the configuration.
    texts
        Files of the reference beside its folder `figures`.
    make
        Writes the files that follow from one dataset into a folder: pictures, tables and pages. It
        takes their name, the dataset, or none for a picture without data, and the folder.
    code
        Folders and files of code, from the top of the repository.
    describe
        Today's descriptions of the variables of a dataset, by its name.
    """

    top: Path
    texts: tuple[str, ...]
    make: Callable[[str, xr.Dataset | None, Path], None]
    code: tuple[str, ...]
    describe: Callable[[str], Mapping[str, Variable]]

    def files(self, *sides: Path) -> list[str]:
        """All files that one of the folders has: datasets first, and `FOLLOWING` last of them."""
        found = {text for text in self.texts if any((side / text).exists() for side in sides)}
        found |= {f"figures/{path.name}" for side in sides for path in side.glob("figures/[!.]*")}
        return sorted(
            found - {ACCEPTED},
            key=lambda file: (file[-3:] != ".nc", Path(file).stem in FOLLOWING, file),
        )

    def configuration(self) -> dict:
        """The configuration of the checkout."""
        return yaml.safe_load((self.top / "config/config.yaml").read_text("utf-8"))


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
    """

    label: str
    folder: Path
    records: Mapping[str, dict]

    def record(self, file: str, data: xr.Dataset | None = None) -> dict[str, Any]:
        """What made a file, as far as it is known. A dataset has its own parameters and code.

        The parameters of a text are the entries of the configuration.
        """
        accepted = self.records.get(ACCEPTED, {})
        known = self.records.get(file, accepted)
        found = {"made": {}, "data": {}, "code": {}, "versions": {}} | known
        found["parameters"] = known.get("entries", {})
        if data is not None:
            found |= {
                key: json.loads(data.attrs.get(key, "{}"))
                for key in ("parameters", "code", "versions")
            }
            # The titles of claims and choices are code.
            found["parameters"] |= {"title": data.attrs["title"]} if found["parameters"] else {}
        return found | accepted

    def older(self, record: Mapping) -> list[str]:
        """The datasets of a file that were made again after it."""
        made = {name: self.record(name)["made"].get(name) for name in record["data"]}
        return [name for name, known in record["data"].items() if made[name] not in (known, None)]

    def edited(self, file: str) -> bool:
        """Whether a file is not what its record names."""
        made = self.record(file)["made"]
        return file in made and made[file] != content(self.folder / file)


def run_in(folder: Path, label: str) -> Run:
    """The run in a folder, with its records. A damaged record is none."""
    records: dict[str, dict] = {}
    for path in [*folder.glob("records/*.json"), *folder.glob(ACCEPTED)]:
        with suppress(ValueError):
            record = json.loads(path.read_text("utf-8"))
            files = [path.relative_to(folder).as_posix(), *record.get("made", {})]
            records |= dict.fromkeys(files, record)
    return Run(label, folder, records)


@dataclass(frozen=True)
class Finding:
    """What is wrong with a file.

    Attributes
    ----------
    differences
        What differs, the furthest first.
    causes
        Why, by the kind of the cause.
    usable
        Whether `accept` may make it the reference.
    """

    differences: Sequence[str]
    causes: Mapping[str, Sequence[str]] = field(default_factory=dict)
    usable: bool = True

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
                f" (tolerance {old[name].tolerance:g})" if "tolerance" in old[name].attrs else ""
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


def git(*arguments: str) -> str:
    """What git answers about the repository; empty without git.

    A hook has variables that name the repository and the index of its commit. They are dropped, as
    git advises for another repository.
    """
    run = partial(subprocess.run, capture_output=True, check=True, text=True)
    try:
        names = run(["git", "rev-parse", "--local-env-vars"]).stdout.split()
        environment = {name: value for name, value in os.environ.items() if name not in names}
        return run(["git", "-C", str(CHECKOUT), *arguments], env=environment).stdout.strip()
    except (OSError, subprocess.CalledProcessError):
        return ""


def tree(commit: str, *paths: str) -> dict[str, str]:
    """The hashes of the files of a commit."""
    listed = git("ls-tree", "-r", commit, *paths)
    return {line.partition("\t")[2]: line.split()[2] for line in listed.splitlines()}


def code_of_main() -> dict[str, str]:
    """The hashes of the files on the main branch where this one left it; empty if no main branch is
    known, as in a shallow checkout.
    """
    bases = (git("merge-base", "HEAD", name) for name in ("origin/HEAD", "origin/main", "main"))
    forks = [*filter(None, bases)]
    return tree(forks[0]) if forks else {}


def causes(before: Mapping, after: Mapping, main: Mapping) -> Mapping[str, Sequence[str]]:
    """What differs between the records of a file, by kind. `main` has the code on the main branch.

    Parameters count if both records have some.
    """
    if not before["code"] or not after["code"]:
        return {"cause": ["not known without a record"]}
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
        The configuration of the new run, if the old one is the reference. Then the new run must be
        what today's code makes. If it is None, both runs are judged by their records.
    main
        The code on the main branch, as in `causes`.
    files
        The files that are compared.
    findings
        Files that differ, are stale, missing or unexpected, with what is wrong.
    following
        Files that were not compared, because one of their datasets differs. A text has its changed
        sentences, the old and the new one.
    drawn_elsewhere
        Pictures that were not compared, because another matplotlib drew them.
    """

    project: Project
    old: Run
    new: Run
    config: Mapping | None
    main: Mapping
    files: Sequence[str]
    findings: dict[str, Finding] = field(default_factory=dict)
    following: dict[str, list[tuple[str, str]]] = field(default_factory=dict)
    drawn_elsewhere: list[str] = field(default_factory=list)

    @property
    def names(self) -> list[str]:
        """The figures, tables and texts that differ."""
        return sorted({Path(file).stem for file in self.findings})

    def lines(self) -> list[str]:
        """What is wrong, by name. Both pictures of a figure have the same line."""
        found = self.findings.items()
        return list(dict.fromkeys(f"{Path(file).stem}: {each}" for file, each in found))

    def printed(self, template: str, **more: Any) -> str:
        """The report as a template prints it."""
        return environment(TEMPLATES).get_template(template).render(report=self, **more)

    def finding(self, file: str) -> Finding | None:
        """What is wrong with a file; None if nothing is, or if it is listed elsewhere."""
        runs = (self.old, self.new)
        for run in runs:
            if not (run.folder / file).is_file():
                return Finding([f"{file} is missing in {run.label}"])
        is_data = file.endswith(".nc")
        same = not is_data and content(self.old.folder / file) == content(self.new.folder / file)
        old: Any = None if same else content_of(self.old, file)
        new: Any = None if same else content_of(self.new, file)
        before = self.old.record(file, old if is_data else None)
        after = self.new.record(file, new if is_data else None)
        found = [] if same else differences(file, old, new)
        by_hand = [f"{file} of {run.label}" for run in runs if run.edited(file)]
        stale = self.old.older(before) + self.new.older(after)
        if self.config is not None:
            stale += outdated(self.project, self.new, file, self.config, new if is_data else None)
        if stale and not (found and by_hand):
            line = f"stale, remove it and run again; changed since: {', '.join(stale)}"
            return Finding([line], usable=False)
        if not found and (same or before["parameters"] == after["parameters"]):
            return None
        if by_hand:
            return Finding(found, {"edited by hand": by_hand}, not self.new.edited(file))
        main = self.main if self.config is not None else before["code"]
        follows = [Path(each).stem for each in after["data"] if each in self.findings]
        if is_data:
            if self.config is not None and about(old) != about(new):
                # Descriptions are not among the code that a dataset records.
                after["code"] = after["code"] | contents(
                    path
                    for name in self.project.code
                    for path in (CHECKOUT / name).rglob("variables.py")
                )
            why = {"follows from": follows} if follows else causes(before, after, main)
            return Finding(found, why)
        drawn_by = {record["versions"].get("matplotlib") for record in (before, after)} - {None}
        if follows:
            # A text with another title is another text.
            self.following[file] = (
                sentences(old, new) if file.endswith(".md") and old[0] == new[0] else []
            )
        elif file.endswith(PICTURES) and len(drawn_by) == 2:
            self.drawn_elsewhere.append(file)
        elif not self.rounded(file, before, after):
            return Finding(found, causes(before, after, main))
        return None

    def rounded(self, file: str, before: Mapping, after: Mapping) -> bool:
        """Whether a file differs only because numbers of its datasets, which agree, are rounded
        otherwise: the same code made both, or today's code makes that of the reference again.
        """
        if self.config is None:
            return causes(before, after, before["code"]) == NOTHING
        path = (self.old.folder / file).with_suffix(".nc")
        with TemporaryDirectory() as folder, suppress(Exception):
            self.project.make(path.stem, read(path) if path.exists() else None, Path(folder))
            return content(Path(folder, Path(file).name)) == content(self.old.folder / file)
        return False


def compare(
    project: Project,
    old: Run,
    new: Run,
    config: Mapping | None = None,
    names: Collection[str] = (),
) -> Comparison:
    """Compare all files of two runs, or those of the figures and tables named.

    If `config` is given, the old run is the reference, and the new run must be what today's code
    makes with this configuration. If not, both runs are judged by their records.
    """
    files = [
        file
        for file in project.files(old.folder, new.folder)
        if not names or Path(file).stem in names
    ]
    main = {} if config is None else code_of_main()
    report = Comparison(project, old, new, config, main, files)
    for file in files:
        try:
            found = report.finding(file)
        except Exception as error:  # Whatever readers raise for a damaged file.
            found = Finding([f"{file} cannot be compared: {error}"], usable=False)
        if found:
            report.findings[file] = found
    return report


def outdated(
    project: Project, run: Run, file: str, config: Mapping, data: xr.Dataset | None
) -> list[str]:
    """What changed in the checkout since a file was made: the parameters of a dataset or a text,
    descriptions and code.
    """
    if file not in run.records:
        return ["it has no record"]
    record = run.record(file, data)
    recorded = record["parameters"]
    wanted = {
        name: entry
        for stage in config.values()
        if isinstance(stage, Mapping)
        for name, entry in stage.items()
        if name != "title"
    }
    if data is not None:
        entry = wanted.get(Path(file).stem, {}).items()
        wanted = {key: value for key, value in config.items() if key in recorded}
        wanted |= {key: value for key, value in entry if key not in ("caption", "table")}
    found = [
        f"{line} (config/config.yaml or the Snakefile)"
        for line in changes(recorded, plain(wanted))
        if recorded
    ]
    variables = {} if data is None else {str(name): data[name] for name in data.variables}
    told = project.describe(Path(file).stem)
    today = {
        name: attributes(told[name], variables[name].dtype) for name in variables if name in told
    }
    found += changes({name: plain(variables[name].attrs) for name in today}, plain(today))
    now = contents(path for path in map(CHECKOUT.joinpath, record["code"]) if path.is_file())
    return found + [each for each, known in record["code"].items() if now.get(each) != known]


def content_of(run: Run, file: str) -> Any:
    """A dataset, a picture, or the lines of a text.

    Raises ValueError if a file is damaged, or is not what its name says. An example is a pointer of
    Git LFS.
    """
    path = run.folder / file
    try:
        if path.suffix == ".nc":
            return read(path)
        if path.suffix == ".svg":
            return ElementTree.parse(path)
        if path.suffix == ".png":
            with Image.open(path) as picture:
                return picture.load()
        return path.read_bytes().replace(b"\r\n", b"\n").decode().split("\n")
    except Exception as error:  # Whatever readers raise for a damaged file.
        raise ValueError(f"in {run.label} {error!r}") from error


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
    noted. Raises ValueError if a result is stale, was edited by hand or cannot be read, or if its
    code is not committed.
    """
    if not git("rev-parse", "HEAD"):
        raise ValueError("nothing is accepted, because there is no git")
    if edited := git("status", "--porcelain", "--", *project.code):
        raise ValueError(f"nothing is accepted, commit first: {edited}")
    new = run_in(results, "the results")
    report = compare(project, run_in(project.top, "the reference"), new, project.configuration())
    if wrong := [file for file, found in report.findings.items() if not found.usable]:
        why = f"{Path(wrong[0]).stem}: {report.findings[wrong[0]]}"
        raise ValueError(f"nothing is accepted, run snakemake again first: {why}")
    before = {file: content(project.top / file) for file in project.files(project.top)}
    for file in report.files:
        if not (results / file).is_file():
            (project.top / file).unlink()
        elif Path(file).stem in report.names or file in {
            *report.following,
            *report.drawn_elsewhere,
        }:
            write(project.top / file, (results / file).read_bytes())
    made = {file: content(project.top / file) for file in project.files(project.top)}
    accepted = {
        "made": made,
        "code": tree("HEAD", "--", *project.code),
        "versions": versions(),
        "entries": new.record(project.texts[0])["parameters"],
    }
    write(project.top / ACCEPTED, f"{json.dumps(accepted, indent=0)}\n".encode())
    return [file for file in report.files if before.get(file) != made.get(file)]


# The command and the rule


def results_of(path: Path, unpacked: Path) -> Path:
    """The folder of the results of a run: `results` in a folder, or the folder itself, or the same
    in a zip file, as continuous integration delivers it, which is unpacked.

    Raises ValueError if there are none, or another error if a zip file is damaged.
    """
    if path.is_file():
        shutil.unpack_archive(path, unpacked, "zip")
        path = unpacked
    for folder in (path / "results", path):
        if (folder / "figures").is_dir():
            return folder
    raise ValueError(f"there is nothing to compare in {path}")


def main(project: Project, arguments: list[str]) -> int:
    """Compare a run with the reference, or two runs: the command `compare.py`.

    Returns the exit status: 1 if something differs.
    """
    parser = argparse.ArgumentParser(
        prog="compare.py",
        description="Compare a run with the reference in git, or two runs with each other.",
        epilog="The exit status is 1 if something differs. The last line is the path of a page.",
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
            config = project.configuration()
        beside = paths[-1] if paths[-1].is_dir() else paths[-1].parent
        return written(compare(project, runs[0], runs[1], config), beside / "diff", sys.stdout)


def report_of_run(project: Project, results: Path, config: Mapping, names: Collection[str]) -> int:
    """Compare the results of a run: the rule `diff`.

    Returns the exit status: 1 if something differs. Snakemake then prints the log, at its end.
    """
    old = run_in(project.top, "the reference")
    report = compare(project, old, run_in(results, "the results"), config, names)
    return written(report, results / "diff", sys.stderr if report.findings else sys.stdout)


def written(report: Comparison, folder: Path, stream: TextIO) -> int:
    """Print a report, and save it as a text and as a page with the pictures of both sides.

    Returns the exit status: 1 if something differs.
    """
    pictures = {
        file: [
            base64.b64encode(path.read_bytes()).decode()
            for path in (report.old.folder / file, report.new.folder / file)
            if path.is_file()
        ]
        for file in [*report.findings, *report.following, *report.drawn_elsewhere]
        if file.endswith(".png")
    }
    page = folder.resolve() / "index.html"
    write(page, report.printed("diff.html.j2", pictures=pictures).encode())
    text = f"{report.printed('diff.txt.j2')}{page}\n"
    write(folder / "report.txt", text.encode())
    print(text, end="", file=stream)
    return 1 if report.findings else 0
