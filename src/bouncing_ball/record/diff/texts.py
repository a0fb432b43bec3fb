"""Tables cell by cell, and texts line by line."""

import csv
import io
import re
from decimal import Decimal
from xml.etree import ElementTree

from bouncing_ball.record.diff.outcome import Outcome

# A number as it is printed, with its sign and exponent.
_NUMBER = re.compile(r"[-+]?\d+(?:\.\d+)?(?:[eE][-+]?\d+)?")
# Below, a number is only the size of a rounding error: it has no digits that
# two processors share. The largest budget of a disagreement between two routes
# to one number, that of the witness's rate of departure (audit/cross_check.py).
_ROUNDING_LEVEL = Decimal("1e-5")
_METADATA = re.compile(r"<metadata\b.*?</metadata>\s*", re.DOTALL)


class PictureTextError(ValueError):
    """A text that is no vector graphic."""


class TableError(ValueError):
    """A text that is no CSV table."""


def without_metadata(svg: str) -> str:
    """A vector graphic without the block that tells how it was made.

    Examples
    --------
    >>> without_metadata("<svg><metadata><a>1</a></metadata><g/></svg>")
    '<svg><g/></svg>'
    """
    return _METADATA.sub("", svg)


def check_svg(text: str) -> None:
    """Raise :class:`PictureTextError` unless a text is a whole vector graphic."""
    try:
        ElementTree.fromstring(text)
    except ElementTree.ParseError as error:
        raise PictureTextError(f"not a whole SVG file: {error}") from None


def compare_texts(record: str, new: str) -> tuple[Outcome, str]:
    """Outcome and the first line that differs.

    Examples
    --------
    >>> outcome, note = compare_texts("a\\nb\\n", "a\\nc\\n")
    >>> str(outcome), note
    ('drifted', 'line 2: b → c')
    """
    if record == new:
        return Outcome.IDENTICAL, ""
    before, after = record.splitlines(), new.splitlines()
    for number, (old, line) in enumerate(zip(before, after, strict=False), start=1):
        if old != line:
            # Long lines from where they begin to differ.
            same = next(
                (k for k, pair in enumerate(zip(old, line, strict=False)) if pair[0] != pair[1]),
                min(len(old), len(line)),
            )
            start = max(0, same - 10)
            shown = " → ".join(part[start : start + 40].strip() for part in (old, line))
            return Outcome.DRIFTED, f"line {number}: {shown}"
    if len(before) == len(after):
        return Outcome.DRIFTED, "ends of lines"
    return Outcome.DRIFTED, f"{len(before)} lines → {len(after)} lines"


def _last_digit(number: str) -> Decimal:
    """One unit of the last printed digit.

    Examples
    --------
    >>> [str(_last_digit(text)) for text in ("0.25", "-4.5e-13", "82")]
    ['0.01', '1E-14', '1']
    """
    exponent = Decimal(number).as_tuple().exponent
    return Decimal((0, (1,), int(exponent)))


def _same_to_the_last_digit(old: str, new: str) -> bool:
    """Whether two printed numbers may be one number, rounded on two processors.

    Examples
    --------
    >>> _same_to_the_last_digit("0.25", "0.26"), _same_to_the_last_digit("0.25", "0.27")
    (True, False)
    >>> _same_to_the_last_digit("99.99", "100"), _same_to_the_last_digit("9e-16", "0.0e+00")
    (True, True)
    >>> _same_to_the_last_digit("7", "8")
    False
    """
    if old == new:
        return True
    a, b = Decimal(old), Decimal(new)
    if old.lstrip("+-").isdigit() and new.lstrip("+-").isdigit():
        # A count, or a part of a name.
        return a == b
    # Across a power of ten, and where zeros are left out, the smaller unit is the step.
    unit = min(_last_digit(old), _last_digit(new))
    return abs(a - b) <= unit or max(abs(a), abs(b)) < _ROUNDING_LEVEL


def compare_tables(record: str, new: str, data: Outcome | None) -> tuple[Outcome, str]:
    """Outcome on two CSV tables, and the first cell that differs.

    A table prints a dataset. Where the data have drifted within their budget,
    the last printed digit may move with them by one, and numbers of the size of
    rounding at will; nothing else may. Where the data are the same, or there
    are none, a digit that moves is a drift.

    Parameters
    ----------
    record, new : str
    data : Outcome or None
        The outcome on the dataset of the same name.

    Raises
    ------
    TableError
        If one of them is no CSV table.

    Examples
    --------
    >>> [str(compare_tables("x\\n0.25\\n", "x\\n0.26\\n", data)[0])
    ...  for data in (Outcome.WITHIN, Outcome.IDENTICAL)]
    ['within budget', 'drifted']
    >>> str(compare_tables("x\\n0.25\\n", "x\\n0.31\\n", Outcome.WITHIN)[0])
    'drifted'
    >>> compare_tables("x\\n0.25\\n", "x,y\\n0.25,1\\n", Outcome.IDENTICAL)[1]
    'columns of row 1: 1 → 2'
    """
    try:
        before, after = (list(csv.reader(io.StringIO(text))) for text in (record, new))
    except csv.Error as error:
        raise TableError(f"not a CSV table: {error}") from None
    if before == after:
        return Outcome.IDENTICAL, ""
    if len(before) != len(after):
        return Outcome.STRUCTURE, f"rows: {len(before)} → {len(after)}"
    moved, too_far = [], []
    for row, (old, line) in enumerate(zip(before, after, strict=True), start=1):
        if len(old) != len(line):
            return Outcome.STRUCTURE, f"columns of row {row}: {len(old)} → {len(line)}"
        for column, (cell, other) in enumerate(zip(old, line, strict=True), start=1):
            if cell == other:
                continue
            place = f"row {row}, column {column}: {cell} → {other}"
            if _NUMBER.split(cell) != _NUMBER.split(other):
                return Outcome.STRUCTURE, place
            moved.append(place)
            pairs = zip(_NUMBER.findall(cell), _NUMBER.findall(other), strict=True)
            if not all(_same_to_the_last_digit(*pair) for pair in pairs):
                too_far.append(place)
    if data is Outcome.WITHIN and not too_far:
        return Outcome.WITHIN, _first_of(moved)
    return Outcome.DRIFTED, _first_of(too_far if data is Outcome.WITHIN else moved)


def _first_of(places: list[str]) -> str:
    more = f" and {len(places) - 1} more" if len(places) > 1 else ""
    return places[0] + more
