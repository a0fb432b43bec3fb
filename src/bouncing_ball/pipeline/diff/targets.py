"""The artifacts that a run of Snakemake compares: all, or those requested together with ``diff``.

In ``snakemake --cores 2 fig14 diff`` this is Figure 14. Snakemake knows the targets of a run only
after it has read all rules, so that these functions are called by input functions.
"""

from pathlib import Path
from typing import Any

from bouncing_ball.pipeline.artifacts import TEXTS


def requested_names(workflow: Any) -> list[str]:
    """The names of the rules that are targets of the run beside ``diff``, sorted."""
    names = sorted({*workflow.dag_settings.targets} - {"diff"})
    return [name for name in names if workflow.is_rule(name)]


def requested_files(workflow: Any) -> list[str]:
    """The files of artifacts that the requested rules make, or that they list as inputs."""
    rules = [workflow.get_rule(name) for name in requested_names(workflow)]
    files = [str(file) for rule in rules for file in (rule.output or rule.input)]
    texts = [f"results/{text}" for text in TEXTS]
    return [file for file in files if file.startswith("results/figures/") or file in texts]


def requested_artifacts(workflow: Any) -> list[str]:
    """The names of the requested artifacts; an empty list means all."""
    return sorted({Path(file).stem for file in requested_files(workflow)})
