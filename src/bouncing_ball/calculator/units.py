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


class Unit(NamedTuple):
    """What a parameter is, as its annotation: its SI unit, an example, and its range."""

    name: str
    example: str
    allowed: str = "positive"


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
# Parameters that a quantity may have been meant for.
_OWN = {
    "a time": "period",
    "a frequency": "frequency",
    "an acceleration": "acceleration",
    "a damping": "damping",
}
_OF_THE_TABLE = ("frequency", "angular_frequency", "period", "amplitude", "acceleration")


@cache
def _registry() -> Any:
    # Imported where it is needed: it takes half a second, and plain numbers do without.
    import pint

    return pint.UnitRegistry()


def number(name: str, value: Any, kind: Unit) -> float:
    """A parameter in SI units.

    Parameters
    ----------
    name : str
        What the parameter is called in an error.
    value : float, str or pint.Quantity
        A plain number is in SI units.
    kind : Unit
        What it is; its range is not checked here.

    Raises
    ------
    ModelError
        In one line, if it is not a finite number with a unit of the right kind.

    Examples
    --------
    >>> stiffness, frequency = Unit("N/m", "1e6 N/m"), Unit("Hz", "50 Hz")
    >>> number("stiffness", 2e6, stiffness), number("stiffness", "2 kN/mm", stiffness)
    (2000000.0, 2000000.0)
    >>> number("frequency", "3000 rpm", frequency)
    50.0
    >>> number("frequency", "20 ms", frequency)
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
            raise ModelError(
                f"{name} = {short!r} does not begin with a number: write it as {kind.example!r}"
            )
        value, unit = found.groups()
    elif hasattr(value, "magnitude") and hasattr(value, "units"):
        value, unit = value.magnitude, str(value.units).replace("dimensionless", "")
    try:
        plain = float(value)
    except (TypeError, ValueError):
        raise ModelError(f"{name} = {value!r} is neither a number nor a text") from None
    # To the last digit but one: the digits that a user wrote are kept.
    found_value = float(f"{plain * _factor(name, given, unit, kind):.15g}") if unit else plain
    if not math.isfinite(found_value):
        raise ModelError(f"{given} is not a finite number")
    return found_value


def _factor(name: str, given: str, unit: str, kind: Unit) -> float:
    """What one unit is in SI units; cycles or radians in a second, whichever is asked for."""
    registry = _registry()
    if kind.name == "m/s^2" and unit in _GRAVITY:
        unit = "standard_gravity"
    try:
        if not _UNIT.fullmatch(unit.replace("**", "^")):
            raise ValueError(unit)
        one = registry.Quantity(1.0, registry.parse_units(unit))
        # An offset scale, such as °C, has no factor.
        linear = math.isclose((2 * one).to_root_units().m, 2 * one.to_root_units().m)
    except Exception:  # pint raises whatever its tokenizer does
        linear = False
    if not linear:
        raise ModelError(f"{given} has an unknown unit: write it as {kind.example!r}")
    if not one.is_compatible_with(kind.name or "dimensionless"):
        raise ModelError(_other_kind(name, given, one, kind))
    if kind.name not in ("Hz", "rad/s"):
        return float(one.to(kind.name or "dimensionless").m)
    root, turn = one.to_root_units(), 2 * math.pi
    if "radian" in str(root.units):
        return float(root.m) / (1 if kind.name == "rad/s" else turn)
    if not {str(unit) for unit, _ in one.unit_items()} <= _CYCLES:
        raise ModelError(
            f"{given} does not say whether it counts cycles or radians: write Hz or rad/s"
        )
    return float(root.m) * (turn if kind.name == "rad/s" else 1)


def _other_kind(name: str, given: str, one: Any, kind: Unit) -> str:
    found = [words for unit, words in _DIMENSIONS.items() if one.is_compatible_with(unit)]
    what = found[0] if found else f"of dimension {one.dimensionality}"
    text = f"{given} is {what}: it needs {_DIMENSIONS[kind.name]}, such as {kind.example}"
    own = _OWN.get(what)
    if own is None or name not in (("damping_ratio",) if own == "damping" else _OF_THE_TABLE):
        return text
    return f"{text}; a{'n' if own == 'acceleration' else ''} {own} has its own parameter, {own}"


_PREFIXES = {9: "G", 6: "M", 3: "k", 0: "", -3: "m", -6: "µ", -9: "n"}


def shown(value: float | None, unit: str = "") -> str:
    """A value to read: four digits, with a prefix of its unit; a share in "%", two digits.

    Examples
    --------
    >>> shown(1.25e-5, "s"), shown(2e7, "N/m"), shown(None, "m"), shown(1.25e-5)
    ('12.5 µs', '20 MN/m', 'none', '1.25e-05')
    >>> [shown(share, "%") for share in (0.0123, 2.5e-5, 1e-9, 0.996)]
    ['1.2 %', '0.0025 %', 'less than 0.001 %', '100 %']
    """
    if value is None:
        return "none"
    if unit == "%":
        if 0 < value < 1e-5:
            return "less than 0.001 %"
        return f"{100 * value:.2g} %" if value < 0.995 else f"{100 * value:.0f} %"
    if value == 0 or not unit:
        return f"{value:.4g} {unit}".rstrip()
    power = min(9, max(-9, 3 * math.floor(math.log10(abs(float(f"{value:.4g}"))) / 3)))
    return f"{value / 10**power:.4g} {_PREFIXES[power]}{unit}"
