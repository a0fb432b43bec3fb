"""The article, its appendices and the list of figures: templates filled in from datasets.

As in the replication, a template has text and names of numbers, and no numbers.
"""

from decimal import ROUND_HALF_EVEN, Decimal
from pathlib import Path

import numpy as np

from paper_replication.datasets import Datasets, parameters
from paper_replication.templates import environment

TEMPLATES = Path(__file__).parents[1] / "templates"


def filled_in(name: str, datasets: Datasets) -> str:
    """The text of a template, Markdown: "article", "appendix", or "figures", the list of all."""
    templates = environment(TEMPLATES)
    templates.filters.update(digits=digits)
    return templates.get_template(f"{name}.md.j2").render(
        **datasets,
        titles={key: data.attrs["title"] for key, data in datasets.items()},
        given={key: parameters(data) for key, data in datasets.items()},
    )


def digits(value: float, count: int) -> str:
    """A number with a number of digits, small ones with a power of ten.

    >>> digits(82.177, 2), digits(1.5812, 4), digits(3.63e-6, 2), digits(5613.2, 2)
    ('82', '1.581', '3.6·10⁻⁶', '5600')
    """
    number = float(value)
    if not np.isfinite(number):
        return "–"
    exact = Decimal(repr(number))
    unit = Decimal(1).scaleb(exact.adjusted() - count + 1)
    rounded = exact.quantize(unit, rounding=ROUND_HALF_EVEN)
    exponent = rounded.adjusted()
    if exponent < -3:
        power = str(exponent).translate(str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹"))
        return f"{rounded.scaleb(-exponent)}·10{power}".replace("-", "−")
    return f"{rounded:f}".replace("-", "−")
