"""Compare results with the reference, or two runs.

Each side of a file is checked by itself first (`runs.side`): whether it is present, readable, named
by a record, as the record says, and fresh. Then both sides are compared (`differences`):

- Datasets agree if their numbers do (`of_dataset`).
- All other files are functions of datasets (`of_product`). If one of their datasets differs, they
  follow from it.
- Another processor rounds numbers differently. Then a picture, a table or a page of one dataset
  agrees if today's code makes the file of the reference again.

A difference comes with all that differs in what made both sides: parameters, files of code and
versions of libraries. Which of them is the cause is not known.
"""

import argparse
import base64
import sys
from collections.abc import Callable, Collection, Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, field, replace
from functools import cache
from io import BytesIO
from itertools import chain
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any, TextIO, cast

import numpy as np
import xarray as xr
from PIL import Image, ImageColor

from paper_replication.datasets import Project, read, write
from paper_replication.differences import (
    Difference,
    about,
    changes,
    differences,
    printable,
    sentences,
)
from paper_replication.provenance import (
    PACKAGES,
    content,
    contents_in,
    main_branch,
    relative,
    versions,
)
from paper_replication.runs import (
    ACCEPTED,
    CONFLICT,
    EDITED,
    LEFT,
    MISSING,
    UNNAMED,
    UNREADABLE,
    Checkout,
    Run,
    Side,
    configuration,
    one_line,
    results_of,
    run_in,
    side,
)
from paper_replication.templates import environment

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
    if differs_by_rounding(old, new, checkout):
        return Finding("agrees")
    return Finding("differs", lines, what_differs(old, new, checkout, differing), pairs)


def drawn_elsewhere(old: Mapping, new: Mapping, checkout: Checkout | None) -> bool:
    """Whether another matplotlib drew a picture, with the same code or that of the main branch."""
    drawn_by = {made["versions"].get("matplotlib") for made in (old, new)} - {None}
    known = {*old["code"].items(), *(checkout.main.items() if checkout else ())}
    return len(drawn_by) == 2 and {*new["code"].items()} <= known


def differs_by_rounding(old: Side, new: Side, checkout: Checkout | None) -> bool:
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
        printing = environment(Path(__file__).parent).overlay(finalize=printable)
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


# The command and the rule


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
