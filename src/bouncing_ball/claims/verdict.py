"""The verdict on a claim: a number against a printed one, or a condition that holds or not."""

from dataclasses import dataclass
from enum import StrEnum

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike

from bouncing_ball.datasets.rounding import compared_text
from bouncing_ball.errors import ModelError

CLOSE_UNITS = 2
"""A number is close, not contradicted, if it is off by no more than so many units of its
last printed digit: what a rounded intermediate result, or a point read off a curve, may
cost. Our choice."""

# Rounding must not decide what lies exactly on a bound.
_ROUNDING = 1e-9


class Verdict(StrEnum):
    """From the best to the worst, and no verdict at all."""

    REPRODUCED = "reproduced"
    """Within half a unit of the last printed digit; a condition that holds."""
    CLOSE = "close"
    """A number farther away, by no more than :data:`CLOSE_UNITS`."""
    CONTRADICTED = "contradicted"
    UNDECIDABLE = "undecidable"
    """Depends on how the claim is read."""
    NOT_ASKED = "not asked"
    """The datasets were not computed with the paper's parameters."""


@dataclass(frozen=True)
class Finding:
    """What decides a claim in one reading.

    ``required`` is the printed number, or the condition in signs with its ``limit``,
    which is NaN for a printed number. ``deviation_units`` and ``deviation`` are that from
    a printed number, in units of its last digit and as a share of it; NaN for a condition.
    """

    found: float
    verdict: Verdict
    required: str = ""
    limit: float = np.nan
    deviation_units: float = np.nan
    deviation: float = np.nan

    def __str__(self) -> str:
        """The number found, or its bound where that is of the size of rounding."""
        return compared_text(self.found, self.limit)


def _finite(values: ArrayLike | xr.DataArray) -> np.ndarray:
    """The numbers, none of which may be missing: a missing one decides nothing."""
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
    """
    return float(_finite(values).max())


def smallest(values: ArrayLike | xr.DataArray) -> float:
    """The smallest of some numbers; raises as :func:`largest` does."""
    return float(_finite(values).min())


def _condition(value: float, sign: str, bound: float, holds: bool) -> Finding:
    verdict = Verdict.REPRODUCED if holds else Verdict.CONTRADICTED
    return Finding(value, verdict, f"{sign} {bound:g}", bound)


def at_most(values, bound) -> Finding:
    """That all values are at most a bound; ties are decided in favour of the condition.

    Examples
    --------
    >>> [str(at_most(x, 0.01).verdict) for x in (0.009, 0.01, [0.009, 0.011])]
    ['reproduced', 'reproduced', 'contradicted']
    """
    value, limit = largest(values), smallest(bound)
    return _condition(value, "≤", limit, value <= limit + _ROUNDING * abs(limit))


def at_least(values, bound) -> Finding:
    """That all values are at least a bound; ties are decided in favour of the condition."""
    value, limit = smallest(values), largest(bound)
    return _condition(value, "≥", limit, value >= limit - _ROUNDING * abs(limit))


def below(values, bound) -> Finding:
    """That all values are below a bound."""
    value, limit = largest(values), smallest(bound)
    return _condition(value, "<", limit, value < limit)


def above(values, bound) -> Finding:
    """That all values are above a bound."""
    value, limit = smallest(values), largest(bound)
    return _condition(value, ">", limit, value > limit)


def against_print(value: float, printed: str) -> Finding:
    """A computed number judged by its distance from a printed one, in units of the last digit.

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
