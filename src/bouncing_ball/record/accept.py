"""The accepted record: what may replace it, how, and the log of what did.

git holds the record, ``figures/`` and ``paper.md``, laid out as the results
are, and ``accepted.csv``, in which every acceptance says why the record moved.
"""

import csv
import io
import json
import re
import shutil
from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from contextlib import ExitStack
from pathlib import Path
from typing import Any

import bouncing_ball
from bouncing_ball.datasets.atomic import replacing
from bouncing_ball.errors import ModelError
from bouncing_ball.record.carriers import CARRIERS, read_provenance
from bouncing_ball.record.diff.folders import ComparisonError, artifacts_in, compare_folders
from bouncing_ball.record.diff.outcome import Outcome
from bouncing_ball.record.diff.report_terminal import to_terminal
from bouncing_ball.record.diff.tolerance_file import read_tolerances
from bouncing_ball.record.provenance import (
    LIBRARIES,
    LOCK,
    SUM,
    Provenance,
    departure,
    file_digest,
)
from bouncing_ball.record.revision import Revision, revision

LOG = "accepted.csv"
COLUMNS = ("number", "commit", "reason", "changes")


class RefusedError(ModelError):
    """Results that must not become the record, with the reason why."""


def check_reason(reason: str) -> None:
    """Raise :class:`RefusedError` without a reason to write into the log."""
    if not reason.strip():
        raise RefusedError('say why the record changes: --config reason="…"')


def check_tree(now: Revision) -> None:
    """Raise :class:`RefusedError` unless a commit, and nothing else, is checked out.

    Results carry no word of the texts and tables; but Snakemake has just found
    them up to date, so that a clean tree now is the one they are made from.
    """
    if now.commit == "unknown":
        raise RefusedError("no git repository with a commit here, and the record is what git holds")
    if now.dirty != "no":
        raise RefusedError("the tree is dirty: commit first, and accept what that commit makes")


def check_results(made: Mapping[str, Provenance]) -> None:
    """Raise :class:`RefusedError` if a result was not made from a commit alone."""
    bad = [name for name, provenance in made.items() if provenance.dirty != "no"]
    if bad:
        more = f" and {len(bad) - 1} more" if len(bad) > 1 else ""
        raise RefusedError(
            f"{bad[0]}{more} made from a dirty or unknown tree, or with another configuration or "
            "package: make them again from the commit, snakemake --cores 2 --forceall"
        )


def check_run(record: Path, config: Mapping[str, Any]) -> None:
    """Raise :class:`RefusedError` if this run rests on more than the commit's tree."""
    reason = departure(record, config, [str(bouncing_ball.__file__)])
    if reason:
        raise RefusedError(f"{reason}: accept what the commit alone makes")


def pins(lock: str) -> dict[str, set[str]]:
    """The versions that a lock file asks for, by the names of the packages.

    Several, where they depend on the system.

    Examples
    --------
    >>> lock = ["numpy==2.4.1 ; sys_platform == 'linux'", "    --hash=sha256:1f0e", "scipy==1.17.0"]
    >>> pins("\\n".join(lock))
    {'numpy': {'2.4.1'}, 'scipy': {'1.17.0'}}
    """
    found: dict[str, set[str]] = {}
    for name, version in re.findall(r"^([\w.-]+)==([^\s;\\]+)", lock, re.MULTILINE):
        found.setdefault(name.lower(), set()).add(version)
    return found


def check_versions(made: Mapping[str, Provenance], lock: str) -> None:
    """Raise :class:`RefusedError` if a result was made with versions that are not locked."""
    pinned = pins(lock)
    for name, provenance in made.items():
        versions = json.loads(provenance.versions)
        for library in LIBRARIES:
            wanted, used = pinned.get(library.lower(), set()), versions.get(library)
            if used not in wanted:
                locked = " or ".join(sorted(wanted)) or "none"
                raise RefusedError(
                    f"{name} made with {library} {used}, {LOCK} has {locked}: make setup, then "
                    "snakemake --cores 2 --forceall"
                )


def written(logs: Path) -> dict[str, str]:
    """Checksums of what the jobs wrote, by path, from their logs."""
    found = {}
    for log in sorted(logs.rglob("*.log")):
        for line in log.read_text(encoding="utf-8").splitlines():
            start, _, rest = line.partition(" ")
            if start == SUM:
                checksum, _, path = rest.partition(" ")
                found[path] = checksum
    return found


def check_untouched(results: Path, files: Sequence[str]) -> None:
    """Raise :class:`RefusedError` if a result is not what its job wrote."""
    sums = written(results / "logs")
    for file in files:
        if sums.get((results / file).as_posix()) != file_digest(results / file):
            raise RefusedError(
                f"{results / file} is not what its job wrote: remove it, and the next run makes it "
                "again"
            )


