r"""The case that given data determine: the stiffness and the loss of a contact.

A free impact ends at the angle π - 2α (:mod:`bouncing_ball.models.damping`), so that ::

    ω_d t = π - 2α,   ω_d = ω√(1 - ζ²),   ω² = k/m,   c = 2ζmω

A drop test is a drop with gravity onto a table at rest, from which the damping is fitted
(:mod:`bouncing_ball.contacts.drop_test`); for a contact law gravity is neglected, and
r = √(h′/h). A Hertz contact has the
force ``k x^{3/2} + C √(mk) x^{1/4} x′``, k = (4/3) E* √R, with the damping of Tsuji. Its r
is the same at every speed (:mod:`bouncing_ball.models.laws.hertzian`), so that E*, R and r
determine it. For two elastic bodies, the ball and the table (Hertz), ::

    1/E* = (1 - ν₁²)/E₁ + (1 - ν₂²)/E₂

All quantities are in SI units.
"""

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace

import numpy as np

from bouncing_ball.contacts.case import PhysicalCase, TableMotion
from bouncing_ball.contacts.drop_test import fitted_damping_ratio
from bouncing_ball.contacts.given import STANDARD_GRAVITY, Contact, given, single
from bouncing_ball.contacts.named_laws import law_named
from bouncing_ball.errors import ModelError, ParameterError
from bouncing_ball.models.damping import Release, damping_ratio
from bouncing_ball.models.laws.contact_law import ContactLaw
from bouncing_ball.models.laws.hertzian import Tsuji, tsuji_damping
from bouncing_ball.models.laws.law_of_impact import law_of_impact
from bouncing_ball.models.laws.signature import Signature
from bouncing_ball.models.rigid import RestitutionModel
from bouncing_ball.models.spring_damper import SpringDamper
from bouncing_ball.periodic import n_t
from bouncing_ball.periodic.restitution_branch import rigid_speed

# Parameters that determine the stiffness of a contact; a modulus needs the radius, too.
STIFF = ("stiffness", "contact_time", "reduced_modulus", "youngs_modulus")
MATERIALS = ("youngs_modulus", "poissons_ratio", "table_youngs_modulus", "table_poissons_ratio")
"""Moduli E and Poisson's ratios ν of the ball and of the table, from which E* follows."""
# Parameters that determine its loss; the height of a rebound needs that of the drop, too.
LOSSY = ("damping", "damping_ratio", "restitution", "measured_restitution", "rebound_height")
_PAIRS = {"rebound_height": "drop_height"}
Given = Mapping[str, float]
# What a contact of a law is not given by, because its parameters follow from a free impact.
_NOT_OF_A_LAW = ("stiffness", "damping", "damping_ratio", "reduced_modulus", "youngs_modulus")


def require_own_release(contact: Contact) -> None:
    """Refuse a release that is given with a law, which has its own.

    Raises
    ------
    ModelError
        If a release and a law other than the linear one are given.
    """
    if contact.release is not None and contact.law not in (None, SpringDamper.name):
        raise ParameterError(
            f"{{release}} is not allowed with {{law}} {contact.law}, which has its own"
        )


def law_type(contact: Contact) -> type[ContactLaw] | None:
    """The type of the contact law that is named; None for the linear contact.

    Raises
    ------
    ModelError
        If there is no such law, or if it is given by other parameters than those of an impact.

    Examples
    --------
    >>> law_type(Contact(law="hunt-crossley", contact_time="1 ms")).name
    'hunt-crossley'
    """
    name = contact.law
    if name is None:
        return None
    if name.casefold() in ("hertz", "hertzian"):
        raise ParameterError(
            f"{{law}} {name} has no damper: Hertz's spring with a damper is {{law}} tsuji, or give "
            "{radius} and {reduced_modulus} in place of {law}"
        )
    kind = law_named(name)
    if kind is SpringDamper:
        return None
    for other in _NOT_OF_A_LAW:
        if getattr(contact, other) is not None:
            instead = "give {contact_time} and {restitution}"
            raise ParameterError(f"{{{other}}} is not allowed with {{law}} {name}: {instead}")
    if contact.contact_time is None:
        raise ParameterError(
            f"{{law}} {name} needs {{contact_time}}, the duration of a free impact"
        )
    return kind


