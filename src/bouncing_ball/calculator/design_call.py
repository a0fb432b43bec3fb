"""The calculator as one function, :func:`design`: parameters with units in, a `Design` out."""

import math
from typing import Any

import numpy as np

from bouncing_ball.accuracy.quantities import OF_ORBITS
from bouncing_ball.accuracy.thresholds import ThresholdStatus
from bouncing_ball.calculator.case import Case, Table
from bouncing_ball.calculator.contact_data import (
    STIFF,
    hertz,
    loss,
    of_contact_time,
    stiffness_and_damping,
    which,
)
from bouncing_ball.calculator.design import Design, describe, families, judged
from bouncing_ball.calculator.judgement import QUANTITIES, Judgement, assess, percent
from bouncing_ball.calculator.needed import RATIOS, Needed, needed
from bouncing_ball.calculator.units import KINDS, number, shown
from bouncing_ball.contacts.law_signature import free_impact
from bouncing_ball.contacts.release import Release
from bouncing_ball.contacts.spring_damper import SpringDamper
from bouncing_ball.errors import ModelError, NoOrbitError, require
from bouncing_ball.orbits.calls import Index, Rule
from bouncing_ball.orbits.law_calls import rigid_speed
from bouncing_ball.orbits.restitution_model import RestitutionModel

STANDARD_GRAVITY = 9.80665
"""Standard acceleration of gravity, in m/s²."""

_RATE = ("frequency", "angular_frequency", "period")
_EXCITATION = ("amplitude", "acceleration")
_MAY_VANISH = ("damping", "damping_ratio")
_AT_MOST_ONE = ("restitution", "measured_restitution")
# Beyond, the squares of ϖ and Λ leave no digits; as on the rest of the command line.
_LARGEST = 1e8
# Of any quantity in SI units: products and powers of a few stay floating-point numbers.
_SPAN = (1e-40, 1e40)


def _read(parameters: dict[str, Any]) -> dict[str, float]:
    """The quantities that are given, in SI units and in their ranges."""
    given = {name: number(name, value) for name, value in parameters.items() if value is not None}
    for name, value in given.items():
        unit = f" {KINDS[name].unit}" if KINDS[name].unit else ""
        shown = f"{name} = {value:g}{unit}"
        if name in _AT_MOST_ONE:
            require(0 < value <= 1, value, name, "in (0, 1]")
        elif value < 0 or (value == 0 and name not in _MAY_VANISH):
            raise ModelError(f"{shown} is not {'≥ 0' if name in _MAY_VANISH else 'positive'}")
        if value and not _SPAN[0] <= value <= _SPAN[1]:
            raise ModelError(f"{shown} is not between {_SPAN[0]:g} and {_SPAN[1]:g}")
    return given


def _table(given: dict[str, float]) -> Table:
    """The table, from one of the ways to say how fast and one to say how far it moves."""
    rate = which(given, _RATE, "how fast the table moves")
    far = which(given, _EXCITATION, "how far the table moves")
    if rate is None:
        raise ModelError("how fast the table moves is missing: give frequency, such as 50 Hz")
    if far is None:
        raise ModelError(
            "how far the table moves is missing: give amplitude, such as 0.1 mm, or acceleration, "
            "such as 2 g"
        )
    value = given[rate]
    omega = {
        "frequency": 2 * math.pi * value,
        "angular_frequency": value,
        "period": 2 * math.pi / value,
    }[rate]
    height = given[far] if far == "amplitude" else given[far] / omega**2
    return Table(omega, height, given.get("gravity", STANDARD_GRAVITY))


def _lowest_stable(restitution: float, amplitude: float) -> int:
    """The family that is meant if none is named: the lowest that is stable at Λ, or n = 1."""
    families = np.arange(1, 9)
    orbits = RestitutionModel(restitution).orbit(families, amplitude)
    stable = orbits.exists & orbits.is_stable()
    return int(families[np.argmax(stable)])


