"""Find all n-T orbits of instantaneous impacts: the roots of two scalar equations.

An n-T orbit has one impact in n periods of the table. The ball falls from the height to which it
rises, so its velocity is nπ just after an impact and -nπ just before. The closing speed u and the
phase τ of the impact thus satisfy

    (1 + r(u)) u = 2nπ,    ΛW′(τ) = u - nπ.
"""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from bouncing_ball_beyond.contacts.balls import Ball
from bouncing_ball_beyond.contacts.resolution import SEGMENTS, H, roots
from bouncing_ball_beyond.tables.table import PERIOD, Table

OF_CONTACTS = 8
"""As `SEGMENTS`, for the r(u) of contacts, which is smooth and may take long to compute."""


def closing_speeds(ball: Ball, n: int) -> NDArray:
    """Find all roots u of (1 + r(u)) u = 2nπ.

    There is one root if r is constant or rises, or if it falls so slowly that (1 + r(u)) u rises.
    Others are found to a resolution: r must not leave its course and return to it within a range of
    nπ divided by `SEGMENTS`, or by `OF_CONTACTS` if the r(u) is that of a contact.
    """
    half = n * np.pi
    of_contacts = ball.has_duration or ball.below_table

    def excess(u: NDArray) -> Any:
        r = ball.signature(u.ravel()).restitution
        # The free impacts of a contact may not end, but an r(u) must be known.
        if not (of_contacts or np.isfinite(r).all()):
            place = u.ravel()[~np.isfinite(r)][0].real
            raise ValueError(
                f"restitution: r(u), or its derivative, is not finite near u = {place:.4g}; {n}-T"
                f" orbits close at u from {half:.4g} to {2 * half:.4g}"
            )
        return (1 + r.reshape(u.shape)) * u - 2 * half

    return roots(excess, half, 2 * half, half, OF_CONTACTS if of_contacts else SEGMENTS)


def around(function: Any, size: float) -> NDArray:
    """Find all roots of a function of the phase in [0, 2π)."""
    phases = roots(function, 0.0, PERIOD, size) % PERIOD
    return np.unique(np.where(PERIOD - phases < 1e-12, 0.0, phases))


def instants(
    ball: Ball, n: int, amplitude: float, table: Table, speeds: NDArray | None = None
) -> NDArray:
    """Find the τ and u of all n-T orbits with the r(u) of a ball, shape (orbits, 2).

    The closing ``speeds`` may be given, if they are known.
    """
    size = amplitude * table.bounds[1]
    orbits = [
        (tau, u)
        for u in (closing_speeds(ball, n) if speeds is None else speeds)
        for tau in around(lambda tau, u=u: amplitude * table(tau, 1) - (u - n * np.pi), size)
    ]
    return np.reshape(orbits, (-1, 2))


def folds(n: int, table: Table, speeds: NDArray) -> NDArray:
    """Find the Λ, τ and u of the saddle-nodes of n-T orbits that close at ``speeds``.

    Returns an array of the shape (folds, 3).

    There is one for each speed and each phase at which the rate of the table is largest.
    """
    rises = around(lambda tau: table(tau, 2), table.bounds[2])
    rises = rises[(table(rises, 1) > 0) & (table(rises, 3) < 0)]
    saddle_nodes = [((u - n * np.pi) / table(tau, 1), tau, u) for u in speeds for tau in rises]
    return np.reshape(saddle_nodes, (-1, 3))


def others(rows: NDArray, speeds: NDArray, tau: float, u: float) -> NDArray:
    """Leave out the row (..., τ, u) to which an impact belongs, if there is one.

    The impact belongs to the nearest of the closing ``speeds``, and to the nearest phase.
    """
    if not len(rows):
        return rows
    own = speeds[np.argmin(np.abs(speeds - u))]
    apart = np.abs((rows[:, -2] - tau + np.pi) % PERIOD - np.pi)
    apart = np.where(rows[:, -1] == own, apart, np.inf)
    return rows[(np.arange(len(rows)) != np.argmin(apart)) | np.isinf(apart)]


def same_side(rows: NDArray, ball: Ball, table: Table, side: int) -> NDArray:
    """Select the rows (τ, u) where 1 - tr/(1 + det) has the sign ``side``."""
    tau, u = rows.T + 1j * H * np.array([[0.0], [1.0]])
    slope = np.imag((1 + ball.signature(u).restitution) * u) / H if u.size else u.real
    return rows[np.sign(-table(tau.real, 2) * slope) == side]


def named(orbits: NDArray) -> str:
    """Text of orbits (τ, u): the phase and the closing speed of each, but of four at most."""
    texts = [f"u = {u:.6g} at phase {np.pi - (np.pi - tau) % PERIOD:.6g}" for tau, u in orbits[:4]]
    return "; ".join([*texts, *(["…"] if len(orbits) > 4 else [])])


def where_begun(saddle_nodes: NDArray) -> str:
    """Text of saddle-nodes (Λ, τ, u): where other orbits begin, but of four at most."""
    saddle_nodes = saddle_nodes[np.argsort(saddle_nodes[:, 0])]
    texts = [f"near Λ = {amplitude:.6g} with u = {u:.6g}" for amplitude, _, u in saddle_nodes[:4]]
    return ", ".join([*texts, *(["…"] if len(saddle_nodes) > 4 else [])])
