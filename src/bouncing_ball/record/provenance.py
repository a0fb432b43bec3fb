"""Where an artifact comes from, as the artifact itself says.

Every dataset carries its provenance in netCDF attributes, every picture in its
metadata; of texts and tables the log of their job holds it. It names the
commit, what the configuration changes, parameters, sources, lock file and
inputs as checksums, and the versions of the libraries. No time and no machine,
so that two runs of one commit give the same bytes.
"""

import hashlib
import json
import platform
import re
from collections.abc import Iterable, Mapping
from dataclasses import asdict, dataclass, fields
from functools import cache
from importlib.metadata import version
from pathlib import Path
from typing import Any, Self

import bouncing_ball
from bouncing_ball.errors import ModelError

PREFIX = "provenance_"
"""How the names of the attributes begin."""

LOCK = "requirements.lock"
LIBRARIES = ("numpy", "scipy", "xarray", "netCDF4", "matplotlib")

_SHA256 = r"[0-9a-f]{64}"
_PATH = r"(?![-/])(?!.*\.\.)[\w.+/-]{1,300}"
_FORMS = {
    "commit": r"[0-9a-f]{40}|[0-9a-f]{64}|unknown",
    "dirty": "yes|no|unknown",
    "target": r"results/(\w{1,40}/)?\w{1,80}\.\w{1,4}",
    "parameters": _SHA256,
    "sources": _SHA256,
    "lock": f"{_SHA256}|unknown",
}
# Of a mapping in JSON: the forms of its keys and of its values.
_MAPPINGS = {"inputs": (_PATH, _SHA256), "versions": (r"\w{1,40}", r"\d[\w.+!-]{0,40}")}
_LONGEST = 100_000


class ProvenanceError(ModelError):
    """A file that says nothing, or nothing readable, of where it comes from."""


@dataclass(frozen=True)
class Provenance:
    """Where an artifact comes from; all checksums are SHA-256."""

    commit: str
    """Full hash of the commit, or unknown."""
    dirty: str
    """Whether more than the commit's files decided: a changed tree, or a package from
    elsewhere. yes, no or unknown."""
    configuration: str
    """JSON: what the run's configuration changes in config/config.yaml, nested alike."""
    target: str
    """What to ask Snakemake for to have the artifact made again."""
    parameters: str
    """Checksum of the parameters on which the artifact depends."""
    sources: str
    """Checksum of the script and the modules that made it."""
    lock: str
    """Checksum of the lock file, or unknown."""
    inputs: str
    """JSON: for each input file, by its path, its checksum."""
    versions: str
    """JSON: for Python and each library, its version."""

    def attributes(self) -> dict[str, str]:
        """The provenance as attributes of a dataset, or metadata of a picture."""
        return {PREFIX + name: value for name, value in asdict(self).items()}

    @classmethod
    def of(cls, attributes: Mapping[str, Any]) -> Self:
        """The provenance among the attributes of an artifact.

        The form of every part is checked, as it comes from a file.

        Raises
        ------
        ProvenanceError
            If a part is missing, or is not of its form.
        """
        values = {}
        for field in fields(cls):
            name = PREFIX + field.name
            if name not in attributes:
                raise ProvenanceError(f"no attribute {name}")
            value = attributes[name]
            if not isinstance(value, str) or not _is_of_its_form(field.name, value):
                raise ProvenanceError(f"attribute {name} is malformed")
            values[field.name] = value
        return cls(**values)


def _is_of_its_form(name: str, value: str) -> bool:
    if name in _FORMS:
        return re.fullmatch(_FORMS[name], value, re.ASCII) is not None
    try:
        mapping = read_mapping(value)
    except ValueError:
        return False
    if name == "configuration":
        return all(re.fullmatch(r"[\w.-]{1,200}", key, re.ASCII) for key in flattened(mapping))
    return all(
        isinstance(part, str) and re.fullmatch(form, part, re.ASCII)
        for item in mapping.items()
        for form, part in zip(_MAPPINGS[name], item, strict=True)
    )


