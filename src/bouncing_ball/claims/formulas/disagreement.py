"""One check of a formula, and what rounding accounts for."""

from typing import NamedTuple

import numpy as np

# Flow, roots and minima are right to rounding, 1e-16, amplified by the terms
# that cancel in them: 10⁴ covers the samples.
ROUNDING = 1e-12


class Check(NamedTuple):
    """One formula: largest disagreement, what rounding allows, and with what."""

    disagreement: float
    budget: float
    comparison: str


def largest(*defects) -> float:
    """The largest absolute entry of all arrays; NaN if one is NaN.

    Examples
    --------
    >>> largest([0.5, -2.0], 1.0)
    2.0
    """
    return float(np.max([np.max(np.abs(x)) for x in defects]))
