"""The n-T families of a case: orbits, margins, loads and errors in every model.

All errors here are deviations from the contact, ``(q - q_SD)/q_SD``
(:func:`~bouncing_ball_beyond.accuracy.errors.deviation`), and not the paper's.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Annotated, Any

import numpy as np

from bouncing_ball_beyond.accuracy import error_law, errors
from bouncing_ball_beyond.accuracy.errors import OF_IMPACTS, OF_ORBITS, deviation
from bouncing_ball_beyond.inherited.accuracy.errors import Quantity
from bouncing_ball_beyond.inherited.contacts.contact.needed import finite
from bouncing_ball_beyond.inherited.contacts.contact.rebounds import greatest_loads
from bouncing_ball_beyond.inherited.contacts.contact.resolved import ResolvedContact
from bouncing_ball_beyond.inherited.contacts.contact.rows import Listed
from bouncing_ball_beyond.inherited.errors import NoOrbitError
from bouncing_ball_beyond.inherited.models.permanent_contact import RESTITUTION_THRESHOLD
from bouncing_ball_beyond.inherited.periodic.orbit import Bifurcation
from bouncing_ball_beyond.inherited.periodic.restitution_branch import (
    restitution_period_doubling,
    restitution_saddle_node,
)
from bouncing_ball_beyond.models.laws.contact_law import ContactLaw
from bouncing_ball_beyond.models.laws.loaded import under
from bouncing_ball_beyond.models.model import Model
from bouncing_ball_beyond.periodic.one_impact import n_t
from bouncing_ball_beyond.periodic.one_impact.restitution_branch import rigid_speed
from bouncing_ball_beyond.periodic.orbits.motion import contact_motion
from bouncing_ball_beyond.periodic.orbits.orbit import Orbit

ErrorsByQuantity = dict[str, float | None]
"""Deviations from the contact by quantity, (q - q_SD)/q_SD with the value q_SD of the contact; None
where one of the values does not exist, or that of the contact is zero."""


@dataclass(frozen=True)
class Standing:
    """The place of a case in its family, in one model.

    ``saddle_node`` and ``period_doubling`` are the Λ of the bifurcations. The margins are relative
    changes of Λ: ``1 - Λ_SN/Λ`` is the fall down to the saddle-node, and ``Λ_PD/Λ - 1`` the rise
    up to the period doubling. They are None if there is no such bifurcation.
    """

    exists: Annotated[bool, Listed("exists")]
    is_stable: Annotated[bool, Listed("stable")]
    is_admissible: bool
    saddle_node: Annotated[float | None, Listed(f"{Bifurcation.SADDLE_NODE} at Λ")]
    saddle_node_margin: Annotated[float | None, Listed("  Λ may fall by", "%")]
    period_doubling: Annotated[float | None, Listed(f"{Bifurcation.PERIOD_DOUBLING} at Λ")]
    period_doubling_margin: Annotated[float | None, Listed("  Λ may rise by", "%")]

    @property
    def attracts(self) -> bool:
        """Whether balls near the orbit end on it."""
        return self.exists and self.is_stable and self.is_admissible


@dataclass(frozen=True)
class ComparedOrbit:
    """The n-T orbit of a case, in SI units, and the errors of the simple models.

    ``exists``, ``is_stable`` and ``is_admissible`` refer to the orbit of the exact model, which
    comes first in ``standing``. ``values`` has each quantity in every model, the exact one first,
    in m, in m/s or without a unit. All errors are deviations from the exact value, relative to it
    (:func:`~bouncing_ball_beyond.accuracy.errors.deviation`), and have a sign, positive where the
    model predicts too much: ``errors`` are those of the restitution model, ``corrected_errors``
    those of the corrected model, and ``law_errors`` those that the error law gives for the
    restitution model; ``law_holds`` tells whether the law holds.
    """

    n: int
    exists: bool
    is_stable: bool
    is_admissible: bool
    standing: dict[str, Standing]
    max_height: Annotated[float | None, Listed("greatest height", "m")]
    impact_speed: Annotated[float | None, Listed("impact speed", "m/s")]
    contact_duration: Annotated[float | None, Listed("duration of contact", "s")]
    greatest_compression: Annotated[float | None, Listed("greatest compression", "m")]
    peak_force: Annotated[float | None, Listed("peak force", "N")]
    peak_force_over_weight: Annotated[float | None, Listed("peak force over weight")]
    values: dict[str, dict[str, float | None]]
    errors: ErrorsByQuantity
    corrected_errors: ErrorsByQuantity
    law_errors: ErrorsByQuantity
    law_holds: bool

    @property
    def attracts(self) -> bool:
        """Whether balls near the orbit of the exact model end on it."""
        exact = next(iter(self.standing.values()))
        return exact.attracts


# Samples of a contact, and further samples for each radian of the table's motion, because a long
# contact has several maxima. The two steps around the greatest sample are sampled again. A step is
# then 2·10⁻⁶ of the contact, so that a parabola exceeds its samples by less than 10⁻¹¹ of its
# height.
_SAMPLES = 1001
_IN_A_RADIAN = 16
# A bifurcation of a law is followed in Λ, which takes long if the loss is strong. It is not
# searched for if the simple models, which above this ϖ are within a few percent of the law, have
# their saddle-nodes at a multiple of Λ.
_STIFF = 10.0
_FAR = 2.0


def _by_quantity(values: np.ndarray) -> ErrorsByQuantity:
    return {str(q): finite(x) for q, x in zip(Quantity, values, strict=False)}


def _loads(law: ContactLaw, orbit: Any) -> tuple[float, float]:
    """Greatest compression and greatest force over weight in one contact, dimensionless."""
    if not orbit.exists:
        return math.nan, math.nan

    def motion(time: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        displacement, velocity = contact_motion(orbit, time)
        return -displacement, -velocity, 1 - orbit.amplitude * np.sin(orbit.phase + time)

    duration = float(orbit.contact_duration)
    times = np.linspace(0.0, duration, _SAMPLES + int(_IN_A_RADIAN * duration))
    started = law.started(-float(orbit.relative_impact_velocity))
    return greatest_loads(started, motion, times)


def by_error_law(case: ResolvedContact, n: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The deviations of the restitution model from the contact that the error law predicts, shape
    (quantity, n), and whether it holds, shape (n,).

    The law has the paper's error e, of which the deviation is -e/(1 + e). If r depends on the
    speed, the period doubling of the restitution model, whose r is constant, differs from that of
    r(v) too. The error of the permanent contact, K₂/ϖ², is known for the linear contact only.

    Examples
    --------
    >>> from bouncing_ball_beyond.inherited.contacts.contact.contact import Contact
    >>> from bouncing_ball_beyond.inherited.contacts.contact.table import TableMotion
    >>> from bouncing_ball_beyond.models.spring_damper import SpringDamper
    >>> spring = SpringDamper(10.0, 0.0)
    >>> case = ResolvedContact(Contact(mass=1.0), TableMotion(1.0, 1.0, 1.0), spring, spring)
    >>> by_error_law(case, np.array([1]))[0][-1].round(12).tolist()
    [0.010101010101]
    """
    lam = case.table.amplitude
    contact = case.equivalent
    of_paper = np.full((len(Quantity), n.size), np.nan)
    holds = np.zeros(n.size, dtype=bool)
    there = n_t.orbit(case.models["restitution"], n, lam).exists
    instant = case.instant(n[there])
    speed = rigid_speed(n[there], instant.restitution)
    curvature = error_law.curvature_of(case.models["corrected"].signature, speed)
    found = error_law.law_errors(n[there], instant, lam, curvature)
    r = instant.restitution
    line = restitution_saddle_node(n[there], r)
    by_speed = np.hypot(line, error_law.doubling_lift(r, r + instant.d_restitution * speed))
    by_constant = restitution_period_doubling(n[there], r)
    doubling = found[Quantity.PERIOD_DOUBLING]
    found[Quantity.PERIOD_DOUBLING] = (1 + doubling) * by_speed / by_constant - 1
    of_paper[: len(OF_IMPACTS), there] = [*found.values()]
    is_small = error_law.small_parameter(n[there], instant, lam) < error_law.VALID_BELOW
    # If the r of a contact law depends on the speed, it equals the r of the restitution model at
    # one speed only.
    holds[there] = is_small & case.has_its_restitution(n[there])
    if case.is_linear:
        second = error_law.permanent_contact_coefficient(contact.damping_ratio, contact.release)
        of_paper[-1] = second / contact.frequency_ratio**2
    return errors.as_deviation(of_paper), holds


