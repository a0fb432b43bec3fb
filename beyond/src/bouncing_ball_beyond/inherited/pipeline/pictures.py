"""The job of a picture, which is drawn from a dataset and written as PNG and SVG.

It is apart from the other jobs because it imports matplotlib.
"""

from collections.abc import Callable
from typing import Any

from matplotlib.figure import Figure

from bouncing_ball_beyond.inherited.drawing.files import save
from bouncing_ball_beyond.inherited.drawing.style import style
from bouncing_ball_beyond.inherited.pipeline.job import provenance, read_input, using


def draw(snakemake: Any, drawing: Callable[..., Figure]) -> None:
    """Draw the figure of the job, from its dataset unless it is a schematic."""
    path = snakemake.input.get("data")
    with style():
        if path:
            data = read_input(path)
            with using(path):
                figure = drawing(data)
        else:
            figure = drawing()
        metadata = provenance(snakemake, snakemake.output[0])
        for file in snakemake.output:
            save(figure, file, metadata)
