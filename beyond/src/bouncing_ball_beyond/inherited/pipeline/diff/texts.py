"""The comparison of texts line by line: words exactly, numbers as far as their data allow."""

import re
from collections.abc import Sequence
from decimal import Decimal
from difflib import SequenceMatcher
from itertools import takewhile, zip_longest
from pathlib import Path

from bouncing_ball_beyond.inherited.pipeline.diff.outcome import Outcome, Row

NUMBER = re.compile(r"[-+]?\d+(?:\.\d+)?(?:[eE][-+]?\d{1,4})?")
"""A printed number with its sign and exponent."""

# Of longer texts, lines that occur often are not matched; it would take as long as for ever.
_LONG = 4000
# More names in a list than these are counted.
_NAMED = 4
# Characters of a line that are shown, and of those some before the difference.
_SHOWN = 60
_BEFORE = 20


def _same_to_the_last_digit(old: str, new: str) -> bool:
    """Whether two printed numbers may be the same number, rounded on two processors.

    Examples
    --------
    >>> _same_to_the_last_digit("0.25", "0.26"), _same_to_the_last_digit("0.25", "0.27")
    (True, False)
    >>> _same_to_the_last_digit("99.99", "100"), _same_to_the_last_digit("7", "8")
    (True, False)
    >>> _same_to_the_last_digit("-4.5e-13", "-4.6e-13"), _same_to_the_last_digit("0.25", "0.3")
    (True, False)
    """
    if old == new or (old.lstrip("+-").isdigit() and new.lstrip("+-").isdigit()):
        # A number without decimals is a count, or a part of a name.
        return old == new
    # If the numbers of decimals differ, at a power of ten or with zeros left out, the step is the
    # smaller unit.
    last = min(int(Decimal(number).as_tuple().exponent) for number in (old, new))
    return abs(Decimal(old) - Decimal(new)) <= Decimal(1).scaleb(last)


def may_be_rounding(old: str, new: str) -> bool:
    """Whether two lines have the same words, and numbers that differ by a last digit at most.

    Examples
    --------
    >>> may_be_rounding("r = 0.25 in 3 orbits", "r = 0.26 in 3 orbits")
    True
    >>> may_be_rounding("right, with 0.25", "wrong, with 0.25")
    False
    """
    return NUMBER.split(old) == NUMBER.split(new) and all(
        map(_same_to_the_last_digit, NUMBER.findall(old), NUMBER.findall(new))
    )


def some(names: Sequence[str]) -> str:
    """The first names, and how many there are more.

    Examples
    --------
    >>> some(["fig05", "fig06", "fig08", "fig09", "fig10"])
    'fig05, fig06, fig08, fig09 and 1 more'
    """
    more = len(names) - _NAMED
    return ", ".join(names[:_NAMED]) + (f" and {more} more" if more > 0 else "")


def excerpt(record: str | None, new: str | None) -> str:
    """Two lines, of long ones the part where they begin to differ.

    Examples
    --------
    >>> excerpt("r = 0.25", "r = 0.26"), excerpt(None, "")
    ('r = 0.25 → r = 0.26', 'nothing → an empty line')
    """
    pairs = zip(record or "", new or "", strict=False)
    start = max(0, len(list(takewhile(lambda pair: pair[0] == pair[1], pairs))) - _BEFORE)
    shown = []
    for line in (record, new):
        part = (line or "")[start : start + _SHOWN].strip()
        after = " …" if len(line or "") > start + _SHOWN else ""
        missing = "nothing" if line is None else "an empty line"
        shown.append(f"{'… ' if start else ''}{part}{after}" if line else missing)
    return " → ".join(shown)


def compare_texts(record: str, new: str, moved: bool) -> list[Row]:
    """All lines that differ, each with its outcome.

    If the data have moved within their budgets, the last digit of a printed number may change by
    one. No other change is allowed: no word, no count, and no digit if the data are identical or
    there are none.

    Parameters
    ----------
    record, new : str
    moved : bool
        Whether the data from which the text is made moved within their budgets.

    Examples
    --------
    >>> for moved in (True, False):
    ...     print(*[str(line.outcome) for line in compare_texts("0.25\\nb", "0.26\\nb", moved)])
    rounding
    drifted
    >>> (line,) = compare_texts("are right\\n", "are wrong\\n", True)
    >>> line.told, str(line.outcome)
    ('line 1: are right → are wrong', 'drifted')
    """
    old_lines, new_lines = (text.split("\n") for text in (record, new))
    # Lines are matched by their words, so that a line whose number changes is still matched.
    old_words, new_words = (NUMBER.sub("#", text).split("\n") for text in (record, new))
    is_long = len(old_lines) + len(new_lines) > _LONG
    found = []
    blocks = SequenceMatcher(None, old_words, new_words, autojunk=is_long).get_opcodes()
    for _, first, last, new_first, new_last in blocks:
        pairs = zip_longest(old_lines[first:last], new_lines[new_first:new_last])
        for number, (old, now) in enumerate(pairs, start=first + 1):
            if old != now:
                is_rounding = moved and old and now and may_be_rounding(old, now)
                outcome = Outcome.ROUNDING if is_rounding else Outcome.DRIFTED
                name = f"line {number}"
                found.append(Row(name, outcome, f"{name}: {excerpt(old, now)}", size=0.0))
    return found


def words_of(path: Path, is_same: bool) -> str:
    """The words and numbers of a text, a table or a page.

    Of an HTML page it is all but the commit, and but the reference numbers if their dataset is not
    identical, because they have all its digits.

    Raises
    ------
    OSError, UnicodeDecodeError
        If the file cannot be read, or is not UTF-8.
    """
    # With the ends of lines of any system.
    text = path.read_text(encoding="utf-8")
    if path.suffix != ".html":
        return text
    references = "" if is_same else r'|(?<=id="references">)[^<]*'
    return re.sub(rf'(?<="commit": ")\w+{references}', "", text)
