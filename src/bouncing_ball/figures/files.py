"""Figures as files that are the same from run to run."""

import json
from collections.abc import Iterable, Mapping
from pathlib import Path

from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.backends.backend_svg import FigureCanvasSVG
from matplotlib.figure import Figure

from bouncing_ball.datasets.files import replacing
from bouncing_ball.figures.style import RESOLUTION


def save_all(figure: Figure, paths: Iterable[str | Path], metadata: Mapping[str, str]) -> None:
    """Write a figure in several formats, laid out once for all of them."""
    if layout := figure.get_layout_engine():
        layout.execute(figure)
    figure.set_layout_engine("none")
    for path in paths:
        save(figure, path, metadata)


def save(figure: Figure, path: str | Path, metadata: Mapping[str, str]) -> None:
    """Write a figure, whole or not at all, the same every time.

    The metadata become text chunks of a PNG; an SVG, whose vocabulary is
    limited, holds them as JSON in its description.
    """
    # Neither a time nor a version of matplotlib's own.
    attributes = {"Software": None, **metadata}
    description = {"Date": None, "Creator": None, "Description": json.dumps(dict(metadata))}
    with replacing(path) as temporary:
        # Not by savefig, which draws these two twice.
        match Path(path).suffix:
            case ".svg":
                FigureCanvasSVG(figure).print_svg(temporary, metadata=description)
            case ".png":
                figure.set_dpi(RESOLUTION)
                FigureCanvasAgg(figure).print_png(temporary, metadata=attributes)
            case _:
                figure.savefig(temporary, metadata=attributes)
