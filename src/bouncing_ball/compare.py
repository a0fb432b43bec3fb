"""The comparison of results with the reference.

The reference is kept in git: the folder `figures` with datasets, pictures and tables, and the texts
`paper.md` and `supplement.md`. A run writes the same files into a folder of its own, `results`.
Three comparisons are made, of which `differences` says what is different:

1. Each dataset of the results with that of the reference. A result that records other parameters
   than those of the configuration, or other code than today's, is stale, whatever else it says.
2. Pictures, tables, claims and texts are functions of datasets. Today's code makes them again from
   the datasets of the *reference*, and they must equal the files of the reference. The datasets
   being the same, there is no rounding to forgive.
3. Made from the datasets of the *results*, they must equal the files of the results in the same
   way. Otherwise a picture is older than its dataset, or was edited.

The cause of a difference is what the file is made from and what has changed. A dataset records its
parameters, versions, and files of code with their contents, so that those of both sides can be
compared without git, which then only says when a file changed. Claims change by other code, which
the second comparison shows, or by the datasets that decide them.
"""

import io
import os
import sys
import tempfile
from collections.abc import Collection, Iterable, Iterator, Mapping
from contextlib import suppress
from dataclasses import dataclass, replace
from functools import cache
from pathlib import Path
from typing import Any

import jinja2
import xarray as xr
import yaml

from bouncing_ball import datasets
from bouncing_ball.artifacts import Product, Side, needed, read_side, staleness
from bouncing_ball.datasets import PACKAGES
from bouncing_ball.differences import (
    DESCRIPTIVE,
    KINDS,
    Finding,
    changes,
    dataset_differences,
    file_differences,
    record,
    same_bits,
)
from bouncing_ball.history import CHECKOUT, History


@dataclass(frozen=True)
class Report:
    """What was found, the most telling first, and what else a reader should know.

    `consequences` are files of the results that differ from those of the reference because their
    datasets do; they are shown and not counted. `notes` tell of other versions. `skipped` of the
    files are pictures that were not compared, because another matplotlib drew them.
    """

    findings: list[Finding]
    consequences: list[Finding]
    notes: list[str]
    files: int
    skipped: int

    @property
    def lines(self) -> list[str]:
        """The report on a terminal: the most telling finding of each artifact, others of the same
        with another cause, and the verdict.
        """
        told = []
        red: set[str] = set()
        for finding in self.findings:
            if finding.cause or finding.artifact not in red:
                told.append(finding.line)
            red.add(finding.artifact)
        agreeing = f"{self.files - self.skipped} of {self.files}" if self.skipped else self.files
        verdict = f"{'' if self.skipped else 'All '}{agreeing} files agree with the reference."
        if red:
            verdict = f"Differences: {len(self.findings)}, in {', '.join(sorted(red))}."
        return [*told, " ".join([verdict, *self.notes])]


