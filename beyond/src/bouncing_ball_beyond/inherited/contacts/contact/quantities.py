"""The quantities that a user gives: their SI units, examples and ranges, as annotations.

A quantity is a plain number in SI units, a text such as ``"50 Hz"``, or a pint quantity. A class
with such fields converts them when it is made (:func:`convert`), so that its fields are numbers in
SI units; a quantity that is not given is None.
"""

from collections.abc import Mapping, Sequence
from dataclasses import fields
from typing import Annotated, Any, get_args

from bouncing_ball_beyond.inherited.contacts.contact.units import SIParameter, in_si
from bouncing_ball_beyond.inherited.errors import ParameterError, Range, shortened

# A longer value is named by its type in a message.
_LONGEST_SHOWN = 60
_NONE_TOO = Range(0, 1e40, "[]")
Frequency = Annotated[Any, SIParameter("Hz", "50 Hz")]
TableAmplitude = Annotated[Any, SIParameter("m", "0.1 mm")]
Acceleration = Annotated[Any, SIParameter("m/s^2", "2 g")]
Gravity = Annotated[Any, SIParameter("m/s^2", "9.81 m/s^2")]
Mass = Annotated[Any, SIParameter("kg", "20 g")]
Stiffness = Annotated[Any, SIParameter("N/m", "1e6 N/m")]
ContactTime = Annotated[Any, SIParameter("s", "50 us")]
Penetration = Annotated[Any, SIParameter("m", "1 mm")]
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


def quantities(kind: Any) -> dict[str, SIParameter]:
    """The parameters with a unit of a class or a function, by name.

    Examples
    --------
    >>> from bouncing_ball_beyond.inherited.contacts.contact.question import Question
    >>> quantities(Question)["tolerance"].example
    '1 %'
    """
    found = {}
    for name, hint in kind.__annotations__.items():
        for each in get_args(hint)[1:]:
            if isinstance(each, SIParameter):
                found[name] = each
    return found


def convert(data: Any) -> None:
    """Replace the quantities of a dataclass that is being made by their values in SI units.

    Raises
    ------
    ModelError
        If a quantity is out of range or of another dimension.
    """
    for name, kind in quantities(type(data)).items():
        value = getattr(data, name)
        if value is not None:
            # A frozen dataclass lets no other statement set its fields.
            object.__setattr__(data, name, in_si(name, value, kind))


def check_kinds(call: str, **arguments: tuple[Any, type]) -> None:
    """Raise :class:`ParameterError` unless each argument of a function is of its class.

    Examples
    --------
    >>> from bouncing_ball_beyond.inherited.contacts.contact.question import Question
    >>> check_kinds("choose_contact", question=(0.05, Question))
    Traceback (most recent call last):
    bouncing_ball_beyond.inherited.errors.ParameterError: question = 0.05 is not a Question
    """
    kinds = [kind for _, kind in arguments.values()]
    for name, (value, kind) in arguments.items():
        if isinstance(value, kind):
            continue
        # The text of a ball or of a dataset has several lines.
        text = shortened(value)
        shown = type(value).__name__ if len(text) > _LONGEST_SHOWN else text
        article = "an" if kind.__name__[0] in "AEIOU" else "a"
        order = ""
        if value is not None and type(value) in kinds:
            order = f": write {call}({', '.join(arguments)}), in this order"
        wrong = f"{{{name}}} = {{}} is not {article} {kind.__name__}{{}}"
        raise ParameterError(wrong, shown, order)


def given(data: Any) -> dict[str, Any]:
    """The fields of a dataclass that are given, by name.

    Examples
    --------
    >>> from bouncing_ball_beyond.inherited.contacts.contact.contact import Contact
    >>> given(Contact(mass="2 g", restitution=1))
    {'mass': 0.002, 'restitution': 1.0}
    """
    values = {each.name: getattr(data, each.name) for each in fields(data)}
    return {name: value for name, value in values.items() if value is not None}


def text_of_given(data: Any) -> str:
    """A dataclass as Python shows it, with the fields that are given only.

    Examples
    --------
    >>> from bouncing_ball_beyond.inherited.contacts.contact.contact import Contact
    >>> Contact(mass="2 g", restitution=1)
    Contact(mass=0.002, restitution=1.0)
    """
    named = (f"{name}={value!r}" for name, value in given(data).items())
    return f"{type(data).__name__}({', '.join(named)})"


def single(data: Mapping[str, Any], names: Sequence[str], what: str, give: str = "") -> str:
    """Name of the single one of these parameters that is given.

    If none of them is given, the result is an empty text, or, where ``give`` names the parameters
    to give, an error.

    Raises
    ------
    ModelError
        If several of them are given, because they contradict each other, or none that must be.

    Examples
    --------
    >>> single({"stiffness": 2.0}, ["stiffness", "contact_time"], "the stiffness of the contact")
    'stiffness'
    """
    found = [name for name in names if name in data]
    if len(found) > 1:
        both = " and ".join(f"{{{name}}}" for name in found)
        raise ParameterError(f"{both} contradict each other, because each gives {what}: give one")
    if give and not found:
        raise ParameterError(f"{what} is missing: give {give}")
    return found[0] if found else ""
