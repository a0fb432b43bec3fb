"""Where an artifact comes from, as it stands in the artifact itself.

Every dataset carries its provenance in netCDF attributes, every picture in its
metadata: the commit, the configuration, sources, lock file and inputs as
checksums, and the versions of the libraries. No time and no machine, so that
two runs of one commit give the same bytes. It is gathered when a file is
written: as a parameter of the job it would run everything again at each commit.
"""

import hashlib
import json
import platform
from collections.abc import Iterable, Mapping
from dataclasses import asdict, dataclass, fields
from importlib.metadata import version
from pathlib import Path
from typing import Any, Self

import bouncing_ball
from bouncing_ball.configuration.yaml_file import read_yaml
from bouncing_ball.errors import ModelError
from bouncing_ball.record.revision import revision

PREFIX = "provenance_"
"""How the names of the attributes begin."""

CONFIGURATION = "config/config.yaml"
SUM = "sha256"
"""How the lines of a job's log begin that tell the checksum of what it wrote."""

LOCK = "requirements.lock"
LIBRARIES = ("numpy", "scipy", "xarray", "netCDF4", "matplotlib")


class ProvenanceError(ModelError):
    """A file that says nothing, or nothing readable, of where it comes from."""


@dataclass(frozen=True)
class Provenance:
    """Where an artifact comes from; all checksums are SHA-256."""

    commit: str
    """Full hash of the commit, or unknown."""
    dirty: str
    """Whether more than the commit decided: a changed tree, another configuration or
    package (:func:`departure`). yes, no or unknown."""
    target: str
    """What to ask Snakemake for to have the artifact made again."""
    parameters: str
    """Checksum of the configuration on which the artifact depends."""
    sources: str
    """Checksum of the modules that made it."""
    lock: str
    """Checksum of the lock file, or unknown."""
    inputs: str
    """JSON: for each input file, by its path in the working directory, its checksum."""
    versions: str
    """JSON: for Python and each library, its version."""

    def attributes(self) -> dict[str, str]:
        """The provenance as attributes of a dataset, or metadata of a picture."""
        return {PREFIX + name: value for name, value in asdict(self).items()}

    @classmethod
    def of(cls, attributes: Mapping[str, Any]) -> Self:
        """The provenance among the attributes of an artifact.

        Raises
        ------
        ProvenanceError
            If a part of it is missing.
        """
        try:
            values = {field.name: str(attributes[PREFIX + field.name]) for field in fields(cls)}
        except KeyError as error:
            raise ProvenanceError(f"no attribute {error.args[0]}") from None
        return cls(**values)


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


def dependent_digest(parameters: Mapping[str, Any], inherited: Iterable[str]) -> str:
    """Checksum of a job's own parameters and of those its inputs were made with.

    A picture has the checksum of its dataset.

    Examples
    --------
    >>> dependent_digest({}, ["ab12"])
    'ab12'
    >>> dependent_digest({"n": 1}, []) == digest({"n": 1})
    True
    """
    parts = sorted(set(inherited))
    if parameters or not parts:
        parts = [digest(parameters), *parts]
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


def sources_digest(files: Iterable[str]) -> str:
    """Checksum of modules of this package, wherever the package is."""
    root = Path(bouncing_ball.__file__).resolve().parent
    paths = sorted(Path(file).resolve() for file in files)
    return digest({path.relative_to(root).as_posix(): file_digest(path) for path in paths})


def lock_digest(repository: Path) -> str:
    """Checksum of the lock file of a checkout, or unknown."""
    lock = repository / LOCK
    return file_digest(lock) if lock.is_file() else "unknown"


def versions() -> dict[str, str]:
    """Versions of Python and of the libraries that decide about the artifacts."""
    return {"python": platform.python_version(), **{name: version(name) for name in LIBRARIES}}


def departure(repository: Path, config: Mapping[str, Any], files: Iterable[str]) -> str:
    """What a run rests on that the tree of a repository does not hold, in words.

    Parameters
    ----------
    repository : Path
    config : mapping
        The configuration in effect, in which Snakemake's options count.
    files : iterable of str
        Modules of this package that are at work.

    Returns
    -------
    str
        Empty if there is nothing.

    Raises
    ------
    ConfigurationError
        If the repository's own configuration cannot be read.
    """
    package = repository.resolve() / "src"
    if not all(Path(file).resolve().is_relative_to(package) for file in files):
        return "the package is not imported from src/ of the repository"
    given, written = (
        {key: value for key, value in mapping.items() if key != "reason"}
        for mapping in (config, read_yaml(repository / CONFIGURATION))
    )
    return "" if digest(given) == digest(written) else f"the configuration is not {CONFIGURATION}"


def gather(snakemake: Any, parameters: Mapping[str, Any], inherited: Iterable[str]) -> Provenance:
    """The provenance of what a job is about to write.

    ``parameters`` are the job's own, ``inherited`` the checksums of the
    parameters of the datasets that it reads.
    """
    # The scripts are in workflow/scripts of the repository; the run may be
    # anywhere.
    repository = Path(snakemake.scriptdir).resolve().parents[1]
    now = revision(repository)
    sources = snakemake.input.get("source", [])
    modules = set(sources)
    inputs = {path: file_digest(path) for path in snakemake.input if path not in modules}
    output = snakemake.output[0]
    dirty = now.dirty
    if dirty == "no" and departure(
        repository, snakemake.config, [*sources, str(bouncing_ball.__file__)]
    ):
        dirty = "yes"
    return Provenance(
        commit=now.commit,
        dirty=dirty,
        target=output,
        parameters=dependent_digest(parameters, inherited),
        sources=sources_digest(sources),
        lock=lock_digest(repository),
        inputs=json.dumps(inputs, sort_keys=True),
        versions=json.dumps(versions()),
    )
