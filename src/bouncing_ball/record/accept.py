"""The accepted record: what may replace it, how, and the log of what did.

git holds the record, ``figures/`` and ``paper.md``, laid out as the results
are, and ``accepted.csv``, in which every acceptance says why the record moved.

An artifact that says the same within its budgets stays as it is, with the commit
that it names: another processor moves most of them, and git would grow by what
has not changed. What has moved is copied if it is named, with a reason of its
own: a whole run accepted in one go brings in what nobody looked at. With it is
copied what is made from it and differs at all: the verdicts and the paper follow
the numbers that they are about. What is made from something else that has moved
is refused without it. So the files of the record agree with each other within
the budgets, and a text quotes the tables beside it.
"""

import csv
import io
import shutil
from collections import Counter
from collections.abc import Callable, Collection, Iterable, Mapping, Sequence
from contextlib import ExitStack
from dataclasses import dataclass
from itertools import takewhile
from pathlib import Path
from tempfile import TemporaryDirectory

from bouncing_ball.compare.folders import ComparisonError, artifacts_in, compare_folders
from bouncing_ball.compare.outcome import Outcome
from bouncing_ball.compare.report_terminal import to_terminal
from bouncing_ball.compare.tolerance_file import read_tolerances
from bouncing_ball.datasets.atomic import replacing
from bouncing_ball.record.proof import RefusedError, check_made, check_versions
from bouncing_ball.record.provenance import LOCK, Provenance, file_digest
from bouncing_ball.record.recipe import Recipe, Run
from bouncing_ball.record.revision import Revision

LOG = "accepted.csv"
COLUMNS = ("number", "commit", "reason", "changes")
MOVED = "moved"
"""In place of the names of artifacts: all that have moved."""
ALL = "all"
"""In place of the names of artifacts: all, within their budgets or not."""
_BETWEEN = "|"


def check_reason(reason: str) -> None:
    """Raise :class:`RefusedError` without a reason, one line, to write into the log."""
    if not reason.strip():
        raise RefusedError("say why the record changes: make accept REASON='…'")
    if not reason.isprintable():
        raise RefusedError("the reason is one line of text")


def groups(only: str, reason: str) -> list[tuple[list[str], str]]:
    """Names of artifacts and their reason, group by group.

    Raises
    ------
    RefusedError
        If there are not as many reasons as groups, or one of them is none.

    Examples
    --------
    >>> groups("fig08, table1 | fig05", "a finer step | another root")
    [(['fig08', 'table1'], 'a finer step'), (['fig05'], 'another root')]
    >>> groups("fig08", "one | reason")
    [(['fig08'], 'one | reason')]
    """
    named = [part.replace(",", " ").split() for part in only.split(_BETWEEN)]
    reasons = reason.split(_BETWEEN) if len(named) > 1 else [reason]
    for each in reasons:
        check_reason(each)
    if len(named) != len(reasons):
        raise RefusedError(
            f"ONLY has {len(named)} groups and REASON has {len(reasons)}: "
            f"give one reason for each, with {_BETWEEN} between them"
        )
    if len(named) > 1 and not all(named):
        raise RefusedError("a group in ONLY is empty")
    return list(zip(named, (each.strip() for each in reasons), strict=True))


def check_tree(now: Revision) -> None:
    """Raise :class:`RefusedError` unless a commit, and nothing else, is checked out."""
    if now.commit == "unknown":
        raise RefusedError("no git repository with a commit here: the record must be in git")
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


def behind(name: str, reads: Mapping[str, Collection[str]]) -> set[str]:
    """All that an artifact is made from, straight or not.

    Examples
    --------
    >>> sorted(behind("paper", {"paper": ["claims"], "claims": ["evidence"]}))
    ['claims', 'evidence']
    """
    found: set[str] = set()
    new = set(reads.get(name, ()))
    while new:
        found |= new
        new = {more for each in new for more in reads.get(each, ())} - found
    return found


