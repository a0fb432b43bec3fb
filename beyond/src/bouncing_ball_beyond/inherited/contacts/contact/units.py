"""Quantities with units, read at the interface: SI numbers inside.

A text is a number, or a fraction of two, followed by its unit: ``50 Hz``, ``2e6 N/m``, ``1/240 s``.
A plain number is in SI units. Pint receives the unit alone and never an expression, so that texts
of a command line are not evaluated.

An angle has a dimension here, and a hertz is one turn per second. ``Hz``, ``rad/s``, ``rpm`` and
``deg/s`` therefore have the same dimension; a bare ``1/s`` is refused, because it might mean turns
or radians.
"""

import math
import re
import textwrap
from collections.abc import Mapping
from contextlib import suppress
from functools import cache
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from bouncing_ball_beyond.inherited.errors import ParameterError, Range, shortened

STANDARD_GRAVITY = 9.80665
"""Standard acceleration of gravity, in m/s²."""

COMMON: Mapping[str, Mapping[str, float]] = {
    "kg": {"kg": 1.0, "g": 1e-3, "mg": 1e-6},
    "Hz": {"Hz": 1.0, "kHz": 1e3, "rpm": 1 / 60, "rad/s": 1 / (2 * math.pi)},
    "s": {"s": 1.0, "ms": 1e-3, "us": 1e-6, "ns": 1e-9},
    "m": {"m": 1.0, "cm": 1e-2, "mm": 1e-3, "um": 1e-6},
    "m/s": {"m/s": 1.0, "cm/s": 1e-2, "mm/s": 1e-3, "km/h": 1 / 3.6},
    "m/s^2": {"m/s^2": 1.0, "mm/s^2": 1e-3, "g": STANDARD_GRAVITY},
    "N/m": {"N/m": 1.0, "kN/m": 1e3, "MN/m": 1e6, "N/mm": 1e3, "kN/mm": 1e6},
    "N*s/m": {"N s/m": 1.0, "kN s/m": 1e3, "N s/mm": 1e3, "kg/s": 1.0},
    "Pa": {"Pa": 1.0, "kPa": 1e3, "MPa": 1e6, "GPa": 1e9},
}
"""The size of common units in SI units as they are written, by the SI unit of a parameter.

They need no pint, which takes as long as the rest of a recipe, and are hints on a wrong spelling.
"""
# A frequency in 1/s, which pint takes for no angle at all.
_PER_TIME = "does not say whether it counts turns or radians"
_UNKNOWN = "has an unknown unit"
_BETWEEN = re.compile(r"[\s·*.^]")
# Digits behind a number, in place of a unit.
_DIGITS = re.compile(r"(?![^\W\d_]).*\d", re.DOTALL)
# The smallest modulus in Pa that is taken for one if it is given without a unit.
_SOFTEST = 1e4
# The smallest restitution that may be one in percent.
_PERCENT = 5
# Units that mean something else than what a user of SI units means, by the SI unit of a parameter.
_FALSE_FRIENDS = {"kg": {"gr": "g", "gm": "g"}, "N/m": {"Nm": "N/m", "N m": "N/m", "N*m": "N/m"}}
# Units that are a part of the unit of a parameter.
_PARTS = {
    "N/m": {"N": "N/m", "kN": "kN/m", "MN": "MN/m"},
    "N*s/m": {"N s": "N s/m", "Ns": "N s/m", "N*s": "N s/m", "kN s": "kN s/m"},
    "m/s^2": {"m/s": "m/s^2"},
}
# Rates in Hz, of which a time was meant: a time step.
_RATES = {"Hz": 1.0, "hz": 1.0, "kHz": 1e3, "fps": 1.0, "FPS": 1.0}
# The rest of a fraction, behind its numerator.
_OVER = re.compile(r"/\s*(\d+\.?\d*)\s*(?![\d/])(.*)")
# A number, and the rest of the text.
_TEXT = re.compile(r"([+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?)\s*(.*)", re.DOTALL)
# Letters, products, quotients and powers of one digit. A power of a power is refused, because pint
# would evaluate it, however large it is. A digit after a letter is a power as well: m/s2.
_POWER = re.compile(r"(?<=[^\W\d_])(?=\d(?!\d))")
_UNIT = re.compile(r"(?:[^\W\d]|[ ·*/%°²³¹⁻]|\^-?\d(?![\d^])|_0|1(?= */)){1,40}")


class SIParameter(NamedTuple):
    """The annotation of a parameter: its SI unit, an example, and the range allowed.

    Products and powers of a few numbers in the default range neither overflow nor underflow.
    """

    name: str
    example: str
    allowed: Range = Range(1e-40, 1e40, "[]")


