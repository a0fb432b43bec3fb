r"""How stiff a contact must be for the greatest height, over the stable orbits (beyond the paper).

The map has the ϖ from which on the height of the restitution model is within a tolerance ε, over n,
r and Λ. At each of its nodes a contact with the displacement release, whose damping follows from r
by Eq. 16, is compared with the restitution model at the same Λ (Eq. 37). Λ is given by its position
p in the stable range of the restitution model ::

    Λ = Λ_SN + p (Λ_PD - Λ_SN)

Next to the saddle-node the error changes with √p, so that the positions, p = sin² of evenly spaced
angles, are dense there, and at the period doubling as well.

The orbits are points of the explicit branch
(:mod:`bouncing_ball_beyond.periodic.one_impact.spring_damper_branch`), whose parameter is the
excess angle of the contact. From the free contact, whose excess angle is 0, a few steps of Newton's
method lead to the Λ of the node: along the branch (X, Y) = Λ (cos φ, sin φ) is almost a straight
line, on which the change of the angle to a given Λ solves a quadratic equation; the smaller
solution belongs to the stable side of the saddle-node.

Beside the ϖ by the branch the map has the ϖ by the error law, which is a closed formula
(:func:`~bouncing_ball_beyond.accuracy.error_law.law_thresholds`).
"""

from typing import Annotated, NamedTuple

import numpy as np
import xarray as xr
from pydantic import Field

from bouncing_ball_beyond.accuracy.error_law import law_thresholds
from bouncing_ball_beyond.accuracy.errors import paper_error
from bouncing_ball_beyond.inherited.accuracy.errors import Quantity
from bouncing_ball_beyond.inherited.accuracy.thresholds import ThresholdStatus, thresholds
from bouncing_ball_beyond.inherited.datasets.parameters import (
    Family,
    Interval,
    LossyRestitution,
    Many,
    Parameters,
    Samples,
    Span,
    Tolerance,
)
from bouncing_ball_beyond.inherited.datasets.variables import Variable, described
from bouncing_ball_beyond.inherited.periodic.restitution_branch import (
    restitution_period_doubling,
    restitution_saddle_node,
)
from bouncing_ball_beyond.models.damping import damping_ratio
from bouncing_ball_beyond.models.laws.signature import Signature
from bouncing_ball_beyond.models.spring_damper import SpringDamper
from bouncing_ball_beyond.periodic.one_impact.spring_damper_bifurcations import orbit_at
from bouncing_ball_beyond.periodic.one_impact.spring_damper_branch import (
    branch_point,
    excess_angle,
    orbits_on_branch,
)
from bouncing_ball_beyond.periodic.orbits.orbit import Orbit

VARIABLES = {
    "threshold_by_law": Variable(
        "frequency ratio for the tolerance of the height by the error law", symbol="ϖ"
    ),
    "position": Variable(
        "position of the amplitude in the stable range of the restitution model, 0 at the "
        "saddle-node and 1 at the period doubling",
        symbol="p",
    ),
    "law_differs_above": Variable("share by which both frequency ratios differ where it is marked"),
    "rule_product": Variable(
        "n times the frequency ratio times the error, at the threshold; its modulus is at most 1 "
        "where the frequency ratio 1/(nε) is enough",
        symbol="nϖe",
        budget=1e-10,
    ),
}

# Newton's method doubles the digits in each step; eight steps are enough at every node of the map.
_STEPS = 10
# The relative difference from the Λ of the node up to which an orbit is that of the node; rounding
# leaves some 1e-14.
_REACHED = 1e-12


class RestitutionAxis(Interval):
    """Evenly spaced restitution coefficients."""

    min: Annotated[LossyRestitution, Field(description="smallest r")]
    max: Annotated[LossyRestitution, Field(description="largest r, above min")]
    samples: Samples

    def grid(self) -> np.ndarray:
        """The restitution coefficients, rounded to 12 decimals, shape (samples,)."""
        return np.round(np.linspace(self.min, self.max, self.samples), 12)


class StiffnessMap(Parameters):
    """The nodes of the map, the ϖ in which thresholds are sought, and the tolerated error."""

    n: Many[Family]
    restitution: RestitutionAxis
    positions: Samples
    frequency_ratio: Span
    tolerance: Tolerance


