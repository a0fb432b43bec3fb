"""The calculator: :func:`design`, parameters with units in, a :class:`Design` out."""

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from bouncing_ball.accuracy.quantities import OF_ORBITS, Quantity
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
from bouncing_ball.calculator.families import Family, families, finite
from bouncing_ball.calculator.needed import RATIOS, Needed, needed
from bouncing_ball.calculator.units import KINDS, number
from bouncing_ball.calculator.verdict import QUANTITIES, Verdict, assessed, chosen, notes, percent
from bouncing_ball.contacts.law_signature import free_impact
from bouncing_ball.contacts.permanent_contact import RESTITUTION_THRESHOLD
from bouncing_ball.contacts.release import Release
from bouncing_ball.contacts.spring_damper import SpringDamper
from bouncing_ball.errors import ModelError, NoOrbitError, require
from bouncing_ball.orbits.calls import Index, Rule
from bouncing_ball.orbits.restitution_model import RestitutionModel
from bouncing_ball.orbits.restitution_orbit import rigid_speed

STANDARD_GRAVITY = 9.80665
"""Standard acceleration of gravity, in m/s²."""
STEPS = 50
"""Steps in one contact."""
STEP_RULE = (
    f"a contact takes {STEPS} steps, the default of MFiX-Exa (mfix.tcoll_ratio = {STEPS}) and the "
    "step of MercuryDPM's tutorials"
)

# Families looked at if none is asked for: as many as the paper shows, and some more.
_FAMILIES = range(1, 9)
_RATE = ("frequency", "angular_frequency", "period")
_EXCITATION = ("amplitude", "acceleration")
_MAY_VANISH = ("damping", "damping_ratio")
_AT_MOST_ONE = ("restitution", "measured_restitution")
# Beyond, the squares of ϖ and Λ leave no digits; as on the rest of the command line.
_LARGEST = 1e8
# Of any quantity in SI units: products and powers of a few stay floating-point numbers.
_SPAN = (1e-40, 1e40)


@dataclass(frozen=True)
class Corrected:
    """The three numbers of the corrected restitution model, in SI units.

    The impact is an instant t_c = ``delay`` after the ball touches, with the
    restitution ``r + σ a/v``: σ = ``load`` is a time, a the acceleration that
    presses the ball to the table and v the impact speed.
    """

    delay: float
    restitution: float
    load: float


@dataclass(frozen=True)
class TimeStep:
    """The largest time step that resolves the contact, in s, and where the rule is from."""

    largest: float
    rule: str


@dataclass(frozen=True)
class PermanentContact:
    """Λ up to which the ball stays down, in the contact and in the restitution model.

    ``margin`` is the share by which Λ may fall to the threshold; below zero the ball may
    stay down. None of a Hertz contact, whose stiffness at rest is that of its static deflection.
    """

    threshold: float | None
    restitution_threshold: float
    margin: float | None


@dataclass(frozen=True)
class Design:
    """What an engineer needs to know of a contact; times in s, lengths in m, forces in N.

    ``frequency_ratio``, ``damping_ratio`` and ``amplitude`` are ϖ, ζ and Λ; ``restitution``
    is that of a free impact by the release rule; ``n`` is the family of the verdict.
    """

    frequency_ratio: float
    damping_ratio: float
    amplitude: float
    contact_time: float
    stiffness: float
    damping: float
    static_deflection: float
    restitution: dict[str, float]
    corrected: Corrected
    time_step: TimeStep
    permanent_contact: PermanentContact
    orbits: tuple[Family, ...]
    needed: Needed
    is_good_enough: bool
    verdict: str
    reason: str
    notes: tuple[str, ...]
    case: Case
    n: int


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
    asked = _FAMILIES if n is None else [n]
    stiff = which(given, STIFF, "how stiff the contact is")
    if stiff is None:
        return _choose(table, given, rule, asked, quantity, epsilon)
    if stiff == "reduced_modulus":
        case, remarks = _hertz(table, given, rule, asked)
    else:
        k, c = stiffness_and_damping(given["mass"], given, rule)
        case, remarks = Case(given["mass"], table, k, c, rule), []
    ratio = float(case.contact.frequency_ratio)
    require(1 / _LARGEST < ratio < _LARGEST, ratio, "ϖ", f"between {1 / _LARGEST:g} and 1e8")
    found = families(case, asked)
    one = _judged(found)
    need = needed(quantity, epsilon, case.contact, one.n, table.amplitude)
    return _design(case, found, one, need, assessed(one, need, ratio), remarks)


def _read(parameters: dict[str, Any]) -> dict[str, float]:
    """The quantities that are given, in SI units and in their ranges."""
    given = {name: number(name, value) for name, value in parameters.items() if value is not None}
    for name, value in given.items():
        shown = f"{name} = {value:g} {KINDS[name].unit}".rstrip()
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
    turn = {"frequency": 2 * math.pi * given[rate], "period": 2 * math.pi / given[rate]}
    omega = turn.get(rate, given[rate])
    height = given[far] if far == "amplitude" else given[far] / omega**2
    return Table(omega, height, given.get("gravity", STANDARD_GRAVITY))