class Comparison:
    """Results beside the reference: all, or those with the names given.

    `products` are all files that follow from datasets; these and their datasets are compared.
    `config` is the configuration of the results, and `top` the checkout of today's code. Raises
    ValueError if the results are no results or the reference itself, or for a name that is not
    compared.
    """

    def __init__(
        self,
        results: str | Path,
        reference: str | Path,
        products: Collection[Product],
        config: Mapping,
        names: Collection[str] = (),
        top: Path = CHECKOUT,
    ):
        self.config = config
        self.history = History(top)
        self.names, self.made = chosen(products, names)
        self.whole = len(self.made) == len(products)
        files = [f"figures/{name}.nc" for name in self.names]
        self.files = list(dict.fromkeys([*files, *(f for each in self.made for f in each.files)]))
        refuse(Path(results), Path(reference), self.files)
        self.new = read_side("results", Path(results), needed(products))
        self.old = read_side("reference", Path(reference), needed(products))
        self.derived = {product.artifact for product in products if product.is_dataset}
        self.differences = {
            name: compared(self.new.data[name], self.old.data[name])
            for name in self.new.data
            if name in self.old.data and name not in self.derived
        }
        self.why = cache(self.cause_of_dataset)
        self.why_made = cache(self.cause_of_product)

    def report(self) -> Report:
        """All findings. The cause of differences is stated once for each artifact."""
        findings = [*self.file_findings(self.new), *self.file_findings(self.old)]
        for name in self.names:
            findings += self.dataset_findings(name)
        with tempfile.TemporaryDirectory() as scratch:
            for product in self.made:
                findings += self.product_findings(product, Path(scratch))
        findings.sort(key=lambda each: each.rank)
        red = {finding.artifact for finding in findings}
        shown = [each for product in self.made for each in self.consequences(product, red)]
        stated = {(each.artifact, each.cause): each for each in reversed(findings)}
        return Report(
            [
                each if stated[each.artifact, each.cause] is each else replace(each, cause="")
                for each in findings
            ],
            shown,
            self.notes(),
            len(self.files),
            len(self.skipped()),
        )

    # What differs

    def file_findings(self, side: Side) -> Iterator[Finding]:
        """Files of one side that are missing, unreadable or, in a whole comparison, unexpected."""
        present = sorted(path.name for path in (side.folder / "figures").iterdir())
        accepted = {path.stem for path in (self.old.folder / "figures").iterdir()}
        texts = {
            file: f"{file} of the {side.name} is made by no rule"
            for file in (f"figures/{name}" for name in present if name[0] != ".")
            if self.whole and file not in self.files
        }
        for file in self.files:
            path = side.folder / file
            name = path.stem
            if side is self.old and file.startswith("figures/") and name not in accepted:
                texts[name] = (
                    f"{name} is not in the reference yet: commit, then "
                    f"snakemake --cores 2 {name} accept"
                )
            elif not path.is_file():
                what = "no regular file" if path.exists() else "missing"
                texts[file] = f"{file} is {what} in the {side.name}"
            elif file == f"figures/{name}.nc" and name in side.unread:
                texts[file] = f"{file} of the {side.name} cannot be read: {side.unread[name]}"
        for file, words in texts.items():
            yield Finding("file", words, artifact=Path(file).stem, of_results=side is self.new)

    def dataset_findings(self, name: str) -> Iterator[Finding]:
        """Whether a dataset is stale, and where it differs from the reference."""
        if name in self.new.data:
            for words in staleness(self.new.data[name], name, self.config, self.history.top):
                yield Finding("stale", words, artifact=name, of_results=True)
        for each in self.differences.get(name, []):
            yield replace(each, artifact=name, cause=self.why(name))

    def product_findings(self, product: Product, scratch: Path) -> Iterator[Finding]:
        """Files of both sides that are not what today's code makes of the datasets of that side.

        The datasets being the same to the last bit, a product is made once.
        """
        made = None
        for side in (self.old, self.new):
            if side.drawn_elsewhere(product) or not side.data.keys() >= {*product.needs}:
                continue
            needs = [(self.new.data.get(name), self.old.data.get(name)) for name in product.needs]
            if made is None or not all(new and old and same_bits(new, old) for new, old in needs):
                made = scratch / side.name
                (made / "figures").mkdir(parents=True, exist_ok=True)
                try:
                    product.make(side.data, made)
                except Exception as error:  # Whatever a drawing does not find in a dataset.
                    words = f"today's code cannot make it of the dataset in the {side.name}"
                    yield self.found(Finding("file", f"{words}: {error!r}"), product, side)
                    # The other side would fail in the same way.
                    return
            for file in product.files:
                path = side.folder / file
                what = f"today's code makes another {file} of the reference"
                if side is self.new:
                    what = f"{file} in the results is not what its dataset gives"
                for each in file_differences(made / file, path) if path.is_file() else []:
                    yield self.found(replace(each, text=f"{what}: {each.text}"), product, side)
            if side is self.old and product.is_dataset:
                yield from self.followed(product, datasets.read(made / product.files[0]))

    def found(self, finding: Finding, product: Product, side: Side) -> Finding:
        """A finding on a product; what is wrong in the results alone has no cause in the code."""
        wrong = side is self.new
        cause = "" if wrong else self.why_made(product)
        return replace(finding, artifact=product.artifact, cause=cause, of_results=wrong)

    def followed(self, product: Product, expected: xr.Dataset) -> Iterator[Finding]:
        """How a dataset that follows from others differs from what today's code makes of those in
        the reference. The causes are the datasets that decide the claims that differ.
        """
        name = product.artifact
        if name not in self.new.data:
            return
        new = self.new.data[name]
        declared = declarations(expected) | declarations(new)
        changed = [other for other in product.needs if self.values_differ(other)]
        for each in compared(new, expected):
            decided = [declared.get(label, set()) & {*changed} for label in each.labels]
            deciding = fewest(decided) if each.labels else changed
            causes = {self.why(other) for other in deciding}
            # Each of several causes stands with its dataset.
            words = [f"follows from {', '.join(deciding)}", *(causes if len(causes) == 1 else ())]
            yield replace(each, artifact=name, cause=": ".join(words) if deciding else "")

    def values_differ(self, name: str) -> bool:
        """Whether a dataset has other numbers, texts or parameters than that of the reference."""
        if name not in self.differences:
            return name in self.new.data and name not in self.derived
        return any(each.order != DESCRIPTIVE for each in self.differences[name])

    def consequences(self, product: Product, red: Collection[str]) -> Iterator[Finding]:
        """Texts and PNG files in the results that differ from those in the reference because one of
        their datasets does.
        """
        for file in product.files if not {*product.needs}.isdisjoint(red) else ():
            paths = self.new.folder / file, self.old.folder / file
            if not file.endswith((".svg", ".nc")) and all(path.is_file() for path in paths):
                for difference in file_differences(*paths):
                    yield replace(difference, artifact=product.artifact)

    # Why it differs

    def cause_of_dataset(self, name: str) -> str:
        """Why a dataset differs: by what both sides record."""
        if name not in self.old.data:
            return "it is not in the reference"
        old, new = (
            {key: record(side.data[name], key) for key in ("parameters", "versions", "code")}
            for side in (self.old, self.new)
        )
        # A file that was only moved has the same content.
        same = {*old["code"].values()} & {*new["code"].values()}
        code = {**old["code"], **new["code"]}
        changed = [file for file, content in code.items() if content not in same]
        parameters = changes(old["parameters"], new["parameters"])
        versions = changes(old["versions"], new["versions"])
        libraries = [each for each in versions if each.split()[0] in PACKAGES]
        return self.cause([f"figures/{name}.nc"], changed, parameters, libraries)

    def cause_of_product(self, product: Product) -> str:
        """Why today's code makes other files of the reference: by what has changed since they were
        made.
        """
        files = [*product.files, *(f"figures/{name}.nc" for name in product.needs)]
        commits = [str(self.old.data[name].attrs.get("commit")) for name in product.needs]
        made = self.history.newest(commits, [self.old.folder / file for file in files])
        code = [self.history.top / file for file in product.code]
        later = self.history.since(made, code)
        edited = self.history.uncommitted(code)
        if later is None and not edited:
            unknown = ": git does not know when the reference was made"
            without = unknown if self.history.head else " without git"
            return f"changes of the code are unknown{without}"
        return self.cause(files, {*edited, *(later or ())})

    def cause(
        self,
        reference: Collection[str],
        changed: Collection[str],
        parameters: Collection[str] = (),
        libraries: Collection[str] = (),
    ) -> str:
        """The cause in words: what surely changes the result, changed files, among them those of
        the reference that were edited, and what perhaps changes it.
        """
        paths = [self.old.folder / file for file in reference]
        files = self.history.told({*changed, *self.history.uncommitted(paths)})
        causes = {
            "changed parameter": "; ".join(parameters),
            "changed": ", ".join(files),
            "other versions": ", ".join(libraries),
        }
        words = [f"{what}: {which}" for what, which in causes.items() if which]
        if words:
            return "; ".join(words)
        since = self.history.told(self.history.names(paths))[:1]
        return " since ".join(["no file that it is made from has changed", *since])

    # What else a reader should know

    def skipped(self) -> dict[str, set[str]]:
        """Pictures that are not compared, with the versions of matplotlib that drew them."""
        sides = self.old, self.new
        return {
            file: {side.matplotlib(product) for side in sides if side.drawn_elsewhere(product)}
            for product in self.made
            if any(side.drawn_elsewhere(product) for side in sides)
            for file in product.files
        }

    def notes(self) -> list[str]:
        """What was not compared, and which versions are not those of today."""
        found = []
        skipped = self.skipped()
        today = datasets.versions()
        if skipped:
            drew = ", ".join(sorted(set().union(*skipped.values())))
            found.append(
                f"{len(skipped)} pictures were not compared: matplotlib {drew} drew them, and this "
                f"is {today['matplotlib']}."
            )
        others = []
        compared = {*self.names, *needed(self.made)}
        for package in PACKAGES:
            old, new = (
                {record(side.data[name], "versions")[package] for name in compared & {*side.data}}
                for side in (self.old, self.new)
            )
            if (old | new) - {today[package]}:
                others.append(
                    f"{package} {', '.join(sorted(old))} in the reference, "
                    f"{', '.join(sorted(new))} in the results, {today[package]} today"
                )
        if others:
            found.append(f"Other versions: {'; '.join(others)}.")
        return found