class Nodes(NamedTuple):
    """Orbits of the restitution model, one at each node of the map; arrays of one shape."""

    n: np.ndarray
    restitution: np.ndarray
    amplitude: np.ndarray

    @classmethod
    def at(cls, n: np.ndarray, restitution: np.ndarray, position: np.ndarray) -> "Nodes":
        """The nodes at these positions in the stable range; the arguments broadcast."""
        low = restitution_saddle_node(n, restitution)
        high = restitution_period_doubling(n, restitution)
        return cls(*np.broadcast_arrays(n, restitution, low + position * (high - low)))

    def take(self, which: np.ndarray) -> "Nodes":
        """The nodes with these numbers, in one row."""
        return Nodes(*(np.ravel(column)[which] for column in self))

    @property
    def lift(self) -> np.ndarray:
        """Λ sin φ of the restitution model's orbit."""
        fold = restitution_saddle_node(self.n, self.restitution)
        return np.sqrt((self.amplitude - fold) * (self.amplitude + fold))

    @property
    def height(self) -> np.ndarray:
        """max z of the restitution model: the ball leaves the height Λ sin φ with nπ."""
        return self.lift + (self.n * np.pi) ** 2 / 2

    def orbits(self, frequency_ratio: np.ndarray) -> Orbit:
        """The contact's orbits at the Λ of the nodes, NaN where there is none.

        Newton's method does not reach every orbit of contacts with ϖ below 2; the others are
        bracketed by :func:`.spring_damper_bifurcations.orbit_at`.
        """
        contact = SpringDamper(frequency_ratio, damping_ratio(self.restitution))
        excess = np.zeros(self.amplitude.shape)
        for _ in range(_STEPS):
            point = branch_point(excess, contact, self.n)
            square = point.d_x**2 + point.d_y**2
            above = point.x**2 + point.y**2 - self.amplitude**2
            # Without a solution the step leads to the smallest Λ of the straight line.
            root = np.sqrt(np.maximum(point.fold**2 - square * above, 0))
            excess = excess - (point.fold + root) / square
        found = branch_point(excess, contact, self.n).amplitude
        lost = np.flatnonzero(~(np.abs(found / self.amplitude - 1) <= _REACHED))
        if lost.size:
            of_lost = contact[lost]
            sought = orbit_at(of_lost, self.n[lost], self.amplitude[lost])
            excess[lost] = excess_angle(of_lost, sought.contact_duration)
        return orbits_on_branch(excess, contact, self.n)


def height_errors(nodes: Nodes, frequency_ratio: np.ndarray) -> np.ndarray:
    """The paper's errors of the restitution model's greatest height (Eq. 37), NaN without an orbit.

    Parameters
    ----------
    nodes : Nodes
        Nodes in one row, shape (k,).
    frequency_ratio : ndarray, shape (k,)
        ϖ of the contact at each node.

    Examples
    --------
    The threshold of Fig. 14, printed as "≈ 82":

    >>> node = Nodes(np.array([1]), np.array([0.65]), np.array([1.0]))
    >>> height_errors(node, np.array([82.17735912])).round(10).tolist()
    [-0.01]
    """
    orbits = nodes.orbits(frequency_ratio)
    return paper_error(exact=orbits.max_height, simple=nodes.height)


def law_ratios(nodes: Nodes, tolerance: float) -> np.ndarray:
    """The ϖ from which on the height is within the tolerance by the error law, at each node.

    Examples
    --------
    >>> node = Nodes(np.array([1]), np.array([0.65]), np.array([1.0]))
    >>> law_ratios(node, 0.01).round(2).tolist()
    [82.18]
    """
    unit = Signature(SpringDamper(1.0, damping_ratio(nodes.restitution)))()
    # The r of the contact differs by rounding, which matters at the saddle-node.
    instant = unit._replace(restitution=nodes.restitution)
    needed = law_thresholds(nodes.n, instant, nodes.amplitude, (-tolerance, tolerance))
    return needed[Quantity.MAX_HEIGHT]


def stiffness_map(parameters: StiffnessMap) -> xr.Dataset:
    """The ϖ from which on the greatest height of the restitution model is within the tolerance.

    Over (n, restitution, position) the dataset has ``amplitude``, Λ; ``error_threshold``, the ϖ
    from which on the modulus of the error is within the tolerance; ``threshold_by_law``, the ϖ by
    the error law, and the share ``law_differs_above`` above which a difference is marked; and
    ``rule_product``, nϖe with the signed error e at the first ϖ. That and the first ϖ are NaN where
    the contact has no stable and admissible orbit at this ϖ, and where the error is not within the
    tolerance at the largest ϖ of the range.
    """
    r = parameters.restitution.grid()
    position = np.sin(np.linspace(0.0, np.pi / 2, parameters.positions)) ** 2
    family = np.array(parameters.n)
    nodes = Nodes.at(family[:, np.newaxis, np.newaxis], r[:, np.newaxis], position)
    size = nodes.amplitude.size
    ratios = parameters.frequency_ratio.grid()

    def error(ratio: np.ndarray, which: np.ndarray) -> np.ndarray:
        return height_errors(nodes.take(which), ratio)

    every, place = np.divmod(np.arange(size * ratios.size), ratios.size)
    scanned = error(ratios[place], every).reshape(size, ratios.size)
    found = thresholds(error, ratios, scanned, [parameters.tolerance])
    is_known = found.status[:, 0] == ThresholdStatus.FOUND
    is_outside = found.status[:, 0] == ThresholdStatus.NEVER_WITHIN
    # Within the tolerance at every ϖ, the error is within it from the smallest on.
    start = np.where(is_known, found.ratio[:, 0], ratios[0])
    row = nodes.take(np.arange(size))
    orbits = row.orbits(start)
    exists = orbits.is_stable() & orbits.is_admissible()
    threshold = np.where(exists & ~is_outside, start, np.nan)
    product = row.n * threshold * paper_error(exact=orbits.max_height, simple=row.height)
    shape = nodes.amplitude.shape
    dims = ("n", "restitution", "position")
    return described(
        {
            "amplitude": (dims, nodes.amplitude),
            "error_threshold": (dims, threshold.reshape(shape)),
            "law_differs_above": 0.1,
            "threshold_by_law": (dims, law_ratios(nodes, parameters.tolerance)),
            "rule_product": (dims, product.reshape(shape)),
        },
        coords={"n": family, "restitution": r, "position": position},
        variables=VARIABLES,
    )
