"""``bouncing-ball explain FILE``: the origin of an artifact, and the commands that make it
again.
"""

import json
import shlex
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

import bouncing_ball
from bouncing_ball.errors import ModelError, printable
from bouncing_ball.provenance.origin import (
    CARRIERS,
    PREFIX,
    RECORD,
    UNKNOWN,
    checkout,
    read_attributes,
    read_provenance,
    revision,
    versions,
)

# Git ignores this file, so that it does not mark the next run as dirty.
_CHANGED = "results/configuration.json"


def _carrier(path: Path) -> Path:
    """The file that carries the provenance of an artifact: the artifact itself, or its dataset.

    For the article and the supplement it is the dataset of the claims, the last dataset of a run.
    """
    if not path.is_file():
        raise ModelError(f"{path} cannot be read: no such file")
    if path.suffix in CARRIERS:
        return path
    dataset = Path("figures/claims.nc" if path.name in RECORD else f"{path.stem}.nc")
    if not (path.parent / dataset).is_file():
        why = f"there is no {dataset} next to it"
        raise ModelError(f"{path} is not an artifact of this workflow: {why}")
    return path.parent / dataset


def _parameters(path: Path, commit: str) -> dict[str, Any]:
    """The parameters, from the dataset beside the artifact if it has the same commit."""
    beside = path.with_suffix(".nc")
    attributes = read_attributes(beside) if beside.is_file() else {}
    if attributes.get(PREFIX + "commit") != commit:
        return {}
    return {
        name: np.asarray(value).tolist()
        for name, value in attributes.items()
        if not name.startswith((PREFIX, "title", "references", "history", "Conventions"))
    }


def _commands(made: Mapping[str, Any], target: str, checked_out: bool | None) -> list[str]:
    """The commands that make a file again, ready to paste into a shell."""
    # --force, because Snakemake does not make a file again that is up to date.
    force = "snakemake --cores 2 --force"
    commands = [target if target.startswith("make ") else f"{force} {shlex.quote(target)}"]
    if changed := made["configuration"]:
        text = shlex.quote(json.dumps(changed))
        commands = [
            f"mkdir -p results && printf '%s\\n' {text} > {_CHANGED}",
            f"{commands[0]} --configfile {_CHANGED}",
        ]
    if checked_out or made["commit"] == "unknown":
        return commands
    return [f"git checkout {shlex.quote(made['commit'])}", "make setup", *commands]


def explain(file: Path, /) -> dict[str, Any]:
    """What an artifact is made from, as plain values.

    Parameters
    ----------
    file
        An artifact, or a copy of one.

    Raises
    ------
    ModelError
        If the file is not one of this workflow, or carries no provenance.
    """
    made = read_provenance(_carrier(file))
    repository = checkout(Path.cwd(), Path(bouncing_ball.__file__).resolve())
    now = revision(repository) if repository else UNKNOWN
    unknown = "unknown" in (made["commit"], now.commit)
    checked_out = None if unknown else made["commit"] == now.commit
    target = made["target"]
    if file.suffix not in CARRIERS:
        target = f"results/{'' if file.name in RECORD else 'figures/'}{file.name}"
    running = versions().items()
    return {
        "file": str(file),
        "commit": made["commit"],
        "checked_out": checked_out,
        "dirty": made["dirty"],
        "configuration": made["configuration"],
        "parameters": _parameters(file, made["commit"]),
        "inputs": made["inputs"],
        "versions": made["versions"],
        "running": {name: x for name, x in running if made["versions"].get(name) != x},
        "make_again": _commands(made, target, checked_out),
    }


def lines(answer: Mapping[str, Any]) -> list[str]:
    """The answer of :func:`explain` as a readable table, line by line."""
    rows: dict[str, Any] = {}
    for name, value in answer.items():
        parts = value if isinstance(value, Mapping) else {"": value}
        title = name.replace("_", " ")
        rows |= {f"{title} {key}".strip(): part for key, part in parts.items()}
    rows["make again"] = " && ".join(answer["make_again"])
    texts = {k: x if isinstance(x, str) else json.dumps(x) for k, x in rows.items()}
    width = max(map(len, rows)) + 2
    # Texts from a file are made printable; paths and commands must not be cut off.
    return [f"{printable(name):<{width}}{printable(text, None)}" for name, text in texts.items()]
