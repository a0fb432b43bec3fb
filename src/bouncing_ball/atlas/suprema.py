"""Suprema of the errors over all orbits of the atlas, between its nodes too.

The modulus of an error is maximised over r and over the whole stable range, on a grid that is
refined around its largest value. Next to the saddle-node, p = 0, where most errors are largest,
they vary with √p; the grid is therefore even in √p.
"""

from collections.abc import Callable
from functools import partial

import numpy as np
from scipy.optimize import brentq

from bouncing_ball.accuracy.errors import SIMPLE, errors, modulus
from bouncing_ball.accuracy.quantities import OF_LIMITS, Quantity
from bouncing_ball.atlas.plan import Plan

# Points along r and √p, and refinements, each of which divides their distances by four.
_POINTS, _ROUNDS = 9, 8
# √p next to the saddle-node. The restitution model's phase is 0 there, so that its relative error
# grows as 1/√p; no other error of an existing orbit is above this bound.
_NEAREST, _UNBOUNDED = 1e-6, 1e3
# Tolerance of ln ϖ and ln r.
_CLOSE = 1e-8


def largest(
    plan: Plan, row: int, kind: tuple[str, Quantity], ratio: float, span: tuple[float, float]
) -> float:
    """The largest error at ϖ over p and a range of r, for the rule and the n of a row.

    ``kind`` is the model and the quantity. The error is infinite if it is unbounded, or if a model
    lacks an orbit.
    """
    model, quantity = kind
    # The limits of the range do not depend on the place in it.
    first = 1.0 if quantity in OF_LIMITS else _NEAREST
    ends = np.array([span, (first, 1.0)]).T
    (low, high), before = ends, -np.inf
    for _ in range(_ROUNDS):
        grid = (np.unique(part) for part in np.linspace(low, high, _POINTS).T)
        r, root = (x.ravel() for x in np.meshgrid(*grid))
        nodes = plan.placed(row, r, root**2)
        every = errors(nodes.contact(ratio), nodes.n, nodes.amplitude, [quantity])
        # At r = 1 the saddle-node is at Λ = 0, and its relative error 0/0.
        undefined = (r == 1) & (quantity == Quantity.SADDLE_NODE)
        size = np.where(undefined, 0.0, modulus(every[SIMPLE.index(model), 0]))
        best = int(size.argmax())
        place, step = np.array([r[best], root[best]]), (high - low) / (_POINTS - 1)
        # In a corner nothing larger is found next to it.
        if size[best] == before and np.all((place == ends).any(axis=0)):
            break
        before = size[best]
        low, high = np.maximum(low, place - step), np.minimum(high, place + step)
    return float(size[best]) if size[best] < _UNBOUNDED else np.inf


def crossing(error: Callable[[float], float], tolerance: float, low: float, high: float) -> float:
    """The place from which on an error is tolerated, if it falls from one place to another.

    Places are positive, because the search is along their logarithm.
    The result is infinite if the error exceeds the tolerance at the upper end, and the lower end if
    it does not exceed it there.

    Examples
    --------
    >>> [round(crossing(lambda x: 1 / x, level, 1.0, 3.0), 6) for level in (0.5, 2.0, 0.1)]
    [2.0, 1.0, inf]
    """

    def excess(log_place: float) -> float:
        size = np.clip(error(np.exp(log_place)), 1 / _UNBOUNDED**2, _UNBOUNDED)
        return float(np.log(size / tolerance))

    if excess(np.log(high)) > 0:
        return np.inf
    if excess(np.log(low)) <= 0:
        return low
    return float(np.exp(brentq(excess, np.log(low), np.log(high), xtol=_CLOSE)))


def suprema(plan: Plan, rule: float, tolerance: float) -> dict[str, tuple]:
    """Variables of the suprema at a ϖ, and of the ϖ and r from which on they are tolerated.

    Over (release, n, model, supremum_quantity) they are ``supremum`` at the ϖ of the rule and
    ``supremum_needed``, the ϖ from which on all orbits are within the tolerance. Over
    (release, n) it is ``failing_restitution``, the r below which the restitution model's greatest
    height exceeds it at the rule's ϖ. The last two are those of :func:`crossing`.
    """
    shape = *plan.shape[:2], len(SIMPLE), len(Quantity)
    found, failing = np.empty((2, *shape)), np.empty(shape[:2])
    for place in np.ndindex(shape):
        tiles = np.ravel_multi_index((*place[:2], np.arange(plan.shape[2])), plan.shape)
        low, top = plan.edges[:-1][np.isin(tiles, plan.rows)][0], plan.edges[-1]
        error = partial(largest, plan, tiles[0], (SIMPLE[place[2]], tuple(Quantity)[place[3]]))
        along_ratio = partial(error, span=(low, top))
        found[0][place] = along_ratio(rule)
        found[1][place] = crossing(along_ratio, tolerance, plan.ratios[0], plan.ratios[-1])
        if place[2:] == (0, 0):
            at = partial(error, rule)
            failing[place[:2]] = crossing(lambda r, at=at: at((r, r)), tolerance, low, top)  # type: ignore[misc]
    dims = "release", "n", "model", "supremum_quantity"
    every = {"supremum": (dims, found[0]), "supremum_needed": (dims, found[1])}
    return {**every, "failing_restitution": (dims[:2], failing)}