def _hertz(
    mass: float, table: Table, given: dict[str, float], release: Release, n: int | None
) -> tuple[Case, str]:
    """The case of a Hertz contact, with the linear contact that is like it at the impact.

    Raises
    ------
    ModelError
        If the release is not that of the law, or the loss is not given as a restitution.
    """
    if release is not Release.DISPLACEMENT:
        raise ModelError("a Hertz contact with Tsuji's damping is released at δ = 0: no force")
    zeta = loss(given, release)
    if zeta is None:
        raise ModelError("damping needs stiffness: a Hertz contact takes a restitution coefficient")
    r = float(SpringDamper(1.0, zeta, release).restitution)
    law = hertz(mass, given["reduced_modulus"], given["radius"], r, table)
    speed = rigid_speed(n or _lowest_stable(r, table.amplitude), r)
    time = float(free_impact(law, speed).duration) * table.time
    k = of_contact_time(mass, time, zeta, release)
    note = (
        "the orbits are those of the Hertz contact with Tsuji's damping; stiffness, damping, ϖ, ζ "
        "and the ϖ that is needed are those of the linear contact with its r, and its duration at "
        f"the impact speed {speed * table.speed:.3g} m/s of the restitution model's orbit"
    )
    return Case(mass, table, k, 2 * zeta * math.sqrt(k * mass), release, law), note


def _chosen(need: Needed, zeta: float, release: Release, mass: float, table: Table) -> Case:
    """The softest contact that is within the tolerance."""
    ratio = RATIOS[0] if need.frequency_ratio is None else need.frequency_ratio
    own = ratio * table.angular_frequency
    return Case(mass, table, mass * own * own, 2 * zeta * mass * own, release)


def design(
    *,
    mass: Any = None,
    frequency: Any = None,
    angular_frequency: Any = None,
    period: Any = None,
    amplitude: Any = None,
    acceleration: Any = None,
    gravity: Any = None,
    stiffness: Any = None,
    contact_time: Any = None,
    reduced_modulus: Any = None,
    radius: Any = None,
    damping: Any = None,
    damping_ratio: Any = None,
    restitution: Any = None,
    measured_restitution: Any = None,
    drop_height: Any = None,
    rebound_height: Any = None,
    n: Index | None = None,
    release: Rule = "displacement",
    quantity: str = "max_height",
    tolerance: Any = 0.01,
) -> Design:
    """Assess a contact, or choose one.

    Parameters are plain numbers in SI units, texts such as ``"50 Hz"``, or pint
    quantities. With a stiffness (or a contact time, or E* and R of a Hertz contact)
    the question is whether the restitution model is good enough for this contact;
    without one, which contact a simulation needs for the tolerance.

    Parameters
    ----------
    mass
        Mass m of the ball.
    frequency, angular_frequency, period
        How fast the table moves: one of the three. Hz are cycles, rad/s are not.
    amplitude, acceleration
        How far the table moves: one of the two. "2 g" is twice the standard gravity.
    gravity
        9.80665 m/s² by default; in a gear pair the drag torque takes its part.
    stiffness
        k of the contact. Without any stiffness a contact is chosen.
    contact_time
        Duration of a free impact, in place of the stiffness.
    reduced_modulus
        E* of a Hertz contact with the damping of Tsuji, with its radius.
    radius
        R of a Hertz contact.
    damping
        c of the contact, with its stiffness.
    damping_ratio
        Damping ratio ζ.
    restitution
        Restitution coefficient r by Eq. 16.
    measured_restitution
        Restitution coefficient that a free impact has under the release rule.
    drop_height
        Height of a drop test, with that of the rebound.
    rebound_height
        Height of the rebound in a drop test.
    n
        Index of the family; by default the first eight, and a verdict on the first stable one.
    release
        "displacement" or "force": what ends a contact.
    quantity
        What must be right: max_height, bounce_velocity, phase, apparent_restitution,
        saddle_node, period_doubling or permanent_contact.
    tolerance
        How far it may be off.

    Raises
    ------
    ModelError
        In one line, if something is missing, contradictory or of the wrong kind.
    NoOrbitError
        If no model has an orbit there.

    Examples
    --------
    >>> found = design(mass="20 g", frequency="50 Hz", acceleration="0.8 g",
    ...                stiffness="1e7 N/m", restitution=0.85)
    >>> round(found.frequency_ratio, 3), found.orbits[0].is_stable, found.is_good_enough
    (71.176, True, False)
    """
    given = _read({name: value for name, value in locals().items() if name in KINDS})
    rule, epsilon = Release.of(release), given.pop("tolerance")
    if quantity not in QUANTITIES:
        raise ModelError(f"unknown quantity {quantity!r}: one of {', '.join(QUANTITIES)}")
    if n is not None and (n != int(n) or n < 1):
        raise ModelError(f"index of the family n = {n} is not a positive integer")
    table = _table(given)
    if "mass" not in given:
        raise ModelError("mass is missing: give it, such as 20 g")
    require(table.amplitude < _LARGEST, table.amplitude, "Λ", f"below {_LARGEST:g}")
    mass, notes = given["mass"], []
    stiff = which(given, STIFF, "how stiff the contact is")
    if stiff is None:
        return _choose(mass, table, given, rule, n, quantity, epsilon)
    if stiff == "reduced_modulus":
        case, note = _hertz(mass, table, given, rule, n)
        notes.append(note)
    else:
        case = Case(mass, table, *stiffness_and_damping(mass, given, rule), rule)
    ratio = float(case.contact.frequency_ratio)
    require(1 / _LARGEST < ratio < _LARGEST, ratio, "ϖ", f"between {1 / _LARGEST:g} and 1e8")
    found = families(case, n)
    one = judged(found)
    need = needed(quantity, epsilon, case.zeta, rule, one.n, table.amplitude)
    return describe(case, found, one, need, assess(one, need, ratio), notes)