def compared(new: xr.Dataset, old: xr.Dataset) -> list[Finding]:
    """Differences of two datasets, whatever they have in them."""
    try:
        return dataset_differences(new, old)
    except (KeyError, TypeError, ValueError) as error:
        return [Finding("file", f"the datasets cannot be compared: {error!r}")]


def declarations(data: xr.Dataset) -> dict[str, set[str]]:
    """The datasets that each claim declares to decide it."""
    if "decided_by" not in data or data.decided_by.dims != ("claim",):
        return {}
    pairs = zip(data.claim.values, data.decided_by.values, strict=True)
    return {claim: {*str(text).split(", ")} for claim, text in pairs}


def fewest(decided: Iterable[Collection[str]]) -> list[str]:
    """Datasets of which one decides each claim: one that alone decides a claim is enough for the
    others that it decides too.

    >>> fewest([{"fig02", "fig06"}, {"fig06"}, {"fig14"}, set()])
    ['fig06', 'fig14']
    """
    found: set[str] = set()
    for names in sorted(decided, key=len):
        if found.isdisjoint(names):
            found |= {*names}
    return sorted(found)


def chosen(
    products: Collection[Product], names: Collection[str]
) -> tuple[list[str], list[Product]]:
    """The datasets and products to compare: all, or those named and those that need no other
    datasets.

    Raises ValueError for a name that is not compared, so that nothing is not taken for agreement.
    """
    known = {*needed(products), *(product.artifact for product in products)}
    wanted = {*names} or known
    unknown = sorted(wanted - known)
    if unknown:
        allowed = f"allowed are {', '.join(sorted(known))}"
        raise ValueError(f"{', '.join(unknown)}: no file of that name is compared; {allowed}")
    made = [
        product
        for product in products
        if product.artifact in wanted or (product.needs and {*product.needs} <= wanted)
    ]
    return [name for name in needed(products) if name in wanted], made


