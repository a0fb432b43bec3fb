"""The formats of numbers in the article."""

import math
from collections.abc import Iterable

FORMATS = ("decimal", "listed", "pairs", "percent", "short")
"""The functions of this module that templates can call."""
_SUPERSCRIPTS = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")


def _typeset(number: str) -> str:
    """A number printed by Python, with typographic signs for minus, infinity and NaN (a dash)."""
    return number.replace("nan", "–").replace("inf", "∞").replace("-", "−")


def decimal(value: float, digits: int) -> str:
    """A number with the given number of decimals; a dash for NaN.

    Examples
    --------
    >>> decimal(82.1774, 2), decimal(float("nan"), 2), decimal(float("inf"), 2)
    ('82.18', '–', '∞')
    """
    # Adding 0.0 removes the sign of a zero that results from rounding.
    return _typeset(f"{round(float(value), digits) + 0.0:.{digits}f}")


def short(value: float, digits: int = 6) -> str:
    """A parameter without trailing zeros; small and large values have a power of ten.

    Examples
    --------
    >>> short(0.85), short(10000.0), short(2.5e-13, 2), short(99.7, 2)
    ('0.85', '10⁴', '2.5·10⁻¹³', '100')
    """
    value = float(value)
    if not (0 < abs(value) < 1e-3 or 1e4 <= abs(value) < math.inf):
        return _typeset(f"{float(f'{value:.{digits}g}'):.15g}")
    mantissa, exponent = f"{value:.{digits - 1}e}".split("e")
    factor = f"{float(mantissa):g}"
    power = f"10{str(int(exponent)).translate(_SUPERSCRIPTS)}"
    return power if factor == "1" else _typeset(f"{factor}·{power}")


def percent(share: float, digits: int = 3) -> str:
    """A share in per cent.

    Examples
    --------
    >>> percent(0.01), percent(0.0279, 2)
    ('1 %', '2.8 %')
    """
    # A share of a sample may lie halfway between two texts; rounding errors must not decide there.
    return f"{short(100 * float(share) * (1 + 1e-9), digits)} %"


def listed(values, word: str = "and") -> str:
    """Texts or numbers as a list in a sentence.

    Examples
    --------
    >>> listed([0.7, 1.0, 1.2])
    '0.7, 1 and 1.2'
    """
    texts = [value if isinstance(value, str) else short(value) for value in values]
    return texts[0] if len(texts) == 1 else f"{', '.join(texts[:-1])} {word} {texts[-1]}"


def pairs(left: Iterable[float], right: Iterable[float]) -> list[str]:
    """Pairs of parameters in brackets.

    Examples
    --------
    >>> pairs([0.85, 0.65], [1.0, 1.2])
    ['(0.85, 1)', '(0.65, 1.2)']
    """
    return [f"({short(a)}, {short(b)})" for a, b in zip(left, right, strict=True)]