def _standing(orbit: Orbit, values: np.ndarray, amplitude: float) -> Standing:
    there = bool(orbit.exists)
    node, doubling, _ = values[len(OF_ORBITS) :]
    return Standing(
        exists=there,
        is_stable=there and bool(orbit.is_stable()),
        is_admissible=there and bool(orbit.is_admissible()),
        saddle_node=finite(node),
        saddle_node_margin=finite(1 - node / amplitude),
        period_doubling=finite(doubling),
        period_doubling_margin=finite(doubling / amplitude - 1),
    )


def families(
    case: ResolvedContact, asked: Sequence[int], or_first: bool = False
) -> tuple[ComparedOrbit, ...]:
    """The families ``asked`` in which at least one model has an orbit.

    If there is no such family, the result is the first of ``asked`` with ``or_first``, and
    otherwise an error.

    Raises
    ------
    NoOrbitError
        If no model has an orbit; the message gives the Λ that the first family needs.

    Examples
    --------
    >>> from bouncing_ball_beyond.inherited.contacts.contact.contact import Contact
    >>> from bouncing_ball_beyond.inherited.contacts.contact.table import TableMotion
    >>> from bouncing_ball_beyond.models.spring_damper import SpringDamper
    >>> spring = SpringDamper(10.0, 0.1)
    >>> case = ResolvedContact(Contact(mass=1.0), TableMotion(1.0, 0.5, 1.0), spring, spring)
    >>> [family.n for family in families(case, [1, 2, 3])]
    [1]
    """
    n = np.array(asked)
    lam = case.table.amplitude
    exact, *simple = case.models.values()
    near = np.ones(n.shape, dtype=bool)
    of_simple = [_in_model(model, n, lam, RESTITUTION_THRESHOLD, near) for model in simple]
    law = case.integrated_law
    if law is not None:
        near = can_carry(law, n, lam)
        if case.equivalent.frequency_ratio > _STIFF:
            nodes = [found[len(OF_ORBITS)] for _, found in of_simple]
            near &= ~(np.nanmin(nodes, axis=0) > _FAR * lam)
    in_models = [_in_model(exact, n, lam, case.permanent_contact, near), *of_simple]
    orbits = [orbit for orbit, _ in in_models]
    values = np.array([found for _, found in in_models])
    there = np.any([orbit.exists for orbit in orbits], axis=0)
    there[0] |= or_first and not there.any()
    if not there.any():
        raise _no_orbit(case, asked, values[:, len(OF_ORBITS), 0])
    by_law, holds = by_error_law(case, n)
    return tuple(
        _family(
            case,
            asked[k],
            orbits=[orbit[k] for orbit in orbits],
            values=values[:, :, k],
            by_law=by_law[:, k],
            holds=bool(holds[k]),
        )
        for k in np.flatnonzero(there).tolist()
    )


