r"""The case that given data determine: a table, and a contact by its stiffness and its loss.

A free impact ends at the angle π - 2α (:mod:`bouncing_ball.paper.contact.damping`), so that ::

    ω_d t = π - 2α,   ω_d = ω√(1 - ζ²),   ω² = k/m,   c = 2ζmω

A drop test is a drop with gravity onto a table at rest, from which the damping is fitted
(:mod:`bouncing_ball.beyond.calculator.drop_test`); for a contact law gravity is neglected, and
r = √(h′/h). A Hertz contact has the
force ``k x^{3/2} + C √(mk) x^{1/4} x′``, k = (4/3) E* √R, with the damping of Tsuji. Its r
is the same at every speed (:mod:`bouncing_ball.beyond.laws.hertzian`), so that E*, R and r
determine it. For two elastic bodies, the ball and the table (Hertz), ::

    1/E* = (1 - ν₁²)/E₁ + (1 - ν₂²)/E₂

The parameters of a physics engine give a contact, too: :func:`read_engine` finds the stiffness k
and the damping c that the engine computes with. All quantities are in SI units.
"""

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np

from bouncing_ball.beyond.calculator.case import PhysicalCase, Table
from bouncing_ball.beyond.calculator.drop_test import fitted_damping_ratio
from bouncing_ball.beyond.calculator.units import SIParameter, number
from bouncing_ball.beyond.corrected.signature import Signature, free_impact
from bouncing_ball.beyond.engines.choice import engine_named
from bouncing_ball.beyond.engines.engine import Engine, Physical
from bouncing_ball.beyond.laws.contact_law import ContactLaw
from bouncing_ball.beyond.laws.hertzian import Tsuji, tsuji_damping
from bouncing_ball.beyond.laws.law_of_impact import law_of_impact
from bouncing_ball.errors import ModelError, ParameterError
from bouncing_ball.paper.contact.damping import Release, damping_ratio
from bouncing_ball.paper.contact.spring_damper import SpringDamper
from bouncing_ball.paper.orbits.restitution_branch import rigid_speed
from bouncing_ball.paper.orbits.restitution_model import RestitutionModel

# Parameters that determine the stiffness of a contact; a modulus needs the radius, too.
STIFF = ("stiffness", "contact_time", "reduced_modulus", "youngs_modulus")
MATERIALS = ("youngs_modulus", "poissons_ratio", "table_youngs_modulus", "table_poissons_ratio")
"""Moduli E and Poisson's ratios ν of the ball and of the table, from which E* follows."""
# Parameters that determine its loss; the height of a rebound needs that of the drop, too.
LOSSY = ("damping", "damping_ratio", "restitution", "measured_restitution", "rebound_height")
_PAIRS = {"rebound_height": "drop_height"}
# Parameters of MuJoCo that are lists; each of them is a separate argument.
_OF_MUJOCO = ("solref", "solimp")
Given = Mapping[str, float]
STANDARD_GRAVITY = 9.80665
"""Standard acceleration of gravity, in m/s²."""


def _one_of(given: Given, names: tuple[str, ...], what: str, give: str = "") -> str:
    """Name of the single one of these parameters that is given.

    If none of them is given, the result is an empty text, or, where ``give`` names the parameters
    to give, an error.
    """
    found = [name for name in names if name in given]
    if len(found) > 1:
        both = " and ".join(f"{{{name}}}" for name in found)
        raise ParameterError(f"{both} contradict each other, because each gives {what}: give one")
    if give and not found:
        raise ParameterError(f"{what} is missing: give {give}")
    return found[0] if found else ""


