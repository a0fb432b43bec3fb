"""The comparison of results with the reference, and how results become the reference.

The reference is kept in git: the folder `figures` with datasets, pictures and tables, and the texts
`paper.md` and `supplement.md`. A run writes the same files into a folder of its own, `results`.
Three comparisons are made, of which `differences` says what is different:

1. Each dataset of the results with that of the reference. A result that records other parameters
   than those of the configuration, or other code than today's, is stale, whatever else it says.
   Commit, code and versions of the reference are shown and not judged.
2. Pictures, tables and texts are functions of datasets. Today's code makes them again from the
   datasets of the *reference*, and they must equal the files of the reference. The datasets being
   the same, there is no rounding to forgive.
3. Made from the datasets of the *results*, they must equal the files of the results in the same
   way. Otherwise a picture is older than its dataset, or was edited.
"""

import re
import shutil
import tempfile
from collections.abc import Callable, Collection, Iterator, Mapping
from dataclasses import dataclass, replace
from pathlib import Path

import jinja2
import matplotlib
import netCDF4
import xarray as xr
from matplotlib.figure import Figure

from bouncing_ball import datasets, drawing
from bouncing_ball.datasets import Datasets
from bouncing_ball.differences import (
    KINDS,
    Finding,
    changes,
    dataset_differences,
    file_difference,
    record,
    same_bits,
)

Code = tuple[str | Path, ...]
"""Files of code, templates and numbers that a product is made by."""


# Files, and the datasets that they follow from


@dataclass(frozen=True)
class Product:
    """Files that follow from the datasets `needs`; `make` writes them into a folder by `code`."""

    files: tuple[str, ...]
    needs: tuple[str, ...]
    make: Callable[[Datasets, Path], None]
    code: Code

    @property
    def artifact(self) -> str:
        """The name of the figure, table or text."""
        return Path(self.files[0]).stem


def picture(
    name: str, needs: tuple[str, ...], draw: Callable[[Datasets], Figure], code: Code
) -> Product:
    """A figure as SVG and as PNG.

    The SVG comes first, because a difference of its lines tells more than one of pixels.
    """
    files = (f"figures/{name}.svg", f"figures/{name}.png")

    def make(data: Datasets, folder: Path) -> None:
        svg, png = (folder / file for file in files)
        drawing.save_picture(draw(data), png, svg, datasets.commit())

    return Product(files, needs, make, code)


def text(
    file: str, needs: tuple[str, ...], write: Callable[[Datasets], str], code: Code = ()
) -> Product:
    """A file of text."""

    def make(data: Datasets, folder: Path) -> None:
        (folder / file).write_text(write(data), encoding="utf-8", newline="\n")

    return Product((file,), needs, make, code)


def table(
    file: str,
    rows: Callable[[xr.Dataset], list[list[str]]],
    write: Callable[[list[list[str]]], str],
    code: Code,
) -> Product:
    """A table of the dataset with the name of its file."""
    name = Path(file).stem
    return text(f"figures/{file}", (name,), lambda data: write(rows(data[name])), code)


def needed(products: Collection[Product]) -> list[str]:
    """The datasets that some products follow from."""
    return list(dict.fromkeys(name for product in products for name in product.needs))


def following(products: Collection[Product]) -> set[str]:
    """The datasets that are products: they follow from other datasets."""
    return {Path(file).stem for each in products for file in each.files if file.endswith(".nc")}


# Causes


def cause(files: Collection[str | Path], commit: str, reference: Path) -> str:
    """The changed files, as far as git knows, among those that a result is made from.

    First what is not committed, then what this branch changed against the main one, in the code and
    in the file of the reference itself; only if there is none of these, what changed in the code
    since `commit`, that of the reference.
    """
    if not files:
        return "changes of the code are unknown"
    code = [str(Path(file).resolve()) for file in files]
    paths = [*code, str(reference.resolve())]
    folder = Path(code[0]).parent
    if git(folder, "rev-parse", "HEAD") is None:
        return "changes of the code are unknown without git"
    edited = changed_files(folder, paths, "HEAD") or []
    created = git(folder, "ls-files", "--others", "--full-name", "--", *paths) or ""
    uncommitted = sorted({*edited, *created.splitlines()})
    changed = [f"{name} (not committed)" for name in uncommitted]
    main = "origin/main" if git(folder, "rev-parse", "--verify", "origin/main") else "main"
    fork = git(folder, "merge-base", "HEAD", main)
    branch = changed_files(folder, paths, fork, "HEAD") if fork else None
    changed += [f"{name} (on this branch)" for name in branch or [] if name not in uncommitted]
    if changed:
        return f"changed: {', '.join(changed)}"
    since = changed_files(folder, code, commit[:40], "HEAD")
    if since is None:
        return "changes of the code are unknown: git does not know the commit of the reference"
    if since:
        return f"also changed since the reference was made: {', '.join(since)}"
    return "no file that it is made from has changed"


