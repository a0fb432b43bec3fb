r"""Stiffness and damping from what is known of a contact.

A linear contact has two numbers, and any two that fix them will do. Of the free
impact that ends at the angle π - 2α (:mod:`bouncing_ball.contacts.release`) ::

    ω_d t = π - 2α,   ω_d = ω√(1 - ζ²),   k = mω²,   c = 2ζmω

A drop test measures r = √(h′/h), whatever releases the contact. A Hertz contact has the
force ``k x^{3/2} + C √(mk) x^{1/4} x′``, k = (4/3) E* √R, with the damping of Tsuji: its r
is the same at every speed (:mod:`bouncing_ball.contacts.laws.tsuji`), and so E*, R and r are
all of it. Everything in SI units.
"""

import math
from collections.abc import Mapping, Sequence

import numpy as np

from bouncing_ball.calculator.case import Case, Table
from bouncing_ball.contacts.damping import damping_ratio
from bouncing_ball.contacts.laws.tsuji import Tsuji, tsuji_damping
from bouncing_ball.contacts.release import Release
from bouncing_ball.contacts.signature import free_impact
from bouncing_ball.contacts.spring_damper import SpringDamper
from bouncing_ball.errors import ModelError, require
from bouncing_ball.orbits.restitution_model import RestitutionModel
from bouncing_ball.orbits.restitution_orbit import rigid_speed

STIFF = ("stiffness", "contact_time", "reduced_modulus")
"""What says how stiff a contact is; a modulus goes with a radius."""
LOSSY = ("damping", "damping_ratio", "restitution", "measured_restitution", "rebound_height")
"""What says how much it loses; the height of a rebound goes with that of the drop."""
_PAIRS = {"reduced_modulus": "radius", "rebound_height": "drop_height"}

Given = Mapping[str, float]

STANDARD_GRAVITY = 9.80665
"""Standard acceleration of gravity, in m/s²."""


def _words(names: tuple[str, ...]) -> str:
    return ", ".join(f"{name} and {_PAIRS[name]}" if name in _PAIRS else name for name in names)


def which(given: Given, names: tuple[str, ...], what: str) -> str | None:
    """The one of some parameters that is given; none is None.

    Raises
    ------
    ModelError
        If there are two, or one of a pair without the other.

    Examples
    --------
    >>> which({"stiffness": 1e5}, STIFF, "how stiff the contact is")
    'stiffness'
    """
    for first, second in _PAIRS.items():
        if first in names and (first in given) != (second in given):
            raise ModelError(f"{first} and {second} are needed together")
    found = [name for name in names if name in given]
    if len(found) > 1:
        both = " and ".join(found)
        raise ModelError(f"{both} contradict each other: each says {what}; give one of them")
    return found[0] if found else None


def required(given: Given, names: tuple[str, ...], what: str, give: str) -> str:
    """The one of some parameters that is given; a ModelError that says what to give, if none."""
    found = which(given, names, what)
    if found is None:
        raise ModelError(f"{what} is missing: give {give}")
    return found


def rebound(drop_height: float, rebound_height: float) -> float:
    """Restitution coefficient r = √(h′/h) of a drop test.

    Raises
    ------
    ModelError
        If the ball rebounds higher than it was dropped.

    Examples
    --------
    >>> rebound(1.0, 0.25)
    0.5
    """
    if rebound_height > drop_height:
        raise ModelError(
            f"rebound_height = {rebound_height:g} m is above drop_height = {drop_height:g} m"
        )
    return math.sqrt(rebound_height / drop_height)


def loss(given: Given, release: Release, instead: str) -> float:
    """Damping ratio ζ; a damping c needs the stiffness, and ``instead`` says what else will do.

    Raises
    ------
    ModelError
        If nothing says it, or two parameters do, or a damping c, or r is out of range.
    """
    name = required(given, LOSSY, "how much the contact loses", f"one of {_words(LOSSY)}")
    if name == "damping":
        raise ModelError(f"damping needs stiffness{instead}")
    if name == "damping_ratio":
        zeta = given[name]
        require(zeta < 1, zeta, "damping_ratio", "below 1: the contact would not oscillate")
        bounces = SpringDamper(1.0, zeta, release).restitution > 0
        require(bounces, zeta, "damping_ratio", "so far below 1 that the ball bounces at all")
        return zeta
    if name == "rebound_height":
        measured = rebound(given["drop_height"], given[name])
        return float(damping_ratio(measured, release))
    rule = release if name == "measured_restitution" else Release.DISPLACEMENT
    return float(damping_ratio(given[name], rule))


def of_contact_time(mass: float, contact_time: float, zeta: float, release: Release) -> float:
    """Stiffness k of a contact whose free impact takes a time.

    Examples
    --------
    >>> round(of_contact_time(1.0, 3.141592653589793, 0.0, Release.DISPLACEMENT), 15)
    1.0
    """
    # In the unit of time in which the contact's own frequency is 1.
    omega = float(SpringDamper(1.0, zeta, release).free_duration) / contact_time
    return mass * omega * omega


