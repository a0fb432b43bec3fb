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

    def excess(u: NDArray) -> Any:
        return (1 + ball.signature(u.ravel()).restitution.reshape(u.shape)) * u - 2 * half

    of_contacts = ball.has_duration or ball.below_table
    return roots(excess, half, 2 * half, half, OF_CONTACTS if of_contacts else SEGMENTS)


def around(function: Any, size: float) -> NDArray:
    """Find all roots of a function of the phase in [0, 2π)."""
    found = roots(function, 0.0, PERIOD, size) % PERIOD
    return np.unique(np.where(PERIOD - found < 1e-12, 0.0, found))


def instants(ball: Ball, n: int, amplitude: float, table: Table) -> NDArray:
    """Find the τ and u of all n-T orbits with the r(u) of a ball, shape (orbits, 2)."""
    size = amplitude * table.bounds[1]
    found = [
        (tau, u)
        for u in closing_speeds(ball, n)
        for tau in around(lambda tau, u=u: amplitude * table(tau, 1) - (u - n * np.pi), size)
    ]
    return np.reshape(found, (-1, 2))


def folds(ball: Ball, n: int, table: Table) -> NDArray:
    """Find the Λ, τ and u of all saddle-nodes of n-T orbits with the r(u), shape (folds, 3).

    There is one for each closing speed and each phase at which the rate of the table is largest.
    """
    rises = around(lambda tau: table(tau, 2), table.bounds[2])
    rises = rises[(table(rises, 1) > 0) & (table(rises, 3) < 0)]
    found = [
        ((u - n * np.pi) / table(tau, 1), tau, u) for u in closing_speeds(ball, n) for tau in rises
    ]
    return np.reshape(found, (-1, 3))


def not_near(found: NDArray, tau: float, u: float) -> NDArray:
    """Leave out the row (..., τ, u) of an array that is nearest to an impact."""
    apart = np.abs((found[:, -2] - tau + np.pi) % PERIOD - np.pi) + np.abs(found[:, -1] - u)
    return found[np.arange(len(found)) != np.argmin(apart)] if len(found) else found


def same_side(found: NDArray, ball: Ball, table: Table, turn: float) -> NDArray:
    """Select the rows (τ, u) on one side of their saddle-node: that with this tr/(1 + det)."""
    tau, u = found.T
    if not len(u):
        return found
    r = ball.signature(u + 1j * H).restitution * (u + 1j * H)
    return found[np.sign(-table(tau, 2) * (1 + r.imag / H)) == np.sign(1 - turn)]
