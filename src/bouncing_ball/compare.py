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
the second comparison shows, or by datasets: those that alone change them in the reference, too.
"""

import io
import os
import sys
import tempfile
from collections.abc import Collection, Iterator, Mapping
from contextlib import suppress
from dataclasses import replace
from functools import cache
from pathlib import Path
from typing import Any

import jinja2
import xarray as xr
import yaml

from bouncing_ball import datasets
from bouncing_ball.artifacts import Product, Side, needed, read_side, staleness
from bouncing_ball.datasets import Datasets
from bouncing_ball.differences import (
    KINDS,
    PICTURES,
    Finding,
    changes,
    dataset_differences,
    file_differences,
    record,
    same_bits,
)
from bouncing_ball.history import CHECKOUT, History


class Comparison:
    """Results beside the reference: all, or those with the names given.

    `products` are all files that follow from datasets; these and their datasets are compared.
    `config` is the configuration of the results, and `top` the checkout of today's code. Raises
    ValueError if the results are no results or the reference itself, or for a name that is not
    compared.

    `findings` are the differences, the most telling first. `consequences` are files of the results
    that differ from those of the reference because their datasets do; the page shows them.
    `skipped` are pictures that were not compared, because another matplotlib drew them.
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
        both = self.new.data.keys() & self.old.data.keys()
        self.differences = {
            name: compared(self.new.data[name], self.old.data[name]) for name in both
        }
        self.same = {name for name in both if same_bits(self.new.data[name], self.old.data[name])}
        # A picture without a dataset may have been drawn by the versions of any.
        known = {*self.names, *needed(self.made)} or {*needed(products)}
        self.others = {side.name: side.other_versions(known) for side in (self.old, self.new)}
        drawn = any(each.startswith("matplotlib") for side in self.others.values() for each in side)
        self.skipped = [each for each in self.files if drawn and each.endswith(PICTURES)]
        self.why = cache(self.cause_of_dataset)
        self.why_made = cache(self.cause_of_product)
        self.findings = sorted(self.found(), key=lambda each: each.rank)
        red = {finding.artifact for finding in self.findings}
        self.consequences = [each for made in self.made for each in self.seen(made, red)]

    @property
    def lines(self) -> list[str]:
        """The report on a terminal: the most telling finding of each artifact with each cause, and
        the verdict.
        """
        told: dict[tuple[str, str], str] = {}
        for finding in self.findings:
            told.setdefault((finding.artifact, finding.cause), finding.line)
        red = sorted({artifact for artifact, _ in told})
        number = len(self.files)
        count = f"{number - len(self.skipped)} of {number}" if self.skipped else f"All {number}"
        verdict = f"{count} files agree with the reference."
        if red:
            verdict = f"Differences: {len(self.findings)}, in {', '.join(red)}."
        notes = []
        if self.skipped:
            number = len(self.skipped)
            notes.append(
                f"{number} pictures were not compared, because another matplotlib drew them."
            )
        for side, others in self.others.items():
            if others:
                notes.append(f"Other versions in the {side}: {', '.join(others)}.")
        return [*told.values(), " ".join([verdict, *notes])]

    # What differs

    def found(self) -> Iterator[Finding]:
        """All findings with their causes."""
        yield from self.file_findings(self.new)
        yield from self.file_findings(self.old)
        for name in self.names:
            yield from self.dataset_findings(name)
        with tempfile.TemporaryDirectory() as scratch:
            for product in self.made:
                yield from self.product_findings(product, scratch)

    def file_findings(self, side: Side) -> Iterator[Finding]:
        """Files of one side that are missing, unreadable or, in a whole comparison, unexpected."""
        present = [path.name for path in (side.folder / "figures").iterdir()]
        figures = [f"figures/{name}" for name in present if not name.startswith(".")]
        for file in sorted({*self.files, *(figures if self.whole else ())}):
            path = side.folder / file
            words = ""
            if file not in self.files:
                words = "is made by no rule"
            elif not path.is_file():
                words = "is no regular file" if path.exists() else "is missing"
                words += "; if it is new, commit, then accept it" if side is self.old else ""
            elif path.suffix == ".nc" and path.stem in side.unread:
                words = f"cannot be read: {side.unread[path.stem]}"
            if words:
                text = f"{file} in the {side.name} {words}"
                yield Finding("file", text, artifact=path.stem, of_results=side is self.new)

    def dataset_findings(self, name: str) -> Iterator[Finding]:
        """Whether a dataset is stale, and where one of the models differs from the reference."""
        if name in self.new.data:
            for words in staleness(self.new.data[name], name, self.config, self.history.top):
                yield Finding("stale", words, artifact=name, of_results=True)
        if name not in self.derived:
            for each in self.differences.get(name, []):
                yield replace(each, artifact=name, cause=self.why(name))

    def product_findings(self, product: Product, scratch: str) -> Iterator[Finding]:
        """Files of both sides that are not what today's code makes of the datasets of that side.

        The datasets being the same to the last bit, a product is made once.
        """
        needs = {*product.needs}
        sides = [side for side in (self.old, self.new) if side.data.keys() >= needs]
        made = None
        for side in sides if product.files[0] not in self.skipped else ():
            if made is None or not needs <= self.same:
                try:
                    made = remade(product, side.data, scratch)
                except Exception as error:  # Whatever a drawing does not find in a dataset.
                    words = f"today's code cannot make it of the dataset in the {side.name}"
                    yield self.attributed(Finding("file", f"{words}: {error!r}"), product, side)
                    # The other side would fail in the same way.
                    return
            for file in product.files:
                path = side.folder / file
                what = f"{file} in the {side.name} is not what today's code makes of its data"
                for each in file_differences(made / file, path) if path.is_file() else ():
                    told = replace(each, text=f"{what}: {each.text}")
                    yield self.attributed(told, product, side)
            if side is self.old and self.differences.get(product.artifact) and product.is_dataset:
                yield from self.derived_findings(product, made, scratch)

    def attributed(self, finding: Finding, product: Product, side: Side) -> Finding:
        """A finding on a product; what is wrong in the results alone has no cause in the code."""
        wrong = side is self.new
        cause = "" if wrong else self.why_made(product)
        return replace(finding, artifact=product.artifact, cause=cause, of_results=wrong)

    def derived_findings(self, product: Product, made: Path, scratch: str) -> Iterator[Finding]:
        """How a dataset that follows from others differs from what is `made` of those in the
        reference. The causes are the datasets that alone change the same variable.
        """
        (file,) = product.files
        others = {*product.needs} - self.derived
        changed = sorted(name for name in others if self.differences.get(name))
        alone: dict[str, set[str]] = {}
        for name in changed:
            with suppress(Exception):  # A mixture of old and new datasets may make no sense.
                mixture = {**self.old.data, name: self.new.data[name]}
                one = remade(product, mixture, scratch) / file
                alone[name] = {each.variable for each in file_differences(one, made / file)}
        for each in file_differences(self.new.folder / file, made / file):
            deciding = [name for name in changed if each.variable in alone.get(name, ())]
            deciding = deciding or changed
            causes = {self.why(name) for name in deciding}
            # Each of several causes stands with its dataset.
            words = [f"follows from {', '.join(deciding)}", *(causes if len(causes) == 1 else ())]
            cause = ": ".join(words) if deciding else ""
            yield replace(each, artifact=product.artifact, cause=cause)

    def seen(self, product: Product, red: Collection[str]) -> Iterator[Finding]:
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
        old = self.old.data[name]
        new = self.new.data[name]
        before = record(old, "code")
        after = record(new, "code")
        # A file that was only moved has the same content.
        same = {*before.values()} & {*after.values()}
        changed = [file for file, content in (before | after).items() if content not in same]
        parameters = changes(record(old, "parameters"), record(new, "parameters"))
        versions = changes(record(old, "versions"), record(new, "versions"))
        libraries = [each for each in versions if not each.startswith("python")]
        return self.cause([self.old.dataset(name)], changed, parameters, libraries)

    def cause_of_product(self, product: Product) -> str:
        """Why today's code makes other files of the reference: by what has changed since they were
        made.
        """
        made = [self.old.folder / file for file in product.files]
        made += [self.old.dataset(name) for name in product.needs]
        commits = [str(self.old.data[name].attrs.get("commit")) for name in product.needs]
        code = [self.history.top / file for file in product.code]
        edited = self.history.uncommitted(code)
        later = self.history.since(self.history.newest(commits, made), code)
        if later is None and not edited:
            return "changes of the code are unknown without the history of git"
        return self.cause(made, {*edited, *(later or ())})

    def cause(
        self,
        reference: Collection[Path],
        changed: Collection[str],
        parameters: Collection[str] = (),
        libraries: Collection[str] = (),
    ) -> str:
        """The cause in words: what surely changes the result, changed files, among them those of
        the reference that were edited, and what perhaps changes it.
        """
        files = self.history.told({*changed} | self.history.uncommitted(reference))
        causes = {
            "changed parameter": "; ".join(parameters),
            "changed": ", ".join(files),
            "other versions": ", ".join(libraries),
        }
        words = [f"{what}: {which}" for what, which in causes.items() if which]
        if words:
            return "; ".join(words)
        last = self.history.told(self.history.names(reference))[:1]
        return " since ".join(["no file that it is made from has changed", *last])


def compared(new: xr.Dataset, old: xr.Dataset) -> list[Finding]:
    """Differences of two datasets, whatever they have in them."""
    try:
        return dataset_differences(new, old)
    except (KeyError, TypeError, ValueError) as error:
        return [Finding("file", f"the datasets cannot be compared: {error!r}")]


def remade(product: Product, data: Datasets, scratch: str) -> Path:
    """A new folder below another one, with the files that follow from some datasets."""
    folder = Path(tempfile.mkdtemp(dir=scratch))
    (folder / "figures").mkdir()
    product.make(data, folder)
    return folder


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


def page(report: Comparison) -> str:
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
        report = Comparison(**given, products=products, top=top)
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
