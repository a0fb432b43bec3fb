"""A comparison and its reports."""

from collections.abc import Collection
from pathlib import Path

from bouncing_ball.compare.folders import compare_folders
from bouncing_ball.compare.terminal import to_terminal
from bouncing_ball.datasets.files import write_text


def compared(
    record: Path, results: Path, only: Collection[str] = (), page: str | Path | None = None
) -> tuple[str, int]:
    """The short table of a comparison and its exit status, with the page written.

    Raises
    ------
    ComparisonError
        If the folders cannot be compared at all.
    """
    comparison = compare_folders(record, results, only)
    if page is not None:
        # Imported where it is wanted: it brings Jinja2 with it.
        from bouncing_ball.compare.page import to_html

        write_text(page, to_html(comparison))
    return to_terminal(comparison), comparison.outcome.status
