r"""Orbits at given Λ along ϖ, by walking on the branch and not by root finding.

On the branch of :mod:`bouncing_ball.orbits.closed_form` the product t = ϖε is almost
constant along ϖ, and (X, Y) almost a straight line along ε. So the walk comes down
from the stiffest contact. There the load a = 1 - Y alone delays the release, by
``(1 + r) a/(r v ϖ²)`` for both rules (:mod:`bouncing_ball.impacts.signature`), with
``v = 2nπ/(1 + r)``; in the contact's own angle ::

    t = √(1 - ζ²) (1 + r)² (1 - Y)/(2nπ r)

At each softer ϖ, t is extrapolated along ln ϖ from the last two, and corrected once:
with X and Y straight along ε, Λ² is a parabola, and of the two d with ::

    (X + X′d)² + (Y + Y′d)² = Λ²

the smaller one is that of the stable side. Two evaluations of the branch for each
orbit, where a bracketing root finder takes hundreds. What the walk gives is an orbit
of the closed form in any case; only its Λ is not exactly that asked for, and the
difference is known. Where it exceeds :data:`REACHED`, the orbit is looked for by
:func:`bouncing_ball.orbits.limits.orbit_at`, whose word is the last.
"""

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from bouncing_ball.atlas.plan import Nodes
from bouncing_ball.impacts.spring_damper import Contact
from bouncing_ball.orbits import limits, restitution_orbit
from bouncing_ball.orbits.closed_form import BranchPoint, branch_point
from bouncing_ball.orbits.contact_orbit import ContactOrbit
from bouncing_ball.orbits.stability import is_stable

REACHED = 1e-6
"""Relative distance of an orbit's Λ from that asked for. Errors are then those of an
orbit next to the node's, exact there; the walk mostly keeps within 1e-9."""
# The extrapolation has no past at the stiffest contact.
_FIRST_CORRECTIONS = 4


class Step(NamedTuple):
    """The orbits of the nodes at one ϖ; NaN where there is none."""

    frequency_ratio: float
    orbit: ContactOrbit
    stable: np.ndarray
    sought: np.ndarray
    """Whether each orbit was looked for, as the walk had not reached it."""


def stiff_start(nodes: Nodes) -> np.ndarray:
    """t = ϖε of the nodes as ϖ → ∞.

    Examples
    --------
    Where the table's acceleration balances gravity, Λ sin φ = 1, there is no load:

    >>> from bouncing_ball.impacts.release import Release
    >>> nodes = Nodes(Release.DISPLACEMENT, 1, np.array([1.0]), np.array([1.0]))
    >>> stiff_start(nodes).tolist()
    [0.0]
    """
    r, zeta = nodes.restitution, nodes.damping_ratio
    fold = restitution_orbit.saddle_node(nodes.n, r)
    lift = np.sqrt((nodes.amplitude - fold) * (nodes.amplitude + fold))
    root = np.sqrt((1 - zeta) * (1 + zeta))
    return root * (1 + r) ** 2 * (1 - lift) / (2 * nodes.n * np.pi * r)


def extrapolated(
    t: np.ndarray, before: np.ndarray | None, ratios: np.ndarray, k: int
) -> np.ndarray:
    """t at ``ratios[k]``, along ln ϖ from those at the two ratios before it."""
    if before is None:
        return t
    grown = np.log(ratios[k] / ratios[k - 1]) / np.log(ratios[k - 1] / ratios[k - 2])
    return t + grown * (t - before)


def correction(point: BranchPoint, amplitude: np.ndarray) -> np.ndarray:
    """The d by which ε reaches Λ on the stable side, with X and Y straight along ε.

    Where the parabola does not come down to Λ², the d of its lowest point.
    """
    square = point.d_x * point.d_x + point.d_y * point.d_y
    above = point.x * point.x + point.y * point.y - amplitude * amplitude
    root = np.sqrt(np.maximum(point.fold * point.fold - square * above, 0.0))
    return -(point.fold + root) / square


def walk(nodes: Nodes, ratios: np.ndarray) -> Iterator[Step]:
    """The orbits of the nodes at each ϖ, from the largest to the smallest.

    Parameters
    ----------
    nodes : Nodes
    ratios : ndarray
        ϖ, increasing.
    """
    down, before, t = ratios[::-1], None, stiff_start(nodes)
    for k, ratio in enumerate(down):
        contact = nodes.contact(ratio)
        excess = extrapolated(t, before, down, k) / ratio
        for _ in range(1 if k > 1 else _FIRST_CORRECTIONS):
            excess = excess + correction(branch_point(excess, contact, nodes.n), nodes.amplitude)
        point = branch_point(excess, contact, nodes.n)
        before, t = (t if k else None), excess * ratio
        orbit = ContactOrbit.from_branch(point, contact, nodes.n)
        stable = is_stable(point.trace, point.determinant)
        sought = ~(np.abs(point.amplitude / nodes.amplitude - 1) <= REACHED)
        if np.any(sought):
            orbit = _replaced(orbit, sought, contact, nodes)
            stable[sought] = orbit[sought].is_stable()
        yield Step(float(ratio), orbit, stable, sought)


def _replaced(orbit: ContactOrbit, sought: np.ndarray, contact: Contact, nodes: Nodes):
    """The orbits, those not reached by the walk looked for directly."""
    found = limits.orbit_at(contact[sought], nodes.n, nodes.amplitude[sought])
    names = ("amplitude", "phase", "contact_duration", "impact_velocity")
    columns = [np.array(getattr(orbit, name)) for name in names]
    for column, name in zip(columns, names, strict=True):
        column[sought] = getattr(found, name)
    return ContactOrbit.of(nodes.n, contact, *columns)
