"""What a user gives: a table, a contact with its ball, and a question.

Quantities are plain numbers in SI units, texts such as ``"50 Hz"``, or pint quantities. Each class
converts them when it is made, so that its fields are numbers in SI units; a parameter that is not
given is None.
"""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, fields, replace
from typing import Annotated, Any, Literal, get_args

from bouncing_ball.accuracy.errors import QUANTITIES
from bouncing_ball.contacts.case import TableMotion
from bouncing_ball.contacts.engines.choice import engine_named
from bouncing_ball.contacts.engines.engine import ERROR
from bouncing_ball.contacts.units import SIParameter, number
from bouncing_ball.errors import FAMILY, ModelError, ParameterError, Range, count, one_of
from bouncing_ball.models.spring_damper import SpringDamper

STANDARD_GRAVITY = 9.80665
"""Standard acceleration of gravity, in m/s²."""

# The families of which one is judged by default: those that the paper shows, and some more.
_FAMILIES = range(1, 9)
# The smallest modulus in Pa that is taken for one if it is given without a unit.
_SOFTEST = 1e4
# The smallest restitution that may be one in percent.
_PERCENT = 5
_NONE_TOO = Range(0, 1e40, "[]")
MOST_BALLS = count(100_000)
Index = Annotated[int, FAMILY]
Balls = Annotated[int, MOST_BALLS]
Rule = Literal["displacement", "force"]
Frequency = Annotated[Any, SIParameter("Hz", "50 Hz")]
AngularFrequency = Annotated[Any, SIParameter("rad/s", "314 rad/s")]
Period = Annotated[Any, SIParameter("s", "20 ms")]
TableAmplitude = Annotated[Any, SIParameter("m", "0.1 mm")]
Acceleration = Annotated[Any, SIParameter("m/s^2", "2 g")]
Gravity = Annotated[Any, SIParameter("m/s^2", "9.81 m/s^2")]
Mass = Annotated[Any, SIParameter("kg", "20 g")]
Stiffness = Annotated[Any, SIParameter("N/m", "1e6 N/m")]
ContactTime = Annotated[Any, SIParameter("s", "50 us")]
ReducedModulus = Annotated[Any, SIParameter("Pa", "115 GPa")]
YoungsModulus = Annotated[Any, SIParameter("Pa", "210 GPa")]
PoissonsRatio = Annotated[Any, SIParameter("", "0.3", Range(-1, 0.5, "(]"))]
Radius = Annotated[Any, SIParameter("m", "5 mm")]
Damping = Annotated[Any, SIParameter("N*s/m", "10 N s/m", _NONE_TOO)]
DampingRatio = Annotated[Any, SIParameter("", "0.05", _NONE_TOO)]
Loss = Annotated[Any, SIParameter("", "0.85", Range(0, 1, "(]"))]
DropHeight = Annotated[Any, SIParameter("m", "1 m")]
ReboundHeight = Annotated[Any, SIParameter("m", "70 cm")]
Speed = Annotated[Any, SIParameter("m/s", "1 m/s")]
Tolerance = Annotated[Any, SIParameter("", "1 %", Range(0, 1))]
RestitutionError = Annotated[Any, SIParameter("", "0.001", Range(0, 1))]
TimeStep = Annotated[Any, SIParameter("s", "1 ms")]


@dataclass(frozen=True, kw_only=True)
class Table:
    """A vibrating table: one parameter for its frequency, one for its amplitude, and gravity.

    Parameters
    ----------
    frequency, angular_frequency, period
        Frequency in Hz, or Ω in rad/s, or the period in s.
    table_amplitude, acceleration
        Amplitude A of the table's motion in m, or its greatest acceleration AΩ² in m/s²; "2 g" is
        twice standard gravity.
    gravity
        g, by default 9.80665 m/s². For a gear pair, the deceleration that the drag torque causes.

    Raises
    ------
    ModelError
        If a quantity is out of range or of another dimension, or if parameters are missing or
        contradict each other.

    Examples
    --------
    >>> table = Table(frequency="50 Hz", acceleration="0.8 g")
    >>> table.frequency, round(table.acceleration, 5), round(table.motion.amplitude, 12)
    (50.0, 7.84532, 0.8)
    """

    frequency: Frequency = None
    angular_frequency: AngularFrequency = None
    period: Period = None
    table_amplitude: TableAmplitude = None
    acceleration: Acceleration = None
    gravity: Gravity = None

    def __post_init__(self) -> None:
        _convert(self)
        motion_of_table(given(self))

    @property
    def motion(self) -> TableMotion:
        """Ω, A and g."""
        return motion_of_table(given(self))