def can_carry(law: ContactLaw, n: np.ndarray, amplitude: float) -> np.ndarray:
    """Whether the force of a law can exceed the weight of a ball on an n-T orbit.

    Over the time P = 2πn of an orbit the mean force is the weight, 1, and the mean velocity is 0. A
    contact whose force is below the weight pulls by less than the weight too, if its release lets
    it pull, so that z″ ≥ -2. Then ``|z′| ≤ P``, and the highest and the lowest place of the ball
    are at most P²/4 apart. The contact is no deeper than ``P²/4 + 2Λ``, and no faster than
    ``P + Λ``. If its force there is below 1, the law has no such orbit.

    Examples
    --------
    >>> from bouncing_ball_beyond.models.laws.hertzian import Tsuji
    >>> can_carry(Tsuji(1.0, 0.1), np.array([1, 2]), 2.0).tolist()
    [True, True]
    >>> can_carry(Tsuji(1e-3, 0.1), np.array([1, 2, 9]), 2.0).tolist()
    [False, False, True]
    """
    period = 2 * math.pi * n
    deepest = period * period / 4 + 2 * amplitude
    force = under(law, 1 + amplitude).force(deepest, period + amplitude)
    return np.asarray(force >= 1)


def _in_model(
    model: Model,
    n: np.ndarray,
    amplitude: float,
    permanent_contact: float,
    near: np.ndarray,
) -> tuple[Orbit, list[np.ndarray]]:
    """The n-T orbits of one model and the values of all quantities, in the order of Quantity.

    Families that are not ``near`` Λ have neither orbits nor bifurcations in the result.
    """
    bifurcations = np.full((2, *n.shape), np.nan)
    if near.any():
        both = Quantity.SADDLE_NODE, Quantity.PERIOD_DOUBLING
        bifurcations[:, near] = errors.values(model, n[near], amplitude, both)
    # Below its saddle-node a model has no orbit, so that none is searched for.
    orbit = n_t.orbit(model, n, np.where((amplitude < bifurcations[0]) | ~near, np.nan, amplitude))
    of_orbits = [getattr(orbit, quantity) for quantity in OF_ORBITS]
    return orbit, [*of_orbits, *bifurcations, np.full(n.shape, permanent_contact)]


