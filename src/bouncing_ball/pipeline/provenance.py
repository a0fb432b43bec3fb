"""The origin of an artifact, as the artifact itself records it.

A dataset holds its provenance in netCDF attributes, a PNG file in its text, an SVG file in its
description; a table or a page has the provenance of its dataset. The provenance contains neither a
time nor the name of a machine, so that two runs of one commit give the same bytes.

``bouncing-ball explain FILE``: the origin of an artifact, and the commands that make it
again.
"""

import json
import os
import shlex
import subprocess
from collections.abc import Iterable, Mapping
from pathlib import Path, PurePosixPath
from typing import Any, NamedTuple

import numpy as np

from bouncing_ball.datasets import DRAWING
from bouncing_ball.errors import ModelError
from bouncing_ball.pipeline.artifacts import CARRIERS, DATASET, RECORD, TEXTS, carrier_of
from bouncing_ball.pipeline.sources import versions
from bouncing_ball.pipeline.yaml_files import read_yaml

PREFIX = "provenance_"
"""The prefix of the attributes' names."""

CONFIGURATION = "config/config.yaml"

# Entries of the provenance that are JSON.
_NESTED = ("configuration", "inputs", "versions")
_DESCRIPTION = "{http://purl.org/dc/elements/1.1/}description"


class Revision(NamedTuple):
    """The full hash of a commit, and whether the tree was dirty (yes or no), or unknown."""

    commit: str
    dirty: str


UNKNOWN = Revision("unknown", "unknown")


def _git(folder: Path, *arguments: str) -> str | None:
    """The output of git; None if git fails or is not installed."""
    # In a hook the variables GIT_… name a repository that may not be this one.
    environment = {key: value for key, value in os.environ.items() if not key.startswith("GIT_")}
    # Without optional locks, parallel jobs do not wait for each other's lock of the index.
    command = ["git", "--no-optional-locks", "-C", str(folder), *arguments]
    try:
        done = subprocess.run(
            command, env=environment, capture_output=True, encoding="utf-8", check=True
        )
    except (OSError, subprocess.CalledProcessError):
        return None
    return done.stdout


def revision(folder: Path) -> Revision:
    """The commit checked out in a folder, and whether its tree is dirty.

    Untracked files count, unless git ignores them; the accepted record does not count.
    The result is :data:`UNKNOWN` without git, or if the folder is not the top of a repository.
    """
    # A release that was unpacked inside of another repository is not a commit of that one.
    if not (folder / ".git").exists():
        return UNKNOWN
    excluded = [f":(exclude){name}" for name in RECORD]
    commit = _git(folder, "rev-parse", "HEAD")
    changed = _git(folder, "status", "--porcelain", "--untracked-files=normal", ".", *excluded)
    if commit is None or changed is None:
        return UNKNOWN
    return Revision(commit.strip(), "yes" if changed else "no")


def checkout(*starts: Path) -> Path | None:
    """The first folder, at or above each start in turn, that holds this workflow, or None."""
    for start in starts:
        for folder in (start, *start.parents):
            if (folder / "Snakefile").is_file() and (folder / "src" / "bouncing_ball").is_dir():
                return folder
    return None


def changes(config: Mapping[str, Any], written: Mapping[str, Any]) -> dict[str, Any]:
    """The values of a configuration that differ from the written configuration, nested as there.

    Examples
    --------
    >>> written = {"release": "force", "fig11": {"restitution": 0.85, "points": 11}}
    >>> changes({"release": "force", "fig11": {"restitution": 0.7, "points": 11}}, written)
    {'fig11': {'restitution': 0.7}}
    """
    found = {}
    for key, value in config.items():
        before = written.get(key)
        if isinstance(value, Mapping) and isinstance(before, Mapping):
            if inside := changes(value, before):
                found[key] = inside
        elif key not in written or value != before:
            found[key] = value
    return found


def gather(
    target: str, inputs: Iterable[str], repository: Path, config: Mapping[str, Any]
) -> dict[str, str]:
    """The provenance of the files that a job writes, in a checkout and with a configuration.

    Returns
    -------
    dict of str
        Attributes of a dataset, or metadata of a picture: ``commit``, the full hash or unknown;
        ``dirty``, whether the tree had uncommitted changes (yes, no or unknown); ``configuration``,
        as JSON the values of the run that differ from config/config.yaml; ``target``, the file to
        request from Snakemake to make the artifact again, or a command ``make …``; ``inputs`` and
        ``versions``, as JSON the files that it is made from and the versions of Python and the
        libraries. Each name begins with :data:`PREFIX`.

    Raises
    ------
    ConfigurationError
        If config/config.yaml cannot be read.
    """
    now = revision(repository)
    written = read_yaml(repository / CONFIGURATION)
    # A run may be in any folder; files outside it are named relative to the top of the checkout.
    named = {os.path.relpath(path, repository) if ".." in path else path for path in inputs}
    made = {
        "commit": now.commit,
        "dirty": now.dirty,
        "configuration": json.dumps(changes(config, written), sort_keys=True),
        "target": target,
        "inputs": json.dumps(sorted(named)),
        "versions": json.dumps(versions()),
    }
    return {PREFIX + name: text for name, text in made.items()}