@dataclass(frozen=True, kw_only=True)
class Contact:
    """A ball and its contact with a table, by any parameters that determine them.

    One of them gives the stiffness: ``stiffness``, ``contact_time``, or for Hertz ``radius`` with
    ``reduced_modulus`` or the data of both materials. Without any of these the contact is still to
    be chosen. Another one gives the loss: ``damping``, ``damping_ratio``, ``restitution``,
    ``measured_restitution``, or ``drop_height`` with ``rebound_height``. In place of both, a
    contact may have the parameters of a physics engine. :func:`~.design.design` describes each
    parameter.

    Raises
    ------
    ModelError
        If a quantity is out of range or of another dimension.

    Examples
    --------
    >>> contact = Contact(mass="20 g", stiffness="1e4 kN/m", restitution="85 %")
    >>> contact.mass, contact.stiffness, contact.restitution
    (0.02, 10000000.0, 0.85)
    """

    mass: Mass = None
    stiffness: Stiffness = None
    contact_time: ContactTime = None
    reduced_modulus: ReducedModulus = None
    youngs_modulus: YoungsModulus = None
    poissons_ratio: PoissonsRatio = None
    table_youngs_modulus: YoungsModulus = None
    table_poissons_ratio: PoissonsRatio = None
    radius: Radius = None
    damping: Damping = None
    damping_ratio: DampingRatio = None
    restitution: Loss = None
    measured_restitution: Loss = None
    drop_height: DropHeight = None
    rebound_height: ReboundHeight = None
    release: Rule | str | None = None
    law: str | None = None
    from_engine: str | None = None
    solref: str | Sequence[float] | None = None
    solimp: str | Sequence[float] | None = None
    parameters: Mapping[str, float] | None = None

    def __post_init__(self) -> None:
        _convert(self)

    @property
    def is_stiff(self) -> bool:
        """Whether a parameter gives the stiffness; a contact without one is to be chosen."""
        stiff = (self.stiffness, self.contact_time, self.reduced_modulus, self.youngs_modulus)
        return self.from_engine is not None or any(value is not None for value in stiff)

    def with_measured_restitution(self) -> "Contact":
        """The contact whose restitution is the measured one, under the release that it has.

        A contact with both restitutions stays as it is, because they contradict each other.
        """
        if self.restitution is None or self.measured_restitution is not None:
            return self
        return replace(self, restitution=None, measured_restitution=self.restitution)

    def in_engine(self, name: str) -> "Contact":
        """The contact as it ends in the engine with this name, in which r is the measured one.

        Raises
        ------
        ModelError
            If there is no such engine, or if it has no such release or no such contact.

        Examples
        --------
        >>> contact = Contact(mass=1.0, stiffness=1e5, restitution=0.8).in_engine("mujoco")
        >>> contact.release, contact.measured_restitution
        ('force', 0.8)
        """
        engine = engine_named(name)
        law = self.law
        rule = str(engine.release(self.release))
        if self.reduced_modulus is not None or self.youngs_modulus is not None:
            raise ParameterError(f"a Hertz contact is not written for {name}: give {{stiffness}}")
        if law not in (None, SpringDamper.name, *engine.laws, *engine.laws.values()):
            raise ParameterError(f"{{law}} {law} is not written for {name}: leave {{law}} out")
        law = engine.laws.get(str(law), law)
        return replace(self.with_measured_restitution(), release=rule, law=law)


@dataclass(frozen=True, kw_only=True)
class Question:
    """What is asked of a contact on a table.

    Parameters
    ----------
    n
        Index of the family of orbits; None for the first of eight with a stable orbit.
    quantity
        Name of the quantity that must be accurate.
    tolerance
        Largest relative error of the restitution model's quantity against the contact's.
    balls
        Largest number of balls whose means over time are compared if the motion does not repeat;
        None for a number that takes about a second.

    Raises
    ------
    ModelError
        If there is no such quantity, or a number is out of range.

    Examples
    --------
    >>> Question(tolerance="5 %").tolerance, list(Question(n=2).families)
    (0.05, [2])
    """

    n: Index | None = None
    quantity: str = "max_height"
    tolerance: Tolerance = 0.01
    balls: Balls | None = None

    def __post_init__(self) -> None:
        _convert(self)
        one_of("quantity", self.quantity, {str(each): each for each in QUANTITIES})
        if self.n is not None and self.n not in FAMILY:
            raise ModelError(f"index of the family n = {self.n} is not {FAMILY}")
        if self.balls is not None and self.balls not in MOST_BALLS:
            raise ParameterError(f"{{balls}} = {self.balls} is not {MOST_BALLS}")

    @property
    def families(self) -> Sequence[int]:
        """The families n among which the orbit of the answer is."""
        return _FAMILIES if self.n is None else [int(self.n)]


