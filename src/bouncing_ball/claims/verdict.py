"""The verdict on a claim: a number against a printed one, or a condition that holds or not."""

from dataclasses import dataclass
from enum import StrEnum

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike

from bouncing_ball.datasets.rounding import compared_text
from bouncing_ball.errors import ModelError

CLOSE_UNITS = 2
"""A number is close, and not contradicted, if it differs by no more than so many units of its
last printed digit, because a rounded intermediate result, or a point read off a curve, may
cause as much. The bound is our choice."""

# Relative tolerance, so that rounding does not decide about a number exactly on a bound.
_ROUNDING = 1e-9


class Verdict(StrEnum):
    """The verdicts, from the best to the worst, and the absence of a verdict."""

    REPRODUCED = "reproduced"
    """Within half a unit of the last printed digit; a condition that holds."""
    QUALIFIED = "qualified"
    """Reproduced for what the paper means it for, but not in other readings."""
    CLOSE = "close"
    """A number farther away, by no more than :data:`CLOSE_UNITS`."""
    CONTRADICTED = "contradicted"
    UNDECIDABLE = "undecidable"
    """The verdict depends on how the claim is read."""
    NOT_ASKED = "not asked"
    """The datasets were not computed with the paper's parameters."""
    CONFIRMED = "confirmed"
    """A statement of ours that holds in the whole interval of the number found."""
    NOT_DECIDED = "not decided"
    """A statement of ours that holds in a part of the interval."""


@dataclass(frozen=True)
class Finding:
    """The number that decides a claim in one reading, with its verdict.

    ``required`` is the printed number, or the condition in signs with its ``limit``,
    which is NaN for a printed number. ``deviation_units`` and ``deviation`` are the difference from
    a printed number, in units of its last digit and as a share of it; NaN for a condition.
    ``low`` and ``high`` are the limits of an estimate, NaN for a number that is none.
    """

    found: float
    verdict: Verdict
    required: str = ""
    limit: float = np.nan
    deviation_units: float = np.nan
    deviation: float = np.nan
    low: float = np.nan
    high: float = np.nan

    def __str__(self) -> str:
        """The number found, or its bound if that is of the size of rounding."""
        return compared_text(self.found, self.limit)


def _finite(values: ArrayLike | xr.DataArray) -> np.ndarray:
    """The numbers as an array; a missing one is an error, because it would decide nothing."""
    numbers = np.asarray(values, dtype=float)
    missing = int(np.isnan(numbers).sum())
    if missing or not numbers.size:
        name = getattr(values, "name", None) or "the number that decides"
        raise ModelError(f"{name}: {missing} of {numbers.size} numbers missing")
    return numbers


def largest(values: ArrayLike | xr.DataArray) -> float:
    """The largest of some numbers.

    Raises
    ------
    ModelError
        If there is none, or one of them is NaN.

    Examples
    --------
    >>> largest([1.0, 3.0])
    3.0
    """
    return float(_finite(values).max())


def smallest(values: ArrayLike | xr.DataArray) -> float:
    """The smallest of some numbers.

    Raises
    ------
    ModelError
        If there is none, or one of them is NaN.

    Examples
    --------
    >>> smallest([1.0, 3.0])
    1.0
    """
    return float(_finite(values).min())


def _condition(value: float, sign: str, bound: float, holds: bool) -> Finding:
    verdict = Verdict.REPRODUCED if holds else Verdict.CONTRADICTED
    return Finding(value, verdict, f"{sign} {bound:g}", bound)


def at_most(values, bound) -> Finding:
    """The finding that all values are at most a bound; a tie counts in favour of the condition.

    Of several bounds the smallest decides.

    Raises
    ------
    ModelError
        If there is no value, or one of them is NaN; likewise in the other conditions.

    Examples
    --------
    >>> [str(at_most(x, 0.01).verdict) for x in (0.009, 0.01, [0.009, 0.011])]
    ['reproduced', 'reproduced', 'contradicted']
    """
    value, limit = largest(values), smallest(bound)
    return _condition(value, "≤", limit, value <= limit + _ROUNDING * abs(limit))


def at_least(values, bound) -> Finding:
    """The finding that all values are at least a bound; a tie counts in favour of the condition.

    Of several bounds the largest decides.

    Examples
    --------
    >>> [str(at_least(x, 2).verdict) for x in (3, 2, [3, 1])]
    ['reproduced', 'reproduced', 'contradicted']
    """
    value, limit = smallest(values), largest(bound)
    return _condition(value, "≥", limit, value >= limit - _ROUNDING * abs(limit))


def below(values, bound) -> Finding:
    """The finding that all values are below a bound, the smallest of several.

    Examples
    --------
    >>> [str(below(x, 2).verdict) for x in (1, 2)]
    ['reproduced', 'contradicted']
    """
    value, limit = largest(values), smallest(bound)
    return _condition(value, "<", limit, value < limit)


def above(values, bound) -> Finding:
    """The finding that all values are above a bound, the largest of several.

    Examples
    --------
    >>> [str(above(x, 2).verdict) for x in (3, 2)]
    ['reproduced', 'contradicted']
    """
    value, limit = smallest(values), largest(bound)
    return _condition(value, ">", limit, value > limit)


def against_print(value: float, printed: str) -> Finding:
    """A computed number judged by its distance from a printed one, in units of the last digit.

    Raises
    ------
    ModelError
        If the number is NaN.

    Examples
    --------
    >>> pairs = (82.177, "82"), (0.2395, "0.238"), (9.81, "6")
    >>> [str(against_print(*pair).verdict) for pair in pairs]
    ['reproduced', 'close', 'contradicted']
    """
    value, wanted = largest(value), float(printed)
    units = (value - wanted) * 10.0 ** len(printed.partition(".")[2])
    if abs(units) <= 0.5 + _ROUNDING:
        verdict = Verdict.REPRODUCED
    elif abs(units) <= CLOSE_UNITS + _ROUNDING:
        verdict = Verdict.CLOSE
    else:
        verdict = Verdict.CONTRADICTED
    return Finding(value, verdict, printed, np.nan, units, (value - wanted) / abs(wanted))


def decided(estimate: ArrayLike, *, above: float = -np.inf, below: float = np.inf) -> Finding:
    """The finding that the interval of an estimate lies above a bound, or below one.

    ``estimate`` is a number, or a number with its lower and its upper limit. The statement is
    contradicted if the whole interval lies beyond the bound, and not decided if a part of it does,
    or if a limit is NaN.

    Examples
    --------
    >>> [str(decided([x, x - 1, x + 1], above=3).verdict) for x in (5, 3, 1)]
    ['confirmed', 'not decided', 'contradicted']
    """
    value, low, high = map(float, np.broadcast_to(estimate, 3))
    # A mean life may be infinite.
    holds = low > above and (high < below or np.isinf(below))
    fails = high <= above or low >= below
    verdict = Verdict.CONTRADICTED if fails else Verdict.NOT_DECIDED
    required = f"> {above:g}" if np.isinf(below) else f"< {below:g}"
    return Finding(value, Verdict.CONFIRMED if holds else verdict, required, low=low, high=high)
