"""Figures as files that are identical from run to run."""

import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from matplotlib.figure import Figure

from bouncing_ball.datasets.files import replacing


def save(figure: Figure, path: str | Path, metadata: Mapping[str, str]) -> None:
    """Write a figure, completely or not at all, with the same bytes every time.

    The metadata become text chunks of a PNG; an SVG, whose vocabulary is
    limited, holds them as JSON in its description.

    Raises
    ------
    OSError
        If the file cannot be written.
    """
    # No time and no version, which matplotlib would write otherwise.
    texts: dict[str, Any] = {"Software": None, **metadata}
    if Path(path).suffix == ".svg":
        texts = {"Date": None, "Creator": None, "Description": json.dumps(dict(metadata))}
    with replacing(path) as temporary:
        figure.savefig(temporary, metadata=texts)