def _choose(
    mass: float,
    table: Table,
    given: dict[str, float],
    release: Release,
    n: int | None,
    quantity: str,
    tolerance: float,
) -> Design:
    """The softest contact for a tolerance.

    Raises
    ------
    NoOrbitError
        If the restitution model has no orbit to be right about, or no contact will do.
    """
    zeta = loss(given, release)
    if zeta is None:
        raise ModelError(
            "damping needs stiffness, which is missing; to choose a contact, give its restitution "
            "instead"
        )
    r = float(SpringDamper(1.0, zeta, release).restitution)
    index = n or _lowest_stable(r, table.amplitude)
    if quantity in OF_ORBITS:
        RestitutionModel(r).require_orbit(index, table.amplitude)
    need = needed(quantity, tolerance, zeta, release, index, table.amplitude)
    if need.status == ThresholdStatus.NEVER_WITHIN:
        raise NoOrbitError(
            f"no contact up to ϖ = {RATIOS[-1]:g} has its {QUANTITIES[quantity]} within "
            f"{percent(tolerance)} of the restitution model with r = {r:.4g}"
        )
    case = _chosen(need, zeta, release, mass, table)
    name = QUANTITIES[quantity]
    own = name if quantity == "permanent_contact" else f"{name} of the {index}-T orbit"
    verdict = Judgement(
        True,
        f"A simulation needs a contact of at least {shown(case.stiffness, 'N/m')}, with a contact "
        f"time of {shown(case.contact_time, 's')} or less and a damping of "
        f"{shown(case.damping, 'N s/m')} at that stiffness: the {own} is then "
        f"within {percent(tolerance)} of the restitution model's.",
        f"the error is {need.status}"
        if need.status == ThresholdStatus.ALWAYS_WITHIN
        else f"the error crosses {percent(tolerance)} for the last time at the frequency ratio "
        f"ϖ = {float(case.contact.frequency_ratio):.4g}",
    )
    found = families(case, n)
    one = next((one for one in found if one.n == index), judged(found))
    missed = f"at this Λ the contact that is chosen has no {index}-T orbit"
    return describe(case, found, one, need, verdict, () if one.exists else (missed,))
