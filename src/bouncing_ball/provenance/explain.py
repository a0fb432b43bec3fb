"""``bouncing-ball explain FILE``: what an artifact is made from, and how to make it again."""

import json
import shlex
from collections.abc import Mapping
from dataclasses import astuple
from pathlib import Path
from typing import Any

import numpy as np

import bouncing_ball
from bouncing_ball.errors import printable
from bouncing_ball.provenance.origin import (
    CARRIERS,
    PREFIX,
    Provenance,
    ProvenanceError,
    read_attributes,
    read_provenance,
    versions,
)
from bouncing_ball.provenance.revision import UNKNOWN, checkout, revision

_SEVERAL = "several"
# Ignored by git, so that it does not mark the next run as dirty.
_CHANGED = "results/configuration.json"


def _carriers(path: Path) -> list[Path]:
    """The files that carry the provenance of an artifact: itself, or its datasets."""
    if not path.is_file():
        why = "a folder" if path.is_dir() else "no such file"
        raise ProvenanceError(f"{path} cannot be read: {why}")
    if path.suffix in CARRIERS:
        return [path]
    wanted = "figures/*.nc" if path.name == "paper.md" else f"{path.stem}.nc"
    found = sorted(path.parent.glob(wanted))
    if not found:
        raise ProvenanceError(
            f"{path} is not an artifact of this workflow: there is no {wanted} next to it"
        )
    return found


def _common(all_of: list[Provenance]) -> Provenance:
    """What several artifacts agree on; "several" for the rest."""
    parts = zip(*map(astuple, all_of), strict=True)
    return Provenance(*(values[0] if len({*values}) == 1 else _SEVERAL for values in parts))


def _parsed(text: str) -> Any:
    """JSON from an artifact; nothing where several artifacts differ."""
    return {} if text == _SEVERAL else json.loads(text)


def flattened(mapping: Mapping[str, Any], prefix: str = "") -> dict[str, Any]:
    """Nested values by their keys in full.

    Examples
    --------
    >>> flattened({"release": "force", "figures": {"fig11": {"restitution": 0.7}}})
    {'release': 'force', 'figures.fig11.restitution': 0.7}
    """
    found: dict[str, Any] = {}
    for key, value in mapping.items():
        nested = isinstance(value, Mapping)
        found |= flattened(value, f"{prefix}{key}.") if nested else {f"{prefix}{key}": value}
    return found


def _parameters(path: Path, made: Provenance) -> dict[str, Any]:
    """The parameters, from the artifact's dataset if it is beside it and of the same commit."""
    beside = path.with_suffix(".nc")
    attributes = read_attributes(beside) if beside.is_file() else {}
    if attributes.get(PREFIX + "commit") != made.commit:
        return {}
    return {
        name: np.asarray(value).tolist()
        for name, value in attributes.items()
        if not name.startswith((PREFIX, "title", "references", "history", "Conventions"))
    }


def _commands(made: Provenance, target: str, checked_out: bool | None) -> list[str]:
    """What makes a file again, to be pasted into a shell."""
    # Asked for by its name, a file that is up to date would not be made again.
    make = f"snakemake --cores 2 --force {shlex.quote(target)}"
    commands = [make]
    if changed := _parsed(made.configuration):
        text = shlex.quote(json.dumps(changed))
        write = f"mkdir -p results && printf '%s\\n' {text} > {_CHANGED}"
        commands = [write, f"{make} --configfile {_CHANGED}"]
    if checked_out or made.commit in ("unknown", _SEVERAL):
        return commands
    return [f"git checkout {shlex.quote(made.commit)}", "make setup", *commands]


def explain(file: Path, /) -> dict[str, Any]:
    """What an artifact is made from, as plain values.

    Parameters
    ----------
    file
        An artifact, or a copy of one.

    Raises
    ------
    ProvenanceError
        If the file is not one of this workflow, or carries no provenance.
    """
    made = _common([read_provenance(carrier) for carrier in _carriers(file)])
    repository = checkout(Path.cwd(), Path(bouncing_ball.__file__).resolve())
    now = revision(repository) if repository else UNKNOWN
    checked_out = None if "unknown" in (made.commit, now.commit) else made.commit == now.commit
    target = made.target
    if file.suffix not in CARRIERS:
        target = f"results/{'' if file.name == 'paper.md' else 'figures/'}{file.name}"
    return {
        "file": str(file),
        "commit": made.commit,
        "checked_out": checked_out,
        "dirty": made.dirty,
        "configuration": flattened(_parsed(made.configuration)),
        "parameters": _parameters(file, made),
        "inputs": list(_parsed(made.inputs)),
        "versions": {
            name: {"made_with": version, "running": versions().get(name)}
            for name, version in _parsed(made.versions).items()
        },
        "make_again": _commands(made, target, checked_out),
    }


def lines(answer: Mapping[str, Any]) -> list[str]:
    """The answer of :func:`explain` as a readable table."""
    here = {None: "", True: " (checked out)", False: " (not checked out)"}
    tree = {"no": "clean", "yes": "dirty: the commit alone does not give this file"}
    changed = answer["configuration"]
    rows = {
        "file": answer["file"],
        "commit": answer["commit"] + here[answer["checked_out"]],
        "tree": tree.get(answer["dirty"], answer["dirty"]),
        "configuration": "config/config.yaml" + (" with other values:" if changed else ""),
        **{f"  {name}": json.dumps(value) for name, value in changed.items()},
        **{f"parameter {name}": value for name, value in answer["parameters"].items()},
        "inputs": ", ".join(answer["inputs"]),
    }
    for name, item in answer["versions"].items():
        made, running = item["made_with"], item["running"]
        rows[f"version of {name}"] = made if made == running else f"{made}, now {running}"
    rows["make it again"] = " && ".join(answer["make_again"])
    # The content of a file moves no cursor; paths and commands must stay whole.
    whole = ("inputs", "make it again")
    width = max(30, *map(len, rows)) + 2
    return [
        f"{printable(name):<{width}}{printable(value, None if name in whole else 300)}"
        for name, value in rows.items()
    ]
