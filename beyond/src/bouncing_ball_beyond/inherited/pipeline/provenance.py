"""The origin of an artifact, as the artifact itself records it.

A dataset holds its provenance in netCDF attributes, a PNG file in its text, an SVG file in its
description; a table or a page has the provenance of its dataset. The provenance contains neither a
time nor the name of a machine, so that two runs of one commit give the same bytes.

``bouncing-ball explain FILE``: the origin of an artifact, and the commands that make it
again.
"""

import json
import os
import re
import shlex
import subprocess
from collections.abc import Callable, Iterable, Mapping
from contextlib import suppress
from pathlib import Path, PurePosixPath
from typing import Any, NamedTuple

import numpy as np

from bouncing_ball_beyond.inherited.datasets import DRAWING
from bouncing_ball_beyond.inherited.datasets.files import require_readable
from bouncing_ball_beyond.inherited.errors import ModelError, printable
from bouncing_ball_beyond.inherited.pipeline.artifact_files import (
    CARRIERS,
    DATASET,
    FIGURES,
    TEXT,
    carrier_of,
    is_text,
)
from bouncing_ball_beyond.inherited.pipeline.sources import REPOSITORY, versions
from bouncing_ball_beyond.inherited.pipeline.yaml_files import read_yaml

PREFIX = "provenance_"
"""The prefix of the attributes' names."""

CONFIGURATION = "config/config.yaml"

TEXTUAL = ("title", "references", "history", "Conventions", DRAWING)
"""Attributes of a dataset that are no parameters and no provenance."""

# Entries of the provenance that are JSON, and all others.
_NESTED: dict[str, Callable[[Any], Any]] = {
    "configuration": dict,
    "inputs": lambda names: list(map(str, names)),
    "versions": dict,
}
_PLAIN = ("commit", "dirty", "target", "rule", "code")
_NO_PARAMETERS = {*TEXTUAL, *(f"{PREFIX}{name}" for name in (*_NESTED, *_PLAIN))}
_DESCRIPTION = "{http://purl.org/dc/elements/1.1/}description"
# The file in which `git archive` names the commit, in a form that other programs know, too.
_ARCHIVAL = ".git_archival.txt"
_NODE = re.compile("^node: ([0-9a-f]{40}|[0-9a-f]{64})$", re.MULTILINE)
# Git ignores this file, so that it does not mark the next run as dirty.
_CHANGED = "results/configuration.json"


class Revision(NamedTuple):
    """The full hash of a commit, and whether the tree was dirty (yes or no), or unknown."""

    commit: str
    dirty: str


UNKNOWN = Revision("unknown", "unknown")


def git(folder: Path, *arguments: str) -> str | None:
    """The output of git; None if git fails or is not installed."""
    # In a hook the variables GIT_… name a repository that may not be this one.
    environment = {key: value for key, value in os.environ.items() if not key.startswith("GIT_")}
    # Without optional locks, parallel jobs do not wait for each other's lock of the index.
    command = ["git", "--no-optional-locks", "-C", str(folder), *arguments]
    with suppress(OSError, ValueError):
        done = subprocess.run(command, env=environment, capture_output=True, encoding="utf-8")
        return None if done.returncode else done.stdout
    return None


def _tops(house: Path) -> list[Path]:
    """The folders that may be the repository or the release of a house: the house itself, and the
    checkout in which it stands.

    A release that was unpacked inside of another repository is not a commit of that one.
    """
    return [top for top in (house, REPOSITORY) if house.is_relative_to(top)]


def released(house: Path) -> Revision:
    """The commit of the release in which a house was unpacked, or :data:`UNKNOWN`.

    Nobody knows whether its files have changed since.
    """
    for top in _tops(house):
        with suppress(OSError, UnicodeDecodeError):
            if found := _NODE.search((top / _ARCHIVAL).read_text(encoding="utf-8")):
                return Revision(found[1], "unknown")
    return UNKNOWN


def revision(house: Path) -> Revision:
    """The commit of the repository of a house, and whether its tree is dirty.

    Untracked files count, unless git ignores them; the accepted record does not count.
    Without a repository it is the commit of the :func:`released` archive, and without git
    :data:`UNKNOWN`.
    """
    top = next((top for top in _tops(house) if (top / ".git").exists()), None)
    if top is None:
        return released(house)
    own = house.relative_to(top).as_posix()
    record = (f"**/{FIGURES}/**", f"[a-z]*{TEXT}", f"{own}/[a-z]*{TEXT}")
    excluded = [f":(top,exclude,glob){pattern}" for pattern in record]
    commit = git(top, "rev-parse", "HEAD")
    changed = git(top, "status", "--porcelain", "--untracked-files=normal", ".", *excluded)
    if commit is None or changed is None:
        return UNKNOWN
    return Revision(commit.strip(), "yes" if changed else "no")


