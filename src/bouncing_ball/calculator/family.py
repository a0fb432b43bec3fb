"""One n-T family of a case: orbit, margins, loads and errors in every model."""

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np

from bouncing_ball.accuracy import error_law
from bouncing_ball.accuracy.errors import relative
from bouncing_ball.accuracy.quantities import Quantity, values
from bouncing_ball.calculator.case import Case
from bouncing_ball.contacts.signature import Instant
from bouncing_ball.contacts.spring_damper import SpringDamper, contact_force
from bouncing_ball.orbits.model import ImpactModel
from bouncing_ball.orbits.orbit import Orbit
from bouncing_ball.orbits.restitution_model import RestitutionModel

Errors = dict[str, float | None]
"""Relative errors by quantity; None where there is nothing to compare, or to divide by."""

# A maximum in contact is looked for among so many samples, then among as many
# between its neighbours: after six times it is known to 10⁻⁸ of the contact, and
# its value, next to a maximum, to rounding.
_SAMPLES, _ZOOMS = 33, 6


@dataclass(frozen=True)
class Standing:
    """Where a case stands in its family, in one model.

    ``saddle_node`` and ``period_doubling`` are Λ; the margins are the shares by
    which Λ may fall to the one, ``1 - Λ_SN/Λ``, and rise to the other,
    ``Λ_PD/Λ - 1``. None where there is no such bifurcation.
    """

    exists: bool
    is_stable: bool
    is_admissible: bool
    saddle_node: float | None
    period_doubling: float | None
    saddle_node_margin: float | None
    period_doubling_margin: float | None


@dataclass(frozen=True)
class Family:
    """The n-T orbit of a case, in SI units, and how wrong the simple models are.

    ``exists``, ``is_stable`` and ``is_admissible`` are those of the exact model. The
    errors are the moduli of relative errors, by the quantities of the ``thresholds``
    table: ``errors`` and ``corrected_errors`` exact, ``law_errors`` by the error law,
    which is stated where ``law_holds``.
    """

    n: int
    exists: bool
    is_stable: bool
    is_admissible: bool
    standing: Mapping[str, Standing]
    contact_duration: float | None
    impact_speed: float | None
    max_height: float | None
    greatest_compression: float | None
    peak_force: float | None
    peak_force_over_weight: float | None
    errors: Errors
    corrected_errors: Errors
    law_errors: Errors
    law_holds: bool


def _number(value: float) -> float | None:
    return float(value) if math.isfinite(value) else None


def _standing(model: ImpactModel, orbit: Orbit, n: int, amplitude: float) -> Standing:
    node = float(model.saddle_node(n).amplitude)
    doubling = float(model.period_doubling(n).amplitude)
    there = bool(orbit.exists)
    return Standing(
        exists=there,
        is_stable=there and bool(orbit.is_stable()),
        is_admissible=there and bool(orbit.is_admissible()),
        saddle_node=_number(node),
        period_doubling=_number(doubling),
        saddle_node_margin=_number(1 - node / amplitude),
        period_doubling_margin=_number(doubling / amplitude - 1),
    )


def greatest(function: Callable[[np.ndarray], np.ndarray], duration: float) -> float:
    """Greatest value on [0, duration] of a function with one hump in each sample's width.

    Examples
    --------
    >>> round(greatest(np.sin, 3.0), 12)
    1.0
    """
    low, high = 0.0, duration
    for _ in range(_ZOOMS):
        time = np.linspace(low, high, _SAMPLES)
        values = function(time)
        at, step = int(np.argmax(values)), (high - low) / (_SAMPLES - 1)
        low, high = max(0.0, time[at] - step), min(duration, time[at] + step)
    return float(np.max(values))


