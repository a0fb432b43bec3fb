"""What moved, in words: a line for each artifact, that of the largest change first."""

import math
from collections import Counter
from contextlib import suppress

from bouncing_ball.pipeline.artifacts import DATASET
from bouncing_ball.pipeline.diff.outcome import ComparedItem, Outcome, Whole

# More changes of words than these are counted.
_NAMED = 6
# Files of code that are named, and how the line with them begins.
_SUSPECTS = 4
_CODE = "changed code (artifacts made by it that differ, and that do not)"
# Of a value that is within an absolute budget, a relative change above this is named nevertheless,
# unless the change itself is below the second number: it is rounding.
_LARGE = 1.0
_ROUNDING = 1e-9
# Digits of a number beside which there is none.
_ENOUGH = 5
# A number in double precision has no more digits.
_ALL_DIGITS = 17
# A percentage above this is read more easily as a factor.
_FACTOR = 10.0
# Above this the record's number is rounding.
_FROM_NOTHING = 1e6


def change_in_percent(change: float) -> str:
    """A relative change with two digits, as a factor if it is large; empty if there is none, and
    for a change from rounding to a number, of which a factor says nothing.

    Examples
    --------
    >>> [change_in_percent(change) for change in (0.000941, -0.25, 8.0, 41.0, 0.0, 1e10)]
    ['+0.094 %', '-25 %', '+800 %', '× 42', '', '']
    """
    if not math.isfinite(change) or change == 0 or change > _FROM_NOTHING:
        return ""
    if change > _FACTOR:
        return f"× {1 + change:.2g}"
    two = f"{100 * change:+.2g}"
    return f"{float(two):+.0f} %" if "e+" in two else f"{two} %"


def moved_by(row: ComparedItem) -> str:
    """The change of a number in words; of one that was almost nothing, as a part of its range.

    Examples
    --------
    >>> moved_by(ComparedItem("level", Outcome.DRIFTED, "2.0", "1.5", change=-0.25))
    '-25 %'
    >>> moved_by(ComparedItem("level", Outcome.DRIFTED, "2e-14", "5.6", change=0.52))
    '+52 % of the range'
    """
    change = change_in_percent(row.change)
    if not change:
        return ""
    record = float(row.record or 0)
    moved = abs(float(row.new or 0) - record)
    # A number below a thousandth of the range of its variable is compared with this range.
    if moved < 2 * abs(row.change * record):
        return change
    return f"{100 * row.change:+.2g} % of the range" if row.change <= _FACTOR else ""


def both_contents(row: ComparedItem) -> str:
    """Both contents of a row; of numbers the digits that differ, and one more.

    Examples
    --------
    >>> row = ComparedItem("phase", Outcome.DRIFTED, "0.8403156852330397", "0.8395002457896041")
    >>> both_contents(row)
    '0.84032 → 0.83950'
    >>> both_contents(ComparedItem("orbits", Outcome.DRIFTED, "1204", "1187"))
    '1204 → 1187'
    >>> both_contents(ComparedItem("phase", Outcome.DRIFTED, "0.15487439262148725", "nan"))
    '0.15487 → nan'
    """
    record = str(row.record)
    new = str(row.new)
    if row.record is None or row.new is None or record.lstrip("-").isdigit():
        return f"{row.record or 'nothing'} → {row.new or 'nothing'}"
    with suppress(ValueError):
        if not math.isfinite(float(record)) or not math.isfinite(float(new)):
            return " → ".join(f"{float(text):.{_ENOUGH}g}" for text in (record, new))
    try:
        far = abs(float(new) - float(record)) / max(abs(float(new)), abs(float(record)))
        digits = max(3, 2 - math.ceil(math.log10(far)))
    # Words, NaN, or an infinity.
    except (ValueError, ZeroDivisionError, OverflowError):
        return f"{record} → {new}"
    if digits > _ALL_DIGITS:
        return f"{record} → {new}"
    return " → ".join(f"{float(text):#.{digits}g}".removesuffix(".") for text in (record, new))


def _told(row: ComparedItem) -> str:
    """One variable in words."""
    if row.changes:
        named = "; ".join(row.changes[:_NAMED])
        more = len(row.changes) - _NAMED
        rest = f"; and {more} more" if more > 0 else ""
        return f"{len(row.changes)} changed in {row.name}: {named}{rest}"
    others = f" and {row.beyond - 1} more" if row.beyond > 1 else ""
    place = f" at {row.at}{others}" if row.at else ""
    change = moved_by(row)
    return (
        f"{f'{change} in ' if change else ''}{row.title or row.name}{place}: {both_contents(row)}"
    )


