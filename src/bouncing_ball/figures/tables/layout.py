"""Tables from datasets: rows are parts of a dataset, columns are functions of such a part."""

from collections.abc import Callable, Iterable
from typing import Any

import xarray as xr

from bouncing_ball.figures.tables.formats import Table, number, words

Column = Callable[[xr.Dataset], str]
"""A function that makes the text of a cell from the part of the dataset for its row."""
Columns = dict[str, Column]
"""Columns by their headings."""


def table(parts: Iterable[xr.Dataset], columns: Columns) -> Table:
    """The header, and a row of texts for each part.

    Examples
    --------
    >>> data = [xr.Dataset({"n": n, "x": x}) for n, x in ((1, 0.5), (2, float("nan")))]
    >>> table(data, {"n": text("n"), "x": value("x", ".2f")})
    (['n', 'x'], [['1', '0.50'], ['2', '–']])
    """
    return list(columns), [[column(part) for column in columns.values()] for part in parts]


def text(name: str) -> Column:
    """The column of a variable as text without a number format."""
    return lambda part: str(part[name].item())


def quantity(part: xr.Dataset) -> str:
    """The name of the quantity of a row."""
    return words(part["quantity"].item())


def value(name: str, form: str, none: str = "–") -> Column:
    """The column of a variable in a number format; ``none`` stands for NaN."""
    return lambda part: number(part[name], form, none)


def at(column: Column, **where: Any) -> Column:
    """A column at one place along dimensions over which the rows do not run."""
    return lambda part: column(part.sel(where))