def _loads(case: Case, orbit: Orbit) -> tuple[float, float]:
    """Greatest compression in m and greatest force over weight, in one contact."""

    def state(time: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        height, velocity = orbit.contact_path(time)
        angle = orbit.phase + time
        depth = orbit.amplitude * np.sin(angle) - height
        rate = orbit.amplitude * np.cos(angle) - velocity
        if case.law is None:
            ratio, zeta = case.contact.frequency_ratio, case.contact.damping_ratio
            return depth, contact_force(-depth, -rate, ratio, zeta)
        return depth, case.law.force(np.maximum(depth, 0.0), rate)

    duration = float(orbit.contact_duration)
    depth = greatest(lambda time: state(time)[0], duration)
    return depth * case.table.length, greatest(lambda time: state(time)[1], duration)


def _by_quantity(found: np.ndarray) -> Errors:
    return {str(q): _number(float(v)) for q, v in zip(Quantity, np.ravel(found), strict=True)}


def first_order(instant: Instant, n: int, amplitude: float) -> tuple[Errors, bool]:
    """Moduli of the first-order errors, and whether the law is stated there.

    Permanent contact has none: its error is of the second order.
    """
    absent: Errors = dict.fromkeys(map(str, Quantity))
    if not RestitutionModel(instant.restitution).orbit(n, amplitude).exists:
        return absent, False
    first = error_law.first_order(n, instant, amplitude)
    errors = absent | {str(name): _number(abs(float(value))) for name, value in first.items()}
    return errors, bool(error_law.small_parameter(n, instant, amplitude) < error_law.STATED)


def permanent_law(contact: SpringDamper) -> float:
    """|K₂|/ϖ², the error of the restitution model's permanent contact.

    Examples
    --------
    >>> permanent_law(SpringDamper(10.0, 0.0))
    0.01
    """
    second = error_law.permanent_contact_coefficient(contact.damping_ratio, contact.release)
    return abs(float(second)) / float(contact.frequency_ratio) ** 2


def _values(case: Case, model: ImpactModel, n: int) -> np.ndarray:
    """All quantities in a model; NaN for the permanent contact of a Hertz contact.

    About its static deflection that is one of another stiffness, not known here.
    """
    known = [q for q in Quantity if case.law is None or q is not Quantity.PERMANENT_CONTACT]
    found = dict(zip(known, values(model, n, case.table.amplitude, known), strict=True))
    return np.array([found.get(q, np.nan) for q in Quantity])


def family(case: Case, n: int) -> Family:
    """All answers about the n-T orbit.

    Examples
    --------
    >>> from bouncing_ball.calculator.case import Table
    >>> from bouncing_ball.contacts.release import Release
    >>> case = Case(1.0, Table(1.0, 0.1, 1.0), 100.0, 2.0, Release.DISPLACEMENT)
    >>> family(case, 1).exists
    False
    """
    of, lam = case.models(), case.table.amplitude
    orbits = {name: model.orbit(n, lam) for name, model in of.items()}
    standing = {name: _standing(of[name], orbits[name], n, lam) for name in of}
    exact, *simple = (_values(case, model, n) for model in of.values())
    by_restitution, by_corrected = (np.abs(relative(exact, each)) for each in simple)
    there, orbit = next(iter(standing.values())), next(iter(orbits.values()))
    depth, force = _loads(case, orbit) if there.exists else (math.nan, math.nan)
    law_errors, holds = first_order(case.instant(n), n, lam)
    if case.law is None:
        law_errors[Quantity.PERMANENT_CONTACT] = permanent_law(case.contact)
    unit = case.table
    return Family(
        n=n,
        exists=there.exists,
        is_stable=there.is_stable,
        is_admissible=there.is_admissible,
        standing=standing,
        contact_duration=_number(float(orbit.contact_duration) * unit.time),
        impact_speed=_number(-float(orbit.relative_impact_velocity) * unit.speed),
        max_height=_number(float(orbit.max_height) * unit.length),
        greatest_compression=_number(depth),
        peak_force=_number(force * case.weight),
        peak_force_over_weight=_number(force),
        errors=_by_quantity(by_restitution),
        corrected_errors=_by_quantity(by_corrected),
        law_errors=law_errors,
        law_holds=holds,
    )
