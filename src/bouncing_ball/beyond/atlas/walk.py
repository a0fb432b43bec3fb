r"""Orbits at given Λ along ϖ, by extrapolation along the branch instead of root finding.

On the branch of :mod:`bouncing_ball.periodic.one_impact.spring_damper_branch` the product t = ϖε is
almost constant along ϖ, and (X, Y) is almost a straight line along ε. The walk therefore starts at
the stiffest contact and goes down. For stiff contacts only the load a = 1 - Y delays the release,
by ``(1 + r) a/(r v ϖ²)`` for both rules (:mod:`bouncing_ball.models.laws.signature`), with ``v =
2nπ/(1 + r)``. Expressed as an angle of the oscillation of the contact, this is ::

    t = √(1 - ζ²) (1 + r)² (1 - Y)/(2nπ r)

The smaller ϖ are taken eight at a time. There t is extrapolated by the polynomial in ln ϖ
through the last eight values, and corrected once. If X and Y are linear in ε, Λ² is a parabola,
and of the two solutions d of ::

    (X + X′d)² + (Y + Y′d)² = Λ²

the smaller belongs to the stable side. This takes two evaluations of the branch for each orbit,
whereas a bracketing root finder takes hundreds. Every result of the walk is an orbit of the closed
form; only its Λ differs slightly from the requested Λ, by a known difference. Where the difference
exceeds :data:`REACHED`, the orbit is computed by
:func:`bouncing_ball.periodic.one_impact.spring_damper_bifurcations.orbit_at`, which is
authoritative.
"""

from collections.abc import Iterator
from itertools import permutations
from typing import NamedTuple

import numpy as np

from bouncing_ball.beyond.atlas.plan import Nodes
from bouncing_ball.models.contact_model import ContactModel
from bouncing_ball.models.spring_damper import SpringDamper
from bouncing_ball.periodic.one_impact import restitution_branch as restitution_orbit
from bouncing_ball.periodic.one_impact import spring_damper_bifurcations as bifurcations
from bouncing_ball.periodic.one_impact.spring_damper_branch import (
    BranchPoint,
    branch_point,
    orbits_of_points,
)
from bouncing_ball.periodic.orbits.orbit import Orbit
from bouncing_ball.periodic.orbits.stability import is_stable

REACHED = 1e-6
"""Largest relative difference between the Λ of an orbit and the requested Λ. Errors of models are
those of this neighbouring orbit, computed exactly; most differences are within 1e-9."""

TOGETHER = 8
"""Number of ϖ computed at the same time, so that arrays are long even for few nodes; t is
extrapolated from the same number of values."""
# At the stiffest contacts there is nothing to extrapolate from, so that t is corrected more often.
_FIRST_CORRECTIONS = 4


class Stride(NamedTuple):
    """The orbits of the nodes at several ϖ, shape (ϖ, nodes); NaN where there is no orbit."""

    frequency_ratio: np.ndarray
    orbit: Orbit
    stable: np.ndarray
    sought: np.ndarray
    """Whether each orbit was found by the root finder, because the walk did not reach it."""


def stiff_start(nodes: Nodes) -> np.ndarray:
    """The limit of t = ϖε for ϖ → ∞, with the shape of the nodes.

    Examples
    --------
    Where the acceleration of the table balances gravity, Λ sin φ = 1, the load is zero:

    >>> from bouncing_ball.models.damping import Release
    >>> nodes = Nodes(Release.DISPLACEMENT, 1, np.array([1.0]), np.array([1.0]))
    >>> stiff_start(nodes).tolist()
    [0.0]
    """
    r = nodes.restitution
    zeta = nodes.damping_ratio
    fold = restitution_orbit.saddle_node(nodes.n, r)
    lift = np.sqrt((nodes.amplitude - fold) * (nodes.amplitude + fold))
    root = np.sqrt((1 - zeta) * (1 + zeta))
    return root * (1 + r) ** 2 * (1 - lift) / (2 * nodes.n * np.pi * r)


