r"""Saddle-node and period doubling along ϖ, without a scan for each.

As in :mod:`bouncing_ball.atlas.walk` the walk comes down from the stiffest contact in
t = ϖε, almost a constant along ϖ. The saddle-node is the zero of ``½ dΛ²/dε``, the period
doubling that of ``1 + tr + det``, both almost straight along ε: some steps of
the secant method from the extrapolated t close them. Where these do not converge
:mod:`bouncing_ball.orbits.spring_damper_limits` looks for the bifurcation.
"""

from collections.abc import Callable, Iterator
from dataclasses import replace

import numpy as np

from bouncing_ball.accuracy.errors import models, relative
from bouncing_ball.accuracy.quantities import OF_LIMITS, values
from bouncing_ball.atlas.plan import Nodes
from bouncing_ball.atlas.walk import extrapolated, stiff_start
from bouncing_ball.contacts.spring_damper import SpringDamper
from bouncing_ball.orbits import restitution_orbit
from bouncing_ball.orbits import spring_damper_limits as limits
from bouncing_ball.orbits.spring_damper_branch import BranchPoint, branch_point
from bouncing_ball.orbits.stability import Bifurcation

_SECANTS = 6
# First step of the secants in t, and the last one at most; t is of the order of 1.
_STEP = 1e-4
CLOSED = 1e-8
"""Last step of t, relative to 1 + |t|. Λ follows t by its square at the saddle-node and
in proportion at the period doubling, over ϖ: it is closer than this."""


def limit_errors(nodes: Nodes, ratios: np.ndarray) -> Iterator[tuple[float, np.ndarray]]:
    """Signed errors of saddle-node, period doubling and permanent contact.

    Parameters
    ----------
    nodes : Nodes
        At the saddle-nodes of the restitution model.
    ratios : ndarray
        ϖ, increasing.

    Yields
    ------
    float, ndarray
        ϖ, from the largest to the smallest, and errors of shape (model, quantity, nodes).
    """
    n, r, down = nodes.n, nodes.restitution, ratios[::-1]
    flips = replace(nodes, amplitude=restitution_orbit.period_doubling(n, r))
    tracks = (
        _track(lambda point: point.fold, limits.saddle_node, nodes, down),
        _track(_flip, limits.period_doubling, flips, down),
    )
    for ratio, *bounds in zip(down, *tracks, strict=True):
        model, *simple = models(nodes.contact(ratio))
        exact = [*bounds, model.permanent_contact_threshold()]
        each = (values(model, n, nodes.amplitude, OF_LIMITS) for model in simple)
        yield ratio, np.stack([relative(exact, one) for one in each])


def _flip(point: BranchPoint) -> np.ndarray:
    return Bifurcation.PERIOD_DOUBLING.test(point.trace, point.determinant)


def _track(
    test: Callable[[BranchPoint], np.ndarray],
    direct: Callable[[SpringDamper, int], np.ndarray],
    start: Nodes,
    down: np.ndarray,
) -> Iterator[np.ndarray]:
    """Λ at the zero of a test function for each ϖ of a decreasing sequence."""
    along, n = np.log(down), start.n
    at, past = along[:1], stiff_start(start)[np.newaxis]
    for k, ratio in enumerate(down):
        contact = start.contact(ratio)

        def value(t, contact=contact, ratio=ratio):
            return test(branch_point(t / ratio, contact, n))

        (guess,) = extrapolated(at, past, along[k : k + 1])
        found, closed = _secant(value, guess)
        if not np.all(closed):
            found[~closed] = ratio * direct(contact[~closed], n)
        at, past = along[max(k - 1, 0) : k + 1], np.array([past[-1], found] if k else [found])
        yield branch_point(found / ratio, contact, n).amplitude


def _secant(
    value: Callable[[np.ndarray], np.ndarray], t: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Zeros of functions of t, one each, and whether the last step was short."""
    old, t = t, t + _STEP
    was = value(old)
    step = np.full(t.shape, _STEP)
    for _ in range(_SECANTS):
        now = value(t)
        rise = now - was
        step = np.where(rise == 0, 0.0, -now * (t - old) / np.where(rise == 0, 1.0, rise))
        old, was, t = t, now, t + step
    return t, np.abs(step) <= CLOSED * (1 + np.abs(t))
