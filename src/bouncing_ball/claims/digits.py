"""Numbers as printed: their value and the unit of their last digit."""

import re

# Digits with or without a decimal part, and a power of ten.
_NUMBER = re.compile(r"-?[0-9]{1,20}(\.[0-9]{1,20})?(e-?[0-9]{1,2})?")


def is_number_text(value: object) -> bool:
    """Whether a value is a number written as a text.

    Examples
    --------
    >>> is_number_text("0.750"), is_number_text(0.75)
    (True, False)
    """
    return isinstance(value, str) and _NUMBER.fullmatch(value) is not None


def last_unit(text: str) -> float:
    """Unit of the last printed digit.

    Examples
    --------
    >>> last_unit("0.255"), last_unit("82"), last_unit("1.0e-2")
    (0.001, 1.0, 0.001)
    """
    mantissa, _, exponent = text.lower().partition("e")
    decimals = len(mantissa.partition(".")[2])
    # From its decimal form, so that 0.001 is the nearest number to 1/1000.
    return float(f"1e{int(exponent or 0) - decimals}")


def distance_in_units(computed: float, text: str, unit: float | None = None) -> float:
    """(computed - printed) in units of the last printed digit.

    Examples
    --------
    >>> round(distance_in_units(82.25, "82"), 10)
    0.25
    """
    return (computed - float(text)) / (unit or last_unit(text))
