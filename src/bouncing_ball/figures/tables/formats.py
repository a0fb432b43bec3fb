"""Small tables as CSV and Markdown text."""

import csv
import io
from collections.abc import Sequence
from typing import Any

import numpy as np

Rows = Sequence[Sequence[str]]
Table = tuple[list[str], list[list[str]]]
"""Header and rows."""


def words(name: object) -> str:
    """A name in words, as in a table.

    Examples
    --------
    >>> words("max_height")
    'max height'
    """
    return str(name).replace("_", " ")


def number(value: Any, form: str, none: str = "–") -> str:
    """A number in a format, or ``none`` if it is NaN or infinite.

    Examples
    --------
    >>> number(2.0, ".2f"), number(float("nan"), ".2f")
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


def texts(header: Sequence[str], rows: Rows) -> dict[str, str]:
    """A table in all formats, by the suffix of its file.

    Examples
    --------
    >>> list(texts(["n"], [["1"]]))
    ['.csv', '.md']
    """
    return {".csv": to_csv(header, rows), ".md": to_markdown(header, rows)}