def changed_files(folder: Path, paths: list[str], *commits: str) -> list[str] | None:
    """Files that differ between two commits, or one and the checkout; none if git fails."""
    revisions = [*commits, "--", *paths]
    names = git(folder, "diff", "--name-only", *revisions)
    return None if names is None else names.splitlines()


def git(folder: Path, *arguments: str) -> str | None:
    """The answer of git in a folder; none if there is no git or it refuses."""
    answer = datasets.git(folder, *arguments)
    return answer.stdout.strip() if answer and answer.returncode == 0 else None


# The comparison


@dataclass(frozen=True)
class Report:
    """What was found, the most telling first, and what else a reader should know.

    `consequences` are files of the results that differ from those of the reference because their
    datasets do; they are shown and not counted. `provenance` has a line for each dataset of the
    reference, and `notes` say what was not compared.
    """

    findings: list[Finding]
    consequences: list[Finding]
    provenance: list[str]
    notes: list[str]
    files: int

    @property
    def lines(self) -> list[str]:
        """The report on a terminal: the most telling finding of each artifact, then the verdict."""
        first: dict[str, str] = {}
        for finding in self.findings:
            first.setdefault(finding.artifact, finding.line)
        verdict = f"All {self.files} files agree with the reference."
        if first:
            verdict = f"Differences: {len(self.findings)}, in {', '.join(sorted(first))}."
        return [*first.values(), " ".join([verdict, *self.notes])]


@dataclass(frozen=True)
class Side:
    """The folder of the results or of the reference, with the datasets that could be read."""

    name: str
    folder: Path
    data: dict[str, xr.Dataset]

    def other_matplotlib(self, names: Collection[str] = ()) -> set[str]:
        """Versions of matplotlib that made all or some of this side, and are not that of today."""
        made = [self.data[name] for name in names or self.data]
        found = {str(record(data, "versions").get("matplotlib")) for data in made}
        return found - {matplotlib.__version__}


def compare(
    results: str | Path,
    reference: str | Path,
    products: Collection[Product],
    artifacts: Mapping[str, Mapping],
    names: Collection[str] = (),
) -> Report:
    """Compare the results in a folder with the reference: all, or those with the names given.

    `products` are all files that follow from datasets; these and their datasets are compared.
    `artifacts` has for each dataset the "parameters" of the configuration and the files of "code"
    that compute it; "settings" are parameters that count where a result records them. Without
    parameters and code it is unknown whether a result is stale, and why it differs. The cause of
    differences is stated once for each artifact. Raises ValueError if the results are the reference
    itself, or for a name that is not compared.
    """
    compared, made = chosen(products, names)
    files = [f"figures/{name}.nc" for name in compared]
    files += [file for product in made for file in product.files if file not in files]
    folders = Path(results), Path(reference)
    refuse_links(*folders, files)
    new, old = (
        Side(name, folder, read_all(folder, [*compared, *needed(made)] or needed(products)))
        for name, folder in zip(("results", "reference"), folders, strict=True)
    )
    whole = len(made) == len(products)
    findings = [*file_findings(new, files, whole), *file_findings(old, files, whole)]
    for name in compared:
        if name in new.data:
            artifact = artifacts.get(name, {})
            findings += dataset_findings(name, new.data[name], old.data.get(name), artifact)
    findings = [*derived(findings, set(needed(products)) - following(products))]
    with tempfile.TemporaryDirectory() as scratch:
        for side in (new, old):
            (Path(scratch) / side.name / "figures").mkdir(parents=True)
        for product in made:
            findings += product_findings(product, new, old, Path(scratch))
    findings.sort(key=lambda each: each.rank)
    stated = {(each.artifact, each.cause): each for each in reversed(findings)}
    findings = [
        each if stated[each.artifact, each.cause] is each else replace(each, cause="")
        for each in findings
    ]
    red = {finding.artifact for finding in findings}
    return Report(
        findings,
        [
            finding
            for product in made
            if red.intersection(product.needs)
            for finding in consequences(product, new, old)
        ],
        [provenance(name, old.data[name]) for name in compared if name in old.data],
        notes(new, old, artifacts),
        len(files),
    )