def read_mapping(text: str) -> dict[str, Any]:
    """A mapping written as JSON.

    Raises
    ------
    ValueError
        If the text is none, or is longer than any of ours.
    """
    try:
        mapping = json.loads(text) if len(text) <= _LONGEST else None
    except RecursionError:
        mapping = None
    if not isinstance(mapping, dict):
        raise ValueError("not a mapping in JSON")
    return mapping


def made_otherwise(record: Provenance, new: Provenance) -> list[str]:
    """What two files were made from that is not the same, by checksums; commits may differ.

    Examples
    --------
    >>> one = Provenance(*["1f0e"] * 7, inputs='{"a.nc": "1f0e"}', versions="{}")
    >>> from dataclasses import replace
    >>> two = replace(one, sources="2a2a", inputs='{"a.nc": "2a2a"}')
    >>> made_otherwise(one, two)
    ['other sources', 'another a.nc']
    """
    found = [
        said
        for part, said in (
            ("sources", "other sources"),
            ("parameters", "other parameters"),
            ("lock", f"another {LOCK}"),
        )
        if getattr(record, part) != getattr(new, part)
    ]
    before, after = read_mapping(record.inputs), read_mapping(new.inputs)
    found += [
        f"another {path}"
        for path in sorted(before.keys() | after.keys())
        if before.get(path) != after.get(path)
    ]
    return found


def flattened(mapping: Mapping[str, Any], prefix: str = "") -> dict[str, Any]:
    """Nested values by their keys in full.

    Examples
    --------
    >>> flattened({"release": "force", "figures": {"fig11": {"restitution": 0.7}}})
    {'release': 'force', 'figures.fig11.restitution': 0.7}
    """
    found: dict[str, Any] = {}
    for key, value in mapping.items():
        found |= (
            flattened(value, f"{prefix}{key}.")
            if isinstance(value, Mapping)
            else {f"{prefix}{key}": value}
        )
    return found


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
        elif key not in written or digest(value) != digest(before):
            found[key] = value
    return found


def digest(value: Any) -> str:
    """Checksum of parameters, whatever the order of their keys.

    Examples
    --------
    >>> digest({"n": 1, "release": "force"}) == digest({"release": "force", "n": 1})
    True
    >>> digest({})[:12]
    '44136fa355b3'
    """
    text = json.dumps(value, sort_keys=True, separators=(",", ":"), ensure_ascii=False)
    return hashlib.sha256(text.encode()).hexdigest()


def dependent_digest(own: str, inherited: Iterable[str]) -> str:
    """Checksum of a job's own parameters and of those its inputs were made with.

    ``own`` is empty for a job without parameters: a picture has the checksum of
    its dataset.

    Examples
    --------
    >>> dependent_digest("", ["ab12"])
    'ab12'
    >>> dependent_digest("", []) == digest({})
    True
    """
    parts = sorted(set(inherited))
    if own or not parts:
        parts = [own or digest({}), *parts]
    return parts[0] if len(parts) == 1 else digest(parts)


def file_digest(path: str | Path) -> str:
    """Checksum of a file's content.

    Raises
    ------
    OSError
        If it cannot be read.
    """
    with open(path, "rb") as file:
        return hashlib.file_digest(file, "sha256").hexdigest()


def sources_digest(files: Iterable[str | Path], repository: Path) -> str:
    """Checksum of modules of this package, wherever it is, and files of the repository."""
    package = Path(bouncing_ball.__file__).resolve().parent
    found = {}
    for path in (Path(file).resolve() for file in files):
        root = package.parent if path.is_relative_to(package) else repository
        found[path.relative_to(root).as_posix()] = file_digest(path)
    return digest(found)


def lock_digest(repository: Path) -> str:
    """Checksum of the lock file of a checkout, or unknown."""
    lock = repository / LOCK
    return file_digest(lock) if lock.is_file() else "unknown"


# To find one all of a package's description is parsed.
_version = cache(version)


def versions() -> dict[str, str]:
    """Versions of Python and of the libraries that decide about the artifacts."""
    return {"python": platform.python_version(), **{name: _version(name) for name in LIBRARIES}}