def refuse(results: Path, reference: Path, files: Collection[str]) -> None:
    """Refuse folders that have no results, and results that are the reference, also by links."""
    for folder in (results, reference):
        if not (folder / "figures").is_dir():
            raise ValueError(f"{folder} is no folder of results: there is no {folder / 'figures'}")
    for file in ["figures", *files]:
        pair = results / file, reference / file
        if all(path.exists() for path in pair) and pair[0].samefile(pair[1]):
            raise ValueError(
                f"{pair[0]} is a part of the reference: results must be files of their own"
            )


# The page, the log and the terminal

TEMPLATE = CHECKOUT / "workflow" / "templates" / "diff.html.j2"


def page(report: Report) -> str:
    """The report as a page of HTML that needs no other file."""
    environment = jinja2.Environment(autoescape=True, undefined=jinja2.StrictUndefined)
    return environment.from_string(TEMPLATE.read_text("utf-8")).render(report=report, kinds=KINDS)


def main(
    products: Collection[Product], folder: Path, job: Any = None, top: Path = CHECKOUT
) -> int | str:
    """Compare, print the report, and write it as a page into the folder of the results.

    A `job` of Snakemake has the parameters; the command line has a folder of results and perhaps
    one of a reference, which is otherwise `folder`, as is the configuration. Returns the exit
    status, or why nothing was compared. Until the end there is no page, and the log says so. Where
    nothing can be written the report is printed all the same.
    """
    # A terminal may not know all letters.
    if isinstance(sys.stdout, io.TextIOWrapper):
        sys.stdout.reconfigure(errors="replace")
    if job:
        given = dict(job.params)
    elif len(sys.argv) in (2, 3):
        configuration = yaml.safe_load((folder / "config" / "config.yaml").read_text("utf-8"))
        results, reference = (*sys.argv[1:], folder)[:2]
        given = {"results": results, "reference": reference, "config": configuration}
    else:
        return "usage: python workflow/scripts/compare.py RESULTS_FOLDER [REFERENCE_FOLDER]"
    path = Path(given["results"]) / "diff" / "index.html"
    with suppress(OSError):
        path.unlink(missing_ok=True)
    log = Path(job.log[0] if job else os.devnull)
    log.write_text("The comparison has not ended.\n", encoding="utf-8")
    try:
        report = Comparison(**given, products=products, top=top).report()
    except ValueError as error:
        log.write_text(f"{error}\n", encoding="utf-8")
        return str(error)
    *told, verdict = report.lines
    # Snakemake shows the log of a failed job last.
    log.write_text("\n".join([verdict, *told, ""]), encoding="utf-8")
    place = f"See {path}."
    try:
        path.parent.mkdir(exist_ok=True)
        with datasets.whole(path) as unfinished:
            unfinished.write_text(page(report), encoding="utf-8", newline="\n")
    except OSError as error:
        place = f"There is no page: {error}"
    print("\n".join([*told, verdict, place]))
    return 1 if report.findings else 0
