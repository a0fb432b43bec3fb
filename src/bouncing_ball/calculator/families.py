"""The n-T families of a case: orbits, margins, loads and errors in every model."""

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from bouncing_ball.accuracy import error_law
from bouncing_ball.accuracy.errors import relative
from bouncing_ball.accuracy.quantities import OF_ORBITS, Quantity
from bouncing_ball.calculator.case import Case
from bouncing_ball.calculator.results import Errors, Family, Standing
from bouncing_ball.contacts.permanent_contact import RESTITUTION_THRESHOLD
from bouncing_ball.contacts.signature import Instant
from bouncing_ball.contacts.spring_damper import SpringDamper
from bouncing_ball.errors import NoOrbitError
from bouncing_ball.orbits.orbit import Orbit
from bouncing_ball.orbits.restitution_model import RestitutionModel

# A maximum in contact is looked for among so many samples, then among as many
# between its neighbours: after six times it is known to 10⁻⁸ of the contact, and
# its value, next to a maximum, to rounding.
_SAMPLES, _ZOOMS = 33, 6


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


def _loads(orbit: Any) -> tuple[float, float]:
    """Greatest compression and greatest force over weight in one contact, dimensionless."""
    if not orbit.exists:
        return math.nan, math.nan

    def force(time: np.ndarray) -> np.ndarray:
        displacement, velocity = orbit.contact_motion(time)
        return orbit.law.force(np.maximum(-displacement, 0.0), -velocity)

    duration = float(orbit.contact_duration)
    depth = greatest(lambda time: -orbit.contact_motion(time)[0], duration)
    return depth, greatest(force, duration)


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


@dataclass(frozen=True)
class _InModel:
    """A model's orbits at Λ, and its quantities, arrays over the families."""

    orbit: Orbit
    values: dict[Quantity, np.ndarray]

    def standing(self, k: int, amplitude: float) -> Standing:
        orbit, there = self.orbit[k], bool(self.orbit[k].exists)
        node = self.values[Quantity.SADDLE_NODE][k]
        doubling = self.values[Quantity.PERIOD_DOUBLING][k]
        return Standing(
            exists=there,
            is_stable=there and bool(orbit.is_stable()),
            is_admissible=there and bool(orbit.is_admissible()),
            saddle_node=finite(node),
            saddle_node_margin=finite(1 - node / amplitude),
            period_doubling=finite(doubling),
            period_doubling_margin=finite(doubling / amplitude - 1),
        )

    def errors(self, simple: "_InModel", k: int) -> Errors:
        """Moduli of the relative errors of a simple model against this one."""
        return {
            str(quantity): finite(abs(relative(exact[k], simple.values[quantity][k])))
            for quantity, exact in self.values.items()
        }


def _in_models(case: Case, n: np.ndarray) -> list[_InModel]:
    found: list[_InModel] = []
    for model in case.models.values():
        orbit = model.orbit(n, case.table.amplitude)
        values = (
            *(getattr(orbit, quantity) for quantity in OF_ORBITS),
            model.saddle_node(n).amplitude,
            model.period_doubling(n).amplitude,
            np.full(n.shape, RESTITUTION_THRESHOLD if found else case.permanent_contact),
        )
        found.append(_InModel(orbit, dict(zip(Quantity, values, strict=True))))
    return found


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
    found, lam = _in_models(case, np.array(asked)), case.table.amplitude
    there = np.any([each.orbit.exists for each in found], axis=0)
    if not there.any():
        lowest = found[0].values[Quantity.SADDLE_NODE][0]
        which = f"{asked[0]}-T orbit" if len(asked) == 1 else "n-T orbit"
        raise NoOrbitError(
            f"no {which} in any model: the table's acceleration is Λ = {lam:.4g} of gravity, "
            f"and the {asked[0]}-T orbit needs {lowest:.4g}"
        )
    return tuple(_family(case, asked[k], k, found) for k in np.flatnonzero(there).tolist())


def _family(case: Case, n: int, k: int, found: Sequence[_InModel]) -> Family:
    """The k-th of the families, n, from the arrays of all models."""
    unit, lam = case.table, case.table.amplitude
    exact, restitution, corrected = found
    standing = [each.standing(k, lam) for each in found]
    orbit, there = exact.orbit[k], standing[0]
    depth, force = _loads(orbit)
    linear = case.contact if case.law is None else None
    law_errors, holds = by_error_law(case.instant(n), linear, n, lam)
    return Family(
        n=n,
        exists=there.exists,
        is_stable=there.is_stable,
        is_admissible=there.is_admissible,
        standing=dict(zip(case.models, standing, strict=True)),
        max_height=finite(orbit.max_height * unit.length),
        impact_speed=finite(-orbit.relative_impact_velocity * unit.speed),
        contact_duration=finite(orbit.contact_duration * unit.time),
        greatest_compression=finite(depth * unit.length),
        peak_force=finite(force * case.mass * unit.gravity),
        peak_force_over_weight=finite(force),
        errors=exact.errors(restitution, k),
        corrected_errors=exact.errors(corrected, k),
        law_errors=law_errors,
        law_holds=holds,
    )
