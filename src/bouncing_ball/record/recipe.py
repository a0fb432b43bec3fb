"""What a job is made from, and its provenance.

A recipe comes from a running job, or from Snakemake's plan of the same job.
So the provenance that a file carries can be compared with the one that it would
have now: that is the proof that it is up to date, whatever the times of the
files say.
"""

import json
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Self

import bouncing_ball
from bouncing_ball.configuration.yaml_file import read_yaml
from bouncing_ball.record.carriers import CARRIERS, read_attributes, read_provenance
from bouncing_ball.record.job_log import read_log
from bouncing_ball.record.provenance import (
    PREFIX,
    Provenance,
    changes,
    dependent_digest,
    digest,
    file_digest,
    lock_digest,
    sources_digest,
    versions,
)
from bouncing_ball.record.revision import Revision, revision

CONFIGURATION = "config/config.yaml"


@dataclass(frozen=True)
class Recipe:
    """What a job reads and writes; paths are relative to the working directory.

    Parameters
    ----------
    outputs, inputs, sources : tuple of str
        Sources are the job's script and modules; inputs what else it reads.
    parameters : str
        Checksum of the job's own parameters, empty without any.
    log : str
    parts : tuple of str
        Inputs that are one thing in many files, made with parameters that are the job's too.
    """

    outputs: tuple[str, ...]
    inputs: tuple[str, ...]
    sources: tuple[str, ...]
    parameters: str
    log: str
    parts: tuple[str, ...] = ()

    @classmethod
    def of(cls, job: Any, script: str | Path) -> Self:
        """The recipe of a job, as its script or as Snakemake's plan knows it."""
        modules = [str(path) for path in job.input.get("source", [])]
        parts = [str(path) for path in job.input.get("parts", [])]
        parameters = dict(job.params.items())
        return cls(
            outputs=tuple(map(str, job.output)),
            inputs=tuple(sorted({str(path) for path in job.input} - set(modules) - set(parts))),
            sources=(str(script), *modules),
            parameters=digest(parameters) if parameters else "",
            log=str(job.log[0]),
            parts=tuple(parts),
        )

    @property
    def target(self) -> str:
        """What to ask Snakemake for: the first of the files."""
        return self.outputs[0]


def planned(dag: Any) -> list[Recipe]:
    """The recipes of all jobs in Snakemake's plan that write files."""
    return [
        Recipe.of(job, Path(str(job.rule.snakefile)).parent / job.rule.script)
        for job in dag.jobs
        if job.output
    ]


@dataclass(frozen=True)
class Run:
    """What all jobs of a run share: the checkout, its state, and its configuration."""

    repository: Path
    now: Revision
    configuration: str

    @classmethod
    def of(cls, repository: Path, config: Mapping[str, Any]) -> Self:
        """The state of a checkout, in which a configuration is in effect."""
        now = revision(repository)
        package = Path(bouncing_ball.__file__).resolve()
        if now.dirty == "no" and not package.is_relative_to(repository / "src"):
            now = Revision(now.commit, "yes")
        changed = changes(config, read_yaml(repository / CONFIGURATION))
        return cls(repository, now, json.dumps(changed, sort_keys=True))


def gather(recipe: Recipe, run: Run) -> Provenance:
    """The provenance of what a job writes, or would write now."""
    attributes = [read_attributes(Path(path)) for path in recipe.inputs if path.endswith(".nc")]
    name = PREFIX + "parameters"
    inherited = [str(data[name]) for data in attributes if name in data]
    inputs = {_named(path, run.repository): file_digest(path) for path in recipe.inputs}
    if recipe.parts:
        inputs["parts"] = digest([file_digest(path) for path in recipe.parts])
    return Provenance(
        commit=run.now.commit,
        dirty=run.now.dirty,
        configuration=run.configuration,
        target=recipe.target,
        parameters=dependent_digest(recipe.parameters, inherited),
        sources=sources_digest(recipe.sources, run.repository),
        lock=lock_digest(run.repository),
        inputs=json.dumps(inputs, sort_keys=True),
        versions=json.dumps(versions()),
    )


def _named(path: str, repository: Path) -> str:
    """An input's name: a file of the repository has one, wherever the run is."""
    if ".." not in Path(path).parts:
        return path
    return Path(path).resolve().relative_to(repository).as_posix()


def recorded(recipe: Recipe) -> list[Provenance]:
    """What the files of a job say of where they come from, or else its log.

    Raises
    ------
    ProvenanceError
        If they say nothing.
    """
    carriers = [Path(path) for path in recipe.outputs if Path(path).suffix in CARRIERS]
    if carriers:
        return [read_provenance(path) for path in carriers]
    return [read_log(Path(recipe.log)).provenance()]
