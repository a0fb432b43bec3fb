"""``bouncing-ball explain FILE``: where an artifact comes from, and how to make it again."""

import hashlib
import json
import math
import os
import shlex
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
    flattened,
    lock_digest,
    read_mapping,
    versions,
)
from bouncing_ball.record.reading import UnreadableError, printable, read_file, reason
from bouncing_ball.record.revision import UNKNOWN, checkout, revision

_KINDS = {
    ".nc": "dataset",
    ".png": "picture",
    ".svg": "picture",
    ".csv": "table",
    ".tex": "table",
    ".html": "page",
}
_SEVERAL = "several"
# Ignored by git, so that it does not mark the next run as dirty.
_CHANGED = "results/configuration.json"


def _check_file(path: Path) -> None:
    try:
        os.stat(path)
        why = "a folder" if path.is_dir() else ""
    except OSError as error:
        why = "no such file" if isinstance(error, FileNotFoundError) else reason(error)
    if why:
        raise ProvenanceError(f"{printable(path)} cannot be read: {why}")


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
        raise ProvenanceError(
            f"{printable(path)} is not an artifact of this workflow: "
            f"there is no {printable(wanted)} next to it"
        )
    return found


def _common(all_of: list[Provenance]) -> Provenance:
    """What several artifacts agree on; "several" for the rest."""
    values = {
        field.name: {getattr(one, field.name) for one in all_of} for field in fields(Provenance)
    }
    return Provenance(**{k: v.pop() if len(v) == 1 else _SEVERAL for k, v in values.items()})


def _mapping(text: str) -> dict[str, Any]:
    return {} if text == _SEVERAL else read_mapping(text)


def _places(path: Path, recorded: str, repository: Path | None) -> Iterator[tuple[Path, str]]:
    """Where an input may be: next to the artifact, or at its path in the checkout."""
    yield path.parent, Path(recorded).name
    if repository:
        yield repository, recorded


def _state(path: Path, recorded: str, checksum: str, repository: Path | None) -> str:
    for folder, name in _places(path, recorded, repository):
        try:
            content = read_file(folder, name)
        except UnreadableError:
            continue
        return "unchanged" if hashlib.sha256(content).hexdigest() == checksum else "changed"
    return "not found"


def _inputs(path: Path, made: Provenance, repository: Path | None) -> list[dict[str, str]]:
    return [
        {
            "path": recorded,
            "sha256": checksum,
            "state": _state(path, recorded, checksum, repository),
        }
        for recorded, checksum in _mapping(made.inputs).items()
    ]


def _plain(value: Any) -> Any:
    """A value of an attribute as JSON has it; what JSON has not, as text."""
    value = value.tolist() if hasattr(value, "tolist") else value
    if isinstance(value, list):
        return [_plain(part) for part in value]
    finite = isinstance(value, float) and math.isfinite(value)
    return value if finite or isinstance(value, int | str) else str(value)


def _parameters(path: Path, made: Provenance, repository: Path | None) -> dict[str, Any]:
    """The parameters, from the artifact's dataset where that is at hand and whole."""
    places = [path.with_suffix(".nc")]
    for recorded in _mapping(made.inputs):
        places += [folder / name for folder, name in _places(path, recorded, repository)]
    for place in places:
        try:
            attributes = read_attributes(place)
        except ProvenanceError:
            continue
        if attributes.get(PREFIX + "parameters") == made.parameters:
            return {
                name: _plain(value)
                for name, value in attributes.items()
                if not name.startswith(PREFIX) and name not in ("title", "references")
            }
    return {}


def _commands(made: Provenance, target: str, checked_out: bool | None) -> list[str]:
    """What makes a file again, to be pasted into a shell."""
    # Asked for by its name, a file that is up to date would not be made again.
    make = f"snakemake --cores 2 --force {shlex.quote(target)}"
    commands = [make]
    if changed := _mapping(made.configuration):
        text = shlex.quote(json.dumps(changed))
        write = f"mkdir -p results && printf '%s\\n' {text} > {_CHANGED}"
        commands = [write, f"{make} --configfile {_CHANGED}"]
    if checked_out or made.commit in ("unknown", _SEVERAL):
        return commands
    return [f"git checkout {made.commit}", "make setup", *commands]


def _target(path: Path, made: Provenance) -> str:
    """What to ask Snakemake for: the file's name in the results, or what it carries."""
    if path.suffix in CARRIERS:
        return made.target
    return f"results/{'' if path.name == 'paper.md' else 'figures/'}{path.name}"


def explain(file: Path, /) -> dict[str, Any]:
    """Where an artifact comes from; all of it plain JSON.

    The file may be anybody's, and what it holds anything. Nothing of it is
    run, and the commands are made of parts of known forms.

    Parameters
    ----------
    file
        An artifact, or a copy of one.

    Raises
    ------
    ProvenanceError
        If the file is not one of this workflow, or says nothing of it.
    """
    _check_file(file)
    carriers = _carriers(file)
    made = _common([read_provenance(carrier) for carrier in carriers])
    repository = checkout(Path.cwd(), Path(bouncing_ball.__file__).resolve())
    now = revision(repository) if repository else UNKNOWN
    known = made.commit != "unknown" and now.commit != "unknown"
    checked_out = made.commit == now.commit if known else None
    lock = lock_digest(repository) if repository else "unknown"
    running = versions()
    target = _target(file, made)
    return {
        "file": str(file),
        "artifact": f"{Path(target).stem}, a {_KINDS.get(file.suffix, 'text')}",
        "read_from": str(carriers[0]) if len(carriers) == 1 else f"{len(carriers)} datasets",
        "commit": made.commit,
        "checked_out": checked_out,
        "dirty": made.dirty,
        "configuration": flattened(_mapping(made.configuration)),
        "parameters": {"sha256": made.parameters, "values": _parameters(file, made, repository)},
        "sources": made.sources,
        "lock": {
            "sha256": made.lock,
            "unchanged": made.lock == lock if "unknown" not in (made.lock, lock) else None,
        },
        "inputs": _inputs(file, made, repository),
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
    changed = answer["configuration"]
    rows: list[tuple[str, object]] = [
        ("file", answer["file"]),
        ("artifact", answer["artifact"]),
        ("read from", answer["read_from"]),
        (
            "commit",
            answer["commit"] + _said(answer["checked_out"], "checked out", "not checked out"),
        ),
        ("tree", tree.get(answer["dirty"], answer["dirty"])),
        ("configuration", "config/config.yaml" + (" with other values:" if changed else "")),
        *((f"  {name}", json.dumps(value)) for name, value in changed.items()),
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
    ]
    # The content of a file moves no cursor; the commands are ours, and must stay whole.
    shown = [(printable(name), printable(value)) for name, value in rows]
    shown.append(("make it again", " && ".join(answer["make_again"])))
    width = max(32, max(len(name) for name, _ in shown) + 2)
    return [f"{name:<{width}}{value}" for name, value in shown]
