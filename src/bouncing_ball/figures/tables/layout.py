"""Tables from datasets: parts of a dataset as rows, descriptions of a cell as columns."""

from collections.abc import Callable, Iterable
from typing import Any

import xarray as xr

from bouncing_ball.figures.tables.formats import Table, number, words

Column = Callable[[xr.Dataset], str]
"""The text of a cell from the part of the dataset that its row is about."""
Columns = dict[str, Column]
"""Columns by their headings."""


def table(parts: Iterable[xr.Dataset], columns: Columns) -> Table:
    """Header and rows.

    Examples
    --------
    >>> data = [xr.Dataset({"n": n, "x": x}) for n, x in ((1, 0.5), (2, float("nan")))]
    >>> table(data, {"n": text("n"), "x": value("x", ".2f")})
    (['n', 'x'], [['1', '0.50'], ['2', '–']])
    """
    return list(columns), [[column(part) for column in columns.values()] for part in parts]


def text(name: str) -> Column:
    """A variable as it is."""
    return lambda part: str(part[name].item())


def quantity(part: xr.Dataset) -> str:
    """The quantity of a row in words."""
    return words(part["quantity"].item())


def value(name: str, form: str, none: str = "–") -> Column:
    """A variable in a format."""
    return lambda part: number(part[name], form, none)


def at(column: Column, **where: Any) -> Column:
    """A column that is about one place along dimensions which the rows leave."""
    return lambda part: column(part.sel(where))
