"""The verdict on a claim, from the comparison with a printed number or from a condition."""

from dataclasses import dataclass
from enum import StrEnum

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike

from bouncing_ball.errors import ModelError

LAST_DIGITS = 0.01
"""The largest relative difference of a number that differs in its last digits and is not
contradicted: the error that the paper tolerates in a model (Eqs. 37 and 38)."""
# Relative tolerance, because rounding must not decide about a number that is equal to a bound.
_ROUNDING = 1e-9

# The rounding error of a finite difference, √ε. The digits of a number up to this size may come
# from the processor and not from the model.
ROUNDING_SIZE = float(np.sqrt(np.finfo(float).eps))


def compared_text(value: float, bound: float, form: str = ".4g") -> str:
    """The text of a number that is compared with a bound.

    If the bound is of the size of rounding and the number is within it, the digits of the number
    depend on the processor, and the bound is printed instead. Any other number is printed.

    Examples
    --------
    >>> compared_text(4.5e-13, 1e-11), compared_text(0.0884, 1e-8)
    ('≤ 1e-11', '0.0884')
    >>> compared_text(9.834e-06, 2e-05), compared_text(0.0, 0.0)
    ('9.834e-06', '0')
    """
    if 0 < bound <= ROUNDING_SIZE and abs(value) <= bound:
        return f"≤ {bound:g}"
    return f"{value:{form}}"


class Verdict(StrEnum):
    """The verdicts from the best to the worst, and last the absence of a verdict."""

    REPRODUCED = "reproduced"
    """Within half a unit of the last printed digit; a condition that holds."""
    DEFINITION = "definition"
    """A statement that holds by definition, so that its check could not have failed."""
    IN_ONE_READING = "in one reading"
    """Reproduced in at least one reading of the words, but not in all that we name."""
    DIFFERS = "differs in the last digits"
    """A number farther away, by no more than :data:`LAST_DIGITS` of the printed one."""
    CONTRADICTED = "contradicted"
    UNDECIDABLE = "undecidable"
    """The verdict depends on something that the text at hand does not have."""
    NOT_ASKED = "not asked"
    """The datasets were not computed with the paper's parameters."""


@dataclass(frozen=True)
class Finding:
    """The number that decides a claim in one reading, with its verdict.

    ``required`` is the printed number, or the condition as a formula; ``limit`` is the bound of the
    condition, NaN for a printed number. ``deviation_units`` and ``deviation`` are the difference
    from a printed number in units of its last digit and relative to it, NaN for a condition.
    ``low`` and ``high`` are the limits of an estimate, NaN if the number is not an estimate.
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
        """The number found, or its bound if the bound is of the size of rounding."""
        return compared_text(self.found, self.limit)


def _finite(values: ArrayLike | xr.DataArray) -> np.ndarray:
    """The numbers as an array; it is an error if there are none or one is NaN, because then
    nothing could be decided.
    """
    numbers = np.asarray(values, dtype=float)
    missing = int(np.isnan(numbers).sum())
    if missing or not numbers.size:
        name = getattr(values, "name", None) or "the number that decides"
        raise ModelError(f"{name}: {missing} of {numbers.size} numbers missing")
    return numbers


def largest_number(values: ArrayLike | xr.DataArray) -> float:
    """The largest of some numbers.

    Raises
    ------
    ModelError
        If there are no numbers, or one of them is NaN.

    Examples
    --------
    >>> largest_number([1.0, 3.0])
    3.0
    """
    return float(_finite(values).max())


def smallest(values: ArrayLike | xr.DataArray) -> float:
    """The smallest of some numbers.

    Raises
    ------
    ModelError
        If there are no numbers, or one of them is NaN.

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

    If there are several bounds, the smallest decides.

    Raises
    ------
    ModelError
        If there are no values, or one of them is NaN. The other conditions raise the same error.

    Examples
    --------
    >>> [str(at_most(x, 0.01).verdict) for x in (0.009, 0.01, [0.009, 0.011])]
    ['reproduced', 'reproduced', 'contradicted']
    """
    value = largest_number(values)
    limit = smallest(bound)
    return _condition(value, "≤", limit, value <= limit + _ROUNDING * abs(limit))


def at_least(values, bound) -> Finding:
    """The finding that all values are at least a bound; a tie counts in favour of the condition.

    If there are several bounds, the largest decides.

    Examples
    --------
    >>> [str(at_least(x, 2).verdict) for x in (3, 2, [3, 1])]
    ['reproduced', 'reproduced', 'contradicted']
    """
    value = smallest(values)
    limit = largest_number(bound)
    return _condition(value, "≥", limit, value >= limit - _ROUNDING * abs(limit))


def below(values, bound) -> Finding:
    """The finding that all values are below a bound, or below the smallest of several bounds.

    Examples
    --------
    >>> [str(below(x, 2).verdict) for x in (1, 2)]
    ['reproduced', 'contradicted']
    """
    value = largest_number(values)
    limit = smallest(bound)
    return _condition(value, "<", limit, value < limit)


def above(values, bound) -> Finding:
    """The finding that all values are above a bound, or above the largest of several bounds.

    Examples
    --------
    >>> [str(above(x, 2).verdict) for x in (3, 2)]
    ['reproduced', 'contradicted']
    """
    value = smallest(values)
    limit = largest_number(bound)
    return _condition(value, ">", limit, value > limit)


def against_print(number: ArrayLike | xr.DataArray, printed: str) -> Finding:
    """The finding on a computed number, by its distance from a printed number in last digits.

    Raises
    ------
    ModelError
        If the number is NaN.

    Examples
    --------
    >>> pairs = (82.177, "82"), (0.2395, "0.238"), (9.81, "6")
    >>> [str(against_print(*pair).verdict) for pair in pairs]
    ['reproduced', 'differs in the last digits', 'contradicted']
    """
    value = float(_finite(number))
    wanted = float(printed)
    units = (value - wanted) * 10.0 ** decimals(printed)
    distance = abs(units) - _ROUNDING
    if distance <= 0.5:
        verdict = Verdict.REPRODUCED
    elif distance <= LAST_DIGITS * abs(wanted) * 10.0 ** decimals(printed):
        verdict = Verdict.DIFFERS
    else:
        verdict = Verdict.CONTRADICTED
    return Finding(
        value,
        verdict,
        printed,
        deviation_units=units,
        deviation=(value - wanted) / abs(wanted),
    )


def decimals(printed: str) -> int:
    """The number of digits behind the point.

    Examples
    --------
    >>> decimals("0.052"), decimals("82")
    (3, 0)
    """
    return len(printed.partition(".")[2])
