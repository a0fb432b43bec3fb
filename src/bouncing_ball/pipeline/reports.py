"""The reports of a comparison, as files."""

from pathlib import Path

from bouncing_ball.comparison.folders import Comparison
from bouncing_ball.pipeline.files import write_text


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
        from bouncing_ball.comparison.report_json import to_json

        write_text(json, to_json(comparison))
    if markdown is not None:
        from bouncing_ball.comparison.report_markdown import to_markdown

        write_text(markdown, to_markdown(comparison))
    if html is not None:
        from bouncing_ball.comparison.report_html import to_html

        write_text(html, to_html(comparison))