def hertz(
    mass: float, reduced_modulus: float, radius: float, restitution: float, table: Table
) -> Tsuji:
    """The law of a Hertz contact, dimensionless: K = k √g/(mΩ³), C of the restitution.

    Examples
    --------
    >>> law = hertz(1.0, 0.75, 4.0, 1.0, Table(1.0, 1.0, 1.0))
    >>> float(law.stiffness), float(law.damping)
    (2.0, 0.0)
    """
    stiffness = 4 / 3 * reduced_modulus * math.sqrt(radius)
    unit = mass * table.angular_frequency**3 / math.sqrt(table.gravity)
    return Tsuji(stiffness / unit, float(tsuji_damping(restitution)))


def stiffness_and_damping(mass: float, given: Given, release: Release) -> tuple[float, float]:
    """k and c of a linear contact of which enough is known.

    Parameters
    ----------
    mass : float
    given : mapping
        Parameters of :data:`STIFF` and :data:`LOSSY`, with what goes with them.
    release : Release

    Raises
    ------
    ModelError
        If they do not suffice or contradict each other.

    Examples
    --------
    >>> stiffness_and_damping(1.0, {"stiffness": 4.0, "damping": 0.4}, Release.DISPLACEMENT)
    (4.0, 0.4)
    """
    stiff = which(given, STIFF, "how stiff the contact is")
    if stiff == "stiffness" and which(given, LOSSY, "how much the contact loses") == "damping":
        k, c = given["stiffness"], given["damping"]
        critical = 2 * math.sqrt(k * mass)
        if c >= critical:
            raise ModelError(
                f"damping = {c:g} N s/m is not below the critical {critical:g} N s/m: the contact "
                "would not oscillate, and a free impact not end"
            )
        return k, c
    zeta = loss(given, release, ": the two make the contact")
    k = given.get("stiffness") or of_contact_time(mass, given["contact_time"], zeta, release)
    return k, 2 * zeta * math.sqrt(k * mass)


def table_of(given: Given) -> Table:
    """The table, from one of the ways to say how fast and one to say how far it moves."""
    fast = ("frequency", "angular_frequency", "period")
    rate = required(given, fast, "how fast the table moves", "frequency, such as 50 Hz")
    ways = "amplitude, such as 0.1 mm, or acceleration, such as 2 g"
    far = required(given, ("amplitude", "acceleration"), "how far the table moves", ways)
    value, turn = given[rate], 2 * math.pi
    omega = {"frequency": turn * value, "period": turn / value}.get(rate, value)
    height = given["amplitude"] if far == "amplitude" else given["acceleration"] / omega**2
    return Table(omega, height, given.get("gravity", STANDARD_GRAVITY))


def meant(asked: Sequence[int], restitution: float, amplitude: float) -> int:
    """The lowest family that is stable in the restitution model, or the first asked for."""
    orbits = RestitutionModel(restitution).orbit(np.array(asked), amplitude)
    return asked[int(np.argmax(orbits.exists & orbits.is_stable()))]


def _hertz(table: Table, given: Given, release: Release, asked: Sequence[int]) -> tuple[Case, str]:
    """The case of a Hertz contact, with the linear contact that is like it at the impact; a note.

    Raises
    ------
    ModelError
        If the release is not that of the law, or the loss is not given as a restitution.
    """
    if release is not Release.DISPLACEMENT:
        raise ModelError("a Hertz contact with Tsuji's damping is released at δ = 0: no force")
    zeta = loss(given, release, ": a Hertz contact takes a restitution coefficient")
    mass = given["mass"]
    r = float(SpringDamper(1.0, zeta, release).restitution)
    law = hertz(mass, given["reduced_modulus"], given["radius"], r, table)
    speed = rigid_speed(meant(asked, r, table.amplitude), r)
    time = float(free_impact(law, speed).duration) * table.time
    k = of_contact_time(mass, time, zeta, release)
    note = (
        "the orbits are those of the Hertz contact with Tsuji's damping; stiffness, damping, ϖ, ζ "
        "and the ϖ that is needed are those of the linear contact with its r, and its duration at "
        f"the impact speed {speed * table.speed:.3g} m/s of the restitution model's orbit"
    )
    return Case(mass, table, k, 2 * zeta * math.sqrt(k * mass), release, law), note


def case_of(
    given: Given, table: Table, release: Release, asked: Sequence[int]
) -> tuple[Case] | tuple[Case, str] | None:
    """The case whose contact is given, with a note on it; None without any stiffness."""
    stiff = which(given, STIFF, "how stiff the contact is")
    if stiff == "reduced_modulus":
        return _hertz(table, given, release, asked)
    mass = given["mass"]
    found = stiff and stiffness_and_damping(mass, given, release)
    return (Case(mass, table, *found, release),) if found else None
