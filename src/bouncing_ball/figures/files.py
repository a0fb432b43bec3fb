"""Figures as files that are the same from run to run."""

import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from matplotlib.figure import Figure

from bouncing_ball.datasets.files import replacing


def save(figure: Figure, path: str | Path, metadata: Mapping[str, str]) -> None:
    """Write a figure, whole or not at all, the same every time.

    The metadata become text chunks of a PNG; an SVG, whose vocabulary is
    limited, holds them as JSON in its description.
    """
    # Neither a time nor a version of matplotlib's own.
    texts: dict[str, Any] = {"Software": None, **metadata}
    if Path(path).suffix == ".svg":
        texts = {"Date": None, "Creator": None, "Description": json.dumps(dict(metadata))}
    with replacing(path) as temporary:
        figure.savefig(temporary, metadata=texts)