def followers(
    names: Collection[str], outcomes: Mapping[str, Outcome], reads: Mapping[str, Collection[str]]
) -> set[str]:
    """What is made from some artifacts and differs at all.

    Examples
    --------
    >>> outcomes = dict.fromkeys(["fig08", "paper", "fig05"], Outcome.WITHIN)
    >>> followers({"fig08"}, outcomes, {"paper": ["fig05", "fig08"]})
    {'paper'}
    """
    return {
        name
        for name, outcome in outcomes.items()
        if outcome is not Outcome.IDENTICAL and not behind(name, reads).isdisjoint(names)
    }


def _named(
    asked: Sequence[str], outcomes: Mapping[str, Outcome], reads: Mapping[str, Collection[str]]
) -> set[str]:
    """The artifacts of a group, or what it says in place of their names."""
    differ = {name for name, outcome in outcomes.items() if not outcome.agrees}
    if list(asked) == [ALL]:
        return set(outcomes)
    if list(asked) == [MOVED]:
        return differ
    if unknown := set(asked) - outcomes.keys():
        raise RefusedError(f"unknown artifact {', '.join(sorted(unknown))}")
    if asked:
        return set(asked)
    own = sorted(differ - followers(differ, outcomes, reads))
    # In a first record there is nothing to look at.
    if len(own) > 1 and set(outcomes.values()) != {Outcome.EXTRA}:
        raise RefusedError(
            f"{len(own)} artifacts have moved: {', '.join(own)}; look at each and name it with "
            f"its reason: ONLY='{own[0]} {_BETWEEN} {own[1]}' REASON='… {_BETWEEN} …', "
            f"or all of them with one: ONLY={MOVED}"
        )
    return differ


def _left_out(
    name: str,
    names: Collection[str],
    outcomes: Mapping[str, Outcome],
    reads: Mapping[str, Collection[str]],
) -> list[str]:
    """What an artifact is made from that has moved and is not among some names."""
    missed = behind(name, reads) - set(names)
    return sorted(each for each in missed if each in outcomes and not outcomes[each].agrees)


def chosen(
    outcomes: Mapping[str, Outcome],
    reads: Mapping[str, Collection[str]],
    asked: Sequence[Sequence[str]],
) -> list[set[str]]:
    """For each group of names, the artifacts to be copied: these, and what follows them.

    What follows artifacts of several groups is among the last of them.

    Raises
    ------
    RefusedError
        If a name is unknown or in two groups; if nothing is named and several
        artifacts have moved, each by itself; or if what would be copied is made
        from something that has moved and would not.

    Examples
    --------
    >>> outcomes = {"fig05": Outcome.DRIFTED, "fig08": Outcome.DRIFTED, "paper": Outcome.WITHIN}
    >>> reads = {"paper": ["fig05", "fig08"]}
    >>> [sorted(group) for group in chosen(outcomes, reads, [["fig08"], ["fig05"]])]
    [['fig08'], ['fig05', 'paper']]
    >>> chosen(outcomes, reads, [["fig08"]])
    Traceback (most recent call last):
    ...
    bouncing_ball.record.proof.RefusedError: paper is made from fig05 too, which moved: name fig05
    """
    found = [_named(names, outcomes, reads) for names in asked]
    named: set[str] = set()
    for names in found:
        if twice := sorted(named & names):
            raise RefusedError(f"{twice[0]} is named twice")
        named |= names
    following = followers(named, outcomes, reads) - named
    for name in sorted(named | following):
        if left := _left_out(name, named | following, outcomes, reads):
            raise RefusedError(
                f"{name} is made from {', '.join(left)} too, which moved: name {' '.join(left)}"
            )
    for name in following:
        [names for names in found if not behind(name, reads).isdisjoint(names)][-1].add(name)
    return found


@dataclass(frozen=True)
class Entry:
    """An entry of the log: for what, and which artifacts it names."""

    commit: str
    reason: str
    names: frozenset[str]


def entries(text: str) -> list[Entry]:
    """All entries of a log.

    Examples
    --------
    >>> entries(log_with("", "1f0e", "Eq. 8, exact", {"fig03": "drifted"}))
    [Entry(commit='1f0e', reason='Eq. 8, exact', names=frozenset({'fig03'}))]
    """
    return [
        Entry(commit, reason, frozenset(part.split()[0] for part in changes.split("; ")))
        for _, commit, reason, changes in list(csv.reader(io.StringIO(text)))[1:]
    ]


