"""A comparison and its reports."""

from collections.abc import Collection
from pathlib import Path

from bouncing_ball.compare.folders import Comparison, compare_folders
from bouncing_ball.compare.outcome import status
from bouncing_ball.compare.report_terminal import to_terminal
from bouncing_ball.compare.tolerance_file import read_tolerances
from bouncing_ball.datasets.files import write_text


def compare_and_report(
    record: Path,
    results: Path,
    tolerances: str | Path,
    only: Collection[str] = (),
    **reports: str | Path | None,
) -> tuple[str, int]:
    """The short table of a comparison and its exit status, with the reports written.

    ``reports`` are those of :func:`write_reports`, ``only`` the artifacts compared.

    Raises
    ------
    ComparisonError, ConfigurationError
        If the folders cannot be compared, or the tolerances are wrong.
    """
    comparison = compare_folders(record, results, read_tolerances(tolerances), only)
    write_reports(comparison, **reports)
    return to_terminal(comparison), status(comparison.outcome)


def write_reports(
    comparison: Comparison,
    *,
    json: str | Path | None = None,
    markdown: str | Path | None = None,
    html: str | Path | None = None,
) -> None:
    """Write those reports for which a path is given, whole or not at all."""
    # Imported where they are wanted: the page brings Jinja2 with it.
    if json is not None:
        from bouncing_ball.compare.report_json import to_json

        write_text(json, to_json(comparison))
    if markdown is not None:
        from bouncing_ball.compare.report_markdown import to_markdown

        write_text(markdown, to_markdown(comparison))
    if html is not None:
        from bouncing_ball.compare.report_html import to_html

        write_text(html, to_html(comparison))
