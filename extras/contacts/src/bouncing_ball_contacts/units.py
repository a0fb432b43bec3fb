"""Numbers with units, as they are typed and as they are shown."""

import math
import re
from collections.abc import Iterable
from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
MOST_WARNINGS = 3
"""Number of warnings that an answer prints; the others are remarks."""
STANDARD_GRAVITY = 9.80665
"""In m/s²."""
LONGEST_STEP = 0.1
"""Of a simulation, in s."""
LARGEST = 1e18
"""Of a number in SI units: powers of larger ones overflow, and engines have defaults of 1e18."""
DENSITIES = {
    "steel": 7850.0,
    "aluminium": 2700.0,
    "aluminum": 2700.0,
    "brass": 8500.0,
    "copper": 8960.0,
    "lead": 11340.0,
    "glass": 2500.0,
    "rubber": 1100.0,
    "nylon": 1150.0,
    "wood": 700.0,
    "ice": 917.0,
}
"""Of solid materials, in kg/m³."""

SPELLED = {
    "inches": "in",
    "foot": "ft",
    "feet": "ft",
    "metre": "m",
    "metres": "m",
    "meter": "m",
    "meters": "m",
    "centimetres": "cm",
    "centimeters": "cm",
    "millimetres": "mm",
    "millimeters": "mm",
    "second": "s",
    "seconds": "s",
    "sec": "s",
    "milliseconds": "ms",
    "grams": "g",
    "pixel": "px",
    "pixels": "px",
}
"""Units in words."""
_UNITS = {
    "kg": {"kg": 1.0, "g": 1e-3, "mg": 1e-6, "µg": 1e-9, "ug": 1e-9, "t": 1e3}
    | {"lb": 0.45359237, "oz": 0.45359237 / 16},
    "m": {"m": 1.0, "cm": 1e-2, "mm": 1e-3, "µm": 1e-6, "um": 1e-6, "nm": 1e-9, "km": 1e3}
    | {"in": 0.0254, "inch": 0.0254, "ft": 0.3048},
    "s": {"s": 1.0, "ms": 1e-3, "µs": 1e-6, "us": 1e-6, "ns": 1e-9, "min": 60.0},
    "m/s": {"m/s": 1.0, "cm/s": 1e-2, "mm/s": 1e-3, "km/h": 1 / 3.6, "mph": 0.44704}
    | {"ft/s": 0.3048},
    "m/s^2": {"m/s^2": 1.0, "m/s²": 1.0, "m/s2": 1.0, "cm/s^2": 1e-2, "ft/s^2": 0.3048},
    "kg/m^3": {"kg/m^3": 1.0, "kg/m³": 1.0, "kg/m3": 1.0}
    | {"g/cm^3": 1e3, "g/cm³": 1e3, "g/cm3": 1e3},
    "Hz": {"Hz": 1.0, "kHz": 1e3, "fps": 1.0, "FPS": 1.0},
    "N/m": {"N/m": 1.0, "mN/m": 1e-3, "kN/m": 1e3, "MN/m": 1e6, "GN/m": 1e9}
    | {"N/mm": 1e3, "kN/mm": 1e6},
    "N s/m": {"N s/m": 1.0, "Ns/m": 1.0, "kN s/m": 1e3},
    "Pa": {"Pa": 1.0, "kPa": 1e3, "MPa": 1e6, "GPa": 1e9},
    "": {"": 1.0, "%": 1e-2},
}
"""What a text may have behind its number, by the SI unit; another SI unit has itself only."""
_EXAMPLES = {
    "kg": "50 g",
    "m": "2 mm",
    "s": "2 ms",
    "m/s": "3 m/s",
    "m/s^2": "9.81 m/s^2",
    "kg/m^3": "1100 kg/m^3' or 'rubber",
    "N/m": "100 kN/m",
    "": "0.8",
}
_NUMBER = r"[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?"


def units_of(unit: str) -> list[str]:
    """Return the units of the quantity of an SI unit."""
    return list(_UNITS[unit])


class Refused(ValueError):
    """Raised for a question without an answer; the message is one line."""


def holding(said: Iterable[tuple[Any, str]]) -> list[str]:
    """Return the texts whose conditions hold."""
    return [text for holds, text in said if holds]


def refuse(said: Iterable[tuple[Any, str]]) -> None:
    """Raise `Refused` with the first text whose condition holds."""
    for text in holding(said):
        raise Refused(text)


def in_si(name: str, value: Any, unit: str) -> float:
    """Return a number in the SI unit.

    Parameters
    ----------
    name : str
        What the number is, for messages.
    value : float or str
        A plain number is in the SI unit already. A text is a number with a unit, a plain number,
        or a fraction such as ``1/240``.
    unit : str
        The SI unit; empty for a number without one.

    Raises
    ------
    Refused
        If the value is no finite number of this unit, if it can be read in two ways, or if it is
        so large or small that nothing can be computed with it.

    >>> in_si("mass", "50 g", "kg")
    0.05
    """
    wanted = f"write {'it' if unit else 'a number without a unit'} as in "
    wanted += f"'{_EXAMPLES.get(unit, f'2 {unit}')}'"
    try:
        number = _typed(name, value, unit, wanted) if isinstance(value, str) else float(value)
    except TypeError:
        raise Refused(f"{name}: {value!r} does not fit; {wanted}") from None
    # Also of infinity and NaN.
    if number != 0 and not 1 / LARGEST <= abs(number) <= LARGEST:
        raise Refused(
            f"{name} = {f'{number:g} {unit}'.strip()} is not computed, but 0 and quantities from "
            f"{1 / LARGEST:g} to {LARGEST:g} in SI units"
        )
    return number


