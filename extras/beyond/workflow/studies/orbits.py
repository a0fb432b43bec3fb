"""Random n-T orbits, orbits that meet further conditions, and the zeros of errors along ϖ."""

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import brentq

from bouncing_ball.restitution import period_doubling, saddle_node
from bouncing_ball_beyond.contacts.balls import H, SpringDamper, damping_of
from bouncing_ball_beyond.periodic.chains import solve_bordered
from bouncing_ball_beyond.periodic.continuation import follow
from bouncing_ball_beyond.periodic.equations import OrbitEquations
from bouncing_ball_beyond.periodic.orbits import OrbitNotFound, orbit

COMPLIANT = 1.4
"""Contacts with a smaller ϖ are too compliant for the error law to tell where their orbits are."""


def random_orbits(
    size: int, seed: int, release: str, places: tuple[float, float] = (0.0, 1.0)
) -> tuple[NDArray, NDArray, NDArray, np.random.Generator]:
    """Random (n, ζ, Λ) in the stable range of the restitution model, and the generator.

    r is uniform between 0.05 and 0.98, or from 0.15 with the force release, whose contacts have
    r > e⁻²; n is uniform from 1 to 5, and Λ uniform in the part `places` of the range from the
    saddle-node (0) to the period doubling (1).
    """
    rng = np.random.default_rng(seed)
    r = rng.uniform(0.15 if release == "force" else 0.05, 0.98, size)
    n = rng.integers(1, 6, size)
    low = saddle_node(n, r)
    amplitude = low + rng.uniform(*places, size) * (period_doubling(n, r) - low)
    return n, damping_of(r, release), amplitude, rng


def follow_compliant(ball: SpringDamper, n: NDArray, exact: dict[str, NDArray]) -> None:
    """Replace the saddle-nodes of compliant contacts by those on the branches down from the period
    doublings.
    """
    some = (ball.frequency_ratio < COMPLIANT) & np.isfinite(exact["period_doubling"])
    values = {name: value[some] for name, value in ball.parameters.items()}
    starts = orbit(ball.at(**values), amplitude=0.999 * exact["period_doubling"][some], n=n[some])
    nodes = []
    for branch in follow(starts, to=1e-3):
        special = [] if isinstance(branch, OrbitNotFound) else branch.special
        nodes.append(next((node for node in special if node.kind == "saddle-node"), None))
    exact["saddle_node"][some] = [node.amplitude if node else np.nan for node in nodes]


def flight_height(equations: OrbitEquations, z: NDArray) -> NDArray:
    """The heights of the summits of flights after one impact, shape (rows,)."""
    ends = equations.ends(z)
    bounce = ends.speed + ends.amplitude * np.cos(ends.leaves)
    return (ends.gap + ends.amplitude * np.sin(ends.leaves) + bounce**2 / 2)[:, 0]


def solved(
    equations: OrbitEquations,
    z: NDArray,
    conditions: Callable[[NDArray], NDArray],
    iterations: int = 10,
) -> NDArray:
    """Orbits near rows z that meet as many further conditions as parameters change.

    `conditions` are zero then: an analytic function of rows with the shape (rows, p). Each step of
    Newton's method doubles the digits of a near guess.
    """
    steps = 1j * H * np.eye(z.shape[1])
    for _ in range(iterations):
        linear = equations.linearized(z)
        gradient = np.stack([conditions(z + step).imag / H for step in steps], axis=-1)
        values = linear.legs[..., np.newaxis], gradient, conditions(z)[..., np.newaxis]
        z = z - solve_bordered(linear.derivatives, *values)[..., 0]
    return z


def last_zero(ratios: NDArray, errors: NDArray, at: Callable[[float], float]) -> float:
    """The largest ϖ at which an error passes through zero; NaN if there is none on the grid.

    Where it changes its sign through infinity there is no zero.

    Examples
    --------
    >>> grid = np.geomspace(1, 1e4, 8)
    >>> round(last_zero(grid, grid - 100, lambda ratio: ratio - 100), 9)
    100.0
    >>> last_zero(grid, 1 / (grid - 100), lambda ratio: 1 / (ratio - 100))
    nan
    """
    turns = np.flatnonzero(errors[1:] * errors[:-1] < 0)
    if turns.size == 0:
        return np.nan
    last = turns[-1]
    ends = np.log(ratios[last : last + 2])
    zero = np.exp(brentq(lambda logarithm: at(np.exp(logarithm)), *ends, xtol=1e-12))
    beside = np.abs(errors[last : last + 2]).max()
    return float(zero) if abs(at(zero)) < beside else np.nan