def extrapolated_values(at: np.ndarray, past: np.ndarray, to: np.ndarray) -> np.ndarray:
    """Values of the Lagrange polynomial through known values, at other points.

    Parameters
    ----------
    at : ndarray, shape (m,)
    past : ndarray, shape (m, ...)
        The known values at the points ``at``.
    to : ndarray, shape (k,)

    Returns
    -------
    ndarray, shape (k, ...)

    Examples
    --------
    >>> at, past = np.array([0.0, 1.0, 2.0]), np.array([0.0, 1.0, 4.0])
    >>> extrapolated_values(at, past, np.array([3.0])).tolist()
    [9.0]
    """
    places = range(len(at))
    weights = np.ones((len(to), len(at)))
    for i, j in permutations(places, 2):
        weights[:, i] *= (to - at[j]) / (at[i] - at[j])
    each = np.expand_dims(weights, tuple(range(2, past.ndim + 1)))
    # The rounding of a matrix product would depend on the number of nodes.
    return sum(each[:, i] * past[i] for i in places)


def correction(point: BranchPoint, amplitude: np.ndarray) -> np.ndarray:
    """The change d of ε that leads to Λ on the stable side, if X and Y are linear in ε.

    If the minimum of the parabola lies above Λ², the result is the d of the minimum. It has the
    broadcast shape of the fields of ``point`` and of ``amplitude``.
    """
    square = point.d_x * point.d_x + point.d_y * point.d_y
    above = point.x * point.x + point.y * point.y - amplitude * amplitude
    root = np.sqrt(np.maximum(point.fold * point.fold - square * above, 0.0))
    return -(point.fold + root) / square


def walk(nodes: Nodes, ratios: np.ndarray) -> Iterator[Stride]:
    """The orbits of the nodes at each ϖ, from the largest to the smallest.

    Parameters
    ----------
    nodes : Nodes
    ratios : ndarray
        ϖ, increasing.

    Yields
    ------
    Stride
        The orbits at :data:`TOGETHER` values of ϖ; the last stride may have fewer.
    """
    down = ratios[::-1]
    # The first step starts from the limit of t for ϖ → ∞.
    at = np.log(down[:1])
    past = stiff_start(nodes)[np.newaxis]
    for k in range(0, len(down), TOGETHER):
        ratio = down[k : k + TOGETHER, np.newaxis]
        contact = nodes.contact(ratio)
        along = np.log(ratio[:, 0])
        excess = extrapolated_values(at, past, along) / ratio
        for _ in range(1 if k else _FIRST_CORRECTIONS):
            excess = excess + correction(branch_point(excess, contact, nodes.n), nodes.amplitude)
        point = branch_point(excess, contact, nodes.n)
        at = along
        past = excess * ratio
        orbit = orbits_of_points(point, contact, nodes.n)
        stable = is_stable(point.trace, point.determinant)
        sought = ~(np.abs(point.amplitude / nodes.amplitude - 1) <= REACHED)
        if np.any(sought):
            orbit = _replaced(orbit, sought, contact, nodes)
            stable[sought] = orbit[sought].is_stable()
        yield Stride(ratio[:, 0], orbit, stable, sought)


def _replaced(orbit: Orbit, sought: np.ndarray, contact: SpringDamper, nodes: Nodes):
    """The orbits, where those that the walk did not reach are computed by the root finder."""
    asked = np.broadcast_to(nodes.amplitude, sought.shape)[sought]
    found = bifurcations.orbit_at(contact[sought], nodes.n, asked)
    names = ("amplitude", "phase", "contact_duration", "impact_velocity")
    columns = [np.array(getattr(orbit, name)) for name in names]
    for column, name in zip(columns, names, strict=True):
        column[sought] = getattr(found, name)
    return Orbit.of(ContactModel(contact), nodes.n, *columns)