def derived(findings: list[Finding], studies: Collection[str]) -> Iterator[Finding]:
    """The findings of datasets, where those that follow from other datasets have their cause.

    `studies` are the datasets that are computed from the models.
    """
    reasons = {each.artifact: each.cause for each in findings if each.artifact in studies}
    for each in findings:
        if each.artifact not in studies and each.cause and reasons:
            first, why = next(iter(reasons.items()))
            yield replace(each, cause=f"follows from {first}: {why}" if why else each.cause)
        else:
            yield each


def chosen(
    products: Collection[Product], names: Collection[str]
) -> tuple[list[str], list[Product]]:
    """The datasets and products to compare: those named, and those that need no other datasets.

    Raises ValueError for a name that is not compared, so that nothing is not taken for agreement.
    """
    known = {*needed(products), *(product.artifact for product in products)}
    unknown = sorted(set(names) - known)
    if unknown:
        allowed = f"allowed are {', '.join(sorted(known))}"
        raise ValueError(f"{', '.join(unknown)}: no file of that name is compared; {allowed}")
    if not names:
        return needed(products), [*products]
    made = [
        product
        for product in products
        if product.artifact in names or (product.needs and set(product.needs) <= set(names))
    ]
    return [name for name in needed(products) if name in names], made


def refuse_links(results: Path, reference: Path, files: Collection[str]) -> None:
    """Refuse results that are the reference, or lie in it, also by links."""
    inside = results.resolve().is_relative_to((reference / "figures").resolve())
    pairs = [(results / file, reference / file) for file in ["", "figures", *files]]
    same = [
        pair for pair in pairs if all(path.exists() for path in pair) and pair[0].samefile(pair[1])
    ]
    if inside or same:
        path = same[0][0] if same else results
        raise ValueError(f"{path} is a part of the reference: results must be files of their own")


def read_all(folder: Path, names: Collection[str]) -> dict[str, xr.Dataset]:
    """The datasets of a folder that can be read, without groups that nobody sees."""
    data = {}
    for name in dict.fromkeys(names):
        path = folder / "figures" / f"{name}.nc"
        try:
            with netCDF4.Dataset(path) as file:
                hidden = list(file.groups)
            if not hidden:
                data[name] = datasets.read(path)
        except Exception:  # Whatever readers of damaged files raise; `file_findings` tells.
            continue
    return data


def file_findings(side: Side, files: Collection[str], whole: bool) -> Iterator[Finding]:
    """Files of one side that are missing, unreadable or, in a `whole` comparison, unexpected."""
    folder = side.folder / "figures"
    present = sorted(folder.iterdir()) if whole and folder.is_dir() else []
    texts = {
        file: f"figures/{path.name} of the {side.name} is made by no rule"
        for path in present
        if (file := f"figures/{path.name}") not in files and not path.name.startswith(".")
    }
    for file in files:
        if not (side.folder / file).is_file():
            texts[file] = f"{file} is missing in the {side.name}"
        elif file.endswith(".nc") and Path(file).stem not in side.data:
            texts[file] = f"{file} of the {side.name} cannot be read, or has groups"
    for file, words in texts.items():
        name = Path(file).stem
        yield Finding("file", words, artifact=name, of_results=side.name == "results")


def dataset_findings(
    name: str, new: xr.Dataset, old: xr.Dataset | None, artifact: Mapping
) -> Iterator[Finding]:
    """Whether a dataset is stale, and where it differs from the reference, with the causes."""
    for words in staleness(new, artifact):
        yield Finding("stale", words, artifact=name, of_results=True)
    if old is None:
        return
    try:
        differences = dataset_differences(new, old)
    except (KeyError, TypeError, ValueError) as error:
        differences = [Finding("file", f"the datasets cannot be compared: {error!r}")]
    if differences:
        changed = changes(record(old, "parameters"), record(new, "parameters"))
        causes = [f"changed parameter: {'; '.join(changed)}"] if changed else []
        reference = Path(old.encoding["source"])
        causes.append(cause(artifact.get("code", ()), str(old.attrs.get("commit")), reference))
        why = "; ".join(causes)
        yield from (replace(each, artifact=name, cause=why) for each in differences)


