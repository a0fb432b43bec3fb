"""Tables cell by cell, and texts line by line."""

import csv
import io
import re

from bouncing_ball.comparison.verdicts import Verdict

# A number as it is printed, with its sign and exponent.
_NUMBER = re.compile(r"[-+]?\d+(?:\.\d+)?(?:[eE][-+]?\d+)?")
_METADATA = re.compile(r"<metadata\b.*?</metadata>\s*", re.DOTALL)


def without_metadata(svg: str) -> str:
    """A vector graphic without the block that tells how it was made.

    Examples
    --------
    >>> without_metadata("<svg><metadata><a>1</a></metadata><g/></svg>")
    '<svg><g/></svg>'
    """
    return _METADATA.sub("", svg)


def compare_texts(record: str, new: str) -> tuple[Verdict, str]:
    """Verdict and the first line that differs.

    Examples
    --------
    >>> verdict, note = compare_texts("a\\nb\\n", "a\\nc\\n")
    >>> str(verdict), note
    ('drifted', 'line 2: b → c')
    """
    if record == new:
        return Verdict.IDENTICAL, ""
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
            return Verdict.DRIFTED, f"line {number}: {shown}"
    if len(before) == len(after):
        return Verdict.DRIFTED, "ends of lines"
    return Verdict.DRIFTED, f"{len(before)} lines → {len(after)} lines"


def compare_tables(record: str, new: str, data: Verdict | None) -> tuple[Verdict, str]:
    """Verdict on two CSV tables, and the first cell that differs.

    A table prints a dataset. Where the data have drifted within their budget,
    printed digits may move with them; where the data are the same, or there
    are none, a digit that moves is a drift.

    Parameters
    ----------
    record, new : str
    data : Verdict or None
        The verdict on the dataset of the same name.

    Examples
    --------
    >>> [str(compare_tables("x\\n0.25\\n", "x\\n0.26\\n", data)[0])
    ...  for data in (Verdict.WITHIN, Verdict.IDENTICAL)]
    ['within budget', 'drifted']
    >>> compare_tables("x\\n0.25\\n", "x,y\\n0.25,1\\n", Verdict.IDENTICAL)[1]
    'columns of row 1: 1 → 2'
    """
    before, after = (list(csv.reader(io.StringIO(text))) for text in (record, new))
    if before == after:
        return Verdict.IDENTICAL, ""
    if len(before) != len(after):
        return Verdict.STRUCTURE, f"rows: {len(before)} → {len(after)}"
    moved = []
    for row, (old, line) in enumerate(zip(before, after, strict=True), start=1):
        if len(old) != len(line):
            return Verdict.STRUCTURE, f"columns of row {row}: {len(old)} → {len(line)}"
        for column, (cell, other) in enumerate(zip(old, line, strict=True), start=1):
            if cell == other:
                continue
            place = f"row {row}, column {column}: {cell} → {other}"
            if _NUMBER.split(cell) != _NUMBER.split(other):
                return Verdict.STRUCTURE, place
            moved.append(place)
    more = f" and {len(moved) - 1} more" if len(moved) > 1 else ""
    verdict = Verdict.WITHIN if data is Verdict.WITHIN else Verdict.DRIFTED
    return verdict, moved[0] + more
