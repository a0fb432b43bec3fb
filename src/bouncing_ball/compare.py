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
from dataclasses import dataclass, field
from difflib import SequenceMatcher
from functools import partial
from io import BytesIO
from itertools import takewhile, zip_longest
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any
from xml.etree import ElementTree

import jinja2
import numpy as np
import xarray as xr
import yaml
from PIL import Image

from bouncing_ball.datasets import attributes, plain, read, whole
from bouncing_ball.provenance import CHECKOUT, PACKAGES, content, contents, versions
from bouncing_ball.variables import Variable
from bouncing_ball.variables import described as descriptions

FOLLOWING = ("claims", "choices")
"""Datasets that are made of all others."""
ACCEPTED = "figures/accepted.json"
PROVENANCE = {"title", "parameters", "code", "versions", "computed_on"}
"""Attributes of a dataset that are causes of a difference, or are not compared."""
INSIDE = ("parameters", "code", "versions")
"""What a dataset records of itself."""
PICTURES = (".png", ".svg")
TEMPLATE = CHECKOUT / "workflow/templates/diff.html.j2"
SENTENCES = 10
"""Changed sentences of a text that are printed; the page of a comparison shows all."""


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
    describe: Callable[[str], Mapping[str, Variable]] = descriptions

    def files(self, *sides: Path) -> list[str]:
        """All files that one of the folders has: datasets first, and `FOLLOWING` last of them."""
        found = {text for text in self.texts if any((side / text).exists() for side in sides)}
        for side in sides:
            found.update(f"figures/{path.name}" for path in side.glob("figures/[!.]*"))
        found.discard(ACCEPTED)
        return sorted(
            found, key=lambda file: (file[-3:] != ".nc", Path(file).stem in FOLLOWING, file)
        )

    def today(self) -> dict[str, str]:
        """The files of code, each with the hash of its content."""
        kinds = (".py", ".j2", ".csv", ".yaml", ".js", ".css", ".json")
        paths = [CHECKOUT / name for name in self.code]
        paths += [each for path in paths for each in path.rglob("*.*")]
        return contents(sorted(path for path in paths if path.suffix in kinds))

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
            found |= {key: json.loads(data.attrs.get(key, "{}")) for key in INSIDE}
        if data is not None and found["parameters"]:
            found["parameters"] |= {"title": data.attrs.get("title")}
        return found | accepted

    def edited(self, file: str) -> bool:
        """Whether a file is not what its record names."""
        made = self.record(file)["made"]
        return file in made and made[file] != content(self.folder / file)


def run_in(folder: Path, label: str) -> Run:
    """The run in a folder, with its records."""
    records: dict[str, dict] = {}
    for path in [*folder.glob("records/*.json"), *folder.glob(ACCEPTED)]:
        try:
            record = json.loads(path.read_text("utf-8"))
        except ValueError as error:
            record = {"damaged": repr(error)}
        name = path.relative_to(folder).as_posix()
        records |= dict.fromkeys([name, *record.get("made", {})], record)
    return Run(label, folder, records)


@dataclass(frozen=True)
class Finding:
    """A figure, a table or a text that differs.

    Attributes
    ----------
    name
        The name of its files.
    differences
        What differs, the furthest first.
    causes
        Why, by the kind of the cause.
    usable
        Whether `accept` may make it the reference.
    """

    name: str
    differences: Sequence[str]
    causes: Mapping[str, Sequence[str]] = field(default_factory=dict)
    usable: bool = True

    def __str__(self) -> str:
        causes = [f"{what}: {', '.join(which)}" for what, which in self.causes.items()]
        return f"{self.name}: {'; '.join([*self.differences[:1], *causes])}"


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


def described(data: xr.Dataset) -> dict:
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
        return changes(described(old), described(new)) or values_that_differ(old, new)
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
    scale = abs(old[given.get("tolerance_scale", name)].values)
    if "tolerance_scale" not in given:
        scale = np.maximum(scale, given["floor"])
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
        answer = run(["git", "-C", str(CHECKOUT), *arguments], env=environment)
    except (OSError, subprocess.CalledProcessError):
        return ""
    return answer.stdout.strip()


