"""How a claim of the paper is judged.

A claim is a printed number or a statement. A printed number is *reproduced* if the computed number
rounds to it, *near* if it is off by at most one unit of the last printed digit, as a number is
whose last digit was cut off or rounded twice, and *not reproduced* beyond.

A statement is turned into one condition for each way in which its words can be read. The first is
the sense of the paper's own sentence; the others are stricter, weaker, or about another quantity. A
statement is *reproduced* or *contradicted* if all of its readings agree, and *by reading* if they
do not. It is *by construction* if it follows from restored formulas by algebra or could not have
failed, so that computing it would test the restoration and not the paper, and *undecidable* if the
text lacks what would decide it.

A claim is *not asked* if a dataset was computed with other parameters than the claim needs, and
*not computed* if a dataset or a number is missing.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from bouncing_ball.datasets import Datasets
from bouncing_ball.paper import other_parameters

ROUNDING = 1e-9
"""Numbers that differ by less are equal: rounding errors of the datasets are some 1e-12."""

VERDICTS = (
    "reproduced",
    "near",
    "by reading",
    "by construction",
    "undecidable",
    "not reproduced",
    "contradicted",
    "not asked",
    "not computed",
)


# Printed numbers


class Comparison(NamedTuple):
    """A computed number beside a printed one: the verdict, and the distance in units of the last
    printed digit and as a share of the printed number.
    """

    verdict: str
    units: float
    share: float


def against_print(found: float, printed: str) -> Comparison:
    """The verdict on a printed number, of which the text has the digits.

    A number halfway between two roundings counts as rounding to either.

    >>> [against_print(found, "0.255").verdict for found in (0.2545, 0.2560, 0.2561)]
    ['reproduced', 'near', 'not reproduced']
    """
    decimals = len(printed.partition(".")[2])
    distance = found - float(printed)
    units = distance * 10.0**decimals
    if np.isnan(found):
        verdict = "not computed"
    elif abs(units) <= 0.5 + ROUNDING:
        verdict = "reproduced"
    elif abs(units) <= 1 + ROUNDING:
        verdict = "near"
    else:
        verdict = "not reproduced"
    return Comparison(verdict, units, distance / abs(float(printed)))


# Statements


class Reading(NamedTuple):
    """One way to read a statement: what is meant, whether it holds, the number that decides, NaN
    if none does, and what is required of it, or the reason without a number.
    """

    name: str
    holds: bool
    found: float
    required: str


def complete(values: ArrayLike) -> NDArray:
    """Numbers as an array; ValueError if there are none, or one of them is NaN."""
    numbers = np.asarray(values, dtype=float)
    missing = int(np.isnan(numbers).sum())
    if missing or not numbers.size:
        raise ValueError(f"{missing} of {numbers.size} numbers are missing")
    return numbers


def at_most(name: str, values: ArrayLike, bound: float) -> Reading:
    """The reading that no number is larger than a bound."""
    largest = float(complete(values).max())
    required = "≤ 0 but for rounding" if bound == ROUNDING else f"≤ {bound:.3g}"
    return Reading(name, largest <= bound, largest, required)


def at_least(name: str, values: ArrayLike, bound: float) -> Reading:
    """The reading that no number is smaller than a bound."""
    smallest = float(complete(values).min())
    return Reading(name, smallest >= bound, smallest, f"≥ {bound:.3g}")


def above(name: str, values: ArrayLike) -> Reading:
    """The reading that every number is positive."""
    smallest = float(complete(values).min())
    return Reading(name, smallest > 0, smallest, "> 0")


def argued(name: str, holds: bool, reason: str) -> Reading:
    """A reading that no number decides, with the reason."""
    return Reading(name, holds, np.nan, reason)


# Claims


@dataclass(frozen=True)
class Claim:
    """A claim: its name, its place in the paper, what it says in our words, and how it is decided.

    `datasets` are the names of the datasets that decide it, with the parameters that it needs of
    each. `decide` takes these datasets in their order, and returns the computed number if a number
    is `printed`, and otherwise the readings, that of the paper's own sentence first. `missing` is
    what the text lacks to choose among them. `because` is the reason why a claim is so by
    construction; nothing decides such a claim.
    """

    name: str
    place: str
    text: str
    datasets: Mapping[str, Mapping]
    decide: Callable[..., Any]
    printed: str = ""
    missing: str = ""
    because: str = ""
    remark: str = ""


def answer(claim: Claim, datasets: Datasets) -> dict:
    """The verdict on a claim, with what belongs to it: the number found and its distance from the
    printed one, the conditions in words, and the reason for having no other verdict.

    What is missing for one claim changes no other.
    """
    absent = [name for name in claim.datasets if name not in datasets]
    if absent:
        return {"verdict": "not computed", "reason": f"there is no dataset {', '.join(absent)}"}
    others = [
        other_parameters(name, datasets[name], needed) for name, needed in claim.datasets.items()
    ]
    if any(others):
        return {"verdict": "not asked", "reason": "; ".join(filter(None, others))}
    if claim.because:
        return {"verdict": "by construction", "condition": claim.because}
    try:
        decided = claim.decide(*(datasets[name] for name in claim.datasets))
        if claim.printed:
            return of_number(claim, decided)
        return of_readings(claim, decided)
    except (KeyError, ValueError, IndexError) as error:
        return {"verdict": "not computed", "reason": f"{type(error).__name__}: {error}"}


def of_number(claim: Claim, computed: ArrayLike) -> dict:
    """The verdict on a printed number."""
    found = float(complete(computed))
    verdict, units, share = against_print(found, claim.printed)
    return {"verdict": verdict, "found": found, "deviation_units": units, "deviation": share}


def of_readings(claim: Claim, readings: list[Reading]) -> dict:
    """The verdict on a statement from its readings; the number found is that of the first.

    If they differ, `own_sense` says whether the first holds, that of the paper's own sentence.
    """
    right = [reading for reading in readings if reading.holds]
    wrong = [reading for reading in readings if not reading.holds]
    found = {
        "found": readings[0].found if readings else np.nan,
        "condition": listed(readings),
        "verdict": "reproduced" if right else "contradicted",
    }
    if right and wrong:
        found["condition"] = f"right for {listed(right)}; not for {listed(wrong)}"
        found["verdict"] = "by reading"
    if claim.missing and (found["verdict"] == "by reading" or not readings):
        return found | {"verdict": "undecidable", "reason": f"the text lacks {claim.missing}"}
    if found["verdict"] == "by reading":
        found["own_sense"] = "holds" if readings[0].holds else "does not hold"
    return found


def listed(readings: list[Reading]) -> str:
    """Readings in words, each with its number and what is required of it."""
    texts = []
    for reading in readings:
        number = "" if np.isnan(reading.found) else f"{rounded(reading.found)}, required "
        texts.append(f"{reading.name} ({number}{reading.required})")
    return ", ".join(texts)


def rounded(number: float) -> str:
    """Three digits of a number; zero if it is zero but for rounding."""
    return f"{number:.3g}" if abs(number) > ROUNDING else "0"
