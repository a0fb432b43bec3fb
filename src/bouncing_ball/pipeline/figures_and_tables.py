"""The jobs of a picture and of a table, which are made from a dataset.

A picture is written as PNG and SVG, with its provenance, and a table as CSV and in Markdown.
"""

from collections.abc import Callable
from typing import Any

import xarray as xr
from matplotlib.figure import Figure

from bouncing_ball.datasets.files import write_text
from bouncing_ball.drawing.files import save
from bouncing_ball.drawing.style import style
from bouncing_ball.drawing.tables import to_csv, to_markdown
from bouncing_ball.pipeline.job import provenance, read_input, using


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


def write_table(snakemake: Any, table: Callable[[xr.Dataset], Any]) -> None:
    """Write the table of the job, whose columns the function takes from the dataset."""
    columns = table(read_input(snakemake.input.data))
    write_text(snakemake.output.csv, to_csv(*columns))
    write_text(snakemake.output.md, to_markdown(*columns))
