"""Make results the reference: a plan, and its writer."""

import json
from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from tempfile import TemporaryDirectory

import xarray as xr

from paper_replication.compare import Report, compare, other_versions
from paper_replication.datasets import Project, to_netcdf, write
from paper_replication.judgements import raised
from paper_replication.provenance import blob, contents_in, git, relative, tree, uncommitted
from paper_replication.runs import ACCEPTED, LEFT, Checkout, configuration, run_in

BEGUN = "figures/.accepted.part.json"
"""While an acceptance writes: the hashes of its files, before and after. Git ignores this file."""


@dataclass(frozen=True)
class Plan:
    """What an acceptance writes, decided before it writes the first file.

    Attributes
    ----------
    contents
        The new contents of each file of the reference that changes; none if it is removed.
    hashes
        Before and after: those of the file that is there, and of the one that will be.
    record
        The new record of the reference, if it changes.
    """

    contents: Mapping[str, bytes | None]
    hashes: Mapping[str, Sequence[str]]
    record: bytes | None


def accept(project: Project, results: Path, inputs: Iterable[str]) -> list[str]:
    """Make results the reference, and return the files that were written or removed.

    `inputs` are the files that the rules make, in the folder of the results. Each file is written
    atomically, and the record last: an acceptance that was interrupted can be repeated. Raises
    ValueError if a result may not be accepted, or if a file of the reference would be lost.
    """
    plan = planned(project, results, inputs)
    begun = project.top / BEGUN
    if plan.contents:
        write(begun, json.dumps(plan.hashes).encode())
    for file, contents in plan.contents.items():
        if contents is None:
            (project.top / file).unlink(missing_ok=True)
        else:
            write(project.top / file, contents)
    if plan.record:
        write(project.top / ACCEPTED, plan.record)
    begun.unlink(missing_ok=True)
    return [*plan.contents]


def planned(project: Project, results: Path, inputs: Iterable[str]) -> Plan:
    """What `accept` has to write.

    If one file of a figure or a table is written, all files of its dataset are: then the reference
    agrees on processors that round numbers differently. If all agree, the numbers and the pictures
    stay as they are, datasets get the attributes of today, which name their code, and the code and
    the libraries that gave them again are noted. Files that no rule makes any
    more are removed if git tracks them and the record of the reference names them.
    """
    # Read before git says that it is committed, and before results are compared with it.
    committed = tree(project.checkout, "HEAD", "--", *project.code)
    code = contents_in(project.checkout, committed)
    made = [relative(results, file) for file in inputs]
    report = compare(
        project,
        run_in(project.top, "the reference"),
        run_in(results, "the results"),
        Checkout(project, {}, configuration(project), made),
    )
    for reason in refusals(project, report, made, committed):
        raise ValueError(f"nothing is accepted, {reason}")
    accepted = {file: report.sides[file] for file in report.findings if file in made}
    changed = {
        new.shows
        for file, (_, new) in accepted.items()
        if report.findings[file].verdict != "agrees"
    }
    after = {
        file: new.hash
        for file, (old, new) in accepted.items()
        if new.shows in changed and old.hash != new.hash
    }
    contents: dict[str, bytes | None] = {file: (results / file).read_bytes() for file in after}
    for file, (old, new) in accepted.items():
        if isinstance(new.contents, xr.Dataset) and new.shows not in changed:
            today = renewed(old.contents, new.contents)
            if today and blob(today) != old.hash:
                contents[file] = today
                after[file] = blob(today)
    removed = [
        file
        for file in report.old.records
        if file not in made and git(project.checkout, "ls-files", str(project.top / file))
    ]
    hashes = states(project, report, [*after, *removed], after)
    text = report.new.records[project.texts[0]]
    record = {
        "made": {file: after.get(file, old.hash) for file, (old, _) in accepted.items()},
        "code": code,
        "versions": text["versions"],
        "entries": text["entries"],
    }
    # Another Python alone is not noted.
    then = next(iter(report.old.records.values()), {})
    python = {"python": then.get("versions", {}).get("python")}
    now = record | {"versions": record["versions"] | python}
    is_new = any(then.get(key) != now[key] for key in now)
    noted = f"{json.dumps(record, indent=0)}\n".encode() if is_new else None
    return Plan(contents | dict.fromkeys(removed), hashes, noted)


def renewed(old: xr.Dataset, new: xr.Dataset) -> bytes | None:
    """The numbers of a dataset with the attributes of another one, in which they agree; none if it
    has them. What computed the numbers stays.
    """
    kept = old.attrs.keys() & {"computed_on", "versions"}
    attributes = new.attrs | {name: old.attrs[name] for name in kept}
    if old.attrs == attributes:
        return None
    with TemporaryDirectory() as folder:
        path = Path(folder, "renewed.nc")
        to_netcdf(old.drop_encoding().assign_attrs(attributes), path)
        return path.read_bytes()


def states(
    project: Project, report: Report, files: Collection[str], after: Mapping[str, str]
) -> dict[str, list[str]]:
    """The hashes of files of the reference before and after they change, and those of files that an
    interrupted acceptance was about to change.

    Raises ValueError if a file would be lost: git does not have it, and no acceptance wrote it.
    """
    begun = project.top / BEGUN
    interrupted = json.loads(begun.read_bytes()) if begun.exists() else {}
    head = tree(project.top, "HEAD")
    before = contents_in(project.top, files)
    lost = []
    for file, git_hash in before.items():
        recorded = report.old.records.get(file, {}).get("made", {}).get(file)
        if git_hash not in {head.get(file), recorded, after.get(file), *interrupted.get(file, [])}:
            lost.append(file)
    if edited := " ".join(file for file in lost if file in head):
        stash = f"move the edit to a template, or keep it by `git stash -- {edited}`"
        raise ValueError(f"nothing is accepted, edited by hand: {edited}: {stash}")
    if lost:
        raise ValueError(f"nothing is accepted, not made by a rule, move it: {' '.join(lost)}")
    now = {file: [hashes[file] for hashes in (before, after) if file in hashes] for file in files}
    return interrupted | now


def refusals(
    project: Project, report: Report, made: Collection[str], committed: Mapping[str, str]
) -> Iterator[str]:
    """Yield why results may not be accepted: the code is not committed, a claim's function raised
    an exception, a result is not fresh and as recorded, or it was made with other versions of
    libraries.

    Stop at the first: the later ones read records that exist only if no result is wrong.
    """
    if edited := uncommitted(project.checkout, *project.code):
        yield f"commit first: {', '.join(edited)}"
    wrong = [
        f"{kind}: {', '.join(details)}"
        for file, (_, new) in report.sides.items()
        if file in made or LEFT in new.wrong
        for kind, details in new.wrong.items()
    ]
    if wrong:
        yield f"run again or remove first: {'; '.join(dict.fromkeys(wrong))}"
    contents = [new.contents for _, new in report.sides.values()]
    datasets = [data for data in contents if isinstance(data, xr.Dataset)]
    if slips := [line for data in datasets for line in raised(data)]:
        yield f"correct first: {'; '.join(slips)}"
    records = [report.new.records[file] for file in report.findings if file in made]
    if unknown := {file for record in records for file in record["code"]} - committed.keys():
        yield f"commit first: git does not know {min(unknown)}"
    yield from other_versions(report)
