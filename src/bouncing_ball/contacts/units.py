"""Quantities with units, converted at the interface: SI numbers inside.

A text is a number followed by its unit: ``50 Hz``, ``0.5 mm``, ``2e6 N/m``.
A plain number is in SI units. Pint receives the unit alone and never an expression, so that texts
of a command line are not evaluated.

An angle has a dimension here, and a hertz is one turn per second. ``Hz``, ``rad/s``, ``rpm`` and
``deg/s`` therefore have the same dimension; a bare ``1/s`` is refused, because it might mean turns
or radians.
"""

import math
import re
import textwrap
from contextlib import suppress
from functools import cache
from pathlib import Path
from typing import Any, NamedTuple

from bouncing_ball.errors import ParameterError, Range

# Units as they are written, by the SI unit of a parameter, for hints on a wrong spelling.
_SPELLINGS = {
    "kg": ("kg", "g", "mg"),
    "Hz": ("Hz", "kHz", "rpm", "rad/s"),
    "rad/s": ("rad/s", "Hz", "rpm"),
    "s": ("s", "ms", "us", "ns"),
    "m": ("m", "cm", "mm", "um"),
    "m/s": ("m/s", "mm/s", "km/h"),
    "m/s^2": ("m/s^2", "mm/s^2", "g"),
    "N/m": ("N/m", "kN/m", "MN/m", "N/mm", "kN/mm"),
    "N*s/m": ("N s/m", "kN s/m", "N s/mm", "kg/s"),
    "Pa": ("Pa", "kPa", "MPa", "GPa"),
}
# A frequency in 1/s, which pint takes for no angle at all.
_PER_TIME = "does not say whether it counts turns or radians"
_BETWEEN = re.compile(r"[\s·*.^]")
# Units that mean something else than what a user of SI units means.
_FALSE_FRIENDS = {"gr": "g", "gm": "g"}
# A number with one decimal comma and its unit, and one whose thousands are grouped by commas.
_COMMA = re.compile(r"([+-]?\d+),(\d+)([^,]*)", re.DOTALL)
_GROUPS = re.compile(r"[+-]?\d{1,3}(?:,\d{3})+(?!\d).*", re.DOTALL)
# Thousands that are separated in another way, and two numbers with a stroke between them.
_SEPARATED = re.compile(r"[+-]?\d{1,3}(?:['’_ ]\d{3})+(?!\d).*", re.DOTALL)
_SEPARATOR = re.compile(r"(?<=\d)['’_ ](?=\d{3}(?!\d))")
_FRACTION = re.compile(r"([+-]?\d+\.?\d*)/(\d+\.?\d*)((?!\d).*)", re.DOTALL)
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


def number(name: str, value: Any, kind: SIParameter) -> float:
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
    >>> number("stiffness", 2e6, stiffness), number("stiffness", "2 kN/mm", stiffness)
    (2000000.0, 2000000.0)
    >>> number("frequency", "3000 rpm", frequency)
    50.0
    >>> number("frequency", "20 ms", frequency)
    Traceback (most recent call last):
    ...
    bouncing_ball.errors.ParameterError: frequency = 20 ms is in millisecond, not in Hz: \
