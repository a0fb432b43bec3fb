"""Figures as files that are identical from run to run."""

import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from matplotlib import rcParams
from matplotlib.backend_bases import get_registered_canvas_class
from matplotlib.figure import Figure

from bouncing_ball.datasets.files import replacing
from bouncing_ball.figures.style import style


def save(figure: Figure, path: str | Path, metadata: Mapping[str, str]) -> None:
    """Write a figure, completely or not at all, with the same bytes every time.

    The metadata become text chunks of a PNG; an SVG, whose vocabulary is
    limited, holds them as JSON in its description.

    Raises
    ------
    OSError
        If the file cannot be written.
    """
    # Without time and version, which matplotlib would write by default.
    texts: dict[str, Any] = {"Software": None, **metadata}
    if Path(path).suffix == ".svg":
        texts = {"Date": None, "Creator": None, "Description": json.dumps(dict(metadata))}
    kind = Path(path).suffix.removeprefix(".")
    with replacing(path) as temporary, style():
        figure.set_dpi(rcParams["savefig.dpi"])
        # savefig would draw each figure once more to find its extent.
        canvas = get_registered_canvas_class(kind)(figure)
        getattr(canvas, f"print_{kind}")(temporary, metadata=texts)
