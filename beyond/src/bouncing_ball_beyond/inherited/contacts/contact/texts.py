"""Quantities as they are shown, with four digits and a prefix of their unit; and sentences from
their templates.
"""

import math
from functools import cache
from typing import Any

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


@cache
def _templates() -> Any:
    # Imported where it is needed, because numbers without sentences do not need it.
    from jinja2 import Environment, PackageLoader, StrictUndefined

    found = Environment(
        loader=PackageLoader("bouncing_ball_beyond.inherited.contacts"),
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
        # A template is used once, so that constants in it are not worth a search.
        optimized=False,
    )
    found.globals |= {each.__name__: each for each in (percent, shown, signed, in_place_of)}
    return found


def lines(template: str, **values: Any) -> list[str]:
    """The lines of ``templates/TEMPLATE.txt.j2`` with these values."""
    return _templates().get_template(f"{template}.txt.j2").render(values).splitlines()