def loss(
    given: Given,
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
    single = ", ".join(f"{{{name}}}" for name in LOSSY[:-1])
    ways = f"one of {single}, or {{drop_height}} and {{rebound_height}}"
    name = _one_of(given, LOSSY, "the loss of the contact", ways)
    if name == "damping":
        raise ParameterError(
            "{damping} needs {stiffness}: give it, or {restitution} in place of {damping}"
        )
    if name == "damping_ratio":
        return _oscillating(given[name], release, "{damping_ratio}")
    if name != "rebound_height":
        rule = Release.DISPLACEMENT if name == "restitution" else release
        return float(damping_ratio(given[name], rule))
    height = given["rebound_height"]
    drop = given["drop_height"]
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


def reduced_modulus(given: Given) -> float | None:
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
    known = [name for name in MATERIALS if name in given]
    if known:
        missing = " and ".join(f"{{{name}}}" for name in MATERIALS if name not in given)
        if missing:
            raise ParameterError(
                f"{{{known[0]}}} needs {missing}: both bodies are elastic, each with E and ν"
            )
    elastic = "youngs_modulus" if known else "reduced_modulus"
    if (elastic in given) != ("radius" in given):
        ways = "{reduced_modulus}, or {youngs_modulus} and the other data of both materials"
        raise ParameterError(
            f"{{{elastic}}} needs {{radius}}, the radius of curvature at the contact"
            if elastic in given
            else f"{{radius}} of a Hertz contact needs {ways}"
        )
    if not known:
        return given.get("reduced_modulus")
    ball, ball_ratio, table, table_ratio = (given[name] for name in MATERIALS)
    return 1 / ((1 - ball_ratio**2) / ball + (1 - table_ratio**2) / table)


def hertz(mass: float, modulus: float, radius: float, restitution: float, table: Table) -> Tsuji:
    """The dimensionless law of a Hertz contact with E* in Pa and R in m.

    Its stiffness is K = k √g/(mΩ³), and its damping C follows from r.

    Examples
    --------
    >>> law = hertz(1.0, 0.75, 4.0, 1.0, Table(1.0, 1.0, 1.0))
    >>> float(law.stiffness), float(law.damping)
    (2.0, 0.0)
    """
    stiffness = 4 / 3 * modulus * math.sqrt(radius)
    unit = mass * table.angular_frequency**3 / math.sqrt(table.gravity)
    return Tsuji(stiffness / unit, float(tsuji_damping(restitution)))


def table_of(given: Given) -> Table:
    """The table, from one parameter for the frequency and one for the amplitude of its motion.

    Raises
    ------
    ModelError
        If one of them is missing or given twice.

    Examples
    --------
    >>> table_of({"period": 2 * math.pi, "acceleration": 3.0, "gravity": 1.0}).table_amplitude
    3.0
    """
    fast = ("frequency", "angular_frequency", "period")
    rate = _one_of(given, fast, "the frequency of the table", "{frequency}, such as 50 Hz")
    ways = "{acceleration}, such as 2 g, or {table_amplitude}, such as 0.1 mm"
    far = _one_of(given, ("table_amplitude", "acceleration"), "the amplitude of the table", ways)
    if rate == "frequency":
        omega = 2 * math.pi * given["frequency"]
    elif rate == "period":
        omega = 2 * math.pi / given["period"]
    else:
        omega = given["angular_frequency"]
    if far == "table_amplitude":
        moved = given["table_amplitude"]
    else:
        moved = given["acceleration"] / omega**2
    return Table(omega, moved, given.get("gravity", STANDARD_GRAVITY))


def meant(asked: Sequence[int], restitution: float | np.ndarray, amplitude: float) -> int:
    """The first of the families whose orbit is stable in the restitution model.

    If none of these orbits is stable, it is the first family.

    Examples
    --------
    With r = 0.85 and Λ = 1.1 the 1-T orbit is beyond its period doubling:

    >>> meant([1, 2, 3], 0.85, 1.1)
    2
    """
    orbits = RestitutionModel(restitution).orbit(np.array(asked), amplitude)
    return asked[int(np.argmax(orbits.exists & orbits.is_stable()))]


def with_law(case: PhysicalCase, law: ContactLaw, asked: Sequence[int]) -> PhysicalCase:
    """The case with a law, and with the linear contact of its r and duration at the impact speed.

    This speed v = 2πn/(1 + r(v)) is that of the first stable family of the restitution model.

    Examples
    --------
    >>> case = PhysicalCase(1.0, Table(1.0, 1.0, 1.0), SpringDamper(1.0, 0.0))
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
    impact = free_impact(law, float(rigid_speed(n, r[asked.index(n)])))
    unit = SpringDamper.from_restitution(
        float(impact.restitution), 1.0, case.contact.release, measured=True
    )
    ratio = float(unit.free_duration / impact.duration)
    return replace(case, contact=replace(unit, frequency_ratio=ratio), law=law)


def case_of(
    given: Given,
    table: Table,
    release: Release,
    asked: Sequence[int],
    kind: type[ContactLaw] | None = None,
) -> PhysicalCase | None:
    """The case with the contact that is given; None if no parameter gives a stiffness.

    Parameters
    ----------
    given : mapping of str to float
        Parameters in SI units, by name.
    table : Table
    release : Release
    asked : sequence of int
        Families n. The impact speed of a nonlinear contact is that of the first stable family.
    kind : type of ContactLaw, optional
        A contact law, whose parameters follow from r, the contact time and the impact speed.

    Raises
    ------
    ModelError
        If parameters do not suffice or contradict each other.

    Examples
    --------
    >>> given = {"mass": 1.0, "stiffness": 4.0, "damping": 0.4}
    >>> case_of(given, Table(1.0, 1.0, 1.0), Release.DISPLACEMENT, [1]).contact.damping_ratio
    0.1
    """
    for first, second in _PAIRS.items():
        if (first in given) != (second in given):
            raise ParameterError(f"{{{first}}} and {{{second}}} are needed together")
    if "mass" not in given:
        raise ParameterError("the mass is missing: give {mass}, such as 20 g")
    stiff = _one_of(given, STIFF, "the stiffness of the contact")
    modulus = reduced_modulus(given)
    if not stiff:
        return None
    if stiff == "stiffness":
        return _of_stiffness(given, table, release)
    # A contact with ω = 1; its free duration over the given one is ϖ.
    if modulus is None and kind is None:
        zeta = loss(given, release, _omega_of_time(given["contact_time"], release), table.gravity)
    else:
        zeta = loss(given, release)
    unit = SpringDamper(1.0, zeta, release)
    if modulus is not None and release is not Release.DISPLACEMENT:
        raise ModelError("a Hertz contact with Tsuji's damping has the displacement release only")
    r = float(unit.restitution)
    speed = rigid_speed(meant(asked, r, table.amplitude), r)
    law: ContactLaw | None = None
    if modulus is not None:
        law = hertz(given["mass"], modulus, given["radius"], r, table)
        duration = float(free_impact(law, speed).duration)
    else:
        duration = given["contact_time"] / table.time
        if kind is not None:
            law = law_of_impact(kind, r, duration, speed)
    contact = replace(unit, frequency_ratio=float(unit.free_duration) / duration)
    return PhysicalCase(given["mass"], table, contact, law)


def _of_stiffness(given: Given, table: Table, release: Release) -> PhysicalCase:
    """The case of a linear contact whose stiffness is given, with its loss."""
    mass = given["mass"]
    omega = math.sqrt(given["stiffness"] / mass)
    if _one_of(given, LOSSY, "the loss of the contact") == "damping":
        zeta = given["damping"] / (2 * mass * omega)
        zeta = _oscillating(zeta, release, "damping ratio ζ of the contact")
    else:
        zeta = loss(given, release, same_omega(omega), table.gravity)
    contact = SpringDamper(omega / table.angular_frequency, zeta, release)
    return PhysicalCase(mass, table, contact)


def same_omega(omega: float) -> Callable[[float], float]:
    """√(k/m) in rad/s, as a function of ζ, of contacts of one stiffness: it is constant."""
    return lambda zeta: omega


def _omega_of_time(duration: float, release: Release) -> Callable[[float], float]:
    """√(k/m) in rad/s, as a function of ζ, of contacts whose free impacts last as long as given."""
    return lambda zeta: float(SpringDamper(1.0, zeta, release).free_duration) / duration


class Source(NamedTuple):
    """An engine, the given parameters of its contact, and the spring and damper of these."""

    engine: Engine
    parameters: dict[str, Any]
    contact: Physical

    def case(self, case: PhysicalCase, asked: Sequence[int], written: bool) -> PhysicalCase:
        """The case with the law of this contact, or with its linear contact if this is written."""
        law = self.engine.law(self.parameters, case.mass, case.table.time, case.table.length)
        if law is not None and self.engine.needs_speed:
            case = with_law(case, law, asked)
        return replace(case, law=None if written else law)

    def remarks(self, written: str | None, release: Release) -> tuple[str, ...]:
        """Sentences on how the contact differs from a spring and a damper, and on how r changes if
        it is written for the engine with this name and release.
        """
        found = self.engine.remarks(self.parameters)
        own_release = self.engine.release()
        same = written is None or own_release is release
        if same or not 0 < self.contact.damping_ratio < 1:
            return found
        before = f"{self.contact.restitution(own_release):.4f}"
        after = f"{self.contact.restitution(release):.4f}"
        why = f"contacts end by {own_release} in {self.engine.name}, and by {release} in {written}"
        return (*found, f"r changes from {before} to {after}, because {why}")


def read_engine(arguments: Mapping[str, Any]) -> tuple[Source | None, dict[str, Any]]:
    """The engine whose parameters are given, and the arguments with these as k and c.

    Without such an engine, None and the arguments unchanged.
    """
    values = _engine_values(arguments)
    name = arguments.get("from_engine")
    if name is None:
        if values:
            first = next(iter(values))
            what = f"{{{first}}}" if first in _OF_MUJOCO else f"{{parameters}} {first}"
            raise ParameterError(f"{what} needs {{from_engine}}, the name of the engine")
        return None, dict(arguments)
    engine = engine_named(name).reader(values)
    for other in (*STIFF, *LOSSY, "law"):
        if arguments.get(other) is not None:
            raise ParameterError(f"{{{other}}} is not allowed with {{from_engine}}")
    mass = arguments.get("mass")
    if mass is not None:
        mass = number("mass", mass, SIParameter("kg", "20 g"))
    source = Source(engine, values, engine.contact(values, mass))
    rule = arguments.get("release")
    # Written for another engine, the contact ends as there; otherwise as here, or as a law's.
    if not arguments.get("engine") and not engine.needs_speed:
        rule = str(engine.release(rule))
    return source, {**arguments, **source.contact._asdict(), "mass": mass, "release": rule}


def _engine_values(arguments: Mapping[str, Any]) -> dict[str, Any]:
    """The parameters of an engine that are given, by name."""
    values = {name: arguments.get(name) for name in _OF_MUJOCO}
    values |= arguments.get("parameters") or {}
    return {name: value for name, value in values.items() if value is not None}
