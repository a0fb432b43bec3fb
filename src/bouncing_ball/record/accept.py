"""The accepted record: what may replace it, how, and the log of what did.

git holds the record, ``figures/`` and ``paper.md``, laid out as the results
are, and ``accepted.csv``, in which every acceptance says why the record moved.

An artifact that says the same within its budgets stays as it is, with the commit
that it names: another processor moves most of them, and git would grow by what
has not changed. What has moved is copied, and with it what is made from it and
differs at all: the verdicts and the paper follow the numbers that they are
about. So the files of the record agree with each other within the budgets, and
a text quotes the tables beside it.
"""

import csv
import io
import shutil
from collections import Counter
from collections.abc import Collection, Iterable, Mapping, Sequence
from contextlib import ExitStack
from dataclasses import dataclass
from pathlib import Path

from bouncing_ball.datasets.atomic import replacing
from bouncing_ball.record.diff.folders import ComparisonError, artifacts_in, compare_folders
from bouncing_ball.record.diff.outcome import Outcome
from bouncing_ball.record.diff.report_terminal import to_terminal
from bouncing_ball.record.diff.tolerance_file import read_tolerances
from bouncing_ball.record.proof import RefusedError, check_made, check_versions
from bouncing_ball.record.provenance import LOCK, Provenance, file_digest
from bouncing_ball.record.recipe import Recipe, Run
from bouncing_ball.record.revision import Revision

LOG = "accepted.csv"
COLUMNS = ("number", "commit", "reason", "changes")
ALL = "all"
"""In place of the names of artifacts that are copied although they have not moved."""


def check_reason(reason: str) -> None:
    """Raise :class:`RefusedError` without a reason, one line, to write into the log."""
    if not reason.strip():
        raise RefusedError("say why the record changes: make accept REASON='…'")
    if not reason.isprintable():
        raise RefusedError("the reason is one line of text")


def check_tree(now: Revision) -> None:
    """Raise :class:`RefusedError` unless a commit, and nothing else, is checked out."""
    if now.commit == "unknown":
        raise RefusedError("no git repository with a commit here, and the record is what git holds")
    if now.dirty != "no":
        raise RefusedError("the tree is dirty: commit first, and accept what that commit makes")


def commits(made: Iterable[Provenance], now: Revision) -> list[str]:
    """One line for each commit that results were made from."""
    found = Counter(provenance.commit for provenance in made)
    return [
        f"{count} files made at commit {commit}"
        + ("" if commit == now.commit else ", up to date but not the one checked out")
        for commit, count in found.most_common()
    ]


def halfway(folder: Path) -> set[Path]:
    """Temporary files that a killed program left in a folder."""
    return set(folder.glob(".*.part.*"))


def stale(folder: Path, wanted: Iterable[Path]) -> list[Path]:
    """Files of a folder that are not among the wanted ones."""
    kept = {path for path in folder.glob("*") if path.is_file()}
    return sorted(kept - halfway(folder) - set(wanted))


def made_from(recipes: Iterable[Recipe]) -> dict[str, set[str]]:
    """Names of the artifacts that each artifact is made from, straight."""
    found: dict[str, set[str]] = {}
    for recipe in recipes:
        name = Path(recipe.target).stem
        read = {Path(path).stem for path in recipe.inputs if path.startswith("results/")}
        found.setdefault(name, set()).update(read - {name})
    return found


def moved(outcomes: Mapping[str, Outcome], reads: Mapping[str, Collection[str]]) -> set[str]:
    """The artifacts that say something else, and those made from them that differ at all.

    Examples
    --------
    >>> outcomes = dict.fromkeys(["fig08", "paper", "fig05"], Outcome.WITHIN)
    >>> sorted(moved(outcomes | {"fig08": Outcome.DRIFTED}, {"paper": ["fig05", "fig08"]}))
    ['fig08', 'paper']
    """
    found = {name for name, outcome in outcomes.items() if not outcome.agrees}
    differ = {name for name, outcome in outcomes.items() if outcome is not Outcome.IDENTICAL}
    while more := {name for name in differ - found if found & set(reads.get(name, ()))}:
        found |= more
    return found


@dataclass(frozen=True)
class Entry:
    """The last entry of the log: for what, and which artifacts it names."""

    commit: str
    reason: str
    names: frozenset[str]


def last_entry(text: str) -> Entry | None:
    """The last entry of a log, if there is one.

    Examples
    --------
    >>> last_entry(log_with("", "1f0e", "Eq. 8, exact", {"fig03": "drifted"}))
    Entry(commit='1f0e', reason='Eq. 8, exact', names=frozenset({'fig03'}))
    """
    rows = list(csv.reader(io.StringIO(text)))[1:]
    if not rows:
        return None
    _, commit, reason, changes = rows[-1]
    return Entry(commit, reason, frozenset(part.split()[0] for part in changes.split("; ")))


def log_with(text: str, commit: str, reason: str, changes: Mapping[str, str]) -> str:
    """The log with one entry more.

    Examples
    --------
    >>> print(log_with("", "1f0e", "Eq. 8, exact", {"fig03": "drifted"}), end="")
    number,commit,reason,changes
    1,1f0e,"Eq. 8, exact",fig03 drifted
    """
    rows = list(csv.reader(io.StringIO(text))) or [list(COLUMNS)]
    said = "; ".join(f"{name} {change}" for name, change in sorted(changes.items()))
    out = io.StringIO()
    writer = csv.writer(out, lineterminator="\n")
    writer.writerows([*rows, [len(rows), commit, reason.strip(), said]])
    return out.getvalue()


