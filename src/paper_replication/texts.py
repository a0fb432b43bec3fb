"""Numbers and tables as texts."""

import csv
import io
from collections.abc import Iterable
from decimal import ROUND_HALF_EVEN, Decimal
from pathlib import Path

import numpy as np
import xarray as xr

from paper_replication.datasets import write

# Numbers


def fixed(value: float, digits: int, shift: int = 0) -> str:
    """Round a number to a number of decimals, with the decimal point moved by `shift`.

    >>> fixed(82.1774, 2), fixed(-0.25, 1), fixed(-1e-14, 2), fixed(np.nan, 2)
    ('82.18', '−0.2', '0.00', '–')
    """
    if not np.isfinite(value):
        return "–"
    # The shortest decimal number that is this binary one: 0.01 is 1 % and no other share.
    number = Decimal(repr(float(value))).scaleb(shift)
    rounded = number.quantize(Decimal(1).scaleb(-digits), rounding=ROUND_HALF_EVEN)
    # Zero has no sign.
    return str(rounded + 0).replace("-", "−")


def percent(value: float, digits: int | None = None) -> str:
    """Print a share in per cent, with all its digits if `digits` is None.

    >>> percent(0.01), percent(0.005), percent(0.02673, 1), percent(0.01, 2), percent(0.355, 0)
    ('1 %', '0.5 %', '2.7 %', '1.00 %', '36 %')
    """
    text = short(100 * value) if digits is None else fixed(value, digits, shift=2)
    return text if text == "–" else f"{text} %"


def short(value: float) -> str:
    """Print a parameter with all its digits, and large powers of ten as such.

    >>> short(0.85), short(1e3), short(1e4), short(2e4), short(-0.5), short(0.0)
    ('0.85', '1000', '10⁴', '20000', '−0.5', '0')
    """
    number = float(value)
    exponent = round(np.log10(number)) if number > 0 else 0
    if exponent > 3 and number == 10.0**exponent:
        return "10" + str(exponent).translate(str.maketrans("0123456789", "⁰¹²³⁴⁵⁶⁷⁸⁹"))
    return f"{number:g}".replace("-", "−")


def listed(values: Iterable, digits: int | None = None) -> str:
    """List words or numbers, with "and" before the last.

    >>> listed([1.0, 2.5, 4.0]), listed(["one", "two"]), listed([1.234], 2)
    ('1, 2.5 and 4', 'one and two', '1.23')
    """
    texts = [value if isinstance(value, str) else word(value, digits) for value in values]
    *first, last = texts
    return f"{', '.join(first)} and {last}" if first else last


def word(value: float, digits: int | None) -> str:
    """Print a number of a list, with all its digits if `digits` is None."""
    return short(value) if digits is None else fixed(value, digits)


def share_text(share: float) -> str:
    """Return a share in percent with one decimal, or as "< 0.1 %" instead of "0.0 %".

    Examples
    --------
    >>> share_text(0.1222), share_text(0.0004), share_text(0.0), share_text(float("nan"))
    ('12.2 %', '< 0.1 %', 'none', 'unknown')
    >>> share_text(0.00051), share_text(0.00049)
    ('0.1 %', '< 0.1 %')
    """
    if np.isnan(share):
        return "unknown"
    if share == 0:
        return "none"
    return f"{100 * share:.1f} %" if share >= 0.0005 else "< 0.1 %"


def number(value: xr.DataArray | float, form: str, none: str = "–") -> str:
    """Print a number in a format; `none` if it is NaN or infinite."""
    plain = float(value)
    return f"{plain:{form}}" if np.isfinite(plain) else none


# Tables: rows of texts, the header first


def markdown(rows: list[list[str]]) -> str:
    """Print rows of texts, the header first, as a Markdown table.

    >>> print(markdown([["a, b", "c"], ["1", "2"]]), end="")
    | a, b | c |
    | --- | --- |
    | 1 | 2 |
    """
    header, *body = rows
    lines = [header, ["---"] * len(header), *body]
    return "".join(f"| {' | '.join(line)} |\n" for line in lines)


def comma_separated(rows: list[list[str]]) -> str:
    """Print rows of texts, the header first, as CSV."""
    text = io.StringIO()
    csv.writer(text, lineterminator="\n").writerows(rows)
    return text.getvalue()


def save_table(rows: list[list[str]], as_markdown: str | Path, as_csv: str | Path) -> None:
    """Save rows of texts, the header first, as Markdown and as CSV."""
    write(Path(as_markdown), markdown(rows).encode())
    write(Path(as_csv), comma_separated(rows).encode())


def parts_along(data: xr.Dataset, *dimensions: str) -> list[xr.Dataset]:
    """Split a dataset along dimensions; the last dimension varies fastest."""
    parts = [data]
    for name in dimensions:
        parts = [part.isel({name: place}) for part in parts for place in range(data.sizes[name])]
    return parts