def code_of_main() -> dict[str, str]:
    """The hashes of the files on the main branch where this one left it; empty if no main branch is
    known, as in a shallow checkout.
    """
    branches = ("origin/HEAD", "origin/main", "main")
    forks = filter(None, (git("merge-base", "HEAD", branch) for branch in branches))
    fork = next(forks, "")
    tree = git("ls-tree", "-r", fork).splitlines() if fork else []
    return {line.partition("\t")[2]: line.split()[2] for line in tree}


def causes(before: Mapping, after: Mapping, main: Mapping | None) -> dict[str, Sequence[str]]:
    """What differs between the records of a file, by kind.

    `main` has the code on the main branch; it is None if two runs are compared.
    """
    if not before["code"] or not after["code"]:
        return {"cause": ["not known without a record"]}
    code = [file for file, known in after["code"].items() if before["code"].get(file) != known]
    old, new = ({name: each["versions"].get(name) for name in PACKAGES} for each in (before, after))
    known = before["parameters"] and after["parameters"]
    found: dict[str, Sequence[str]] = {
        "changed parameter": changes(before["parameters"], after["parameters"]) if known else [],
        "changed": code,
        "other versions": changes(old, new),
    }
    since = "changed since the last acceptance"
    if main:
        found["changed"] = [file for file in code if main.get(file) != after["code"][file]]
        # The main branch itself may differ from its reference.
        found[since] = [] if any(found.values()) else code
    elif main is not None:
        found[f"{since} (the main branch is not known here)"] = found.pop("changed")
    return {what: which for what, which in found.items() if which}


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
        Files that differ, are stale, missing or unexpected.
    datasets
        Names of the datasets among them.
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
    main: Mapping | None
    files: Sequence[str]
    findings: list[Finding] = field(default_factory=list)
    datasets: list[str] = field(default_factory=list)
    following: dict[str, list[tuple[str, str]]] = field(default_factory=dict)
    drawn_elsewhere: list[str] = field(default_factory=list)

    @property
    def names(self) -> list[str]:
        """The figures, tables and texts that differ."""
        return sorted({finding.name for finding in self.findings})

    def verdict(self) -> str:
        """The last line of the report."""
        found = f"All {len(self.files)} files agree with {self.old.label}."
        if self.findings:
            found = f"Differences in {', '.join(self.names)}."
        if self.drawn_elsewhere:
            number = len(self.drawn_elsewhere)
            found += f" {number} pictures of another matplotlib were not compared."
        return found

    def text(self) -> str:
        """The report on a terminal."""
        lines = [*map(str, self.findings)]
        for file, pairs in self.following.items():
            printed = [f"  − {old}\n  + {new}" for old, new in pairs[:SENTENCES]]
            lines += [f"{file}, changed sentences: {len(pairs)}", *printed] if pairs else []
        others = sorted(file for file, pairs in self.following.items() if not pairs)
        if others:
            lines.append(f"Not compared, because a dataset differs: {', '.join(others)}.")
        return "\n".join([*lines, self.verdict()])

    def finding(self, file: str) -> Finding | None:
        """What is wrong with a file; None if nothing is, or if it is listed elsewhere."""
        name = Path(file).stem
        runs = (self.old, self.new)
        for run in runs:
            if not (run.folder / file).is_file():
                return Finding(name, [f"{file} is missing in {run.label}"])
        is_data = file.endswith(".nc")
        same = not is_data and same_bytes(self.old.folder / file, self.new.folder / file)
        old: Any = None if same else content_of(self.old, file)
        new: Any = None if same else content_of(self.new, file)
        before = self.old.record(file, old if is_data else None)
        after = self.new.record(file, new if is_data else None)
        found = [] if same else differences(file, old, new)
        by_hand = [f"{file} of {run.label}" for run in runs if run.edited(file)]
        follows = [Path(each).stem for each in after["data"] if Path(each).stem in self.datasets]
        stale = older(self.old, before) + older(self.new, after)
        if self.config is not None:
            stale += outdated(self.project, self.new, file, self.config, new if is_data else None)
        if stale and not (found and by_hand):
            line = f"stale, remove it and run again; changed since: {', '.join(stale)}"
            return Finding(name, [line], usable=False)
        if not found and (same or before["parameters"] == after["parameters"]):
            return None
        if by_hand:
            return Finding(name, found, {"edited by hand": by_hand}, not self.new.edited(file))
        if is_data and follows:
            return Finding(name, found, {"follows from": follows})
        if follows:
            self.following[file] = sentences(old, new) if file.endswith(".md") else []
            return None
        if file.endswith(PICTURES) and another_matplotlib(before, after):
            self.drawn_elsewhere.append(file)
            return None
        if not is_data and self.rounded(file, before, after):
            return None
        if is_data and self.config is not None and described(old) != described(new):
            # Descriptions are not among the code that a dataset records.
            today = self.project.today().items()
            described_by = {each: known for each, known in today if each.endswith("variables.py")}
            after["code"] = after["code"] | described_by
        nothing = {"cause": ["no parameter, code or version that is recorded has changed"]}
        return Finding(name, found, causes(before, after, self.main) or nothing)

    def rounded(self, file: str, before: Mapping, after: Mapping) -> bool:
        """Whether a file differs only because numbers of its datasets, which agree, are rounded
        otherwise: the same code made both, or today's code makes that of the reference again.
        """
        if self.config is None:
            return not causes(before, after, None)
        path = (self.old.folder / file).with_suffix(".nc")
        with TemporaryDirectory() as folder:
            try:
                data = read(path) if path.exists() else None
                self.project.make(path.stem, data, Path(folder))
                return same_bytes(Path(folder, Path(file).name), self.old.folder / file)
            except Exception:  # Whatever a drawing does not find in a dataset.
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
    files = project.files(old.folder, new.folder) if (new.folder / "figures").is_dir() else []
    files = [file for file in files if not names or Path(file).stem in names]
    main = None if config is None else code_of_main()
    report = Comparison(project, old, new, config, main, files)
    if not files:
        report.findings.append(Finding(str(new.folder), ["there is nothing to compare"]))
    for run in (old, new):
        for name, record in run.records.items():
            if "damaged" in record:
                line = f"cannot be read in {run.label}: {record['damaged']}"
                report.findings.append(Finding(name, [line], usable=False))
    for file in files:
        try:
            found = report.finding(file)
        except Exception as error:  # Whatever readers raise for a damaged file.
            line = f"{file} cannot be compared: {error}"
            found = Finding(Path(file).stem, [line], usable=False)
        # Both pictures of a figure have the same line.
        if found and found not in report.findings:
            report.findings.append(found)
        if found and file.endswith(".nc"):
            report.datasets.append(found.name)
    return report