def _no_orbit(
    case: ResolvedContact, asked: Sequence[int], saddle_nodes: np.ndarray
) -> NoOrbitError:
    """The error that no model has an orbit, from the saddle-nodes of the first family asked."""
    amplitude = case.table.amplitude
    # The restitution model's where that of a strongly damped law was not found.
    lowest = saddle_nodes[~np.isnan(saddle_nodes)][0]
    which = f"{asked[0]}-T orbit" if len(asked) == 1 else "n-T orbit"
    laid = amplitude <= case.permanent_contact
    rests = ", and a ball laid on the table stays at rest" if laid else ""
    return NoOrbitError(
        f"no {which} in any model{rests}: the table's acceleration is Λ = {amplitude:.4g} times "
        f"gravity, and the {asked[0]}-T orbit needs {lowest:.4g}"
    )


def _family(
    case: ResolvedContact,
    n: int,
    *,
    orbits: Sequence[Any],
    values: np.ndarray,
    by_law: np.ndarray,
    holds: bool,
) -> ComparedOrbit:
    """A family from its orbits in all models, the ``values`` of the quantities, shape
    (model, quantity), and the result of the error law.
    """
    unit = case.table
    orbit = orbits[0]
    standing = [_standing(*each, unit.amplitude) for each in zip(orbits, values, strict=True)]
    depth, force = _loads(case.law, orbit)
    restitution, corrected = map(_by_quantity, deviation(exact=values[0], simple=values[1:]))
    unit_of = {Quantity.MAX_HEIGHT: unit.length, Quantity.BOUNCE_VELOCITY: unit.length / unit.time}
    in_si = values * [unit_of.get(quantity, 1.0) for quantity in Quantity]
    return ComparedOrbit(
        n=n,
        exists=standing[0].exists,
        is_stable=standing[0].is_stable,
        is_admissible=standing[0].is_admissible,
        standing=dict(zip(case.models, standing, strict=True)),
        max_height=finite(orbit.max_height * unit.length),
        impact_speed=finite(-orbit.relative_impact_velocity * unit.length / unit.time),
        contact_duration=finite(orbit.contact_duration * unit.time),
        greatest_compression=finite(depth * unit.length),
        peak_force=finite(force * case.mass * unit.gravity),
        peak_force_over_weight=finite(force),
        values={
            str(quantity): dict(zip(case.models, map(finite, of_models), strict=True))
            for quantity, of_models in zip(Quantity, in_si.T, strict=True)
        },
        errors=restitution,
        corrected_errors=corrected,
        law_errors=_by_quantity(by_law),
        law_holds=holds,
    )
