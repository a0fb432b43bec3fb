"""The artifacts that a run of Snakemake compares: all, or those requested together with ``diff``.

In ``snakemake --cores 2 fig14 diff`` this is Figure 14. Snakemake knows the targets of a run only
after it has read all rules, so that these functions are called by input functions.
"""

from pathlib import Path
from typing import Any

from bouncing_ball.pipeline.artifacts import TEXTS


def requested_names(workflow: Any) -> list[str]:
    """The names of the rules that are targets of the run beside ``diff``, sorted.

    There are none in a whole run.
    """
    names = sorted({*workflow.dag_settings.targets} - {"all", "diff"})
    return [name for name in names if workflow.is_rule(name)]


def name_of_reports(workflow: Any) -> str:
    """The name of the reports on the requested artifacts, empty in a whole run."""
    return "-".join(requested_names(workflow))


def requested_files(workflow: Any) -> list[str]:
    """The files of artifacts that the requested rules make, or that they list as inputs."""
    rules = [workflow.get_rule(name) for name in requested_names(workflow)]
    files = [str(file) for rule in rules for file in (rule.output or rule.input)]
    texts = [f"results/{text}" for text in TEXTS]
    return [file for file in files if file.startswith("results/figures/") or file in texts]


def requested_artifacts(workflow: Any) -> list[str]:
    """The names of the requested artifacts; an empty list means all."""
    return sorted({Path(file).stem for file in requested_files(workflow)})


def report_paths(name: str) -> tuple[Path, Path]:
    """The files of the two reports, see :func:`name_of_reports`: lines of text, and the page.

    Examples
    --------
    >>> print(*report_paths(""), *report_paths("fig14"))
    results/diff/diff.txt results/diff/index.html results/diff/fig14.txt results/diff/fig14.html
    """
    folder = Path("results/diff")
    return folder / f"{name or 'diff'}.txt", folder / f"{name or 'index'}.html"


def remove_reports(workflow: Any) -> None:
    """Remove the reports of an earlier run with these targets, whose results may change now."""
    for path in report_paths(name_of_reports(workflow)):
        path.unlink(missing_ok=True)
