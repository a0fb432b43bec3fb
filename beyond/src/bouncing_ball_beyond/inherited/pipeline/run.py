"""A run of Snakemake: what it was asked for, what it did not make, and how it ends.

A run goes on with the jobs that do not need a failed one. ``workflow`` is the object that Snakemake
provides for its handlers. Every process of a run imports this module, so that it imports little.
"""

from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

PAGE = Path("results/diff/index.html")
"""The page of the comparison with the record."""

CONCLUSION = Path("results/logs/conclusion")
"""The file with the sentence with which a run ends. It may end with exit status 1 although no job
failed, for example because of a difference from the record. For a failed job Snakemake prints ten
lines, with a command that the user did not type; such a run ends with one sentence instead."""


def concluded() -> str:
    """The sentence with which this run ends, or an empty text; it is removed by this call."""
    sentence = CONCLUSION.read_text(encoding="utf-8") if CONCLUSION.is_file() else ""
    CONCLUSION.unlink(missing_ok=True)
    return sentence


def remove_reports() -> None:
    """Remove the reports of an earlier run, whose results may change now."""
    for path in PAGE.parent.glob("*.*"):
        path.unlink()


def names_of_artifacts(files: Iterable[str]) -> list[str]:
    """The names of the artifacts of some files.

    Examples
    --------
    >>> names_of_artifacts(["results/paper.md", "results/figures/fig14.nc"])
    ['fig14', 'paper']
    """
    return sorted({Path(file).stem for file in files})


def requested(workflow: Any) -> list[str]:
    """The files of artifacts that the targets of a run make, or list as inputs; all, if empty.

    Snakemake knows the targets only after it has read all rules, so that an input function calls
    this. In ``snakemake --cores 2 fig14 diff`` it is Figure 14.
    """
    names = sorted({*workflow.dag_settings.targets} - {"all", "diff"})
    rules = [workflow.get_rule(name) for name in names if workflow.is_rule(name)]
    files = [Path(str(file)) for rule in rules for file in (rule.output or rule.input)]
    figures = ("results", "figures")
    return [str(x) for x in files if x.parts[:2] == figures or x.match("results/*.md")]


def failed_behind(job: Any, workflow: Any) -> set[Any]:
    """The jobs that failed among those that a job needs, directly or through others."""
    found: set[Any] = set()
    for needed in workflow.dag.dependencies[job]:
        if needed in workflow.scheduler.failed:
            found.add(needed)
        elif not workflow.dag.finished(needed):
            found |= failed_behind(needed, workflow)
    return found


def reason_of(job: Any) -> str:
    """The last line of the log of a failed job, in which the job itself gives its reason."""
    log = Path(str(job.log[0])) if job.log else Path()
    lines = log.read_text(encoding="utf-8").splitlines() if log.is_file() else []
    return lines[-1] if lines else f"{job.rule.name} ended without a message, see .snakemake/log"


def not_made(workflow: Any) -> dict[str, str]:
    """The files that a run with failed jobs did not make, each with the reason in one line.

    There are none if no job failed, for example if the run was interrupted.
    """
    found: dict[str, str] = {}
    if not workflow.scheduler.failed:
        return found
    for job in workflow.scheduler.failed:
        found |= {str(file): reason_of(job) for file in job.output}
    for job in workflow.dag.needrun_jobs():
        failed = {each.rule.name for each in failed_behind(job, workflow)}
        for file in map(str, job.output):
            found.setdefault(file, f"needs {', '.join(sorted(failed))}")
    return found


def lines_by_reason(files: Mapping[str, str]) -> list[str]:
    """One line for each reason, with the names of what was not made for it; each name once.

    Examples
    --------
    >>> needs = dict.fromkeys(["results/figures/claims.nc", "results/paper.md"], "needs set_fig")
    >>> lines_by_reason({"results/figures/fig.md": "set_fig: no orbit", **needs})
    ['not made: fig (set_fig: no orbit)', 'not made: claims, paper (needs set_fig)']
    """
    reasons: dict[str, str] = {}
    for file, reason in files.items():
        reasons.setdefault(Path(file).stem, reason)
    by_reason: dict[str, list[str]] = {}
    for name, reason in reasons.items():
        by_reason.setdefault(reason, []).append(name)
    return [f"not made: {', '.join(names)} ({reason})" for reason, names in by_reason.items()]