def loss(
    data: Given,
    release: Release,
    omega_of: Callable[[float], float] | None = None,
    gravity: float = STANDARD_GRAVITY,
) -> float:
    """Damping ratio ζ of a contact whose loss is given without the stiffness.

    A drop test needs ``omega_of``, √(k/m) in rad/s as a function of ζ, for the effect of gravity;
    without it gravity is neglected.

    Raises
    ------
    ModelError
        If no parameter or more than one gives the loss, if the loss is given as a damping c, which
        needs the stiffness, or if r or ζ is out of range.

    Examples
    --------
    >>> loss({"drop_height": 4.0, "rebound_height": 4.0}, Release.DISPLACEMENT)
    0.0
    """
    others = ", ".join(f"{{{name}}}" for name in LOSSY[:-1])
    ways = f"one of {others}, or {{drop_height}} and {{rebound_height}}"
    name = single(data, LOSSY, "the loss of the contact", ways)
    if name == "damping":
        raise ParameterError(
            "{damping} needs {stiffness}: give it, or {restitution} in place of {damping}"
        )
    if name == "damping_ratio":
        return _oscillating(data[name], release, "{damping_ratio}")
    if name != "rebound_height":
        rule = Release.DISPLACEMENT if name == "restitution" else release
        return float(damping_ratio(data[name], rule))
    height = data["rebound_height"]
    drop = data["drop_height"]
    if height > drop:
        raise ParameterError(f"{{rebound_height}} {height:g} m is above {{drop_height}} {drop:g} m")
    if omega_of is not None:
        return fitted_damping_ratio(omega_of, drop, height, gravity, release)
    return float(damping_ratio(math.sqrt(height / drop), release))


def _oscillating(zeta: float, release: Release, name: str) -> float:
    """ζ, or an error if a free impact with it does not end: a damper that pulls holds the ball."""
    if release is not Release.DISPLACEMENT:
        return zeta
    if not (zeta < 1 and SpringDamper(1.0, zeta, release).restitution > 0):
        why = "near the critical damping 1 and above it the ball does not bounce"
        raise ParameterError(f"{name} = {zeta:.12g} is too large: {why}")
    return zeta


def reduced_modulus(data: Given) -> float | None:
    """E* of a Hertz contact in Pa, given or computed from the materials of both bodies.

    None if the contact is not a Hertz contact.

    Raises
    ------
    ModelError
        If one of the parameters that are needed together is missing.

    Examples
    --------
    For two bodies of the same material with ν = 0, E* is half of Young's modulus; on a much
    stiffer table it is Young's modulus of the ball:

    >>> same = dict.fromkeys(MATERIALS, 0.0) | {"radius": 1.0}
    >>> reduced_modulus(same | {"youngs_modulus": 2.0, "table_youngs_modulus": 2.0})
    1.0
    >>> round(reduced_modulus(same | {"youngs_modulus": 2.0, "table_youngs_modulus": 1e12}), 9)
    2.0
    """
    known = [name for name in MATERIALS if name in data]
    if known:
        missing = " and ".join(f"{{{name}}}" for name in MATERIALS if name not in data)
        if missing:
            raise ParameterError(
                f"{{{known[0]}}} needs {missing}: both bodies are elastic, each with E and ν"
            )
    elastic = "youngs_modulus" if known else "reduced_modulus"
    if (elastic in data) != ("radius" in data):
        ways = "{reduced_modulus}, or {youngs_modulus} and the other data of both materials"
        raise ParameterError(
            f"{{{elastic}}} needs {{radius}}, the radius of curvature at the contact"
            if elastic in data
            else f"{{radius}} of a Hertz contact needs {ways}"
        )
    if not known:
        return data.get("reduced_modulus")
    ball, ball_ratio, table, table_ratio = (data[name] for name in MATERIALS)
    return 1 / ((1 - ball_ratio**2) / ball + (1 - table_ratio**2) / table)


def hertz(
    mass: float, modulus: float, radius: float, restitution: float, table: TableMotion
) -> Tsuji:
    """The dimensionless law of a Hertz contact with E* in Pa and R in m.

    Its stiffness is K = k √g/(mΩ³), and its damping C follows from r.

    Examples
    --------
    >>> law = hertz(1.0, 0.75, 4.0, 1.0, TableMotion(1.0, 1.0, 1.0))
    >>> float(law.stiffness), float(law.damping)
    (2.0, 0.0)
    """
    stiffness = 4 / 3 * modulus * math.sqrt(radius)
    unit = mass * table.angular_frequency**3 / math.sqrt(table.gravity)
    return Tsuji(stiffness / unit, float(tsuji_damping(restitution)))


def meant(asked: Sequence[int], restitution: float | np.ndarray, amplitude: float) -> int:
    """The first of the families whose orbit is stable in the restitution model.

    If none of these orbits is stable, it is the first family.

    Examples
    --------
    With r = 0.85 and Λ = 1.1 the 1-T orbit is beyond its period doubling:

    >>> meant([1, 2, 3], 0.85, 1.1)
    2
    """
    orbits = n_t.orbit(RestitutionModel(restitution), np.array(asked), amplitude)
    return asked[int(np.argmax(orbits.exists & orbits.is_stable()))]