def older(run: Run, record: Mapping) -> list[str]:
    """The datasets of a file that were made again after it."""
    made = {name: run.record(name)["made"].get(name) for name in record["data"]}
    return [name for name, known in record["data"].items() if made[name] not in (known, None)]


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
    stages = [stage for stage in config.values() if isinstance(stage, Mapping)]
    wanted = {name: entry for stage in stages for name, entry in stage.items() if name != "title"}
    if data is not None:
        entry = wanted.get(Path(file).stem, {}).items()
        wanted = {key: value for key, value in config.items() if key in recorded}
        wanted |= {key: value for key, value in entry if key not in ("caption", "table")}
    given_by = "config/config.yaml or the Snakefile"
    found = [f"{line} ({given_by})" for line in changes(recorded, plain(wanted)) if recorded]
    descriptions = project.describe(Path(file).stem)
    for name, variable in {} if data is None else data.variables.items():
        if name in descriptions:
            today = attributes(descriptions[str(name)], variable.dtype)
            found += changes(plain(variable.attrs), plain(today), f"{name}.")
    now = contents(path for path in map(CHECKOUT.joinpath, record["code"]) if path.is_file())
    return found + [each for each, known in record["code"].items() if now.get(each) != known]


def another_matplotlib(before: Mapping, after: Mapping) -> bool:
    """Whether different versions of matplotlib drew the pictures, as their runs record."""
    drawn_by = [record["versions"].get("matplotlib") for record in (before, after)]
    return None not in drawn_by and drawn_by[0] != drawn_by[1]


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
        content = path.read_bytes()
        if path.suffix == ".png":
            return Image.open(BytesIO(content)).load()
        return content.replace(b"\r\n", b"\n").decode().split("\n")
    except Exception as error:  # Whatever readers raise for a damaged file.
        raise ValueError(f"in {run.label} {error!r}") from error


def same_bytes(first: Path, second: Path) -> bool:
    """Whether two files are equal; line ends of Windows do not count in texts."""
    one = first.read_bytes()
    other = second.read_bytes()
    if first.suffix == ".png":
        return one == other
    return one.replace(b"\r\n", b"\n") == other.replace(b"\r\n", b"\n")


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


