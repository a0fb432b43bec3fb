"""Readings of the paper under which Table 1 is computed again.

A reading is what the authors may have done instead of, or beside, what the
paper says: other equations of the orbit, another damping, another criterion
of stability, another way to write a number down. Each says in words what it
assumes. To add one, add it to :func:`single_readings`, or a pair of them to
:func:`readings`.
"""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from bouncing_ball.contacts.damping import damping_ratio

BASELINE = "equations as they stand"
HIGH_BOUNCE_STABILITY = "high-bounce stability"
FORMULA, ALL_FORMULA = "stiffest row from Eqs. 7-8", "all rows from Eqs. 7-8"
PRINTED_DAMPING, SMALL_DAMPING = "damping as printed", "damping to first order"
UNDAMPED_TRANSIENT, SQUARE_LOST = "undamped transient", "square lost in a constant"
TRUNCATED = "digits cut off"


def at_step(step: float) -> str:
    """Name of the reading that takes the nearest computed point.

    Examples
    --------
    >>> at_step(0.01)
    'nearest point at step 0.01'
    """
    return f"nearest point at step {step!r}"


@dataclass(frozen=True)
class Reading:
    """What is assumed, and how it differs from the equations as they stand.

    Parameters
    ----------
    name, description : str
        The same in short and in full.
    equations : mapping
        Fields of :class:`~bouncing_ball.claims.forensics.altered_model.Altered`
        that differ; arrays run over the rows of the table, shape (rows, 1).
    formula_from : float
        Rows of this ϖ and above are Eqs. 7 and 8 of the restitution model.
    truncated : bool
        Digits beyond the last printed one are cut off, not rounded.
    step : float
        Arclength between the points of a continuation, of which the nearest to
        the bifurcation is taken; 0 for the bifurcation itself.
    """

    name: str
    description: str
    equations: Mapping[str, Any] = field(default_factory=dict)
    formula_from: float = np.inf
    truncated: bool = False
    step: float = 0.0

    def __and__(self, other: "Reading") -> "Reading":
        """Both assumptions together."""
        return Reading(
            f"{self.name}; {other.name}",
            f"{self.description}; and {other.description}",
            {**self.equations, **other.equations},
            min(self.formula_from, other.formula_from),
            self.truncated or other.truncated,
            max(self.step, other.step),
        )


def _as_printed(parameters: Mapping[str, Any]) -> Iterator[Reading]:
    """The paper's own equations, and two values of its damping."""
    zeta = parameters["printed_damping_ratio"]
    first_order = -np.log(parameters["printed"]["restitution"]) / np.pi
    yield Reading(BASELINE, "Eqs. 11-26, the linearised return map, ζ from Eq. 16")
    yield Reading(
        PRINTED_DAMPING,
        f"ζ = {zeta:g}, the rounded value printed with the figures",
        {"damping_ratio": zeta},
    )
    yield Reading(
        SMALL_DAMPING, "ζ = -ln r/π, Eq. 16 to first order", {"damping_ratio": first_order}
    )


def _other_contacts(rows: np.ndarray, zeta: float) -> Iterator[Reading]:
    """Other equations of the contact."""
    yield Reading("force release", "the contact ends where its force vanishes", {"force": 1.0})
    yield Reading(
        "no gravity in contact", "gravity is left out of the contact, Eq. 11", {"weight": 0.0}
    )
    yield Reading(
        UNDAMPED_TRANSIENT,
        "the transient of Eqs. 12-13 oscillates at ϖ and not at ϖ√(1 - ζ²)",
        {"damped": 0.0},
    )
    yield Reading(
        SQUARE_LOST,
        "γ = (ϖ² - 1)² + 2ζϖ, a square forgotten in the constants of Eqs. 12-13",
        {"squared": 0.0},
    )
    yield Reading(
        "ratio of the damped contact",
        "ϖ is the damped frequency of the contact over Ω",
        {"frequency_ratio": rows / np.sqrt((1 - zeta) * (1 + zeta))},
    )
    yield Reading(
        "ratio upside down",
        "ϖ is Ω/ω, so that the contact has the ratio 1/ϖ",
        {"frequency_ratio": 1 / rows},
    )


