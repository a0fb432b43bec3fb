"""The sum of both Lyapunov exponents: the mean contraction of areas.

The determinant of the derivative of the return map is the factor by which areas shrink from impact
to impact, and the sum of the exponents is the mean of its logarithm over the time. The models know
this factor without the derivative: r² in the restitution model and exp(-2ζϖD) in a linear contact.
The second exponent is the difference of this sum from the largest one, so that it keeps its digits
where the two exponents differ by orders of magnitude.
"""

from itertools import islice
from typing import Any

import numpy as np


def exponent_sum(
    model: Any, amplitude: np.ndarray, phase: np.ndarray, velocity: np.ndarray, count: np.ndarray
) -> np.ndarray:
    """The sum of the exponents per period of the table, of a row of balls that are each followed
    for a number of impacts from an impact (φ, z′_i).

    It is -∞ where an instant leaves the ball on the table, because the derivative is zero there,
    and NaN where there is no impact.

    Examples
    --------
    Each impact of the restitution model contracts areas by r², here once in a period of the table:

    >>> from bouncing_ball_beyond.models.rigid import RestitutionModel
    >>> one = [np.array([x]) for x in (1.0, np.arccos(np.pi * 0.15 / 1.85), -np.pi)]
    >>> found = exponent_sum(RestitutionModel(0.85), *one, np.array([10]))
    >>> round(float(found[0] / np.log(0.85)), 9)
    2.0
    """
    logarithm = np.zeros(phase.size)
    time = np.zeros(phase.size)
    going = np.flatnonzero(np.isfinite(phase))
    if going.size:
        row = model.flat(phase.shape).take(going).dynamics(amplitude[going])
        dynamics, start, relative, _ = row.first_impacts(phase[going], velocity[going])
        first = dynamics.start(start, relative)
        legs = dynamics.legs(first, differentiate=True)
        for number, leg in enumerate(islice(legs, int(count[going].max()))):
            here = leg.bouncing()
            (going,) = leg.keep(here[count[going[here]] > number], going)
            if not going.size:
                break
            _, passed = leg.fly()
            with np.errstate(divide="ignore"):
                factor = leg.dynamics.contraction(leg.impact, leg.departure)
                logarithm[going] += np.log(np.abs(factor))
            time[going] += passed
    with np.errstate(invalid="ignore", divide="ignore"):
        return 2 * np.pi * np.where(time > 0, logarithm / time, np.nan)
