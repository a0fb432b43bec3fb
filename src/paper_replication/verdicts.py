"""How a claim of the paper is judged.

A claim is a printed number or a statement. There are four verdicts, and one word for none:

reproduced
    The computed number rounds to the printed one. Or: the statement holds in every sense of its
    words.
partly
    The statement holds in some senses of its words, but not in others.
not reproduced
    The computed number does not round to the printed one, even if it is within one unit of the last
    digit. Or: the statement holds in no sense.
not testable
    The text does not say what decides the claim.
not asked
    This run has other parameters than the claim needs, lacks a dataset, or lacks a number that
    decides the claim. Or: its function raises an exception.

Each sense of a statement is a condition on the datasets, a `Reading`. The first is the literal one.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from paper_replication.datasets import Datasets, other_parameters, selected

ROUNDING = 1e-9
"""Relative difference below which numbers are equal: rounding errors of the datasets are 1e-12."""

RAISED = "its function "
"""How the reason begins if the function of a claim raised an exception."""
VERDICTS = ("reproduced", "partly", "not reproduced", "not testable", "not asked")


def largest(values: ArrayLike) -> float:
    """Return the largest number; NaN if there are none, or if one is NaN.

    >>> largest([1.0, 2.0]), largest([1.0, np.nan]), largest([])
    (2.0, nan, nan)
    """
    numbers = np.asarray(values, dtype=float)
    return float(numbers.max()) if numbers.size else np.nan


def smallest(values: ArrayLike) -> float:
    """Return the smallest number; NaN if there are none, or if one is NaN."""
    return -largest(-np.asarray(values, dtype=float))


# Printed numbers


class Comparison(NamedTuple):
    """A computed number compared with a printed one.

    Attributes
    ----------
    verdict
        "reproduced" or "not reproduced"; "not asked" if the computed number is missing.
    units
        Distance from the printed number, in units of its last digit.
    share
        Distance divided by the printed number.
    """

    verdict: str
    units: float
    share: float


def against_print(computed: float, printed: str) -> Comparison:
    """Compare a number with the digits of a printed one.

    A number halfway between two roundings counts as rounding to either.

    >>> [against_print(x, "0.255").verdict for x in (0.2545, 0.2556, np.nan)]
    ['reproduced', 'not reproduced', 'not asked']
    """
    if np.isnan(computed):
        return Comparison("not asked", np.nan, np.nan)
    decimals = len(printed.partition(".")[2])
    distance = computed - float(printed)
    units = distance * 10.0**decimals
    verdict = "reproduced" if abs(units) <= 0.5 + ROUNDING else "not reproduced"
    return Comparison(verdict, units, distance / abs(float(printed)))


# Statements


class Reading(NamedTuple):
    """One sense of a statement.

    Attributes
    ----------
    name
        What must hold.
    holds
        Whether it holds.
    found
        The number that decides: None if none does, NaN if this run lacks it.
    required
        The bound of this number, as text; without a number, the reason.
    is_share
        Whether the number is printed in per cent.
    cannot_fail
        Whether no result could have made it fail.
    """

    name: str
    holds: bool
    found: float | None
    required: str
    is_share: bool = False
    cannot_fail: bool = False


def at_most(name: str, values: ArrayLike, bound: float) -> Reading:
    """Require that no number is larger than a bound."""
    worst = largest(values)
    words = {0: "none allowed", ROUNDING: "0 within rounding"}
    required = words.get(bound, f"at most {three_digits(bound)}")
    return Reading(name, worst <= bound, worst, required)


def at_least(name: str, values: ArrayLike, bound: float) -> Reading:
    """Require that no number is smaller than a bound."""
    worst = smallest(values)
    return Reading(name, worst >= bound, worst, f"at least {three_digits(bound)}")


def within(name: str, values: ArrayLike, limit: float) -> Reading:
    """Require that no share is larger than a limit."""
    worst = largest(values)
    return Reading(name, worst <= limit, worst, f"at most {100 * limit:g} %", True)


def beyond(name: str, values: ArrayLike, limit: float) -> Reading:
    """Require that no share is smaller than a limit."""
    worst = smallest(values)
    return Reading(name, worst >= limit, worst, f"at least {100 * limit:g} %", True)


def above(name: str, values: ArrayLike) -> Reading:
    """Require that every number is positive."""
    worst = smallest(values)
    return Reading(name, worst > 0, worst, "positive")


def argued(name: str, holds: bool, reason: str) -> Reading:
    """State a sense that no number decides, with the reason."""
    return Reading(name, holds, None, reason)


def by_definition(name: str, reason: str) -> Reading:
    """State a sense that no result could have made fail, with the reason."""
    return Reading(name, True, None, reason, cannot_fail=True)


# Claims


@dataclass(frozen=True)
class Claim:
    """A claim of the paper.

    Attributes
    ----------
    name
        Its name in our datasets and texts.
    place
        Where the paper says it; empty for a claim of one's own.
    text
        What it says, in our words.
    datasets
        The datasets that decide it, each with the parameters that the claim needs.
    decide
        Takes these datasets in their order. Returns the computed number if a number is printed,
        and otherwise the readings, first the literal one.
    printed
        The printed number with its digits.
    missing
        What the text does not say, if that decides among the readings.
    remark
        How we read the claim.
    beside
        The figure or table beside which the claim is shown.
    """

    name: str
    place: str
    text: str
    datasets: Mapping[str, Mapping]
    decide: Callable[..., Any]
    printed: str = ""
    missing: str = ""
    remark: str = ""
    beside: str = ""


def answer(claim: Claim, datasets: Datasets) -> dict:
    """Judge a claim: its verdict, the number found, and the conditions or the reason as text.

    What is missing for one claim, or raised by its function, changes no other.
    """
    absent = [name for name in claim.datasets if name not in datasets]
    if absent:
        return not_asked(f"there is no dataset {', '.join(absent)}")
    others = [
        other_parameters(name, datasets[name], needed) for name, needed in claim.datasets.items()
    ]
    if any(others):
        return not_asked(f"other parameters: {'; '.join(filter(None, others))}")
    chosen = [selected(datasets[name], needed) for name, needed in claim.datasets.items()]
    try:
        decided = claim.decide(*chosen)
        return of_number(claim, decided) if claim.printed else of_readings(claim, decided)
    except Exception as error:  # Whatever the function of a claim raises.
        return not_asked(f"{RAISED}{claim.decide.__name__} raises {error!r}")


def missing_numbers(claim: Claim) -> str:
    """The reason if this run lacks a number that decides a claim."""
    return f"a number that decides it is missing in {', '.join(claim.datasets)}"


def not_asked(reason: str) -> dict:
    """The verdict on a claim that this run cannot judge."""
    return {"verdict": "not asked", "reason": reason}


def of_number(claim: Claim, computed: ArrayLike) -> dict:
    """The verdict on a printed number."""
    number = float(np.asarray(computed))
    verdict, units, share = against_print(number, claim.printed)
    if verdict == "not asked":
        return not_asked(missing_numbers(claim))
    return {
        "verdict": verdict,
        "found": number,
        "deviation_units": units,
        "deviation": share,
    }


def of_readings(claim: Claim, readings: list[Reading]) -> dict:
    """The verdict on a statement; the number found is that of the literal reading.

    If the readings differ, `own_sense` says whether the literal one holds; if none of them could
    have failed, it is "cannot fail". If no number decides, algebra does.
    """
    numbers = [reading.found for reading in readings if reading.found is not None]
    if np.isnan(numbers).any():
        return not_asked(missing_numbers(claim))
    literal = readings[0].found if readings else None
    judgement = {
        "found": np.nan if literal is None else literal,
        "condition": condition_texts(readings),
    }
    if readings and not numbers:
        judgement["decided_by"] = "algebra"
    right = [reading.holds for reading in readings]
    if claim.missing and (any(right) != all(right) or not readings):
        reason = f"the text does not say {claim.missing}"
        return judgement | {"verdict": "not testable", "reason": reason}
    if all(right):
        certain = all(reading.cannot_fail for reading in readings)
        return judgement | {"verdict": "reproduced", "own_sense": "cannot fail" if certain else ""}
    if not any(right):
        return judgement | {"verdict": "not reproduced"}
    sense = "holds" if readings[0].holds else "does not hold"
    return judgement | {"verdict": "partly", "own_sense": sense}


def condition_texts(readings: list[Reading]) -> list[str]:
    """Print readings, each with its number and the bound; of several, the first is the literal one.

    >>> condition_texts([within("Eq. 8", 0.0297, 0.01), within("Eq. 5", 0.000132, 0.01)])
    ['literally, no: Eq. 8 (2.97 %, at most 1 %)', 'yes: Eq. 5 (0.0132 %, at most 1 %)']
    """
    texts = []
    for k, reading in enumerate(readings):
        number = ""
        if reading.found is not None and np.isfinite(reading.found):
            number = f"{rounded(reading.found, reading.is_share)}, "
        word = "yes" if reading.holds else "no"
        mark = "literally, " if k == 0 and len(readings) > 1 else ""
        texts.append(f"{mark}{word}: {reading.name} ({number}{reading.required})")
    return texts


def rounded(number: float, is_share: bool) -> str:
    """Print a number with three digits, a share in per cent; zero if it is zero within rounding."""
    if abs(number) <= ROUNDING:
        return "0"
    return f"{three_digits(100 * number)} %" if is_share else three_digits(number)


def three_digits(value: float) -> str:
    """Print a number with three digits, and all digits of a larger one.

    >>> three_digits(0.0297), three_digits(2975.3), three_digits(999.7), three_digits(-7.318e-5)
    ('0.0297', '2975', '1000', '-7.32·10⁻⁵')
    """
    if abs(value) >= 999.5:
        return f"{value:.0f}"
    digits, _, exponent = f"{value:.3g}".partition("e")
    if not exponent:
        return digits
    power = str(int(exponent)).translate(str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹"))
    return f"{digits}·10{power}"