def read_attributes(path: Path) -> dict[str, Any]:
    """The attributes of a dataset, or the metadata of a picture.

    Raises
    ------
    ModelError
        If the file is of another kind, cannot be read, or is damaged.
    """
    # Imported where they are needed, because each import takes time.
    try:
        match path.suffix:
            case ".nc":
                from netCDF4 import Dataset

                with Dataset(path) as dataset:
                    return {name: dataset.getncattr(name) for name in dataset.ncattrs()}
            case ".png":
                from PIL import Image

                with Image.open(path, formats=["PNG"]) as picture:
                    return {str(name): value for name, value in picture.info.items()}
            case _:
                from xml.etree import ElementTree

                found = ElementTree.parse(path).find(f".//{_DESCRIPTION}")
                return {} if found is None else dict(json.loads(found.text or "{}"))
    # The libraries raise errors of many types on a damaged file.
    except Exception:
        raise ModelError(f"{path} cannot be read: damaged, or not ours") from None


def read_provenance(path: Path) -> dict[str, Any]:
    """The provenance of a dataset or a picture, by the names of :func:`gather` without the prefix.

    Raises
    ------
    ModelError
        If the file cannot be read, see :func:`read_attributes`, or carries no provenance.
    """
    attributes = read_attributes(path).items()
    found = {name.removeprefix(PREFIX): x for name, x in attributes if name.startswith(PREFIX)}
    if not found:
        raise ModelError(f"{path} carries no provenance")
    try:
        return found | {name: json.loads(found[name]) for name in _NESTED}
    except (KeyError, TypeError, ValueError):
        raise ModelError(f"{path}: its provenance is damaged") from None


# Git ignores this file, so that it does not mark the next run as dirty.
_CHANGED = "results/configuration.json"
TEXTUAL = ("title", "references", "history", "Conventions", DRAWING)
"""Attributes of a dataset that are no parameters."""


def parameters_of(attributes: Mapping[Any, Any]) -> dict[str, Any]:
    """The parameters among the attributes of a dataset, as plain values.

    Examples
    --------
    >>> parameters_of({"title": "Figure 14", "restitution": np.float64(0.85), "n": np.array([1])})
    {'restitution': 0.85, 'n': [1]}
    """
    return {
        str(name): np.asarray(value).tolist()
        for name, value in attributes.items()
        if not str(name).startswith((PREFIX, *TEXTUAL))
    }


def _parameters_beside(path: Path, commit: str) -> dict[str, Any]:
    """The parameters, from the dataset beside the artifact if it has the same commit."""
    dataset = path.with_suffix(DATASET)
    attributes = read_attributes(dataset) if dataset.is_file() else {}
    return parameters_of(attributes) if attributes.get(f"{PREFIX}commit") == commit else {}


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
    """The inputs from which an artifact is made, as plain values.

    Parameters
    ----------
    file
        An artifact, or a copy of one.

    Raises
    ------
    ModelError
        If the file is not one of this workflow, or carries no provenance.
    """
    made = read_provenance(carrier_of(file))
    repository = checkout(Path.cwd(), Path(__file__).resolve())
    now = revision(repository) if repository else UNKNOWN
    unknown = "unknown" in (made["commit"], now.commit)
    checked_out = None if unknown else made["commit"] == now.commit
    target = made["target"]
    if file.suffix not in CARRIERS:
        beside = PurePosixPath(target).with_name(file.name)
        target = f"results/{file.name}" if file.name in TEXTS else str(beside)
    running = versions().items()
    return {
        "file": str(file),
        "commit": made["commit"],
        "checked_out": checked_out,
        "dirty": made["dirty"],
        "configuration": made["configuration"],
        "parameters": _parameters_beside(file, made["commit"]),
        "inputs": made["inputs"],
        "versions": made["versions"],
        "running": {name: x for name, x in running if made["versions"].get(name) != x},
        "make_again": _commands(made, target, checked_out),
    }


def explanation_lines(answer: Mapping[str, Any]) -> list[str]:
    """The answer of :func:`explain` as a readable table, line by line."""
    rows: dict[str, Any] = {}
    for name, value in answer.items():
        parts = value if isinstance(value, Mapping) else {"": value}
        title = name.replace("_", " ")
        rows |= {f"{title} {key}".strip(): part for key, part in parts.items()}
    rows["make again"] = " && ".join(answer["make_again"])
    texts = {k: x if isinstance(x, str) else json.dumps(x) for k, x in rows.items()}
    width = max(map(len, rows)) + 2
    return [f"{name:<{width}}{text}" for name, text in texts.items()]
