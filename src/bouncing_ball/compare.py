"""Compare results with the reference in git, and make results the reference.

The reference is a folder `figures` and some texts beside it; a run writes the same files into a
folder of its own. Numbers of datasets agree within the tolerances that the reference declares. All
other files are functions of datasets, and are compared byte for byte. If one of their datasets
differs, this is what is reported, and they are only listed as not compared. Another processor
rounds numbers differently: then a picture, a table or a page of one dataset agrees if today's code
makes the files of both sides from the datasets of both sides.

A difference has a cause: parameters, files of code, or versions of libraries. A dataset records its
own. `figures/accepted.json` has the code and the versions that gave the reference last. A file is a
cause only if the results have it neither as accepted nor as on the main branch.
"""

import base64
import json
import os
import shutil
import subprocess
import sys
from collections.abc import Callable, Collection, Mapping
from dataclasses import dataclass, field
from functools import partial
from itertools import zip_longest
from pathlib import Path
from tempfile import TemporaryDirectory
from xml.etree import ElementTree

import jinja2
import numpy as np
import xarray as xr
import yaml
from PIL import Image

from bouncing_ball.datasets import attributes, plain, read, whole
from bouncing_ball.provenance import CHECKOUT, PACKAGES, contents, versions
from bouncing_ball.variables import Variable
from bouncing_ball.variables import described as descriptions

FOLLOWING = ("claims", "choices")
"""Datasets that are made of all others."""
ACCEPTED = "figures/accepted.json"
PROVENANCE = {"parameters", "code", "versions", "computed_on"}
"""Attributes of a dataset that are compared elsewhere, or not at all."""
PICTURES = (".png", ".svg")
TEMPLATE = CHECKOUT / "workflow/templates/diff.html.j2"


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
class Report:
    """What a comparison found.

    Attributes
    ----------
    lines
        A line for each file that differs, is stale, missing or unexpected.
    skipped
        Files that were not compared, because one of their datasets differs.
    drawn_elsewhere
        Pictures that were not compared, because another matplotlib drew them.
    count
        How many files were compared.
    """

    lines: list[str] = field(default_factory=list)
    skipped: list[str] = field(default_factory=list)
    drawn_elsewhere: list[str] = field(default_factory=list)
    count: int = 0

    @property
    def names(self) -> list[str]:
        """The figures, tables and texts that differ."""
        return sorted({line.partition(":")[0] for line in self.lines})

    def text(self) -> str:
        """The report on a terminal; the verdict is its last line."""
        text = [*self.lines]
        if self.skipped:
            text.append(
                f"Not compared, because a dataset differs: {', '.join(sorted(self.skipped))}."
            )
        verdict = f"All {self.count} files agree with the reference."
        if self.lines:
            verdict = f"Differences in {', '.join(self.names)}."
        if self.drawn_elsewhere:
            number = len(self.drawn_elsewhere)
            verdict += f" {number} pictures of another matplotlib were not compared."
        return "\n".join([*text, verdict])


# Datasets


def record(data: xr.Dataset, key: str) -> dict:
    """The parameters, versions or files of code that a dataset records."""
    return json.loads(data.attrs.get(key, "{}"))


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


def differences(old: xr.Dataset, new: xr.Dataset) -> list[str]:
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
        pairs = enumerate(zip_longest(*texts))
        start = next(index for index, (one, other) in pairs if one != other)
        start = max(0, start - 30)
        texts = [text[start : start + 80] for text in texts]
    return " → ".join(texts)


def shown(value: object) -> str:
    """A number with six digits; a text with its invisible characters escaped.

    >>> shown(2 / 3), shown("5\N{NO-BREAK SPACE}%")
    ('0.666667', '5\\\\xa0%')
    """
    if isinstance(value, float | np.floating):
        return f"{value:.6g}"
    return "".join(each if each.isprintable() else ascii(each)[1:-1] for each in str(value))


