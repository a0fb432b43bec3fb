"""Texts line by line: words as they are, numbers as their data allow."""

import re
from bisect import bisect_left
from collections import Counter
from collections.abc import Callable
from dataclasses import dataclass
from decimal import Decimal
from itertools import zip_longest

from bouncing_ball.compare.outcome import Outcome, worst

# A number as it is printed, with its sign and exponent. An exponent of more digits
# belongs to no number of ours, and Decimal would refuse it.
_NUMBER = re.compile(r"[-+]?[0-9]+(?:\.[0-9]+)?(?:[eE][-+]?[0-9]{1,4}(?![0-9]))?")


@dataclass(frozen=True)
class Line:
    """A line that is not the same on both sides; None where a side has no such line."""

    place: str
    outcome: Outcome
    record: str | None
    new: str | None


def _last_digit(number: str) -> Decimal:
    """One unit of the last printed digit.

    Examples
    --------
    >>> [str(_last_digit(text)) for text in ("0.25", "-4.5e-13", "82")]
    ['0.01', '1E-14', '1']
    """
    return Decimal((0, (1,), int(Decimal(number).as_tuple().exponent)))


def _same_to_the_last_digit(old: str, new: str) -> bool:
    """Whether two printed numbers may be one number, rounded on two processors.

    Examples
    --------
    >>> _same_to_the_last_digit("0.25", "0.26"), _same_to_the_last_digit("0.25", "0.27")
    (True, False)
    >>> _same_to_the_last_digit("99.99", "100"), _same_to_the_last_digit("7", "8")
    (True, False)
    """
    if old == new:
        return True
    if old.lstrip("+-").isdigit() and new.lstrip("+-").isdigit():
        # A count, or a part of a name.
        return False
    # Across a power of ten, and where zeros are left out, the smaller unit is the step.
    return abs(Decimal(old) - Decimal(new)) <= min(_last_digit(old), _last_digit(new))


def may_be_rounding(old: str, new: str) -> bool:
    """Whether two lines have the same words, and numbers apart by a last digit at most.

    Examples
    --------
    >>> may_be_rounding("r = 0.25 in 3 orbits", "r = 0.26 in 3 orbits")
    True
    >>> may_be_rounding("r = 0.25 in 3 orbits", "r = 0.26 in 4 orbits")
    False
    >>> may_be_rounding("right, with 0.25", "wrong, with 0.25")
    False
    """
    return _NUMBER.split(old) == _NUMBER.split(new) and all(
        map(_same_to_the_last_digit, _NUMBER.findall(old), _NUMBER.findall(new))
    )


def _without_numbers(line: str) -> str:
    return _NUMBER.sub("#", line)


_Key = Callable[[str], str]
_KEYS: tuple[_Key, ...] = (str, _without_numbers)


def _pairs(before: list[str], after: list[str], key: _Key) -> list[tuple[int, int]]:
    """Places of lines whose key is there once on each side, in an order that both have.

    The longest such list, by patience sorting.
    """
    places = []
    for side in (before, after):
        keys = list(map(key, side))
        count = Counter(keys)
        places.append({each: k for k, each in enumerate(keys) if count[each] == 1})
    old, new = places
    # Of the lists of each length, the one that ends first; and what comes before a pair.
    ends: list[tuple[int, int]] = []
    previous: dict[tuple[int, int], tuple[int, int] | None] = {}
    for line, place in old.items():
        if line in new:
            pair = place, new[line]
            length = bisect_left(ends, pair[1], key=lambda end: end[1])
            previous[pair] = ends[length - 1] if length else None
            ends[length:] = [pair, *ends[length + 1 :]]
    found = []
    last = ends[-1] if ends else None
    while last is not None:
        found.append(last)
        last = previous[last]
    return found[::-1]


def _changed(
    before: list[str], after: list[str], first: int = 1, keys: tuple[_Key, ...] = _KEYS
) -> list[tuple[int, str | None, str | None]]:
    """Number of the line and both sides of what is not the same.

    Between lines that are found on both sides as they are, those that are found
    with their numbers taken out; between these, one line after the other.
    """
    if not (keys and before and after):
        sides = enumerate(zip_longest(before, after), start=first)
        return [(number, old, new) for number, (old, new) in sides if old != new]
    found = []
    low = new_low = 0
    for high, new_high in [*_pairs(before, after, keys[0]), (len(before), len(after))]:
        between = before[low:high], after[new_low:new_high]
        found += _changed(*between, first=first + low, keys=keys[1:])
        if high < len(before) and before[high] != after[new_high]:
            found.append((first + high, before[high], after[new_high]))
        low, new_low = high + 1, new_high + 1
    return found


def compare_texts(record: str, new: str, data: Outcome | None) -> tuple[Line, ...]:
    """All lines that are not the same, each with its outcome.

    Where the data have drifted within their budget, the last digit of a printed
    number may move with them by one. Nothing else may: not a word, not a count,
    and no digit where the data are the same or there are none.

    Parameters
    ----------
    record, new : str
    data : Outcome or None
        Of what the text is made from, the worst.

    Examples
    --------
    >>> for data in (Outcome.WITHIN, Outcome.IDENTICAL):
    ...     print(*[str(line.outcome) for line in compare_texts("0.25\\nb", "0.26\\nb", data)])
    within budget
    drifted
    >>> line, = compare_texts("are right\\n", "are wrong\\n", Outcome.WITHIN)
    >>> line.place, str(line.outcome), line.record, line.new
    ('line 1', 'drifted', 'are right', 'are wrong')
    """

    def judged(old: str | None, line: str | None) -> Outcome:
        if data is not Outcome.WITHIN or old is None or line is None:
            return Outcome.DRIFTED
        return Outcome.WITHIN if may_be_rounding(old, line) else Outcome.DRIFTED

    return tuple(
        Line(f"line {number}", judged(old, line), old, line)
        for number, old, line in _changed(record.split("\n"), new.split("\n"))
    )


def summary(lines: tuple[Line, ...]) -> tuple[Outcome, str]:
    """The worst outcome and how many lines have it, in words.

    Examples
    --------
    >>> summary(compare_texts("a\\nb", "c\\nd", None))[1]
    '2 lines changed'
    """
    if not lines:
        return Outcome.IDENTICAL, ""
    result = worst(line.outcome for line in lines)
    count = sum(line.outcome is result for line in lines)
    what = "changed" if result is Outcome.DRIFTED else "moved with their data"
    return result, f"{count} line{'s' * (count != 1)} {what}"
