"""One page with everything, which needs neither a network nor a script."""

import base64
import math
from typing import Any

from jinja2 import Environment, PackageLoader, StrictUndefined

from bouncing_ball.record.diff.folders import Comparison
from bouncing_ball.record.diff.outcome import Outcome, status
from bouncing_ball.record.diff.report_terminal import (
    counts,
    excerpts,
    remarks,
    sentence,
    share_text,
)
from bouncing_ball.record.reading import printable


def _colour(outcome: Outcome) -> str:
    """Class of a outcome on the page."""
    return ("ok", "bad", "broken")[status(outcome)]


def _small(value: float | None) -> str:
    if value is None:
        return ""
    return f"{value:.2g}" if math.isfinite(value) else "∞"


def _plain(value: Any) -> Any:
    """The value of an expression of the page; text that is no markup yet, on one line."""
    return (
        value
        if hasattr(value, "__html__") or not isinstance(value, str)
        else printable(value, None)
    )


def to_html(comparison: Comparison) -> str:
    """The page: artifacts worst first; record, new and difference of each picture.

    All pictures are part of the page; one that is the same on both sides is
    there once.

    Examples
    --------
    >>> "<h1>Artifacts against the record</h1>" in to_html(Comparison(()))
    True
    """
    environment = Environment(
        loader=PackageLoader("bouncing_ball.record.diff", "."),
        autoescape=True,
        finalize=_plain,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
        keep_trailing_newline=True,
    )
    return environment.get_template("page.html.j2").render(
        comparison=comparison,
        sentence=sentence(comparison),
        excerpts=excerpts,
        counts=counts(comparison) or "No artifacts",
        remarks=remarks,
        share=share_text,
        small=_small,
        colour=_colour,
        base64=lambda content: base64.b64encode(content).decode("ascii"),
    )
