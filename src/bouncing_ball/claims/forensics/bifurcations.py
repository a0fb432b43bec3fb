"""Saddle-node and period doubling of the altered models.

As in :mod:`bouncing_ball.orbits.spring_damper_limits`: the branch starts at short contacts,
where Λ is large and falls with the duration. The saddle-node is the first
minimum of Λ, whatever the linearisation says: no orbit has a smaller Λ. The
period doubling is the criterion's root next to it, on the side of the short
contacts.
"""

from typing import NamedTuple

import numpy as np
from scipy.optimize.elementwise import find_minimum, find_root

from bouncing_ball.claims.forensics.altered_model import Altered, altered_monodromy, altered_orbit

# The scan runs over ε = sinh-spaced points from a thousandth of the free
# contact to one that fills the cycle but for a thousandth; the middle of the
# scale is that of the fold, 1/ϖ.
_SCAN = 241
_SHORTEST = 1e-3
_MIDDLE = 0.05


class Bifurcations(NamedTuple):
    """Excess angles ε of both; NaN where there is none."""

    saddle_node: np.ndarray
    period_doubling: np.ndarray


def criterion(excess: np.ndarray, model: Altered) -> np.ndarray:
    """The function whose root is the period doubling, positive on the stable side."""
    orbit = altered_orbit(excess, model)
    (a, b), (c, d) = altered_monodromy(orbit, model)
    floquet = 1 + a + d + a * d - b * c
    r_a = -orbit.bounce / orbit.impact
    lift = np.where(model.lift > 0, model.lift, 2 * (1 + r_a * r_a) / (1 + r_a) ** 2)
    angle = orbit.phase + model.share * orbit.contact_duration
    return np.where(model.share < 0, floquet, lift - orbit.amplitude * np.sin(angle))


def scan(model: Altered) -> np.ndarray:
    """Excess angles ε along the branch, on a first axis."""
    start, wave = model.free_angle, model.transient_frequency
    low = -start * (1 - _SHORTEST)
    high = np.minimum(start, wave * 2 * np.pi * model.n * (1 - _SHORTEST) - start)
    middle = _MIDDLE / (1 + model.frequency_ratio)
    share = np.linspace(-1.0, 1.0, _SCAN).reshape(-1, *(1,) * np.ndim(low))
    ends = np.arcsinh(low / middle), np.arcsinh(np.maximum(high, low / 2) / middle)
    return middle * np.sinh(np.where(share < 0, -share * ends[0], share * ends[1]))


def _at(values, index):
    return np.take_along_axis(values, index[np.newaxis], axis=0)[0]


def bifurcations(model: Altered) -> Bifurcations:
    """Both bifurcations of every entry of a model."""
    model = Altered(*np.broadcast_arrays(*(np.asarray(x, dtype=float) for x in model)))
    shape = model.n.shape
    grid = scan(model)
    orbit = altered_orbit(grid, model)
    fits = model.transient_frequency * 2 * np.pi * model.n > model.free_angle + grid
    amplitude = np.where(orbit.touches & fits, orbit.amplitude, np.nan)
    inner = amplitude[1:-1]
    valley = (inner <= amplitude[:-2]) & (inner < amplitude[2:])
    found = valley.any(axis=0)
    lowest = valley.argmax(axis=0) + 1
    node = np.full(shape, np.nan)
    if found.any():
        bracket = tuple(_at(grid, lowest + k)[found] for k in (-1, 0, 1))
        node[found] = find_minimum(
            lambda excess, *fields: altered_orbit(excess, Altered(*fields)).amplitude,
            bracket,
            args=tuple(np.asarray(x)[found] for x in model),
        ).x
    # On the stable side; the points beyond collapse on the saddle-node.
    side = np.minimum(grid, np.where(found, node, grid[-1]))
    values = np.where(np.isnan(amplitude) & (grid < side[-1]), np.nan, criterion(side, model))
    change = (values[:-1] < 0) & (values[1:] >= 0)
    exists = change.any(axis=0) & found
    last = len(change) - 1 - change[::-1].argmax(axis=0)
    doubling = np.full(shape, np.nan)
    if exists.any():
        doubling[exists] = find_root(
            lambda excess, *fields: criterion(excess, Altered(*fields)),
            (_at(side, last)[exists], _at(side, last + 1)[exists]),
            args=tuple(np.asarray(x)[exists] for x in model),
        ).x
    return Bifurcations(node, doubling)