@cache
def _registry() -> Any:
    # Imported where it is needed, because it takes half a second and plain numbers do not need it.
    import pint

    registry: Any = pint.UnitRegistry(None, on_redefinition="ignore")
    registry.load_definitions(Path(pint.__file__).with_name("default_en.txt"))
    registry.define("radian = [angle] = rad")
    registry.define("hertz = turn / second = Hz")
    return registry


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
    found = number_in_si(name, value, kind)
    if found not in kind.allowed:
        raise _out_of_range(name, value, found, kind)
    if kind.name == "Pa" and found < _SOFTEST and _is_bare(value):
        raise ParameterError(
            f"{{{name}}} = {found:g} is in Pa, and no solid is so soft: did you mean {found:g} GPa?"
        )
    return found


def number_in_si(name: str, value: Any, kind: SIParameter) -> float:
    """The value of a parameter in SI units.

    Parameters
    ----------
    name : str
        The name of the parameter in an error.
    value : float, str or pint.Quantity
        The value; a plain number is in SI units.
    kind : SIParameter
        The unit of the parameter and an example. The range is not checked here.

    Raises
    ------
    ModelError
        If the value is not a finite number with a unit of the right dimension.

    Examples
    --------
    >>> stiffness, frequency = SIParameter("N/m", "1e6 N/m"), SIParameter("Hz", "50 Hz")
    >>> number_in_si("stiffness", 2e6, stiffness), number_in_si("stiffness", "2 kN/mm", stiffness)
    (2000000.0, 2000000.0)
    >>> number_in_si("frequency", "3000 rpm", frequency)
    50.0
    >>> number_in_si("time_step", "1/250", SIParameter("s", "1 ms"))
    0.004
    >>> number_in_si("frequency", "20 ms", frequency)
    Traceback (most recent call last):
    ...
    bouncing_ball_beyond.inherited.errors.ParameterError: frequency = 20 ms is in millisecond, \
not in Hz: \
write it as '50 Hz'
    """
    short = textwrap.shorten(
        value if isinstance(value, str) else shortened(value), 60, placeholder="…"
    )
    unit = ""
    example = f"write it as {kind.example!r}"

    def wrong(why: str, said: str = short) -> ParameterError:
        return ParameterError(f"{{{name}}} = {{}} {why}", said)

    # Each of them can be converted to a number.
    if isinstance(value, bool | np.bool_ | np.datetime64 | np.timedelta64):
        raise wrong("is neither a number nor a text", shortened(value))

    if isinstance(value, str):
        found = _TEXT.fullmatch(value.strip())
        if found is None:
            raise wrong(f"does not begin with a number: {example}", repr(short))
        value, unit = found.groups()
        if fraction := _OVER.fullmatch(unit):
            below, unit = fraction.groups()
            if float(below) == 0:
                raise wrong("is divided by 0")
            value = repr(float(value) / float(below))
    elif hasattr(value, "magnitude") and hasattr(value, "units"):
        unit = str(value.units).replace("dimensionless", "")
        value = value.magnitude
    # The first use of masked arrays imports them, which plain numbers do not need.
    if not isinstance(value, str | float | int) and value is np.ma.masked:
        raise wrong("is masked: give a number", "a masked entry")
    try:
        plain = float(value)
    except (TypeError, ValueError):
        raise wrong("is neither a number nor a text", shortened(value)) from None
    except OverflowError:
        raise wrong("is not a finite number") from None
    found_value, why = _converted(plain, unit, kind) if unit else (plain, "")
    if why == _UNKNOWN and _DIGITS.match(unit):
        raise wrong(_not_one_number(value, unit))
    if why:
        meant = _spelling(unit, kind)
        if kind.name == "s" and unit in _RATES and plain > 0:
            raise wrong(f"is a rate: did you mean '{1 / (plain * _RATES[unit]):.12g} s'?")
        if why == _PER_TIME:
            raise wrong(f"{why}: write '{value} Hz' or '{value} rad/s'")
        raise wrong(f"{why}: did you mean '{value} {meant}'?" if meant else f"{why}: {example}")
    if not math.isfinite(found_value):
        raise wrong("is not a finite number")
    return found_value


def _not_one_number(value: str, rest: str) -> str:
    """Why a number and the digits behind it are not one number, and how to write it.

    Examples
    --------
    >>> _not_one_number("0", ",65")
    "has a comma: write '0.65' with a decimal point, or without the comma"
    >>> _not_one_number("20", " ± 1 g")
    'is not one number and a unit: write numbers such as 1500, 0.5 or 1e6'
    """
    if rest[0] == "," and rest.count(",") == 1:
        return f"has a comma: write '{value}.{rest[1:]}' with a decimal point, or without the comma"
    return "is not one number and a unit: write numbers such as 1500, 0.5 or 1e6"