@dataclass(frozen=True, kw_only=True)
class Simulation:
    """An engine in which a contact is simulated, and how.

    Parameters
    ----------
    engine
        Name of the engine: generic, mujoco, lammps, liggghts, pybullet, drake or mercurydpm.
    restitution_error
        Largest error of the restitution coefficient that the time step may cause.
    time_step
        The time step, if it is given; None if it follows from the contact.

    Raises
    ------
    ModelError
        If there is no such engine, or a number is out of range.

    Examples
    --------
    >>> Simulation(engine="mujoco", time_step="2 ms").time_step
    0.002
    """

    engine: str
    restitution_error: RestitutionError = ERROR
    time_step: TimeStep = None

    def __post_init__(self) -> None:
        _convert(self)
        engine_named(self.engine)


def motion_of_table(given: Mapping[str, float]) -> TableMotion:
    """The motion of a table, from one parameter for its frequency and one for its amplitude.

    Raises
    ------
    ModelError
        If one of them is missing or given twice.

    Examples
    --------
    >>> motion_of_table({"period": 2.0, "acceleration": 3.0, "gravity": 1.0}).amplitude
    3.0
    """
    fast = ("frequency", "angular_frequency", "period")
    rate = single(given, fast, "the frequency of the table", "{frequency}, such as 50 Hz")
    ways = "{acceleration}, such as 2 g, or {table_amplitude}, such as 0.1 mm"
    far = single(given, ("table_amplitude", "acceleration"), "the amplitude of the table", ways)
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
    return TableMotion(omega, moved, given.get("gravity", STANDARD_GRAVITY))


def single(given: Mapping[str, Any], names: Sequence[str], what: str, give: str = "") -> str:
    """Name of the single one of these parameters that is given.

    If none of them is given, the result is an empty text, or, where ``give`` names the parameters
    to give, an error.

    Raises
    ------
    ModelError
        If several of them are given, because they contradict each other, or none that must be.

    Examples
    --------
    >>> single({"period": 2.0}, ["frequency", "period"], "the frequency of the table")
    'period'
    """
    found = [name for name in names if name in given]
    if len(found) > 1:
        both = " and ".join(f"{{{name}}}" for name in found)
        raise ParameterError(f"{both} contradict each other, because each gives {what}: give one")
    if give and not found:
        raise ParameterError(f"{what} is missing: give {give}")
    return found[0] if found else ""


def given(data: Table | Contact) -> dict[str, Any]:
    """The parameters of a table or a contact that are given, by name.

    Examples
    --------
    >>> given(Contact(mass="2 g", restitution=1))
    {'mass': 0.002, 'restitution': 1.0}
    """
    values = {each.name: getattr(data, each.name) for each in fields(data)}
    return {name: value for name, value in values.items() if value is not None}


def quantities(kind: Any) -> dict[str, SIParameter]:
    """The parameters with a unit of a class or a call, by name.

    Examples
    --------
    >>> quantities(Question)["tolerance"].example
    '1 %'
    """
    found = {}
    for name, hint in kind.__annotations__.items():
        for each in get_args(hint)[1:]:
            if isinstance(each, SIParameter):
                found[name] = each
    return found


def in_si(name: str, value: Any, kind: SIParameter) -> float:
    """The value of a parameter in SI units, after a check of its range.

    Raises
    ------
    ModelError
        If the value is no number with a unit of the right dimension, or out of range; the message
        gives what was probably meant.

    Examples
    --------
    >>> in_si("tolerance", "5 %", SIParameter("", "1 %", Range(0, 1)))
    0.05
    """
    found = number(name, value, kind)
    if found not in kind.allowed:
        raise _out_of_range(name, value, found, kind)
    if kind.name == "Pa" and found < _SOFTEST and _is_bare(value):
        raise ParameterError(
            f"{{{name}}} = {found:g} is in Pa, and no solid is so soft: did you mean {found:g} GPa?"
        )
    return found


def _convert(data: Any) -> None:
    """Replace the quantities of a dataclass that is being made by their values in SI units."""
    for name, kind in quantities(type(data)).items():
        value = getattr(data, name)
        if value is not None:
            # A frozen dataclass lets no other statement set its fields.
            object.__setattr__(data, name, in_si(name, value, kind))


def _is_bare(value: Any) -> bool:
    """Whether a number has no unit."""
    try:
        float(value)
    except (TypeError, ValueError):
        return False
    return True


def _out_of_range(name: str, text: Any, value: float, kind: SIParameter) -> ParameterError:
    said = f"{{{name}}} = {value:g} {kind.name}".rstrip()
    # A share above 1 was probably meant in percent. A restitution of a few percent is rare.
    least = _PERCENT if 1 in kind.allowed else 1
    is_share = kind.allowed.high == 1 and least <= value < 100 and "%" not in str(text)
    meant = f": did you mean {value:g} %?" if is_share else ""
    return ParameterError(f"{said} is not {kind.allowed}{meant}")