def _typed(name: str, text: str, unit: str, wanted: str) -> float:
    """Return the number of a text in the SI unit."""
    plain = text.strip().replace("−", "-")
    both = (plain.replace(",", ""), plain.replace(",", "."))
    is_double = re.search(r"(?<![\d.,])\d{1,3},\d{3}(?![\d,])", plain)
    match = re.fullmatch(rf"({_NUMBER})(?:\s*/\s*({_NUMBER}))?\s*(.*)", both[1])
    first, second, typed = match.groups() if match else ("0", None, "")
    typed = SPELLED.get(typed.lower(), typed)
    divisor = float(second or 1)
    known = {"": 1.0, **_UNITS.get(unit, {unit: 1.0})}
    units = ", ".join(filter(None, known)) or "none"
    refuse(
        [
            (
                is_double,
                f"{name}: {text!r} can be read as {both[0]!r} or as {both[1]!r}; write one",
            ),
            (not match, f"{name}: {text!r} does not begin with a number; {wanted}"),
            (divisor == 0, f"{name}: {text!r} divides by zero"),
            (
                typed not in known,
                f"{name}: {typed!r} in {text!r} does not fit; {wanted}, in {units}",
            ),
        ]
    )
    return float(first) / divisor * known[typed]


def positive(name: str, value: Any, unit: str) -> float:
    """Return a number in SI units as :func:`in_si`, and refuse it if it is not positive."""
    number = in_si(name, value, unit)
    if number <= 0:
        raise Refused(f"{name} = {show(number, unit)} is not positive")
    return number


def step_in_si(value: Any) -> float:
    """Return a time step in s, which may be given as a rate in Hz.

    Raises
    ------
    Refused
        If it cannot be read, or is too long for any simulation of a contact.
    """
    if isinstance(value, str) and value.strip().lower().endswith(("hz", "fps")):
        step = 1 / positive("rate of the steps", value, "Hz")
    else:
        step = positive("time step", value, "s")
    if step > LONGEST_STEP:
        raise Refused(
            f"time step = {show(step, 's', 4)} is longer than {show(LONGEST_STEP, 's')}: write "
            "'2 ms', 1/240, or '240 Hz' for a rate"
        )
    return step


def within(name: str, value: Any, low: float, high: float) -> float:
    """Return a number without a unit, which may be in per cent, and refuse it outside a range."""
    number = in_si(name, value, "")
    if not low <= number <= high:
        is_share = high == 1 and 10 <= number <= 100
        meant = f"; {number:g} % is written {number / 100:g} or '{number:g} %'" if is_share else ""
        raise Refused(f"{name} = {number:g} is not between {low:g} and {high:g}{meant}")
    return number


def density_of(value: Any) -> float:
    """Return a density in kg/m³, given as a quantity or as the name of a material."""
    typed = value.strip().lower() if isinstance(value, str) else value
    return positive("density", DENSITIES.get(typed, value), "kg/m^3")


def span(low: float, high: float, digits: int = 3, form: str = "f") -> str:
    """Return both ends of a range with as many digits as tell them apart: ``0.6001 to 0.6004``."""
    while low != high and f"{low:.{digits}{form}}" == f"{high:.{digits}{form}}" and digits < 9:
        digits += 1
    return f"{low:.{digits}{form}} to {high:.{digits}{form}}"


_PREFIXES = {-9: "n", -6: "µ", -3: "m", 0: "", 3: "k", 6: "M", 9: "G"}
# Kilometres, kiloseconds and km/s are rare, and masses above a tonne stay in kilograms.
_GREATEST = {"m": 0, "s": 0, "g": 3}
_UNPREFIXED = ("", "m/s", "kg/m^3", "m/s^2")


def show(value: float, unit: str, digits: int = 3) -> str:
    """Return a number with its unit and a prefix: ``2.2 kN/m``.

    A power of ten is only shown above a million of the largest prefix.
    """
    if unit == "kg":
        return show(1000 * value, "g", digits)
    if not math.isfinite(value):
        return "–"
    # Less than a thousandth of the least prefix is rounding.
    rounded = float(f"{value:.{digits}g}") if abs(value) >= 1e-12 else 0.0
    power = 0
    if rounded and unit not in _UNPREFIXED:
        order = math.floor(math.log10(abs(rounded)) / 3)
        power = max(-9, min(3 * order, _GREATEST.get(unit, 9)))
    scaled = float(f"{rounded / 10.0**power:.{digits}g}")
    text = f"{scaled:.0f}" if 100 <= abs(scaled) < 1e6 else f"{scaled:.{digits}g}"
    return f"{text} {_PREFIXES[power]}{unit}".strip()
