"""Small tables as CSV and Markdown text.

Tables from datasets: rows are parts of a dataset, columns are functions of such a part.
"""

import csv
import io
from collections.abc import Callable, Iterable, Sequence
from typing import Any

import numpy as np
import xarray as xr

Rows = Sequence[Sequence[str]]
TextTable = tuple[list[str], list[list[str]]]
"""Header and rows."""


def words(name: object) -> str:
    """A name in words, as in a table.

    Examples
    --------
    >>> words("max_height")
    'max height'
    """
    return str(name).replace("_", " ")


def entry_of(value: Any, form: str, none: str = "–") -> str:
    """A number in a format, or ``none`` if it is NaN or infinite.

    Examples
    --------
    >>> entry_of(2.0, ".2f"), entry_of(float("nan"), ".2f")
    ('2.00', '–')
    """
    return f"{float(value):{form}}" if np.isfinite(value) else none


def to_csv(header: Sequence[str], rows: Rows) -> str:
    """Comma-separated values.

    Examples
    --------
    >>> to_csv(["n", "from"], [["1", "0.255"]])
    'n,from\\n1,0.255\\n'
    """
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(header)
    writer.writerows(rows)
    return text.getvalue()


def to_markdown(header: Sequence[str], rows: Rows) -> str:
    """A pipe table.

    Examples
    --------
    >>> print(to_markdown(["n"], [["1"]]), end="")
    | n |
    | --- |
    | 1 |
    """
    lines = [header, ["---"] * len(header), *rows]
    return "".join("| " + " | ".join(line) + " |\n" for line in lines)


Column = Callable[[xr.Dataset], str]
"""A function that makes the text of a cell from the part of the dataset for its row."""

Columns = dict[str, Column]
"""Columns by their headings."""


def text_table(parts: Iterable[xr.Dataset], columns: Columns) -> TextTable:
    """The header, and a row of texts for each part.

    Examples
    --------
    >>> data = [xr.Dataset({"n": n, "x": x}) for n, x in ((1, 0.5), (2, float("nan")))]
    >>> text_table(data, {"n": text("n"), "x": value("x", ".2f")})
    (['n', 'x'], [['1', '0.50'], ['2', '–']])
    """
    return list(columns), [[column(part) for column in columns.values()] for part in parts]


def text(name: str) -> Column:
    """The column of a variable as text without a number format."""
    return lambda part: str(part[name].item())


def quantity_in_words(part: xr.Dataset) -> str:
    """The column of the names of the quantities."""
    return words(part["quantity"].item())


def value(name: str, form: str, none: str = "–") -> Column:
    """The column of a variable in a number format; ``none`` stands for NaN."""
    return lambda part: entry_of(part[name], form, none)


def at(column: Column, **where: Any) -> Column:
    """A column at one place along dimensions over which the rows do not run."""
    return lambda part: column(part.sel(where))


def threshold(form: str, within: str, never: str) -> Column:
    """A column of thresholds, with the given texts for thresholds outside the range scanned."""

    def column(part: xr.Dataset) -> str:
        outside = within if part.threshold_status.item() == "within" else never
        return entry_of(part.error_threshold, form, outside)

    return column