def commits(made: Iterable[Provenance], now: Revision) -> list[str]:
    """One line for each commit that results were made from."""
    found = Counter(provenance.commit for provenance in made)
    return [
        f"{count} files made at commit {commit}"
        + ("" if commit == now.commit else ", up to date but not the one checked out")
        for commit, count in found.most_common()
    ]


def stale(folder: Path, wanted: Iterable[Path]) -> list[Path]:
    """Files of a folder that are not among the wanted ones."""
    kept = {path for path in folder.glob("*") if path.is_file()}
    return sorted(kept - set(wanted))


def log_with(text: str, commit: str, reason: str, changes: Mapping[str, str]) -> str:
    """The log with one entry more.

    Examples
    --------
    >>> print(log_with("", "1f0e", "Eq. 8, exact", {"fig03": "drifted"}), end="")
    number,commit,reason,changes
    1,1f0e,"Eq. 8, exact",fig03 drifted
    """
    rows = list(csv.reader(io.StringIO(text))) or [list(COLUMNS)]
    said = "; ".join(f"{name} {outcome}" for name, outcome in sorted(changes.items()))
    out = io.StringIO()
    writer = csv.writer(out, lineterminator="\n")
    writer.writerows([*rows, [len(rows), commit, reason.strip(), said]])
    return out.getvalue()


def replace_record(
    record: Path, results: Path, files: Sequence[str], moved: Sequence[str], log: str
) -> list[str]:
    """Copy what has moved over the record and remove what is no longer made.

    Everything is copied under temporary names first: if that fails, the record
    is as it was. A file that says the same as the record's stays, with the
    commit that it names, so that git does not grow by what has not changed.
    """
    with ExitStack() as stack:
        # Entered first, so renamed last.
        stack.enter_context(replacing(record / LOG)).write_text(log, encoding="utf-8", newline="\n")
        for file in moved:
            shutil.copyfile(results / file, stack.enter_context(replacing(record / file)))
    removed = stale(record / "figures", [record / file for file in files])
    for path in removed:
        path.unlink()
    return [*moved, *(f"removed figures/{path.name}" for path in removed)]


# In the log, what the comparison calls missing goes, and what is extra comes.
_IN_THE_LOG = {Outcome.MISSING: "removed", Outcome.EXTRA: "new"}


def show_difference(record: Path, results: Path) -> dict[str, str]:
    """Print how the results differ from the record; the artifacts that do, with outcomes.

    Files that say the same in other bytes, another commit of the provenance for
    one, do not differ.
    """
    try:
        artifacts_in(record)
    except ComparisonError:
        print("There is no record yet.")
        return {name: _IN_THE_LOG[Outcome.EXTRA] for name in artifacts_in(results)}
    rules = read_tolerances(record / "config" / "tolerances.yaml")
    comparison = compare_folders(record, results, rules)
    print(to_terminal(comparison), end="", flush=True)
    return {
        artifact.name: _IN_THE_LOG.get(artifact.outcome, str(artifact.outcome))
        for artifact in comparison.artifacts
        if artifact.outcome is not Outcome.IDENTICAL
    }


def accept(
    record: Path, results: Path, files: Sequence[str], config: Mapping[str, Any]
) -> list[str]:
    """Make the results the record; the lines of the job's log.

    ``config`` is the configuration in effect, with the reason in it.

    Raises
    ------
    RefusedError
        If there is no reason, the tree is dirty or unknown, the configuration
        or the package is not that of the tree, a result was made in such a
        state or with versions that are not locked, or is not one of the files
        that the workflow makes. Nothing is touched then.
    """
    reason = config.get("reason", "")
    check_reason(reason)
    now = revision(record)
    check_tree(now)
    check_run(record, config)
    foreign = stale(results / "figures", [results / file for file in files])
    if foreign:
        raise RefusedError(f"{foreign[0]} is not made by this workflow: remove it")
    check_untouched(results, files)
    carriers = [file for file in files if Path(file).suffix in CARRIERS]
    made = {file: read_provenance(results / file) for file in carriers}
    check_results(made)
    lock = record / LOCK
    check_versions(made, lock.read_text(encoding="utf-8") if lock.is_file() else "")
    print(*commits(made.values(), now), sep="\n")
    changes = show_difference(record, results)
    if not changes:
        print("Nothing to accept: the results are the record.")
        return ["nothing to accept"]
    log = record / LOG
    before = log.read_text(encoding="utf-8") if log.is_file() else ""
    moved = [file for file in files if Path(file).stem in changes]
    after = log_with(before, now.commit, reason, changes)
    lines = replace_record(record, results, files, moved, after)
    print(f"Accepted, reason: {reason.strip()}", flush=True)
    return lines