def house_of(*starts: Path) -> Path | None:
    """The first folder, at or above each start in turn, that is a house, or None."""
    folders = (folder for start in starts for folder in (start, *start.parents))
    marks = ("Snakefile", CONFIGURATION)
    return next((x for x in folders if all((x / mark).is_file() for mark in marks)), None)


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
    target: str, inputs: Iterable[str], house: Path, config: Mapping[str, Any]
) -> dict[str, str]:
    """The provenance of the files that a job writes, in a house and with a configuration.

    Returns
    -------
    dict of str
        Attributes of a dataset, or metadata of a picture: ``commit``, the full hash or unknown;
        ``dirty``, whether the tree had uncommitted changes (yes, no or unknown); ``configuration``,
        as JSON the values of the run that differ from config/config.yaml; ``target``, the file to
        request from Snakemake to make the artifact again; ``inputs`` and ``versions``, as JSON the
        files that it is made from and the versions of Python and the libraries. Each name begins
        with :data:`PREFIX`.

    Raises
    ------
    ConfigurationError
        If config/config.yaml cannot be read.
    """
    now = revision(house)
    written = read_yaml(house / CONFIGURATION)
    # A run may be in any folder; files outside it are named relative to the house.
    named = {os.path.relpath(path, house) if ".." in path else path for path in inputs}
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
    require_readable(path)
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


def provenance_in(path: Path) -> dict[str, Any]:
    """The provenance in a dataset or a picture, by the names of :func:`gather` without the prefix,
    as far as the file has it; ``configuration``, ``inputs`` and ``versions`` always have a value,
    and a dataset has its ``parameters``.

    Raises
    ------
    ModelError
        If the file cannot be read, see :func:`read_attributes`, or its provenance is damaged.
    """
    attributes = read_attributes(path)
    found: dict[str, Any] = {
        name.removeprefix(PREFIX): str(value)
        for name, value in attributes.items()
        if name.startswith(PREFIX)
    }
    if path.suffix == DATASET:
        found["parameters"] = parameters_of(attributes)
    try:
        nested = {name: kind(json.loads(found.get(name, "{}"))) for name, kind in _NESTED.items()}
    except (TypeError, ValueError):
        raise ModelError(f"{path}: its provenance is damaged") from None
    return found | nested


def read_provenance(path: Path) -> dict[str, Any]:
    """The whole provenance of a dataset or a picture, see :func:`provenance_in`.

    Raises
    ------
    ModelError
        If the file cannot be read, or carries no whole provenance.
    """
    found = provenance_in(path)
    if not found.keys() >= {"commit", "dirty", "target"}:
        raise ModelError(f"{path} carries no provenance")
    return found


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
        if name not in _NO_PARAMETERS
    }


def _commands(made: Mapping[str, Any], target: str, checked_out: bool | None) -> list[str]:
    """The commands that make a file again, ready to paste into a shell."""
    # --force, because Snakemake does not make a file again that is up to date. The target is what a
    # file says, and may be anything.
    commands = [shlex.join(["snakemake", "--cores", "2", "--force", target])]
    if changed := made["configuration"]:
        text = shlex.quote(json.dumps(changed))
        commands = [
            f"mkdir -p results && printf '%s\\n' {text} > {_CHANGED}",
            f"{commands[0]} --configfile {_CHANGED}",
        ]
    if checked_out or made["commit"] == "unknown":
        return commands
    return [shlex.join(["git", "checkout", made["commit"]]), "make setup", *commands]


def explain(file: Path, /, *, house: Path | None = None) -> dict[str, Any]:
    """The inputs from which an artifact is made, as plain values.

    Parameters
    ----------
    file
        An artifact, or a copy of one.
    house
        The folder with the Snakefile that makes it. By default the one in which the file or the
        current folder is.

    Raises
    ------
    ModelError
        If the file is not one of this workflow, or carries no provenance.
    """
    made = read_provenance(carrier_of(file))
    house = house or house_of(file.absolute(), Path.cwd(), REPOSITORY / "beyond")
    now = revision(house.absolute()) if house else UNKNOWN
    unknown = "unknown" in (made["commit"], now.commit)
    checked_out = None if unknown else made["commit"] == now.commit
    target = made["target"]
    if file.suffix not in CARRIERS:
        folder = "results" if is_text(file) else PurePosixPath(target).parent
        target = f"{folder}/{file.name}"
    running = versions().items()
    # The parameters of a picture are those of the dataset beside it, if this has the same commit.
    dataset = file.with_suffix(DATASET)
    beside = provenance_in(dataset) if dataset.is_file() else {}
    return {
        "file": str(file),
        "commit": made["commit"],
        "checked_out": checked_out,
        "dirty": made["dirty"],
        "configuration": made["configuration"],
        "parameters": beside["parameters"] if beside.get("commit") == made["commit"] else {},
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
    return [printable(f"{name:<{width}}{text}", None) for name, text in texts.items()]