write it as '50 Hz'
    """
    short = textwrap.shorten(str(value), 60, placeholder="…")
    unit = ""
    example = f"write it as {kind.example!r}"

    def wrong(why: str, said: str = short) -> ParameterError:
        return ParameterError(f"{{{name}}} = {{}} {why}", said)

    if isinstance(value, str):
        if spelled := _plain_spelling(value.strip()[:60]):
            raise wrong(spelled)
        found = _TEXT.fullmatch(value.strip())
        if found is None:
            raise wrong(f"does not begin with a number: {example}", repr(short))
        value, unit = found.groups()
    elif hasattr(value, "magnitude") and hasattr(value, "units"):
        unit = str(value.units).replace("dimensionless", "")
        value = value.magnitude
    try:
        plain = float(value)
    except (TypeError, ValueError):
        raise wrong("is neither a number nor a text", repr(value)) from None
    except OverflowError:
        raise wrong("is not a finite number") from None
    found_value, why = _converted(plain, unit, kind) if unit else (plain, "")
    if why:
        meant = _spelling(unit, kind)
        if why == _PER_TIME:
            raise wrong(f"{why}: write '{value} Hz' or '{value} rad/s'")
        raise wrong(f"{why}: did you mean '{value} {meant}'?" if meant else f"{why}: {example}")
    if not math.isfinite(found_value):
        raise wrong("is not a finite number")
    return found_value


def _without_comma(text: str) -> str:
    """How a number with commas is written without them; empty if the text is none.

    Examples
    --------
    >>> _without_comma("0,65"), _without_comma("1,000,000 N/m"), _without_comma("1,500 N")
    ("'0.65', with a decimal point", "'1000000 N/m'", "'1.500 N' or '1500 N'")
    """
    plain = repr(text.replace(",", ""))
    comma = _COMMA.fullmatch(text)
    grouped = _GROUPS.fullmatch(text) is not None
    if comma is None:
        return plain if grouped else ""
    whole, part, rest = comma.groups()
    decimal = repr(f"{whole}.{part}{rest}")
    if grouped and whole.strip("+-") != "0":
        return f"{decimal} or {plain}"
    return f"{decimal}, with a decimal point"


def _plain_spelling(text: str) -> str:
    """Why a number is not read as it is written, and how to write it; empty if it is plain.

    Examples
    --------
    >>> _plain_spelling("0,65")
    "has a comma: write '0.65', with a decimal point"
    >>> _plain_spelling("1 000 000 N/m"), _plain_spelling("1/2 kg")
    ("has separated thousands: write '1000000 N/m'", "is a fraction: write '0.5 kg'")
    """
    if comma := _without_comma(text):
        return f"has a comma: write {comma}"
    if _SEPARATED.fullmatch(text):
        return f"has separated thousands: write {_SEPARATOR.sub('', text)!r}"
    fraction = _FRACTION.fullmatch(text)
    if fraction and float(fraction[2]):
        return f"is a fraction: write '{float(fraction[1]) / float(fraction[2]):.6g}{fraction[3]}'"
    return ""


def _spelling(unit: str, kind: SIParameter) -> str:
    """The unit that was meant, if a common one has the same letters; otherwise an empty text."""
    if kind.name == "kg" and unit in _FALSE_FRIENDS:
        return _FALSE_FRIENDS[unit]
    typed = _BETWEEN.sub("", unit).casefold()
    for spelling in _SPELLINGS.get(kind.name, ()):
        if _BETWEEN.sub("", spelling).casefold() == typed:
            return spelling
    return ""


def _converted(value: float, unit: str, kind: SIParameter) -> tuple[float, str]:
    """A value in SI units and an empty text, or NaN and the reason why it cannot be converted.

    For an acceleration the unit g means standard gravity and not the gram.
    """
    registry = _registry()
    why = "has an unknown unit"
    if (kind.name, unit) == ("m/s^2", "g"):
        unit = "standard_gravity"
    if kind.name == "kg" and unit in _FALSE_FRIENDS:
        return math.nan, "is in grains, or in no unit of mass"
    # Pint also raises the errors of its tokenizer, which are of many types.
    unit = _POWER.sub("^", unit)
    with suppress(Exception):
        # A percentage of a percentage is a slip of the keyboard.
        if _UNIT.fullmatch(unit.replace("**", "^")) and unit.count("%") < 2:
            one = registry.Quantity(value, registry.parse_units(unit))
            why = _in_another_unit(str(one.units).replace("_", " "), kind)
            # Fifteen digits keep all digits that a user wrote, without the rounding error.
            return float(f"{one.m_as(kind.name):.15g}"), ""
    return math.nan, why


def _in_another_unit(unit: str, kind: SIParameter) -> str:
    """A clause on a unit of another dimension, by the name of the unit."""
    if kind.name in ("Hz", "rad/s") and unit == "1 / second":
        return _PER_TIME
    if not kind.name:
        return f"is in {unit}, and not a plain number"
    return f"is in {unit}, not in {kind.name.replace('*', ' ')}"


_PREFIXES = {9: "G", 6: "M", 3: "k", 0: "", -3: "m", -6: "µ", -9: "n"}


def percent(share: float) -> str:
    """A share as a percentage with at most six digits.

    Examples
    --------
    >>> percent(0.01), percent(1e-6), percent(0.125)
    ('1 %', '0.0001 %', '12.5 %')
    """
    return f"{100 * share:.6g} %"


def shown(value: float | None, unit: str = "", least: float = 1e-5, digits: int = 4) -> str:
    """A value as text: four digits with a prefix of its unit, or a share in "%" with two digits.

    A share below ``least``, or below 1e-5 if this is smaller, is given as "less than" that bound.

    Examples
    --------
    >>> shown(1.25e-5, "s"), shown(2e7, "N/m"), shown(None, "m"), shown(1.25e-5)
    ('12.5 µs', '20 MN/m', 'none', '1.25e-05')
    >>> [shown(share, "%") for share in (0.0123, 2.5e-5, 1e-9, 0.995)]
    ['1.2 %', '0.0025 %', 'less than 0.001 %', '100 %']
    >>> shown(2.5e-6, "%", 1e-6), shown(1e-9, "%", 1e-6)
    ('0.00025 %', 'less than 0.0001 %')
    """
    if value is None:
        return "none"
    if unit == "%":
        bound = min(least, 1e-5)
        if 0 < value < bound:
            return f"less than {percent(bound)}"
        return f"{100 * value:.2g} %" if value < 0.995 else f"{100 * value:.0f} %"
    if value == 0 or not unit:
        return f"{value:.{digits}g} {unit}".rstrip()
    power = _power(value)
    return f"{value / 10**power:.{digits}g} {_PREFIXES[power]}{unit}"


def _power(value: float) -> int:
    """The power of ten of the prefix with which a value is shown, by its four digits."""
    rounded = abs(float(f"{value:.4g}"))
    if rounded == 0:
        return 0
    return min(9, max(-9, 3 * math.floor(math.log10(rounded) / 3)))


def signed(error: float | None, least: float = 1e-5) -> str:
    """An error in percent with its sign, in the digits of :func:`shown`.

    Examples
    --------
    >>> signed(1.1453), signed(-0.0123), signed(0.0), signed(-1e-9), signed(None)
    ('+115 %', '-1.2 %', '0 %', 'less than 0.001 %', 'none')
    """
    if error is None or error == 0:
        return shown(error, "%")
    size = shown(abs(error), "%", least)
    if size.startswith("less"):
        return size
    return f"{'+' if error > 0 else '-'}{size}"


# Digits of two values that are compared: at least four, and two of their difference.
_FEWEST, _MOST = 4, 12


def in_place_of(predicted: float | None, true: float | None, unit: str = "") -> str:
    """Two values that are compared, with one prefix and in as many digits as show that they differ.

    Examples
    --------
    >>> in_place_of(2.061e-3, 0.961e-3, "m"), in_place_of(5.41098, 5.41067)
    ('2.061 mm in place of 0.961 mm', '5.41098 in place of 5.41067')
    """
    error = abs(predicted / true - 1) if predicted is not None and true else 1.0
    needed = 2 - math.floor(math.log10(error)) if error else _FEWEST
    digits = min(_MOST, max(_FEWEST, needed))
    if not unit or predicted is None or true is None:
        texts = [shown(value, unit, digits=digits) for value in (predicted, true)]
    else:
        power = _power(max(abs(predicted), abs(true)))
        name = f"{_PREFIXES[power]}{unit}"
        texts = [f"{value / 10**power:.{digits}g} {name}" for value in (predicted, true)]
    return " in place of ".join(texts)
