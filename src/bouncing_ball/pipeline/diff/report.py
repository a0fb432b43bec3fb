"""The reports on a comparison in ``results/diff``: lines for a terminal, and the page."""

from collections.abc import Collection, Mapping
from pathlib import Path

from bouncing_ball.datasets.files import write_text
from bouncing_ball.pipeline.diff.folders import compare_folders
from bouncing_ball.pipeline.diff.page import differences_html, sentence, to_terminal
from bouncing_ball.pipeline.diff.targets import report_paths
from bouncing_ball.pipeline.diff.words import summary_of_changes


def write_reports(
    record: Path, artifacts: Collection[str], name: str, not_made: Mapping[str, str] | None = None
) -> str:
    """Compare ``results`` with the record, write both reports, and print that for a terminal.

    Parameters
    ----------
    record : Path
        The checkout.
    artifacts : collection of str
        Names of the artifacts to compare; all, if empty.
    name : str
        The requested targets, which are the name of the reports; empty for a whole run.
    not_made : mapping, optional
        The files under ``results`` that the run did not make, each with its reason.

    Returns
    -------
    str
        The sentence with which the run ends; empty if the results agree with the record.
    """
    missing = {file.removeprefix("results/"): why for file, why in (not_made or {}).items()}
    comparison = compare_folders(record, Path("results"), artifacts, missing)
    text = to_terminal(comparison)
    lines, page = report_paths(name)
    head = "".join(f"{line}\n" for line in summary_of_changes(comparison))
    write_text(lines, f"{sentence(comparison)}\n{head}\n{text}")
    write_text(page, differences_html(comparison))
    print(text, end="", flush=True)
    if not comparison.outcome.status:
        return ""
    return f"diff: the results differ from the record (exit status 1), see {page}"