def _spelling(unit: str, kind: SIParameter) -> str:
    """The unit that was meant, if a common one has the same letters; otherwise an empty text."""
    if unit in (friends := _FALSE_FRIENDS.get(kind.name, {}) | _PARTS.get(kind.name, {})):
        return friends[unit]
    typed = _BETWEEN.sub("", unit).casefold()
    for spelling in COMMON.get(kind.name, ()):
        if _BETWEEN.sub("", spelling).casefold() == typed:
            return spelling
    return ""


def _converted(value: float, unit: str, kind: SIParameter) -> tuple[float, str]:
    """A value in SI units and an empty text, or NaN and the reason why it cannot be converted.

    For an acceleration the unit g means standard gravity and not the gram. A unit that is common
    for the parameter needs no pint.
    """
    common = COMMON.get(kind.name, {})
    if unit in common:
        return _digits(value * common[unit]), ""
    registry = _registry()
    why = _UNKNOWN
    if unit in _FALSE_FRIENDS.get(kind.name, {}):
        what = "grains, or in no unit of mass" if kind.name == "kg" else "newton times meter"
        return math.nan, f"is in {what}"
    # Pint also raises the errors of its tokenizer, which are of many types.
    unit = _POWER.sub("^", unit)
    with suppress(Exception):
        # A percentage of a percentage is a slip of the keyboard.
        if _UNIT.fullmatch(unit.replace("**", "^")) and unit.count("%") < 2:
            one = registry.Quantity(value, registry.parse_units(unit))
            why = _in_another_unit(str(one.units).replace("_", " "), kind)
            return _digits(one.m_as(kind.name)), ""
    return math.nan, why


def _digits(value: float) -> float:
    """A number with fifteen digits, which are all that a user wrote, without the rounding error."""
    return float(f"{value:.15g}")


def _in_another_unit(unit: str, kind: SIParameter) -> str:
    """A clause on a unit of another dimension, by the name of the unit."""
    if kind.name == "Hz" and unit == "1 / second":
        return _PER_TIME
    if not kind.name:
        return f"is in {unit}, and not a plain number"
    return f"is in {unit}, not in {kind.name.replace('*', ' ')}"


# What is more, in SI units and without a unit in the text, was probably meant in thousandths.
_MOST_BARE = {
    "contact_time": 0.5,
    "penetration": 0.05,
    "radius": 0.5,
    "table_amplitude": 0.02,
    "time_step": 0.1,
    "mass": 1e3,
    "drop_height": 100.0,
    "speed": 100.0,
    "gravity": 50.0,
    "diameter": 1.0,
}
# Lengths in meters that are beyond any ball, shaker or drop, also with the unit in the text.
_LONGEST = {
    "radius": 1.0,
    "penetration": 1.0,
    "diameter": 2.0,
    "table_amplitude": 1.0,
    "drop_height": 1000.0,
}


def doubts(given: Mapping[str, Any], kinds: Mapping[str, SIParameter]) -> tuple[str, ...]:
    """Sentences on plain numbers that are unusually large in SI units, and on lengths that are
    unusually large with their unit.

    Examples
    --------
    >>> time = {"contact_time": SIParameter("s", "50 us")}
    >>> doubts({"contact_time": "7"}, time)[0][:47], doubts({"contact_time": "7 s"}, time)
    ('contact time 7 was read as 7 s: write a unit, s', ())
    >>> doubts({"radius": "5 m"}, {"radius": SIParameter("m", "5 mm")})
    ("radius 5 m is unusually large: check its unit, as in '5 mm'",)
    """
    found = []
    for name, most in _MOST_BARE.items():
        value = given.get(name)
        if value is None or name not in kinds:
            continue
        words = name.replace("_", " ")
        kind = kinds[name]
        if not _is_bare(value):
            if number_in_si(name, value, kind) > _LONGEST.get(name, math.inf):
                why = f"check its unit, as in {kind.example!r}"
                found.append(f"{words} {value} is unusually large: {why}")
        elif float(value) > most:
            why = f"write a unit, such as {kind.example!r}, if another one was meant"
            found.append(f"{words} {value} was read as {float(value):g} {kind.name}: {why}")
    return tuple(found)


def _is_bare(value: Any) -> bool:
    """Whether a number has no unit."""
    try:
        float(value)
    except (TypeError, ValueError):
        return False
    return True


def _out_of_range(name: str, text: Any, value: float, kind: SIParameter) -> ParameterError:
    said = f"{{{name}}} = {value:g} {kind.name.replace('*', ' ')}".rstrip()
    if value <= 0 < kind.allowed.low:
        return ParameterError(f"{said} is not a positive number")
    if value < 0 == kind.allowed.low:
        return ParameterError(f"{said} is negative")
    # A share above 1 was probably meant in percent. A restitution of a few percent is rare.
    least = _PERCENT if 1 in kind.allowed else 1
    is_share = kind.allowed.high == 1 and least <= value < 100 and "%" not in str(text)
    meant = f": did you mean {value:g} %?" if is_share else ""
    return ParameterError(f"{said} is not {kind.allowed}{meant}")
