"""What an artifact is made from, as the artifact itself carries it.

A dataset carries its provenance in netCDF attributes, a PNG file in its text, an
SVG file in its description; a table or a page has that of its dataset. There is
neither a time nor a machine in it, so that two runs of one commit give the same bytes.
"""

import json
import os
import platform
from collections.abc import Iterable, Mapping
from functools import cache
from importlib.metadata import version
from pathlib import Path
from typing import Any

from bouncing_ball.configuration.yaml_file import read_yaml
from bouncing_ball.errors import ModelError
from bouncing_ball.provenance.revision import revision

PREFIX = "provenance_"
"""How the names of the attributes begin."""
LIBRARIES = ("numpy", "scipy", "xarray", "netCDF4", "matplotlib")
CONFIGURATION = "config/config.yaml"
CARRIERS = (".nc", ".png", ".svg")
"""Suffixes of the files that carry their provenance."""

_DESCRIPTION = "{http://purl.org/dc/elements/1.1/}description"


class ProvenanceError(ModelError):
    """A file that does not say, or not readably, what it is made from."""


def changes(config: Mapping[str, Any], written: Mapping[str, Any]) -> dict[str, Any]:
    """What a configuration changes in the written one, nested alike.

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


# To find one all of a package's description is parsed.
_version = cache(version)


def versions() -> dict[str, str]:
    """Versions of Python and of the libraries that decide about the artifacts."""
    return {"python": platform.python_version(), **{name: _version(name) for name in LIBRARIES}}


def gather(
    target: str, inputs: Iterable[str], repository: Path, config: Mapping[str, Any]
) -> dict[str, str]:
    """The provenance of what a job writes now, in a checkout and with a configuration.

    Returns
    -------
    dict of str
        Attributes of a dataset, or metadata of a picture: the full hash of the commit, or
        unknown; whether the tree had changes that the commit has not, yes, no or unknown; as
        JSON what the run's configuration changes in config/config.yaml, nested alike; what to
        ask Snakemake for to have the artifact made again; as JSON the files that it is made
        from, and the versions of Python and the libraries.
    """
    now = revision(repository)
    written = read_yaml(repository / CONFIGURATION)
    # A run may be anywhere; files of the checkout are named from its top.
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
    """Attributes of a dataset, metadata of a picture.

    Raises
    ------
    ProvenanceError
        If the file is of another kind, cannot be read, or is damaged.
    """
    # Imported where they are needed: each takes a while.
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
        raise ProvenanceError(f"{path} cannot be read: damaged, or not ours") from None


def read_provenance(path: Path) -> dict[str, Any]:
    """What a dataset or a picture carries, by the names of :func:`gather` without the prefix.

    Raises
    ------
    ProvenanceError
        As :func:`read_attributes`, or if it carries no provenance.
    """
    attributes = read_attributes(path).items()
    found = {name.removeprefix(PREFIX): x for name, x in attributes if name.startswith(PREFIX)}
    if not found:
        raise ProvenanceError(f"{path} carries no provenance")
    return found | {
        name: json.loads(found[name]) for name in ("configuration", "inputs", "versions")
    }
