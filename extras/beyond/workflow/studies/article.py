"""The article, its appendices and the list of figures: templates filled in from datasets.

As in the replication, a template has text and names of numbers, and no numbers.
"""

from decimal import ROUND_CEILING, ROUND_HALF_EVEN, Decimal
from pathlib import Path

import numpy as np

from bouncing_ball.article import environment
from bouncing_ball.datasets import Datasets, parameters

TEMPLATES = Path(__file__).parents[1] / "templates"


def filled_in(name: str, datasets: Datasets) -> str:
    """The text of a template, Markdown: "article", "appendix", or "figures", the list of all."""
    templates = environment(TEMPLATES)
    templates.filters.update(digits=digits, bound_digits=bound_digits, bound=bound, at_most=at_most)
    return templates.get_template(f"{name}.md.j2").render(
        **datasets,
        titles={key: data.attrs["title"] for key, data in datasets.items()},
        given={key: parameters(data) for key, data in datasets.items()},
    )


def digits(value: float, count: int, rounding: str = ROUND_HALF_EVEN) -> str:
    """A number with a number of digits, small ones with a power of ten.

    >>> digits(82.177, 2), digits(1.5812, 4), digits(3.63e-6, 2), digits(5613.2, 2)
    ('82', '1.581', '3.6·10⁻⁶', '5600')
    """
    number = float(value)
    if not np.isfinite(number):
        return "–"
    exact = Decimal(repr(number))
    rounded = exact.quantize(Decimal(1).scaleb(exact.adjusted() - count + 1), rounding=rounding)
    exponent = rounded.adjusted()
    if exponent < -3:
        power = str(exponent).translate(str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹"))
        return f"{rounded.scaleb(-exponent)}·10{power}".replace("-", "−")
    return f"{rounded:f}".replace("-", "−")


def bound_digits(value: float, count: int) -> str:
    """An upper bound with a number of digits, rounded up.

    >>> bound_digits(5613.2, 2), bound_digits(25.61, 2), bound_digits(5597.1, 2)
    ('5700', '26', '5600')
    """
    return digits(value, count, ROUND_CEILING)


def bound(value: float, decimals: int, shift: int = 0) -> str:
    """An upper bound with a number of decimals, rounded up, with the point moved by `shift`.

    >>> bound(0.00031460, 5), bound(0.5, 1)
    ('0.00032', '0.5')
    """
    if not np.isfinite(value):
        return "–"
    number = Decimal(repr(float(value))).scaleb(shift)
    rounded = number.quantize(Decimal(1).scaleb(-decimals), rounding=ROUND_CEILING)
    return str(rounded + 0).replace("-", "−")


def at_most(value: float, decimals: int = 0) -> str:
    """An upper bound in per cent.

    >>> at_most(0.00861, 2)
    '0.87 %'
    """
    text = bound(value, decimals, shift=2)
    return text if text == "–" else f"{text} %"
