"""Figures as files that are the same from run to run."""

import json
from collections.abc import Iterable, Mapping
from pathlib import Path

from matplotlib.figure import Figure

from bouncing_ball.datasets.atomic import replacing


def save_all(figure: Figure, paths: Iterable[str | Path], metadata: Mapping[str, str]) -> None:
    """Write a figure in several formats, laid out once for all of them."""
    if layout := figure.get_layout_engine():
        layout.execute(figure)
    figure.set_layout_engine("none")
    for path in paths:
        save(figure, path, metadata)


def save(figure: Figure, path: str | Path, metadata: Mapping[str, str]) -> None:
    """Write a figure as PNG or SVG, whole or not at all, the same every time.

    The metadata become text chunks of a PNG; an SVG, whose vocabulary is
    limited, holds them as JSON in its description.
    """
    # Neither a time nor a version of matplotlib's own.
    if Path(path).suffix == ".svg":
        embedded = {"Date": None, "Creator": None, "Description": json.dumps(dict(metadata))}
    else:
        embedded = {"Software": None, **metadata}
    with replacing(path) as temporary:
        figure.savefig(temporary, metadata=embedded)