def stale(new: xr.Dataset, name: str, config: Mapping, descriptions: Mapping[str, Variable]) -> str:
    """Name the parameters, descriptions and files that changed since a result was computed; empty
    if none.
    """
    recorded = record(new, "parameters")
    wanted = {key: value for key, value in config.items() if key in recorded}
    for stage in config.values():
        if isinstance(stage, Mapping):
            wanted |= stage.get(name, {})
    for word in ("title", "caption", "table"):
        wanted.pop(word, None)
    given_by = "config/config.yaml or the Snakefile"
    found = [f"{line} ({given_by})" for line in changes(recorded, plain(wanted))]
    for each, variable in new.variables.items():
        if each in descriptions:
            today = attributes(descriptions[str(each)], variable.dtype)
            found += changes(plain(variable.attrs), plain(today), f"{each}.")
    code = record(new, "code")
    paths = [CHECKOUT / file for file in code if (CHECKOUT / file).is_file()]
    now = contents(paths)
    found += [file for file, content in code.items() if now.get(file) != content]
    return f"stale, remove it and run again; changed since: {', '.join(found)}" if found else ""


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


@dataclass(frozen=True)
class Causes:
    """What can have changed a result: the code and the versions that are known to give the
    reference, as accepted, and the code on the main branch.
    """

    accepted: Mapping
    main: Mapping

    def of(self, parameters: list[str], code: Mapping, made_with: Mapping) -> str:
        """The cause of a difference, from changed parameters, and the code and versions of a
        result.
        """
        new = [file for file, content in code.items() if self.accepted["code"].get(file) != content]
        libraries = {name: made_with.get(name) for name in PACKAGES}
        before = {name: self.accepted["versions"].get(name) for name in PACKAGES}
        since = "changed since the last acceptance"
        causes = {
            "changed parameter": parameters,
            "changed": [file for file in new if self.main and self.main.get(file) != code[file]],
            "other versions": changes(before, libraries),
        }
        if not self.main:
            causes[f"{since} (the main branch is not known here)"] = new
        elif not any(causes.values()):
            # The main branch itself differs from its reference.
            causes = {since: new}
        found = [f"{what}: {', '.join(which)}" for what, which in causes.items() if which]
        return "; ".join(found) or "no parameter, code or version has changed: edited by hand?"


def causes(project: Project) -> Causes:
    """The causes that are known today."""
    path = project.top / ACCEPTED
    accepted = json.loads(path.read_text("utf-8")) if path.is_file() else {}
    return Causes({"code": {}, "versions": {}} | accepted, code_of_main())


# All files


def compare(
    project: Project,
    results: Path,
    config: Mapping,
    names: Collection[str] = (),
    makers: Mapping[str, Collection[str]] | None = None,
) -> Report:
    """Compare all files of results with the reference, or those of the figures and tables named.

    `config` is the configuration of the results. `makers` has the files of code that make a
    picture, a table or a text. The code of a file that is not among them is all code that did not
    compute its dataset.
    """
    files = [
        file
        for file in project.files(project.top, results)
        if not names or Path(file).stem in names
    ]
    if not files or not (results / "figures").is_dir():
        return Report([f"{results}: there is nothing to compare"])
    why = causes(project)
    code = project.today()
    report = Report(count=len(files))
    differ: list[str] = []
    for file in files:
        name = Path(file).stem
        if line := absent(project, results, file):
            report.lines.append(f"{name}: {line}")
            differ += [name] if file.endswith(".nc") else []
        elif file.endswith(".nc"):
            found = dataset_lines(project, results, file, config, why, differ)
            report.lines.extend(f"{name}: {line}" for line in found)
            differ += [name] if found else []
        elif same_bytes(project.top / file, results / file):
            continue
        elif line := unreadable(project, results, file):
            report.lines.append(f"{name}: {line}")
        elif follows(project, file, differ):
            report.skipped.append(file)
        elif file.endswith(PICTURES) and another_matplotlib(project, results, name):
            report.drawn_elsewhere.append(file)
        elif not made_again(project, results, file):
            change = "the picture differs"
            if not file.endswith(PICTURES):
                change = first_change(project.top / file, results / file)
            able = without_models(project, results, name, code)
            if makers and file in makers:
                able = contents(makers[file])
            # Pictures have no titles and captions of the configuration.
            chosen = [] if file.endswith(PICTURES) else given(project, config)
            line = f"{name}: {change}; {why.of(chosen, able, versions())}"
            # Both pictures of a figure have the same line.
            report.lines.extend({line} - {*report.lines})
    return report