def staleness(new: xr.Dataset, artifact: Mapping) -> Iterator[str]:
    """Why a result is not that of today's configuration and code."""
    if "parameters" in artifact:
        recorded = record(new, "parameters")
        settings = {
            key: value for key, value in artifact.get("settings", {}).items() if key in recorded
        }
        wanted = datasets.plain({**artifact["parameters"], **settings})
        changed = changes(recorded, wanted)
        if changed:
            yield f"stale: the configuration is another than it was made with: {'; '.join(changed)}"
    if "code" in artifact and new.attrs.get("code") != datasets.digest(artifact["code"]):
        yield "stale: it was made by other code than today's; remove it, and run again"


def product_findings(product: Product, new: Side, old: Side, scratch: Path) -> Iterator[Finding]:
    """Files of both sides that are not what today's code makes of the datasets of that side."""
    commit = next((str(data.attrs.get("commit")) for data in old.data.values()), "unknown")
    for side in (old, new):
        made = scratch / side.name
        if any(need not in side.data for need in product.needs):
            continue
        if side is new and all(
            need in old.data and same_bits(new.data[need], old.data[need]) for need in product.needs
        ):
            made = scratch / old.name
        else:
            try:
                product.make(side.data, made)
            except Exception as error:  # Whatever a drawing does not find in an older dataset.
                words = f"today's code cannot make it of the dataset in the {side.name}: {error!r}"
                why = (
                    ""
                    if side is new
                    else cause(product.code, commit, side.folder / product.files[0])
                )
                failed = Finding("file", words, artifact=product.artifact, cause=why)
                yield replace(failed, of_results=side is new)
                return
        loosely = bool(side.other_matplotlib(product.needs))
        for file in product.files:
            path = side.folder / file
            difference = file_difference(made / file, path, loosely) if path.is_file() else None
            if difference:
                what = f"today's code makes another {file} of the reference"
                if side is new:
                    what = f"{file} in the results is not what its dataset gives"
                why = "" if side is new else cause(product.code, commit, path)
                words = f"{what}: {difference.text}"
                named = replace(difference, artifact=product.artifact, text=words)
                yield replace(named, cause=why, of_results=side is new)


def consequences(product: Product, new: Side, old: Side) -> Iterator[Finding]:
    """Texts and PNG files in the results that differ from those in the reference."""
    for file in product.files:
        paths = new.folder / file, old.folder / file
        if not file.endswith(".svg") and all(path.is_file() for path in paths):
            difference = file_difference(*paths, loosely=False)
            if difference:
                yield replace(difference, artifact=product.artifact)


def provenance(name: str, old: xr.Dataset) -> str:
    """What a dataset of the reference records of its making."""
    versions = ", ".join(f"{key} {value}" for key, value in record(old, "versions").items())
    commit, code = (old.attrs.get(key, "unknown") for key in ("commit", "code"))
    return f"{name}: commit {commit}, code {code[:12]}, {versions}"


def notes(new: Side, old: Side, artifacts: Mapping[str, Mapping]) -> list[str]:
    """What was not compared."""
    found = []
    other = sorted(new.other_matplotlib() | old.other_matplotlib())
    if other:
        found.append(
            f"Pictures of matplotlib {', '.join(other)} were compared with those of "
            f"{matplotlib.__version__} by strokes, fills, words and curves, and not by pixels."
        )
    known = [{"parameters", "code"} <= set(artifacts.get(name, {})) for name in new.data]
    if not all(known):
        found.append("It is not known whether today's code made the results.")
    return found


def page(report: Report, template: Path) -> str:
    """The report as a page of HTML that needs no other file."""
    environment = jinja2.Environment(autoescape=True, undefined=jinja2.StrictUndefined)
    written = environment.from_string(template.read_text(encoding="utf-8"))
    return written.render(report=report, kinds=KINDS)


# How results become the reference

CODE = ("Snakefile", "config", "src", "workflow")
"""What must be committed, so that the commit that a reference names is the code that made it."""