def with_law(case: PhysicalCase, law: ContactLaw, asked: Sequence[int]) -> PhysicalCase:
    """The case with a law, and with the linear contact of its r and duration at the impact speed.

    This speed v = 2πn/(1 + r(v)) is that of the first stable family of the restitution model.

    Examples
    --------
    >>> case = PhysicalCase(1.0, TableMotion(1.0, 1.0, 1.0), SpringDamper(1.0, 0.0))
    >>> found = with_law(case, Tsuji(50.0, tsuji_damping(0.8)), [1])
    >>> round(float(found.contact.restitution), 12)
    0.8
    """
    signature = Signature(law)
    r = np.ones(len(asked))
    # A contraction: where r falls like 1/v at most, each step at least halves the error.
    for _ in range(np.finfo(float).nmant):
        r = signature(rigid_speed(asked, r)).restitution
    n = meant(asked, r, case.table.amplitude)
    impact = law.signature(float(rigid_speed(n, r[asked.index(n)])))
    unit = SpringDamper.from_restitution(
        float(impact.restitution), 1.0, case.contact.release, measured=True
    )
    ratio = float(unit.free_duration / impact.duration)
    return replace(case, contact=replace(unit, frequency_ratio=ratio), law=law)


def case_of(contact: Contact, table: TableMotion, families: Sequence[int]) -> PhysicalCase:
    """The case of a contact that is given, on a table.

    Parameters
    ----------
    contact : Contact
        One of its parameters gives the stiffness.
    table : TableMotion
    families : sequence of int
        Families n. The impact speed of a nonlinear contact is that of the first stable family.

    Raises
    ------
    ModelError
        If parameters do not suffice or contradict each other.

    Examples
    --------
    >>> contact = Contact(mass=1.0, stiffness=4.0, damping=0.4)
    >>> case_of(contact, TableMotion(1.0, 1.0, 1.0), [1]).contact.damping_ratio
    0.1
    """
    kind = law_type(contact)
    # The parameters of a law follow from a free impact, so that r counts as measured.
    data = given(contact if kind is None else contact.with_measured_restitution())
    rule = rule_of(contact)
    require_pairs(data)
    stiff = single(data, STIFF, "the stiffness of the contact")
    modulus = reduced_modulus(data)
    if not stiff:
        raise ParameterError("no stiffness: give {stiffness}, or {contact_time}")
    if stiff == "stiffness":
        return _of_stiffness(data, table, rule)
    # A contact with ω = 1; its free duration over the given one is ϖ.
    if modulus is None and kind is None:
        zeta = loss(data, rule, _omega_of_time(data["contact_time"], rule), table.gravity)
    else:
        zeta = loss(data, rule)
    unit = SpringDamper(1.0, zeta, rule)
    if modulus is not None and rule is not Release.DISPLACEMENT:
        raise ModelError("a Hertz contact with Tsuji's damping has the displacement release only")
    r = float(unit.restitution)
    speed = rigid_speed(meant(families, r, table.amplitude), r)
    law: ContactLaw | None = None
    if modulus is not None:
        law = hertz(data["mass"], modulus, data["radius"], r, table)
        duration = float(law.signature(speed).duration)
    else:
        duration = data["contact_time"] / table.time
        if kind is not None:
            law = law_of_impact(kind, r, duration, speed)
    linear = replace(unit, frequency_ratio=float(unit.free_duration) / duration)
    return PhysicalCase(data["mass"], table, linear, law)


def rule_of(contact: Contact) -> Release:
    """The release rule of a contact, by default that of the displacement.

    Raises
    ------
    ModelError
        If there is no such rule.
    """
    return Release.of(contact.release or Release.DISPLACEMENT)


def require_pairs(data: Given) -> None:
    """Refuse a drop test of which one height is missing, and a contact without a mass.

    Raises
    ------
    ModelError
        The message names what is missing.
    """
    for first, second in _PAIRS.items():
        if (first in data) != (second in data):
            raise ParameterError(f"{{{first}}} and {{{second}}} are needed together")
    if "mass" not in data:
        raise ParameterError("the mass is missing: give {mass}, such as 20 g")


def _of_stiffness(data: Given, table: TableMotion, release: Release) -> PhysicalCase:
    """The case of a linear contact whose stiffness is given, with its loss."""
    mass = data["mass"]
    omega = math.sqrt(data["stiffness"] / mass)
    if single(data, LOSSY, "the loss of the contact") == "damping":
        zeta = data["damping"] / (2 * mass * omega)
        zeta = _oscillating(zeta, release, "damping ratio ζ of the contact")
    else:
        zeta = loss(data, release, same_omega(omega), table.gravity)
    contact = SpringDamper(omega / table.angular_frequency, zeta, release)
    return PhysicalCase(mass, table, contact)


def same_omega(omega: float) -> Callable[[float], float]:
    """√(k/m) in rad/s, as a function of ζ, of contacts of one stiffness: it is constant."""
    return lambda zeta: omega


def _omega_of_time(duration: float, release: Release) -> Callable[[float], float]:
    """√(k/m) in rad/s, as a function of ζ, of contacts whose free impacts last as long as given."""
    return lambda zeta: float(SpringDamper(1.0, zeta, release).free_duration) / duration