def given(project: Project, config: Mapping) -> list[str]:
    """The parameters of a run that are not those of the checkout."""
    return changes(plain(project.configuration()), plain(config))


def absent(project: Project, results: Path, file: str) -> str:
    """What to say of a file that one side does not have; empty if both have it."""
    if not (results / file).is_file():
        return f"{file} is missing in the results"
    if not (project.top / file).is_file():
        return f"{file} is not in the reference; if it is new, accept it"
    return ""


def dataset_lines(
    project: Project, results: Path, file: str, config: Mapping, why: Causes, differ: list[str]
) -> list[str]:
    """Whether a dataset is stale, and where it differs most from the reference, with the cause.

    `FOLLOWING` datasets follow from those that `differ`.
    """
    name = Path(file).stem
    try:
        old = read(project.top / file)
        new = read(results / file)
        about = changes(described(old), described(new))
        found = about or differences(old, new)
        old_code = stale(new, name, config, project.describe(name))
    except Exception as error:  # Whatever readers raise for a damaged file.
        return [f"{file} cannot be compared: {error!r}"]
    parameters = changes(record(old, "parameters"), record(new, "parameters"))
    if old.attrs.get("title") != new.attrs.get("title"):
        parameters += [line for line in given(project, config) if f".{name}.title " in line]
    lines = [old_code] if old_code else []
    if found or parameters:
        code = record(new, "code")
        if about:
            # Titles and descriptions are not among the code that a dataset records.
            about_data = ("config/config.yaml", "variables.py")
            now = project.today().items()
            code |= {file: content for file, content in now if file.endswith(about_data)}
        reason = why.of(parameters, code, record(new, "versions"))
        if name in FOLLOWING and differ:
            reason = f"follows from {', '.join(differ)}"
        lines.append("; ".join([*found[:1], reason]))
    return lines


def without_models(
    project: Project, results: Path, name: str, code: Mapping[str, str]
) -> dict[str, str]:
    """The code without the files that computed the dataset of a picture or table, which agrees."""
    path = results / f"figures/{name}.nc"
    if not (project.top / f"figures/{name}.nc").exists():
        return dict(code)
    computed_by = record(read(path), "code")
    return {file: content for file, content in code.items() if file not in computed_by}


def unreadable(project: Project, results: Path, file: str) -> str:
    """What to say of a picture or a text that is empty or damaged on one side; empty if it is not.

    An example is a pointer of Git LFS that stands in place of its file.
    """
    for side, folder in (("reference", project.top), ("results", results)):
        path = folder / file
        try:
            if path.suffix == ".png":
                with Image.open(path) as picture:
                    picture.load()
            elif path.suffix == ".svg":
                ElementTree.parse(path)
            else:
                path.read_text("utf-8")
        except Exception as error:  # Whatever readers raise for a damaged file.
            return f"{file} of the {side} cannot be compared: {type(error).__name__}: {error}"
    return ""


def same_bytes(first: Path, second: Path) -> bool:
    """Whether two files are equal; line ends of Windows do not count in texts."""
    one = first.read_bytes()
    other = second.read_bytes()
    if first.suffix == ".png":
        return one == other
    return one.replace(b"\r\n", b"\n") == other.replace(b"\r\n", b"\n")


def follows(project: Project, file: str, differ: Collection[str]) -> bool:
    """Whether a file follows from datasets that differ: its own, or for a text all of them."""
    name = Path(file).stem
    if (project.top / f"figures/{name}.nc").exists():
        return name in differ
    return bool(differ) and not file.endswith(PICTURES)


def another_matplotlib(project: Project, results: Path, name: str) -> bool:
    """Whether the pictures of both sides were drawn by different versions of matplotlib.

    A picture that names no version was not drawn by this workflow.
    """
    drawn_by = []
    for side in (project.top, results):
        with Image.open(side / f"figures/{name}.png") as picture:
            drawn_by.append(picture.info.get("Software"))
    return None not in drawn_by and drawn_by[0] != drawn_by[1]