def refuse_other_settings(given: Mapping, accepted: Mapping) -> None:
    """Raise ValueError if the settings of a run are not those of the configuration in git."""
    changed = [key for key in {**given, **accepted} if given.get(key) != accepted.get(key)]
    if changed:
        raise ValueError(f"config/config.yaml has another {', '.join(changed)} than this run")


def accept(
    results: str | Path,
    reference: str | Path,
    products: Collection[Product],
    artifacts: Mapping[str, Mapping],
    names: Collection[str] = (),
    code: Collection[str] = CODE,
) -> list[str]:
    """Make results the reference: those named, or all that differ; returns the files written.

    Datasets are copied, and name the commit of today. Pictures and texts, of these and of texts
    that depend on them, are made anew from the datasets that are then the reference. `code` are
    files and folders of code beside the reference. Raises ValueError, with the reason, if a result
    is stale, incomplete, or not what its dataset gives, and if the code is not committed.
    """
    old_folder = Path(reference)
    commit = datasets.commit(old_folder).removesuffix("+dirty")
    if not re.fullmatch("[0-9a-f]{40}", commit):
        raise ValueError(f"nothing is accepted, because the commit of the code is {commit}")
    edited = git(old_folder, "status", "--porcelain", "--untracked-files=all", "--", *code) or ""
    if edited:
        raise ValueError(f"nothing is accepted, commit first: {', '.join(edited.splitlines())}")
    report = compare(results, reference, products, artifacts, names)
    every = needed(products)
    new = Side("results", Path(results), read_all(Path(results), every))
    unfit = [finding.line for finding in report.findings if finding.of_results]
    unfit += notes(new, new, artifacts)
    if unfit:
        raise ValueError(f"nothing is accepted: {unfit[0]}")
    red = {finding.artifact for finding in report.findings}
    with tempfile.TemporaryDirectory() as scratch:
        stage(products, red, new, read_all(old_folder, every), Path(scratch), commit)
        return list(replaced(Path(scratch), old_folder))


def stage(
    products: Collection[Product],
    red: Collection[str],
    new: Side,
    old: Datasets,
    folder: Path,
    commit: str,
) -> None:
    """Write what becomes the reference into a folder: datasets, and what is made from them."""
    (folder / "figures").mkdir()
    data = dict(old)
    for name in red:
        if name in new.data and (
            name not in old
            or dataset_differences(new.data[name], old[name])
            # Its pictures are drawn anew, by the matplotlib of today.
            or record(old[name], "versions").get("matplotlib") != matplotlib.__version__
        ):
            data[name] = stamped(new.folder, folder, name, commit)
    accepted = [name for name in data if data[name] is not old.get(name)]
    for product in products:
        concerned = product.artifact in red or any(need in accepted for need in product.needs)
        if not concerned or any(need not in data for need in product.needs):
            continue
        product.make(data, folder)
        for name in following([product]):
            data[name] = fitting(name, new, old, folder, commit)


def fitting(name: str, new: Side, old: Datasets, folder: Path, commit: str) -> xr.Dataset:
    """A dataset that follows from others, as the accepted ones give it: that of the reference, or
    that of the results.
    """
    path = folder / "figures" / f"{name}.nc"
    made = datasets.read(path)
    path.unlink()
    if name in old and not dataset_differences(made, old[name]):
        return old[name]
    if name in new.data and not dataset_differences(made, new.data[name]):
        return stamped(new.folder, folder, name, commit)
    raise ValueError(f"nothing is accepted: it changes the {name}; make and accept all results")


def stamped(source: Path, folder: Path, name: str, commit: str) -> xr.Dataset:
    """Copy a dataset into a folder, as a result of a commit that has the code that made it."""
    copy = folder / "figures" / f"{name}.nc"
    shutil.copyfile(source / "figures" / copy.name, copy)
    with netCDF4.Dataset(copy, "a") as file:
        file.setncattr("commit", commit)
    return datasets.read(copy)


def replaced(source: Path, folder: Path) -> Iterator[str]:
    """Move the files that differ from one folder into another, each whole or not at all."""
    for path in sorted(path for path in source.rglob("*") if path.is_file()):
        target = folder / path.relative_to(source)
        if path.suffix == ".nc" or not target.is_file() or file_difference(path, target, False):
            with datasets.whole(target) as unfinished:
                shutil.copyfile(path, unfinished)
            yield str(path.relative_to(source))
