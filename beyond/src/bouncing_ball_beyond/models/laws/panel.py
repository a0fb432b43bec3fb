r"""A panel of a contact of any law: the equations of motion in it, and its Gauss nodes.

A law with the root m is smooth in ``q = p^{1/m}`` and p′. In a new time s the motion is therefore
smooth even at the ends of the contact, where p = 0 ::

    dq/ds = p′,    dp′/ds = F = λ [a - f(p, p′)],    dt/ds = λ = m q^{m-1}

with the load ``a = w - Λ sin(φ + t)``. The contact is divided into panels. In each, the motion is
known by its values at 12 Gauss nodes, or 16 if derivatives are computed.
:mod:`bouncing_ball_beyond.models.laws.sweeps` computes them.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import lru_cache
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from bouncing_ball_beyond.models.laws.force_law import ForceLaw

NODES = 12
"""Number of nodes of a panel without derivatives."""
FINER = 16
"""Number of nodes of a panel with derivatives. Their Legendre coefficients are larger by about the
number of nodes, so that more nodes are needed for the same error of the end."""
IMAGINARY_STEP = 1e-20j
"""An imaginary step in s, whose square is lost in rounding."""
# The imaginary step of a slope, relative to p and absolute for p′; its square is lost in rounding.
_IMAGINARY = 1e-20
# The number of the last Legendre coefficients.
_TAIL = 2


class Slopes(NamedTuple):
    """Partial derivatives of a function of (p, p′), arrays of the shape of the arguments."""

    by_penetration: np.ndarray
    by_rate: np.ndarray


def slopes_of(function: Callable, penetration: ArrayLike, rate: ArrayLike) -> Slopes:
    """Partial derivatives by imaginary steps, exact up to rounding for an analytic function.

    Examples
    --------
    >>> slopes = slopes_of(lambda p, u: p**1.5 * u, 4.0, 3.0)
    >>> round(float(slopes.by_penetration), 12), round(float(slopes.by_rate), 12)
    (9.0, 8.0)
    """
    p = np.asarray(penetration, dtype=float)
    u = np.asarray(rate, dtype=float)
    small = _IMAGINARY * np.where(p > 0, p, 1.0)
    by_penetration = np.imag(function(p + 1j * small, u)) / small
    by_rate = np.imag(function(p, u + 1j * _IMAGINARY)) / _IMAGINARY
    return Slopes(by_penetration, by_rate)


class Start(NamedTuple):
    """Starts of contact, one-dimensional arrays.

    The fields are p, p′, the table's phase φ, Λ, and the weight w, which is 1, or 0 for a free
    impact.
    """

    depth: np.ndarray
    rate: np.ndarray
    phase: np.ndarray
    amplitude: np.ndarray
    weight: np.ndarray


class BallsInContact(NamedTuple):
    """Balls in contact: q, p′, t and F, the length of the next panel, and the scales P and V.

    ``side`` is the sign of the law's :meth:`~.ForceLaw.kink` in the state of the ball.
    """

    root: np.ndarray
    rate: np.ndarray
    time: np.ndarray
    push: np.ndarray
    step: np.ndarray
    length: np.ndarray
    speed: np.ndarray
    side: np.ndarray


class Panel(NamedTuple):
    """A panel of each ball: q, p′ and t at its nodes and its end, and F at the nodes.

    ``final`` is F at the end, ``step`` the length of the panel and ``following`` that of the next;
    ``good`` marks accurate panels, ``last`` those that end the contact, ``surfaced`` those of them
    that end at p = 0 with a positive grip, and ``turned`` those that end at a kink of the law.
    """

    root: np.ndarray
    rate: np.ndarray
    time: np.ndarray
    push: np.ndarray
    final: np.ndarray
    step: np.ndarray
    following: np.ndarray
    good: np.ndarray
    last: np.ndarray
    surfaced: np.ndarray
    turned: np.ndarray


class GaussRule(NamedTuple):
    """Gauss nodes in (0, 1), and matrices that act on the values at the nodes.

    ``integral`` gives the integrals from 0 to each node and to 1, ``twice`` the integrals of these
    integrals from 0 to each node, ``tail`` the last Legendre coefficients, and ``end`` the value
    at 1.
    """

    node: np.ndarray
    integral: np.ndarray
    twice: np.ndarray
    tail: np.ndarray
    end: np.ndarray


@lru_cache(maxsize=4)
def gauss_rule(count: int) -> GaussRule:
    """The rule with this number of nodes; ``node`` is a column."""
    legendre = np.polynomial.legendre
    degree = np.arange(count)
    x, weight = legendre.leggauss(count)
    spectrum = (degree + 0.5)[:, np.newaxis] * legendre.legvander(x, count - 1).T * weight
    sums = legendre.legval(np.append(x, 1.0), legendre.legint(np.eye(count), lbnd=-1)).T
    integral = sums / 2 @ spectrum
    return GaussRule(
        node=(1 + x[:, np.newaxis]) / 2,
        integral=integral,
        twice=integral[:-1] @ integral[:-1],
        tail=spectrum[-_TAIL:],
        end=spectrum.sum(0),
    )


def lever_of(m: int, root: np.ndarray, out: np.ndarray | None = None) -> np.ndarray:
    """λ = dp/dq = m q^{m-1}, by products, which cost less than a power."""
    lever = np.empty_like(root) if out is None else out
    lever[...] = m
    for _ in range(m - 1):
        lever *= root
    return lever


def load_of(start: Start, time: np.ndarray) -> np.ndarray:
    """a = w - Λ sin(φ + t), by the tangent of the half angle, which costs less than a sine."""
    tangent = start.phase + time
    tangent *= 0.5
    np.tan(tangent, out=tangent)
    square = tangent * tangent
    square += 1
    tangent *= 2 * start.amplitude
    tangent /= square
    return np.subtract(start.weight, tangent, out=tangent)


def grip_of(law: ForceLaw, m: int, root: Any, rate: Any) -> Any:
    """The function that vanishes at the release: the grip, or q if the grip is a power of q."""
    if law.release.at_surface:
        return root
    grip = law.grip(root**m, rate)
    return grip if law.lag is None else np.where(law.lag == 0, root, grip)


def selected(which: np.ndarray, law: ForceLaw, *rows: Any) -> Any:
    """The laws of some of the contacts, and tuples of arrays whose last axis is the contacts.

    The indices are in ascending order, so that all of them select the rows themselves.
    """
    if which.size == rows[-1][0].shape[-1]:
        return law, *rows
    return law.take(which), *(row._make(x[..., which] for x in row) for row in rows)
