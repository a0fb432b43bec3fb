"""Suprema of the errors over all orbits of the atlas, between its nodes too.

The modulus of an error is maximised over r and over the whole stable range, on a grid that is
refined around its largest value. Next to the saddle-node, p = 0, where most errors are largest,
they vary with √p; the grid is therefore even in √p.
"""

from collections.abc import Callable, Iterable
from functools import partial

import numpy as np
import xarray as xr
from scipy.optimize import brentq

from bouncing_ball.accuracy.errors import SIMPLE, errors, modulus
from bouncing_ball.accuracy.quantities import OF_LIMITS, Quantity
from bouncing_ball.atlas.plan import Plan

# Points along r and √p, and refinements, each of which divides their distances by four.
_POINTS, _ROUNDS = 9, 8
# √p next to the saddle-node. The restitution model's phase is 0 there, so that its relative error
# grows as 1/√p; no other error of an existing orbit is above this bound.
_NEAREST, _UNBOUNDED = 1e-6, 1e3
# How many ϖ of the plan lie between two that are scanned for a crossing.
_SCANNED = 16


def largest(
    plan: Plan,
    row: int,
    kind: tuple[str, Quantity],
    frequency_ratio: float,
    restitution: tuple[float, float],
) -> tuple[float, float, float]:
    """The largest error over p and a range of r, for the rule and the n of a row, with its r and Λ.

    ``kind`` is the model and the quantity. The error is infinite if it is unbounded, or if a model
    lacks an orbit.
    """
    model, quantity = kind
    # The limits of the range do not depend on the place in it.
    ends = np.array([restitution, (1.0 if quantity in OF_LIMITS else _NEAREST, 1.0)])
    (low, high), before = ends.T, -np.inf
    for _ in range(_ROUNDS):
        grid = (np.unique(part) for part in np.linspace(low, high, _POINTS).T)
        r, root = (x.ravel() for x in np.meshgrid(*grid))
        nodes = plan.placed(row, r, root**2)
        every = errors(nodes.contact(frequency_ratio), nodes.n, nodes.amplitude, [quantity])
        # At r = 1 the saddle-node is at Λ = 0, and its relative error is 0/0.
        undefined = (r == 1) & (quantity == Quantity.SADDLE_NODE)
        size = np.where(undefined, 0.0, modulus(every[SIMPLE.index(model), 0]))
        best = int(size.argmax())
        place, step = np.array([r[best], root[best]]), (high - low) / (_POINTS - 1)
        # In a corner nothing larger is found next to it.
        if size[best] == before and np.all(np.isin(place, ends)):
            break
        before = size[best]
        low, high = np.maximum(low, place - step), np.minimum(high, place + step)
    error = size[best] if size[best] < _UNBOUNDED else np.inf
    return float(error), float(r[best]), float(nodes.amplitude[best])


def last_exceeding(
    error: Callable[[float], float], tolerance: float, grid: Iterable[float]
) -> float:
    """The largest place at which an error falls to the tolerance, between places of a grid.

    It is infinite if the error exceeds the tolerance at the last place of the grid, and 0 if it
    does so at none.

    Examples
    --------
    >>> [last_exceeding(lambda x: 1 / x, level, [1.0, 3.0]) for level in (0.5, 2.0, 0.1)]
    [2.0, 0.0, inf]
    """

    def excess(place: float) -> float:
        return float(np.log(np.clip(error(place), 1 / _UNBOUNDED**2, _UNBOUNDED) / tolerance))

    above = np.inf
    for place in sorted(grid, reverse=True):
        if excess(place) > 0:
            return brentq(excess, place, above) if above < np.inf else np.inf
        above = place
    return 0.0


def suprema(plan: Plan, frequency_ratio: float, tolerance: float) -> xr.Dataset:
    """Suprema of the errors at ϖ, and from which ϖ and up to which r they exceed a tolerance.

    Over (release, n, model, supremum_quantity) the dataset has the suprema at ϖ with their places,
    ``worst_error``, ``worst_restitution`` and ``worst_amplitude``, and ``supremum_needed``, the ϖ
    from which on they are tolerated. Over (release, n) it has ``failing_restitution``, the largest
    r with an orbit on which the restitution model's greatest height is wrong by more than the
    tolerance at ϖ. The last two are those of :func:`last_exceeding`.
    """
    shape = *plan.shape[:2], len(SIMPLE), len(Quantity)
    found, failing = np.empty((*shape, 4)), np.empty(shape[:2])
    for place in np.ndindex(shape):
        rows = np.ravel_multi_index((*place[:2], np.arange(plan.shape[2])), plan.shape)
        edges = plan.edges[np.append(np.isin(rows, plan.rows), True)]
        error = partial(largest, plan, rows[0], (SIMPLE[place[2]], tuple(Quantity)[place[3]]))
        span = edges[0], edges[-1]
        ratios = plan.ratios[::-_SCANNED]
        needed = last_exceeding(lambda x: error(x, span)[0], tolerance, ratios)
        found[place] = *error(frequency_ratio, span), needed
        if place[2:] == (0, 0):
            at = partial(error, frequency_ratio)
            failing[place[:2]] = last_exceeding(lambda r: at((r, r))[0], tolerance, edges)
    names = "worst_error", "worst_restitution", "worst_amplitude", "supremum_needed"
    dims = "release", "n", "model", "supremum_quantity"
    data = {name: (dims, found[..., k]) for k, name in enumerate(names)}
    data |= {"failing_restitution": (dims[:2], failing)}
    return xr.Dataset(data, {"supremum_quantity": list(map(str, Quantity))})