def _telling(rows: list[ComparedItem]) -> ComparedItem:
    """The variable that says most: words before single numbers, and these before curves."""
    order = [
        (not row.changes, row.entries > 1, not math.isnan(row.change), -abs(row.change))
        for row in rows
    ]
    return rows[order.index(min(order))]


def telling_row(artifact: Whole) -> ComparedItem | None:
    """The variable of an artifact's dataset that says most about its drift."""
    for file in artifact.parts:
        if file.name.endswith(DATASET):
            rows = [row for row in file.parts if row.outcome is Outcome.DRIFTED and row.entries]
            return _telling(rows) if rows else None
    return None


def _large(artifact: Whole) -> list[ComparedItem]:
    """The variables with a large relative change that an absolute budget allows."""
    rows = [row for file in artifact.parts if file.name.endswith(DATASET) for row in file.parts]
    return [
        row
        for row in rows
        if row.outcome is Outcome.WITHIN
        and abs(row.change) > _LARGE
        and abs(float(row.new or 0) - float(row.record or 0)) > _ROUNDING
    ]


def changed_code(comparison: Whole) -> str:
    """The files of code that changed since the record, where the cause of the differences may be.

    A file comes the earlier, the more of the artifacts that differ it has made, and the fewer
    others. The line is empty if no artifact differs, or if no file has changed.

    Examples
    --------
    >>> moved = (ComparedItem("level", Outcome.DRIFTED),)
    >>> fig14 = Whole("fig14", (Whole("figures/fig14.nc", moved),), code=("a.py", "b.py"))
    >>> changed_code(Whole("", (fig14, Whole("fig15", code=("a.py",)))))
    'changed code (artifacts made by it that differ, and that do not): b.py (1, 0), a.py (1, 1)'
    """
    differ: Counter[str] = Counter()
    agree: Counter[str] = Counter()
    for artifact in comparison.parts:
        counted = agree if artifact.outcome.agrees else differ
        counted.update(artifact.code)
    order = sorted(differ, key=lambda file: (-differ[file], agree[file], file))
    named = [f"{file} ({differ[file]}, {agree[file]})" for file in order[:_SUSPECTS]]
    more = len(order) - _SUSPECTS
    rest = f" and {more} more" if more > 0 else ""
    return f"{_CODE}: {', '.join(named)}{rest}" if named else ""


def summary_of_changes(comparison: Whole) -> list[str]:
    """The code that changed, and a line for each change from the record: what moved, how much.

    Artifacts with the same change share a line.

    Examples
    --------
    >>> row = ComparedItem("level", Outcome.DRIFTED, "82.2", "83.0", entries=1, title="threshold",
    ...     change=0.00973)
    >>> fig14 = Whole("fig14", (Whole("figures/fig14.nc", (row,)),), cause="numbers moved")
    >>> summary_of_changes(Whole("", (fig14,)))
    ['fig14: +0.97 % in threshold: 82.20 → 83.00']
    """
    found: dict[str, tuple[tuple[int, int, float], list[str]]] = {}

    def tell(name: str, told: str, order: tuple[int, int, float]) -> None:
        found.setdefault(told, (order, []))[1].append(name)

    for artifact in comparison.parts:
        if artifact.outcome.agrees:
            for row in _large(artifact):
                tell(artifact.name, f"within its budget, {_told(row)}", (1, 0, 0.0))
            continue
        row = telling_row(artifact) if artifact.outcome is Outcome.DRIFTED else None
        told = _told(row) if row else artifact.cause
        change = row.change if row else 0.0
        size = 0.0 if math.isnan(change) else abs(change)
        # Words first, then what became NaN, then the largest change.
        kind = 0 if row is None or row.changes else 2 - math.isnan(change)
        tell(artifact.name, told, (-artifact.outcome.rank, kind, -size))
    lines = [
        f"{', '.join(sorted(names))}: {told}"
        for told, (_, names) in sorted(found.items(), key=lambda each: each[1][0])
    ]
    code = changed_code(comparison)
    return [code, *lines] if code else lines
