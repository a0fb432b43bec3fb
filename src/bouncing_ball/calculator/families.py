"""The n-T families of a case: orbits, margins, loads and errors in every model."""

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np

from bouncing_ball.accuracy import error_law
from bouncing_ball.accuracy.errors import relative
from bouncing_ball.accuracy.quantities import OF_ORBITS, Quantity
from bouncing_ball.calculator.case import Case
from bouncing_ball.contacts.signature import Instant
from bouncing_ball.contacts.spring_damper import SpringDamper, contact_force
from bouncing_ball.errors import NoOrbitError
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

    ``exists``, ``is_stable`` and ``is_admissible`` are those of the exact model, which comes
    first in ``standing``. The errors are the moduli of relative errors: ``errors`` of the
    restitution and ``corrected_errors`` of the corrected model, ``law_errors`` those of the
    restitution model by the error law, which is stated where ``law_holds``.
    """

    n: int
    exists: bool
    is_stable: bool
    is_admissible: bool
    standing: dict[str, Standing]
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


def finite(value: float | np.ndarray) -> float | None:
    """A number; None if it is NaN or infinite."""
    return float(value) if math.isfinite(value) else None


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
    """Greatest compression and greatest force over weight in one contact, dimensionless."""

    def state(time: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        height, velocity = orbit.contact_path(time)
        angle = orbit.phase + time
        depth = orbit.amplitude * np.sin(angle) - height
        rate = orbit.amplitude * np.cos(angle) - velocity
        if case.law is not None:
            return depth, case.law.force(np.maximum(depth, 0.0), rate)
        ratio, zeta = case.contact.frequency_ratio, case.contact.damping_ratio
        return depth, contact_force(-depth, -rate, ratio, zeta)

    if not orbit.exists:
        return math.nan, math.nan
    duration = float(orbit.contact_duration)
    depth = greatest(lambda time: state(time)[0], duration)
    return depth, greatest(lambda time: state(time)[1], duration)


def by_error_law(
    instant: Instant, contact: SpringDamper | None, n: int, amplitude: float
) -> tuple[Errors, bool]:
    """Moduli of the restitution model's errors by the error law, and whether it holds there.

    Without a linear contact that of the permanent contact, |K₂|/ϖ², is not known.

    Examples
    --------
    >>> contact = SpringDamper(10.0, 0.0)
    >>> from bouncing_ball.contacts.signature import LinearSignature
    >>> by_error_law(LinearSignature(contact)(), contact, 1, 1.0)[0]["permanent_contact"]
    0.01
    """
    errors: Errors = dict.fromkeys(map(str, Quantity))
    if contact is not None:
        second = error_law.permanent_contact_coefficient(contact.damping_ratio, contact.release)
        errors[Quantity.PERMANENT_CONTACT] = finite(abs(second) / contact.frequency_ratio**2)
    if not RestitutionModel(instant.restitution).orbit(n, amplitude).exists:
        return errors, False
    for name, value in error_law.first_order(n, instant, amplitude).items():
        errors[str(name)] = finite(abs(value))
    return errors, bool(error_law.small_parameter(n, instant, amplitude) < error_law.STATED)


class _InModel(NamedTuple):
    """A model's orbits at Λ and limits, arrays over the families."""

    orbit: Orbit
    saddle_node: np.ndarray
    period_doubling: np.ndarray
    permanent_contact: float

    def standing(self, k: int, amplitude: float) -> Standing:
        orbit, there = self.orbit[k], bool(self.orbit[k].exists)
        node, doubling = self.saddle_node[k], self.period_doubling[k]
        return Standing(
            exists=there,
            is_stable=there and bool(orbit.is_stable()),
            is_admissible=there and bool(orbit.is_admissible()),
            saddle_node=finite(node),
            period_doubling=finite(doubling),
            saddle_node_margin=finite(1 - node / amplitude),
            period_doubling_margin=finite(doubling / amplitude - 1),
        )

    def errors(self, simple: "_InModel", k: int) -> Errors:
        """Moduli of the relative errors of a simple model against this one."""
        pairs = zip(self._values(k), simple._values(k), strict=True)
        errors = (finite(abs(relative(*pair))) for pair in pairs)
        return dict(zip(map(str, Quantity), errors, strict=True))

    def _values(self, k: int) -> list[float]:
        orbit = self.orbit[k]
        return [
            *(getattr(orbit, name) for name in OF_ORBITS),
            self.saddle_node[k],
            self.period_doubling[k],
            self.permanent_contact,
        ]


def families(case: Case, asked: Sequence[int]) -> tuple[Family, ...]:
    """The families, of those asked for, in which some model has an orbit.

    Raises
    ------
    NoOrbitError
        If no model has any of them, with the acceleration that the lowest needs.

    Examples
    --------
    >>> from bouncing_ball.calculator.case import Table
    >>> from bouncing_ball.contacts.release import Release
    >>> case = Case(1.0, Table(1.0, 0.5, 1.0), 100.0, 2.0, Release.DISPLACEMENT)
    >>> [family.n for family in families(case, [1, 2, 3])]
    [1]
    """
    n, lam = np.array(asked), case.table.amplitude
    found = {
        name: _InModel(
            model.orbit(n, lam),
            model.saddle_node(n).amplitude,
            model.period_doubling(n).amplitude,
            case.permanent_contact[name],
        )
        for name, model in case.models.items()
    }
    there = np.any([each.orbit.exists for each in found.values()], axis=0)
    if not there.any():
        lowest = next(iter(found.values())).saddle_node[0]
        which = f"{asked[0]}-T orbit" if len(asked) == 1 else "n-T orbit"
        raise NoOrbitError(
            f"no {which} in any model: the table's acceleration is Λ = {lam:.4g} of gravity, "
            f"and the {asked[0]}-T orbit needs {lowest:.4g}"
        )
    return tuple(_family(case, int(n[k]), k, found) for k in np.flatnonzero(there))


def _family(case: Case, n: int, k: Any, found: Mapping[str, _InModel]) -> Family:
    """The k-th of the families, n, from the arrays of all models."""
    unit, lam = case.table, case.table.amplitude
    standing = {name: each.standing(k, lam) for name, each in found.items()}
    exact, restitution, corrected = found.values()
    there, orbit = next(iter(standing.values())), exact.orbit[k]
    depth, force = _loads(case, orbit)
    linear = case.contact if case.law is None else None
    law_errors, holds = by_error_law(case.instant(n), linear, n, lam)
    return Family(
        n=n,
        exists=there.exists,
        is_stable=there.is_stable,
        is_admissible=there.is_admissible,
        standing=standing,
        contact_duration=finite(orbit.contact_duration * unit.time),
        impact_speed=finite(-orbit.relative_impact_velocity * unit.speed),
        max_height=finite(orbit.max_height * unit.length),
        greatest_compression=finite(depth * unit.length),
        peak_force=finite(force * case.mass * unit.gravity),
        peak_force_over_weight=finite(force),
        errors=exact.errors(restitution, k),
        corrected_errors=exact.errors(corrected, k),
        law_errors=law_errors,
        law_holds=holds,
    )
