"""The reports of a comparison, as files."""

from pathlib import Path

from bouncing_ball.datasets.files import write_text
from bouncing_ball.record.diff.folders import Comparison


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
        from bouncing_ball.record.diff.report_json import to_json

        write_text(json, to_json(comparison))
    if markdown is not None:
        from bouncing_ball.record.diff.report_markdown import to_markdown

        write_text(markdown, to_markdown(comparison))
    if html is not None:
        from bouncing_ball.record.diff.report_html import to_html

        write_text(html, to_html(comparison))
