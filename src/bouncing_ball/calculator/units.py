"""Quantities with units, read at the edge: SI floats inside.

A text is one number and, after it, its unit: ``50 Hz``, ``0.5 mm``, ``2e6 N/m``.
A plain number is in SI units. Only the unit is given to pint, and never an
expression: texts of a command line are not evaluated.

Hertz and radians per second have the same dimension, and pint takes one for the
other. Here cycles and radians are kept apart: ``rad/s``, ``rpm`` and ``deg/s``
are angles over time, ``Hz`` counts cycles, and a bare ``1/s`` is refused.
"""

import math
import re
import textwrap
from functools import cache
from typing import Any, NamedTuple

from bouncing_ball.errors import ModelError

# A number, and what is left.
_TEXT = re.compile(r"([+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?)\s*(.*)", re.DOTALL)
# Letters, products, quotients and powers of one digit. A power of a power would
# be evaluated, however large.
_UNIT = re.compile(r"(?:[^\W\d]|[ ·*/%°²³¹⁻]|\^-?\d(?![\d^])|_0|1(?= */)){1,40}")


class UnitKind(NamedTuple):
    """What a parameter is: its SI unit, and an example."""

    unit: str
    example: str


KINDS = {
    "mass": UnitKind("kg", "20 g"),
    "frequency": UnitKind("Hz", "50 Hz"),
    "angular_frequency": UnitKind("rad/s", "314 rad/s"),
    "period": UnitKind("s", "20 ms"),
    "amplitude": UnitKind("m", "0.1 mm"),
    "acceleration": UnitKind("m/s^2", "2 g"),
    "gravity": UnitKind("m/s^2", "9.81 m/s^2"),
    "stiffness": UnitKind("N/m", "1e6 N/m"),
    "damping": UnitKind("N*s/m", "10 N s/m"),
    "damping_ratio": UnitKind("", "0.05"),
    "restitution": UnitKind("", "0.85"),
    "measured_restitution": UnitKind("", "0.85"),
    "contact_time": UnitKind("s", "50 us"),
    "drop_height": UnitKind("m", "1 m"),
    "rebound_height": UnitKind("m", "70 cm"),
    "reduced_modulus": UnitKind("Pa", "115 GPa"),
    "radius": UnitKind("m", "5 mm"),
    "tolerance": UnitKind("", "1 %"),
}
"""The parameters that are quantities, by the names of the calculator."""

_CYCLES = {"hertz", "kilohertz", "megahertz", "millihertz", "counts_per_second"}
# What one calls the standard acceleration of gravity; pint's g is the gram.
_GRAVITY = {"g", "gn", "g_n", "g0", "g_0"}
_DIMENSIONS = {
    "kg": "a mass",
    "Hz": "a frequency",
    "rad/s": "an angular frequency",
    "s": "a time",
    "m": "a length",
    "m/s": "a speed",
    "m/s^2": "an acceleration",
    "N/m": "a stiffness",
    "N*s/m": "a damping",
    "N": "a force",
    "Pa": "a pressure",
    "": "a number without dimension",
}


@cache
def _registry() -> Any:
    # Imported where it is needed: it takes half a second, and plain numbers do without.
    import pint

    return pint.UnitRegistry()