def _meant(asked: Sequence[int], restitution: float, amplitude: float) -> int:
    """The lowest family that is stable in the restitution model, or the first asked for."""
    orbits = RestitutionModel(restitution).orbit(np.array(asked), amplitude)
    return asked[int(np.argmax(orbits.exists & orbits.is_stable()))]


def _hertz(
    table: Table, given: dict[str, float], release: Release, asked: Sequence[int]
) -> tuple[Case, list[str]]:
    """The case of a Hertz contact, with the linear contact that is like it at the impact.

    Raises
    ------
    ModelError
        If the release is not that of the law, or the loss is not given as a restitution.
    """
    if release is not Release.DISPLACEMENT:
        raise ModelError("a Hertz contact with Tsuji's damping is released at δ = 0: no force")
    mass, zeta = given["mass"], loss(given, release)
    if zeta is None:
        raise ModelError("damping needs stiffness: a Hertz contact takes a restitution coefficient")
    r = float(SpringDamper(1.0, zeta, release).restitution)
    law = hertz(mass, given["reduced_modulus"], given["radius"], r, table)
    speed = rigid_speed(_meant(asked, r, table.amplitude), r)
    time = float(free_impact(law, speed).duration) * table.time
    k = of_contact_time(mass, time, zeta, release)
    note = (
        "the orbits are those of the Hertz contact with Tsuji's damping; stiffness, damping, ϖ, ζ "
        "and the ϖ that is needed are those of the linear contact with its r, and its duration at "
        f"the impact speed {speed * table.speed:.3g} m/s of the restitution model's orbit"
    )
    return Case(mass, table, k, 2 * zeta * math.sqrt(k * mass), release, law), [note]


def _choose(
    table: Table,
    given: dict[str, float],
    release: Release,
    asked: Sequence[int],
    quantity: str,
    tolerance: float,
) -> Design:
    """The most compliant contact for a tolerance.

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
    unit = SpringDamper(1.0, zeta, release)
    r, lam = float(unit.restitution), table.amplitude
    n = _meant(asked, r, lam)
    if quantity in OF_ORBITS:
        RestitutionModel(r).require_orbit(n, lam)
    need = needed(quantity, tolerance, unit, n, lam)
    if need.status == ThresholdStatus.NEVER_WITHIN:
        raise NoOrbitError(
            f"no contact up to ϖ = {RATIOS[-1]:g} has its {QUANTITIES[Quantity(quantity)]} within "
            f"{percent(tolerance)} of the restitution model with r = {r:.4g}"
        )
    ratio = RATIOS[0] if need.frequency_ratio is None else need.frequency_ratio
    mass, omega = given["mass"], ratio * table.angular_frequency
    case = Case(mass, table, mass * omega * omega, 2 * zeta * mass * omega, release)
    found = families(case, asked)
    one = next((one for one in found if one.n == n), _judged(found))
    missed = f"at this Λ the contact that is chosen has no {n}-T orbit"
    remarks = [] if one.exists else [missed]
    return _design(case, found, one, need, chosen(case, need, n), remarks)


def _judged(found: Sequence[Family]) -> Family:
    """The family that a verdict is about: the first stable one, or the first there is."""
    steady = [one for one in found if one.exists and one.is_stable and one.is_admissible]
    return (steady or [one for one in found if one.exists] or list(found))[0]


def _design(
    case: Case,
    found: tuple[Family, ...],
    one: Family,
    need: Needed,
    verdict: Verdict,
    remarks: list[str],
) -> Design:
    """Everything that is known of a contact; `one` is the family of the verdict."""
    contact, table, instant = case.contact, case.table, case.instant(one.n)
    threshold = next(iter(case.permanent_contact.values()))
    return Design(
        frequency_ratio=float(contact.frequency_ratio),
        damping_ratio=float(contact.damping_ratio),
        amplitude=table.amplitude,
        contact_time=case.contact_time,
        stiffness=case.stiffness,
        damping=case.damping,
        static_deflection=case.static_deflection,
        restitution={
            str(rule): float(replace(contact, release=rule).restitution) for rule in Release
        },
        corrected=Corrected(
            delay=float(instant.delay) * table.time,
            restitution=float(instant.restitution),
            load=float(instant.load) * table.time,
        ),
        time_step=TimeStep(case.contact_time / STEPS, STEP_RULE),
        permanent_contact=PermanentContact(
            threshold=finite(threshold),
            restitution_threshold=RESTITUTION_THRESHOLD,
            margin=finite(1 - threshold / table.amplitude),
        ),
        orbits=found,
        needed=need,
        is_good_enough=verdict.is_good_enough,
        verdict=verdict.sentence,
        reason=verdict.reason,
        notes=(*remarks, *notes(case, one)),
        case=case,
        n=one.n,
    )
