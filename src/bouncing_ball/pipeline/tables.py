"""The job of a table: listed from its dataset, and written as CSV and in Markdown."""

from collections.abc import Callable
from typing import Any

import xarray as xr

from bouncing_ball.datasets.files import write_text
from bouncing_ball.drawing.tables import to_csv, to_markdown
from bouncing_ball.pipeline.datasets import read_input


def write_table(snakemake: Any, table: Callable[[xr.Dataset], Any]) -> None:
    """Write the table of the job, whose columns the function takes from the dataset."""
    columns = table(read_input(snakemake.input.data))
    write_text(snakemake.output.csv, to_csv(*columns))
    write_text(snakemake.output.md, to_markdown(*columns))