def _other_flights() -> Iterator[Reading]:
    """Other equations of the flight, and of its linearisation."""
    yield Reading(
        "high-bounce flight",
        "the flight ignores the table's displacement, in the orbit and in its stability",
        {"rise": 0.0, "linear_rise": 0.0},
    )
    yield Reading(
        HIGH_BOUNCE_STABILITY,
        "the orbit is exact, but the linearised flight ignores the table's displacement, "
        "which at infinite stiffness is Holmes' map and Eq. 8",
        {"linear_rise": 0.0},
    )
    yield Reading(
        "contact duration not perturbed",
        "the linearisation keeps the contact's duration, not its release condition",
        {"timed": 0.0},
    )


def _other_tables(rows: np.ndarray) -> Iterator[Reading]:
    """Other ways to the numbers of the table."""
    yield Reading(
        FORMULA,
        "the stiffest row is the restitution model's, Eqs. 7 and 8, not computed",
        formula_from=float(rows.max()),
    )
    yield Reading(
        ALL_FORMULA,
        "every row is the restitution model's, Eqs. 7 and 8: what the stiffness changes",
        formula_from=0.0,
    )
    yield Reading(TRUNCATED, "digits beyond the last printed one are cut off", truncated=True)


def _other_criteria() -> Iterator[Reading]:
    """Other criteria of the period doubling."""
    for share, where in ((0.0, "start"), (0.5, "middle"), (1.0, "end")):
        yield Reading(
            f"Holmes' criterion, {where} of contact",
            f"period doubling where Λ sin φ = 1, with φ at the {where} of the contact",
            {"share": share, "lift": 1.0},
        )
        yield Reading(
            f"restitution criterion, {where} of contact",
            "period doubling where Λ sin φ = 2(1 + r_a²)/(1 + r_a)², that of the exact map "
            f"with the apparent restitution, φ at the {where} of the contact",
            {"share": share},
        )


def _other_numbers(parameters: Mapping[str, Any], rows: np.ndarray) -> Iterator[Reading]:
    """Other values of what cannot be read or is not given: ζ, the stiffest ϖ, the step."""
    for other in parameters["other_damping_ratios"]:
        yield Reading(
            f"damping {other!r}",
            f"ζ = {other!r}, whatever formula or rounding may have given it",
            {"damping_ratio": other},
        )
    for exponent in parameters["stiff_exponents"]:
        yield Reading(
            f"stiffest row at ratio 1e{exponent}",
            f"the unreadable exponent of the stiffest row is {exponent}",
            {"frequency_ratio": np.where(rows == rows.max(), 10.0**exponent, rows)},
        )
    for step in parameters["steps"]:
        yield Reading(
            at_step(step),
            "the bifurcation is taken at the nearest point of a continuation with this "
            "arclength between its points; where the points lie is not known, so the "
            "value within half a step that is closest to the printed one is taken",
            step=step,
        )


def single_readings(parameters: Mapping[str, Any]) -> dict[str, Reading]:
    """Readings with one assumption each, by name."""
    rows = np.array(parameters["printed"]["frequency_ratio"], dtype=float)[:, np.newaxis]
    zeta = float(damping_ratio(parameters["printed"]["restitution"]))
    found = (
        *_as_printed(parameters),
        *_other_contacts(rows, zeta),
        *_other_flights(),
        *_other_tables(rows),
        *_other_criteria(),
        *_other_numbers(parameters, rows),
    )
    return {reading.name: reading for reading in found}


def readings(parameters: Mapping[str, Any]) -> list[Reading]:
    """All readings: the single ones, and pairs and triples that make sense."""
    single = single_readings(parameters)
    steps = [at_step(step) for step in parameters["steps"]]
    together = [
        ("force release", "no gravity in contact"),
        ("high-bounce flight", "no gravity in contact"),
        (UNDAMPED_TRANSIENT, SMALL_DAMPING),
        (UNDAMPED_TRANSIENT, SQUARE_LOST),
        (HIGH_BOUNCE_STABILITY, PRINTED_DAMPING),
        (HIGH_BOUNCE_STABILITY, SMALL_DAMPING),
        *((HIGH_BOUNCE_STABILITY, step) for step in steps),
        *((other, FORMULA) for other in (PRINTED_DAMPING, SMALL_DAMPING, TRUNCATED)),
        *((step, FORMULA) for step in steps),
        *((SMALL_DAMPING, step, FORMULA) for step in steps),
    ]
    pairs = []
    for first, *others in together:
        joined = single[first]
        for other in others:
            joined = joined & single[other]
        pairs.append(joined)
    return [*single.values(), *pairs]