def replace_record(
    record: Path, results: Path, copied: Sequence[str], removed: Sequence[Path], log: str
) -> list[str]:
    """Copy files over the record and remove others; the log comes first.

    Everything is copied under temporary names before: if that fails, the record
    is as it was. A program that is killed between two renames leaves the entry in
    the log and a temporary file, by which the next one knows (:func:`begun`).
    """
    with ExitStack() as stack:
        for file in copied:
            shutil.copyfile(results / file, stack.enter_context(replacing(record / file)))
        for path in removed:
            stack.callback(path.unlink)
        # Entered last, so renamed first.
        stack.enter_context(replacing(record / LOG)).write_text(log, encoding="utf-8", newline="\n")
    for path in halfway(record) | halfway(record / "figures"):
        path.unlink()
    return [*copied, *(f"removed figures/{path.name}" for path in removed)]


def begun(record: Path, log: str, commit: str, reason: str) -> frozenset[str]:
    """What an acceptance of this commit for this reason, killed on its way, was to copy."""
    left = halfway(record) | halfway(record / "figures")
    last = last_entry(log)
    if not left or last is None or (last.commit, last.reason) != (commit, reason):
        return frozenset()
    return last.names


def compare(record: Path, results: Path) -> dict[str, Outcome]:
    """Print how the results differ from the record; what became of each artifact.

    Files that say the same in other bytes, another commit of the provenance for
    one, do not differ.
    """
    try:
        artifacts_in(record)
    except ComparisonError:
        print("There is no record yet.")
        return dict.fromkeys(artifacts_in(results), Outcome.EXTRA)
    rules = read_tolerances(record / "config" / "tolerances.yaml")
    comparison = compare_folders(record, results, rules)
    print(to_terminal(comparison), end="", flush=True)
    return {artifact.name: artifact.outcome for artifact in comparison.artifacts}


def _change(outcome: Outcome) -> str:
    """What the log calls it: for the record, what is extra in the results is new."""
    return "new" if outcome is Outcome.EXTRA else str(outcome)


def _same(one: Path, other: Path) -> bool:
    return other.is_file() and file_digest(one) == file_digest(other)


def check(run: Run, results: Path, recipes: Sequence[Recipe], files: Sequence[str]) -> None:
    """Raise :class:`RefusedError` unless results are what the commit checked out makes."""
    check_tree(run.now)
    foreign = stale(results / "figures", [results / file for file in files])
    if foreign:
        raise RefusedError(f"{foreign[0]} is not made by this workflow: remove it")
    made = check_made(recipes, run)
    published = {file: made[(results / file).as_posix()] for file in files}
    lock = run.repository / LOCK
    check_versions(published, lock.read_text(encoding="utf-8") if lock.is_file() else "")
    print(*commits(published.values(), run.now), sep="\n")


def chosen(outcomes: Mapping[str, Outcome], recipes: Iterable[Recipe], also: str) -> set[str]:
    """The artifacts to be copied: those that have moved, and those asked for."""
    asked = set(outcomes if also == ALL else also.split())
    if unknown := asked - outcomes.keys():
        raise RefusedError(f"no artifact {', '.join(sorted(unknown))} to be copied as well")
    return moved(outcomes, made_from(recipes)) | asked


def accept(
    run: Run, results: Path, recipes: Sequence[Recipe], files: Sequence[str], reason: str, also: str
) -> list[str]:
    """Make the results the record; the lines of the job's log.

    Parameters
    ----------
    run : Run
        Whose repository holds the record.
    results : Path
    recipes : sequence of Recipe
        Of all jobs of the workflow.
    files : sequence of str
        What is published, relative to the results.
    reason : str
        Why the record moves. The same reason completes an acceptance that was
        killed: the rest of what its entry names is copied.
    also : str
        Names of artifacts to be copied although they have not moved, or ``all``.

    Raises
    ------
    RefusedError
        If there is no reason, the tree is dirty or unknown, or a result is not
        what the commit makes (:func:`~bouncing_ball.record.proof.check_made`).
        Nothing is touched then.
    """
    check_reason(reason)
    check(run, results, recipes, files)
    record, commit = run.repository, run.now.commit
    outcomes = compare(record, results)
    log = (record / LOG).read_text(encoding="utf-8") if (record / LOG).is_file() else ""
    started = begun(record, log, commit, reason.strip())
    names = chosen(outcomes, recipes, also) | started
    copied = [
        file
        for file in files
        if Path(file).stem in names and not _same(results / file, record / file)
    ]
    removed = stale(record / "figures", [record / file for file in files])
    changes = dict.fromkeys((path.stem for path in removed), "removed")
    changes |= {Path(file).stem: _change(outcomes[Path(file).stem]) for file in copied}
    if not changes:
        print("Nothing to accept: the record says what the results say.")
        return ["nothing to accept"]
    if not changes.keys() <= started:
        log = log_with(log, commit, reason, changes)
    lines = replace_record(record, results, copied, removed, log)
    print(f"Accepted, reason: {reason.strip()}", flush=True)
    return lines
