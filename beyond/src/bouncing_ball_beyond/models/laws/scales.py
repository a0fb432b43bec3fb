"""Scales of a contact: its penetration and speed, whose quotient is a scale of its duration.

They set the step lengths of the numerical methods and the starting points of their iterations; the
results depend on them only within the error of the methods.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import scipy

from bouncing_ball_beyond.inherited.errors import ModelError
from bouncing_ball_beyond.models.laws.force_law import ForceLaw
from bouncing_ball_beyond.models.laws.loaded import LoadedLaw

# Limit and tolerance of Newton's method for ln p, which takes one step for a power law and a few
# for a sum of powers.
_ITERATIONS = 40
_ENOUGH = 1e-3
# Steps of ln p: the one for the difference quotient, and the longest of Newton's method.
_DIFFERENCE = 1e-4
_LONGEST = 10.0
_ROUNDING = np.finfo(float).eps


class Scales(NamedTuple):
    """Length P and speed V of a contact, arrays of one shape; it lasts for a few P/V."""

    length: np.ndarray
    speed: np.ndarray


def depth(law: ForceLaw, rate: np.ndarray, power: float, wanted: np.ndarray) -> np.ndarray:
    """The penetration p at which f(p, p′) p^power = ``wanted``, of the shape of ``wanted``.

    Raises
    ------
    ModelError
        If no such penetration was found, because the force does not grow without limit.
    """

    def logarithm(log):
        p = np.exp(log)
        return np.log(law.force(p, rate)) + power * log

    log = np.zeros_like(wanted)
    target = np.log(wanted)
    with np.errstate(all="ignore"):
        for _ in range(_ITERATIONS):
            missing = logarithm(log) - target
            slope = (logarithm(log + _DIFFERENCE) - logarithm(log)) / _DIFFERENCE
            step = np.clip(missing / slope, -_LONGEST, _LONGEST)
            log = log - step
            if np.all(np.abs(step) < _ENOUGH):
                return np.exp(log)
    raise ModelError(
        f"{law.name} does not stop the ball: its force must push, be finite, and grow with the "
        "penetration to any value"
    )


def rest(law: ForceLaw) -> float:
    """The penetration of one law under the weight of a ball at rest, ``f(p, 0) = 1``.

    Examples
    --------
    >>> from bouncing_ball_beyond.models.spring_damper import SpringDamper
    >>> round(rest(SpringDamper(2.0, 0.1)), 6)
    0.25
    """
    weight = np.ones(1)
    deepest = float(depth(law, 0 * weight, 0.0, weight)[0])
    if not isinstance(law, LoadedLaw):
        return deepest
    # The load adds to the force, so that the ball at rest lies less deep.
    loaded = law.under(1.0)

    def surplus(p: float) -> float:
        return loaded.force(p * weight, 0 * weight)[0] - 1

    # Stiff contacts are less deep than the absolute tolerance that is scipy's default.
    return scipy.optimize.brentq(surplus, 0.0, 2 * deepest, xtol=_ROUNDING * deepest)


def scales(law: ForceLaw, speed: np.ndarray, load: np.ndarray) -> Scales:
    """Scales of contacts with a given impact speed, under a load of at most ``load``.

    ``f(P, V) P = V²``. V² is the square of the impact speed, plus the load times the penetration at
    which the contact force balances it.

    Raises
    ------
    ModelError
        If the law does not stop the ball.

    Examples
    --------
    >>> from bouncing_ball_beyond.models.spring_damper import SpringDamper
    >>> length, speed = scales(SpringDamper(10.0, 0.0), np.array([2.0]), np.array([0.0]))
    >>> round(float(length[0]), 3), float(speed[0])
    (0.2, 2.0)
    """
    v2 = speed * speed
    if np.any(load > 0):
        loaded = np.maximum(load, np.finfo(float).tiny)
        v2 = v2 + load * depth(law, np.zeros_like(v2), 0.0, loaded)
    v = np.sqrt(np.maximum(v2, np.finfo(float).tiny))
    return Scales(depth(law, v, 1.0, v * v), v)