def made_again(project: Project, results: Path, file: str) -> bool:
    """Whether today's code makes a file of both sides from the datasets of both sides."""
    name = Path(file).stem
    with TemporaryDirectory() as folder:
        for side in (project.top, results):
            path = side / f"figures/{name}.nc"
            try:
                project.make(name, read(path) if path.exists() else None, Path(folder))
                agrees = same_bytes(Path(folder, Path(file).name), side / file)
            except Exception:  # Whatever a drawing does not find in a dataset.
                agrees = False
            if not agrees:
                return False
    return True


def first_change(old: Path, new: Path) -> str:
    """The first line of a text that differs. After the line feed of the last line, an empty line
    follows.
    """
    contents_of = (path.read_bytes().replace(b"\r\n", b"\n").decode() for path in (old, new))
    texts = [content.split("\n") for content in contents_of]
    lines = enumerate(zip_longest(*texts, fillvalue="the end of the text"), 1)
    number, pair = next((number, pair) for number, pair in lines if pair[0] != pair[1])
    return f"{new.name}, line {number}: {excerpt(*(line or 'an empty line' for line in pair))}"


def write_page(project: Project, results: Path, report: Report) -> Path:
    """Write the page of a comparison, with the pictures of both sides that differ."""
    page = results / "diff/index.html"
    page.unlink(missing_ok=True)
    pictures = {}
    for path in sorted((results / "figures").glob("*.png")):
        sides = [project.top / "figures" / path.name, path]
        contents_of = [side.read_bytes() for side in sides if side.is_file()]
        if len(contents_of) == 2 and contents_of[0] != contents_of[1]:
            pictures[path.stem] = [base64.b64encode(each).decode() for each in contents_of]
    template = jinja2.Template(TEMPLATE.read_text("utf-8"), autoescape=True)
    text = template.render(lines=report.text().splitlines(), pictures=pictures)
    with whole(page) as unfinished:
        unfinished.write_text(text, "utf-8")
    return page.resolve()


def accept(project: Project, results: Path) -> list[str]:
    """Make results the reference, and return the files that were written or removed.

    Datasets that agree, and their pictures, stay as they are: only the code that gave them again is
    noted. Raises ValueError if a result is stale or cannot be read, or if its code is not
    committed.
    """
    if not git("rev-parse", "HEAD"):
        raise ValueError("nothing is accepted, because there is no git")
    edited = git("status", "--porcelain", "--", *project.code)
    if edited:
        raise ValueError(f"nothing is accepted, commit first: {edited}")
    report = compare(project, results, project.configuration())
    for line in report.lines:
        if ": stale" in line or "cannot be compared" in line:
            raise ValueError(f"nothing is accepted, run snakemake again first: {line}")
    written = []
    for file in project.files(project.top, results):
        source = results / file
        target = project.top / file
        if not source.is_file():
            target.unlink()
        elif target.is_file() and same_bytes(source, target):
            continue
        elif file.endswith((".nc", *PICTURES)) and not (
            source.stem in report.names or file in report.drawn_elsewhere
        ):
            continue
        else:
            with whole(target) as unfinished:
                shutil.copyfile(source, unfinished)
        written.append(file)
    accepted = {"code": project.today(), "versions": versions()}
    (project.top / ACCEPTED).write_text(f"{json.dumps(accepted, indent=0)}\n", "utf-8")
    return written


def main(project: Project, arguments: list[str]) -> int:
    """Compare a folder of results, and print the report: the command `compare.py FOLDER`."""
    if len(arguments) != 1:
        print("usage: python workflow/scripts/compare.py FOLDER")
        return 2
    report = compare(project, Path(arguments[0]), project.configuration())
    print(report.text())
    if (Path(arguments[0]) / "figures").is_dir():
        print(write_page(project, Path(arguments[0]), report))
    return 1 if report.lines else 0


def report_of_run(
    project: Project,
    results: Path,
    config: Mapping,
    names: Collection[str],
    makers: Mapping[str, Collection[str]],
) -> int:
    """Compare the results of a run, and save the report as text and as a page: the rule `diff`.

    Returns the exit status: 1 if something differs. Snakemake then prints the log, at its end.
    """
    report = compare(project, results, config, names, makers)
    text = f"{report.text()}\n{write_page(project, results, report)}\n"
    (results / "diff/report.txt").write_text(text, "utf-8")
    print(text, end="", file=sys.stderr if report.lines else sys.stdout)
    return 1 if report.lines else 0