def write_page(report: Comparison, page: Path) -> Path:
    """Write the page of a comparison, with the pictures of both sides that differ."""
    page.unlink(missing_ok=True)
    pictures = {}
    for path in sorted(report.new.folder.glob("figures/*.png")):
        sides = (run.folder / "figures" / path.name for run in (report.old, report.new))
        found = [base64.b64encode(side.read_bytes()).decode() for side in sides if side.is_file()]
        if len({*found}) == 2:
            pictures[path.stem] = found
    template = jinja2.Template(TEMPLATE.read_text("utf-8"), autoescape=True)
    with whole(page) as unfinished:
        unfinished.write_text(template.render(report=report, pictures=pictures), "utf-8")
    return page.resolve()


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
    reference = run_in(project.top, "the reference")
    new = run_in(results, "the results")
    report = compare(project, reference, new, project.configuration())
    for finding in report.findings:
        if not finding.usable:
            raise ValueError(f"nothing is accepted, run snakemake again first: {finding}")
    before = {file: content(project.top / file) for file in project.files(project.top)}
    for file in report.files:
        if not (results / file).is_file():
            (project.top / file).unlink()
        elif Path(file).stem in report.names or file in {
            *report.following,
            *report.drawn_elsewhere,
        }:
            with whole(project.top / file) as unfinished:
                unfinished.write_bytes((results / file).read_bytes())
    made = {file: content(project.top / file) for file in project.files(project.top)}
    entries = new.record(project.texts[0]).get("entries", {})
    accepted = {"made": made, "code": project.today(), "versions": versions(), "entries": entries}
    with whole(project.top / ACCEPTED) as unfinished:
        unfinished.write_text(f"{json.dumps(accepted, indent=0, ensure_ascii=False)}\n", "utf-8")
    return [file for file in report.files if before.get(file) != made.get(file)]


# The command and the rule


def results_of(path: Path, unpacked: Path) -> Path:
    """The folder of the results of a run: a folder itself, `results` in it, or the same in a zip
    file, as continuous integration delivers it, which is unpacked.
    """
    base = path
    if path.is_file():
        shutil.unpack_archive(path, unpacked, "zip")
        base = unpacked
    return base if (base / "figures").is_dir() else base / "results"


def main(project: Project, arguments: list[str]) -> int:
    """Compare a run with the reference, or two runs: the command `compare.py`.

    Returns the exit status: 1 if something differs.
    """
    parser = argparse.ArgumentParser(
        prog="compare.py",
        description="Compare a run with the reference in git, or two runs with each other.",
        epilog="The exit status is 1 if something differs. The last line is the path of a page.",
    )
    about = "a folder with results, or a zip file of it, as continuous integration delivers it"
    parser.add_argument("run", type=Path, help=about)
    parser.add_argument("other", type=Path, nargs="?", help="compare this run with the first one")
    given = parser.parse_args(arguments)
    paths = [path for path in (given.run, given.other) if path]
    page = (paths[-1] if paths[-1].is_dir() else paths[-1].parent) / "diff/index.html"
    config = None
    with TemporaryDirectory() as unpacked:
        try:
            folders = [results_of(path, Path(unpacked, str(n))) for n, path in enumerate(paths)]
        except Exception as error:  # Whatever unpacking raises for a damaged file.
            parser.error(f"a run cannot be read: {error}")
        runs = [run_in(folder, str(path)) for folder, path in zip(folders, paths, strict=True)]
        if given.other is None:
            runs = [run_in(project.top, "the reference"), run_in(folders[0], "the results")]
            config = project.configuration()
        report = compare(project, runs[0], runs[1], config)
        print(report.text())
        if report.files:
            print(write_page(report, page))
    return 1 if report.findings else 0


def report_of_run(project: Project, results: Path, config: Mapping, names: Collection[str]) -> int:
    """Compare the results of a run, and save the report as text and as a page: the rule `diff`.

    Returns the exit status: 1 if something differs. Snakemake then prints the log, at its end.
    """
    runs = (run_in(project.top, "the reference"), run_in(results, "the results"))
    report = compare(project, *runs, config, names)
    text = f"{report.text()}\n{write_page(report, results / 'diff/index.html')}\n"
    (results / "diff/report.txt").write_text(text, "utf-8")
    print(text, end="", file=sys.stderr if report.findings else sys.stdout)
    return 1 if report.findings else 0
