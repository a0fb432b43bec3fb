"""Figures as files that are identical from run to run."""

import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from matplotlib import rc_context, rcParams
from matplotlib.backend_bases import get_registered_canvas_class
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

from bouncing_ball_beyond.inherited.datasets.files import PICTURES, replacing, require_writable
from bouncing_ball_beyond.inherited.drawing.canvas import lay_out
from bouncing_ball_beyond.inherited.drawing.style import style
from bouncing_ball_beyond.inherited.errors import ModelError

# Text that a program for drawings or a search can read, in place of outlines.
_AS_TEXT: dict[Any, Any] = {"svg.fonttype": "none", "pdf.fonttype": 42}


def save(
    figure: Figure, path: str | Path, metadata: Mapping[str, str], *, as_text: bool = False
) -> None:
    """Write a figure, completely or not at all, with the same bytes every time.

    With ``as_text`` the words of a PDF or an SVG are text, for which the reader needs the font.

    The metadata become text chunks of a PNG; an SVG, whose vocabulary is
    limited, holds them as JSON in its description.

    Raises
    ------
    OSError
        If the file cannot be written.
    """
    kind = Path(path).suffix.removeprefix(".")
    given = dict(metadata)
    # Without time and version, which matplotlib would write by default.
    options: dict[str, Any] = {"metadata": {"Software": None, **given}}
    if kind == "svg":
        options = {"metadata": {"Date": None, "Creator": None, "Description": json.dumps(given)}}
    if kind == "png":
        # A third of the time, and files of one tenth more.
        options["pil_kwargs"] = {"compress_level": 3}
    with replacing(path) as temporary, style(), rc_context(_AS_TEXT if as_text else {}):
        figure.set_dpi(rcParams["savefig.dpi"])
        if engine := figure.get_layout_engine():
            # Laid out once for all formats. The canvas of a PNG keeps the extents of the texts.
            FigureCanvasAgg(figure)
            lay_out(figure, engine)
        canvas = get_registered_canvas_class(kind)
        # savefig would draw each figure once more to find its extent.
        draw = figure.canvas if isinstance(figure.canvas, canvas) else canvas(figure)
        getattr(draw, f"print_{kind}")(temporary, **options)


def write(figure: Figure, path: Path, title: str) -> None:
    """Write a figure that a user has requested.

    Raises
    ------
    ModelError
        If the suffix of the path is not that of a picture, or the file cannot be written.
    """
    require_writable(path, PICTURES)
    try:
        save(figure, path, {"Title": title}, as_text=True)
    except OSError as error:
        raise ModelError(f"{path} cannot be written: {error.strerror}") from None