def log_with(text: str, commit: str, reason: str, changes: Mapping[str, str]) -> str:
    """The log with one entry more.

    Examples
    --------
    >>> print(log_with("", "1f0e", "Eq. 8, exact", {"fig03": "drifted"}), end="")
    number,commit,reason,changes
    1,1f0e,"Eq. 8, exact",fig03 drifted
    """
    rows = list(csv.reader(io.StringIO(text))) or [list(COLUMNS)]
    out = io.StringIO()
    writer = csv.writer(out, lineterminator="\n")
    writer.writerows([*rows, [len(rows), commit, reason.strip(), _said(changes)]])
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


def begun(record: Path, log: str, commit: str, reasons: Collection[str]) -> frozenset[str]:
    """What an acceptance of this commit for these reasons, killed on its way, was to copy."""
    if not halfway(record) | halfway(record / "figures"):
        return frozenset()
    last = takewhile(
        lambda entry: entry.commit == commit and entry.reason in reasons, reversed(entries(log))
    )
    return frozenset().union(*(entry.names for entry in last))


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


def check_again(
    results: Path, copied: Iterable[str], make_again: Callable[[str, Path, Path], None]
) -> None:
    """Raise :class:`RefusedError` if a file is not what its dataset gives once more."""
    with TemporaryDirectory() as folder:
        for name in sorted({Path(file).stem for file in copied}):
            make_again(name, results, Path(folder))
        for file in copied:
            again = Path(folder, Path(file).name)
            if again.exists() and not _same(again, results / file):
                raise RefusedError(
                    f"{file} is not what its dataset gives; make again: "
                    f"snakemake --cores 2 --force {(results / file).as_posix()}"
                )


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


def _said(changes: Mapping[str, str]) -> str:
    return "; ".join(f"{name} {change}" for name, change in sorted(changes.items()))


def accept(
    run: Run,
    results: Path,
    recipes: Sequence[Recipe],
    files: Sequence[str],
    reason: str,
    only: str,
    make_again: Callable[[str, Path, Path], None],
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
    only : str
        Names of artifacts, ``moved`` or ``all``; nothing for the one that has moved.
        Groups with ``|`` between them have as many reasons, and entries of the log.
    make_again : callable
        Makes what it can of an artifact once more: from its name and the results, in
        a folder (:func:`bouncing_ball.pipeline.again.make_again`).

    Raises
    ------
    RefusedError
        If there is no reason, the tree is dirty or unknown, a result is not what
        the commit makes (:func:`~bouncing_ball.record.proof.check_made`), what is
        asked for does not go together (:func:`chosen`), or a file is not what its
        dataset gives (:func:`check_again`).
        Nothing is changed then.
    """
    wanted = groups(only, reason)
    check(run, results, recipes, files)
    record, commit = run.repository, run.now.commit
    outcomes = compare(record, results)
    log = (record / LOG).read_text(encoding="utf-8") if (record / LOG).is_file() else ""
    started = begun(record, log, commit, [why for _, why in wanted])
    # What was removed before the end is gone on both sides.
    outcomes |= dict.fromkeys(started - outcomes.keys(), Outcome.IDENTICAL)
    parts = chosen(outcomes, made_from(recipes), [asked for asked, _ in wanted])
    names = started.union(*parts)
    copied = [
        file
        for file in files
        if Path(file).stem in names and not _same(results / file, record / file)
    ]
    check_again(results, copied, make_again)
    # What is not an artifact any longer cannot be named.
    removed = [
        path
        for path in stale(record / "figures", [record / file for file in files])
        if path.stem in names or path.stem not in outcomes
    ]
    changes = dict.fromkeys((path.stem for path in removed), "removed")
    changes |= {Path(file).stem: _change(outcomes[Path(file).stem]) for file in copied}
    if not changes:
        print("Nothing to accept: the record says what the results say.")
        return ["nothing to accept"]
    parts[-1] |= changes.keys() - outcomes.keys()
    for part, (_, why) in zip(parts, wanted, strict=True):
        moved = {name: change for name, change in changes.items() if name in part}
        if moved and not changes.keys() <= started:
            log = log_with(log, commit, why, moved)
        if moved:
            print(f"Accepted {_said(moved)}; reason: {why}", flush=True)
    return replace_record(record, results, copied, removed, log)
