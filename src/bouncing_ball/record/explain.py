"""``bouncing-ball explain FILE``: where an artifact comes from, and how to make it again."""

import json
from collections.abc import Iterator, Mapping
from dataclasses import fields
from pathlib import Path
from typing import Any

import bouncing_ball
from bouncing_ball.record.carriers import CARRIERS, read_attributes, read_provenance
from bouncing_ball.record.provenance import (
    PREFIX,
    Provenance,
    ProvenanceError,
    file_digest,
    lock_digest,
    versions,
)
from bouncing_ball.record.revision import UNKNOWN, checkout, revision

_KINDS = {".nc": "dataset", ".png": "picture", ".svg": "picture", ".csv": "table", ".tex": "table"}


def _carriers(path: Path) -> list[Path]:
    """The files that say where an artifact comes from: itself, or its datasets."""
    if path.suffix in CARRIERS:
        return [path]
    if path.name == "paper.md":
        found = sorted((path.parent / "figures").glob("*.nc"))
        wanted = "figures/*.nc"
    else:
        found = [path.with_suffix(".nc")] if path.with_suffix(".nc").is_file() else []
        wanted = f"{path.stem}.nc"
    if not found:
        raise ProvenanceError(f"{path} is no artifact of this workflow: no {wanted} next to it")
    return found


def _common(all_of: list[Provenance]) -> Provenance:
    """What several artifacts agree on; "several" for the rest."""
    values = {
        field.name: {getattr(one, field.name) for one in all_of} for field in fields(Provenance)
    }
    return Provenance(**{k: v.pop() if len(v) == 1 else "several" for k, v in values.items()})


def _mapping(text: str) -> dict[str, str]:
    return json.loads(text) if text.startswith("{") else {}


def _places(path: Path, recorded: str, repository: Path | None) -> Iterator[Path]:
    """Where an input may be: next to the artifact, or at its path in the checkout."""
    yield path.parent / Path(recorded).name
    if repository:
        yield repository / recorded


def _inputs(path: Path, made: Provenance, repository: Path | None) -> list[dict[str, str]]:
    answer = []
    for recorded, checksum in _mapping(made.inputs).items():
        found = [file for file in _places(path, recorded, repository) if file.is_file()]
        if not found:
            state = "not found"
        else:
            state = "unchanged" if file_digest(found[0]) == checksum else "changed"
        answer.append({"path": recorded, "sha256": checksum, "state": state})
    return answer


def _plain(value: Any) -> Any:
    return value.tolist() if hasattr(value, "tolist") else value


def _parameters(path: Path, made: Provenance, repository: Path | None) -> dict[str, Any]:
    """The parameters, from the artifact's dataset where that is at hand."""
    places = [path.with_suffix(".nc")]
    for recorded in _mapping(made.inputs):
        places += _places(path, recorded, repository)
    for place in places:
        if place.suffix == ".nc" and place.is_file():
            attributes = read_attributes(place)
            if attributes.get(PREFIX + "parameters") == made.parameters:
                return {
                    name: _plain(value)
                    for name, value in attributes.items()
                    if not name.startswith(PREFIX) and name not in ("title", "references")
                }
    return {}


def _commands(made: Provenance, target: str, checked_out: bool | None) -> list[str]:
    # Asked for by its name, a file that is up to date would not be made again.
    make = f"snakemake --cores 2 --force {target}"
    if checked_out or made.commit in ("unknown", "several"):
        return [make]
    return [f"git checkout {made.commit}", "make setup", make]


def explain(path: Path) -> dict[str, Any]:
    """Where an artifact comes from.

    Raises
    ------
    ProvenanceError
        If the file is not one of this workflow, or says nothing of it.
    """
    if not path.is_file():
        why = "a folder" if path.is_dir() else "no such file"
        raise ProvenanceError(f"{path} cannot be read: {why}")
    carriers = _carriers(path)
    made = _common([read_provenance(carrier) for carrier in carriers])
    repository = checkout(Path.cwd(), Path(bouncing_ball.__file__).resolve())
    now = revision(repository) if repository else UNKNOWN
    known = made.commit != "unknown" and now.commit != "unknown"
    checked_out = made.commit == now.commit if known else None
    lock = lock_digest(repository) if repository else "unknown"
    running = versions()
    whole = f"results/figures/{path.name}" if path.suffix != ".md" else path.stem
    target = made.target if carriers == [path] else whole
    return {
        "file": str(path),
        "artifact": f"{Path(target).stem}, a {_KINDS.get(path.suffix, 'text')}",
        "told_by": str(carriers[0]) if len(carriers) == 1 else f"{len(carriers)} datasets",
        "commit": made.commit,
        "checked_out": checked_out,
        "dirty": made.dirty,
        "parameters": {"sha256": made.parameters, "values": _parameters(path, made, repository)},
        "sources": made.sources,
        "lock": {
            "sha256": made.lock,
            "unchanged": made.lock == lock if "unknown" not in (made.lock, lock) else None,
        },
        "inputs": _inputs(path, made, repository),
        "versions": {
            name: {"made_with": version, "running": running.get(name)}
            for name, version in _mapping(made.versions).items()
        },
        "make_again": _commands(made, target, checked_out),
    }


def _checksum(value: str) -> str:
    """A checksum, short enough to be read."""
    return f"sha256 {value[:12]}" if len(value) == 64 else value


def _said(answer: bool | None, yes: str, no: str) -> str:
    return "" if answer is None else f" ({yes})" if answer else f" ({no})"


def lines(answer: Mapping[str, Any]) -> list[str]:
    """The answer of :func:`explain` as a readable table."""
    tree = {"no": "clean", "yes": "dirty: the commit alone does not give this file"}
    rows = [
        ("file", answer["file"]),
        ("artifact", answer["artifact"]),
        ("told by", answer["told_by"]),
        (
            "commit",
            answer["commit"] + _said(answer["checked_out"], "checked out", "not checked out"),
        ),
        ("tree", tree.get(answer["dirty"], answer["dirty"])),
        ("parameters", _checksum(answer["parameters"]["sha256"])),
        *((f"  {name}", value) for name, value in answer["parameters"]["values"].items()),
        ("sources", _checksum(answer["sources"])),
        (
            "lock file",
            _checksum(answer["lock"]["sha256"])
            + _said(answer["lock"]["unchanged"], "the one checked out", "not the one checked out"),
        ),
        *(
            (f"input {item['path']}", f"{_checksum(item['sha256'])} ({item['state']})")
            for item in answer["inputs"]
        ),
        *(
            (
                f"version of {name}",
                item["made_with"]
                + _said(
                    item["made_with"] == item["running"], "running", f"running: {item['running']}"
                ),
            )
            for name, item in answer["versions"].items()
        ),
        ("make it again", " && ".join(answer["make_again"])),
    ]
    width = max(32, max(len(name) for name, _ in rows) + 2)
    return [f"{name:<{width}}{value}" for name, value in rows]