def number(name: str, value: Any) -> float:
    """A parameter in SI units.

    Parameters
    ----------
    name : str
        One of :data:`KINDS`.
    value : float, str or pint.Quantity
        A plain number is in SI units.

    Raises
    ------
    ModelError
        In one line, if it is not a finite number with a unit of the right kind.

    Examples
    --------
    >>> number("stiffness", 2e6), number("stiffness", "2 kN/mm")
    (2000000.0, 2000000.0)
    >>> number("frequency", "3000 rpm"), number("acceleration", "2 g")
    (50.0, 19.6133)
    >>> number("frequency", "20 ms")
    Traceback (most recent call last):
    ...
    bouncing_ball.errors.ModelError: frequency = 20 ms is a time: it needs a frequency, \
such as 50 Hz; a period has its own parameter, period
    """
    short = textwrap.shorten(str(value), 60, placeholder="…")
    given, unit = f"{name} = {short}", ""
    if isinstance(value, str):
        found = _TEXT.fullmatch(value.strip())
        if found is None:
            example = KINDS[name].example
            raise ModelError(
                f"{name} = {short!r} does not begin with a number: write it as {example!r}"
            )
        value, unit = found.groups()
    elif hasattr(value, "magnitude") and hasattr(value, "units"):
        value, unit = value.magnitude, str(value.units).replace("dimensionless", "")
    try:
        plain = float(value)
    except (TypeError, ValueError):
        raise ModelError(f"{name} = {value!r} is neither a number nor a text") from None
    # To the last digit but one: the digits that a user wrote are kept.
    found_value = float(f"{plain * _factor(name, given, unit):.15g}") if unit else plain
    if not math.isfinite(found_value):
        raise ModelError(f"{given} is not a finite number")
    return found_value


def _factor(name: str, given: str, unit: str) -> float:
    """What one unit is in SI units."""
    kind, registry = KINDS[name], _registry()
    if kind.unit == "m/s^2" and unit in _GRAVITY:
        unit = "standard_gravity"
    try:
        if not _UNIT.fullmatch(unit.replace("**", "^")):
            raise ValueError(unit)
        parsed = registry.parse_units(unit)
        one = registry.Quantity(1.0, parsed)
        # An offset scale, such as °C, has no factor.
        linear = math.isclose((2 * one).to_root_units().m, 2 * one.to_root_units().m)
    except Exception:  # pint raises whatever its tokenizer does
        linear = False
    if not linear:
        raise ModelError(f"{given} has an unknown unit: write it as {kind.example!r}")
    if not one.is_compatible_with(kind.unit or "dimensionless"):
        raise ModelError(_other_kind(name, given, one))
    if kind.unit in ("Hz", "rad/s"):
        return _rate(name, given, one)
    return float(one.to(kind.unit or "dimensionless").m)


def _rate(name: str, given: str, one: Any) -> float:
    """Cycles or radians in a second, whichever is asked for."""
    root = one.to_root_units()
    units = {str(unit) for unit, _ in one.unit_items()}
    if "radian" in {str(unit) for unit, _ in root.unit_items()}:
        radians = float(root.m)
    elif units <= _CYCLES:
        radians = 2 * math.pi * float(root.m)
    else:
        raise ModelError(
            f"{given} does not say whether it counts cycles or radians: write Hz or rad/s"
        )
    return radians if KINDS[name].unit == "rad/s" else radians / (2 * math.pi)


def _other_kind(name: str, given: str, one: Any) -> str:
    found = [words for unit, words in _DIMENSIONS.items() if one.is_compatible_with(unit)]
    what = found[0] if found else f"of dimension {one.dimensionality}"
    kind = KINDS[name]
    text = f"{given} is {what}: it needs {_DIMENSIONS[kind.unit]}, such as {kind.example}"
    if name == "damping_ratio" and what == "a damping":
        return f"{text}; a damping has its own parameter, damping"
    own = {"a time": "period", "a frequency": "frequency", "an acceleration": "acceleration"}
    table = ("frequency", "angular_frequency", "period", "amplitude", "acceleration")
    if name in table and what in own:
        text += f"; {'a period' if what == 'a time' else what} has its own parameter, {own[what]}"
    return text


_PREFIXES = {9: "G", 6: "M", 3: "k", 0: "", -3: "m", -6: "µ", -9: "n"}


def shown(value: float | None, unit: str) -> str:
    """A value with a prefix of its unit, four digits.

    Examples
    --------
    >>> shown(1.25e-5, "s"), shown(2e7, "N/m"), shown(None, "m")
    ('12.5 µs', '20 MN/m', 'none')
    """
    if value is None:
        return "none"
    if value == 0:
        return f"0 {unit}"
    power = min(9, max(-9, 3 * math.floor(math.log10(abs(float(f"{value:.4g}"))) / 3)))
    return f"{value / 10**power:.4g} {_PREFIXES[power]}{unit}"
