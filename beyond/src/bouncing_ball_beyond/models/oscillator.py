r"""Exact responses of a damped linear oscillator, for every damping.

A linear contact is an oscillator, ``y″ + 2a y′ + q y = f(s)`` with
``a = ζϖ`` and ``q = ϖ²``. The model needs two responses:

* the impulse response *g* (f = 0, y(0) = 0, y′(0) = 1);
* the exponential response *h* (f = e^{νs}, y(0) = y′(0) = 0), with ν = 0 for
  gravity and ν = i for the table.

Let ``w = q - a²``, ``C = cos(√w s)`` and ``S = sin(√w s)/√w``. C and S are entire functions
of w, so that underdamped, critical and overdamped contacts need no distinction::

    g  = e^{-as} S                g′ = e^{-as} (C - a S)
    h  = [e^{νs} - g′ - (ν + 2a) g] / p(ν),      p(ν) = ν² + 2aν + q
    h′ = ν h + g

The quotient for *h* has a removable singularity at resonance, p(ν) = 0 (ζ = 0, ϖ = 1 for the
table), and loses digits to cancellation for short times. In these cases the integrals are
computed instead, with enough Gauss nodes for double precision::

    h = ∫₀ˢ g(s - u) e^{νu} du

All quantities are dimensionless; all functions broadcast.
"""

from functools import lru_cache
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

# Below this |p(ν)| s² the quotient for h is not used: its numerator is about p s²/2, but
# the terms of the numerator are of order 1, so that they cancel when |p| s² is small.
_CANCELLATION = 4.0
# The same bound where the values of the responses are needed and not their derivatives: the terms
# exceed the result by a factor of 16 at most.
_OF_VALUES = np.array(0.5)
_SQUARED = _OF_VALUES * _OF_VALUES
_TWO = np.array(2.0)
_ONE = np.array(1.0)
# Nodes of the integral, to which one node is added for each radian of the table. Where the
# integral is used the phase of the integrand changes by (1 + ϖ) s ≤ 2s + 2, and these nodes
# resolve it to rounding.
_NODES = 20
# Longer integrals are divided into panels of at most this many radians of the table, because
# the cost of computing the nodes of one panel grows with the cube of their number.
_PANEL = 200
# Number of contacts integrated at the same time, chosen such that the nodes stay in the cache.
_BLOCK = 512


class Response(NamedTuple):
    """A response y(s) and its rate of change y′(s)."""

    value: np.ndarray
    rate: np.ndarray


class Responses(NamedTuple):
    """The responses at a time, as arrays of one shape.

    ``impulse`` is g, ``gravity`` the response G to a constant unit force, and ``table`` is
    h = Q + iP, the complex response to e^{is}.
    """

    impulse: Response
    gravity: Response
    table: Response


# What remains of an oscillation after a long time may be below the smallest number, and is then 0,
# whatever the caller lets numpy do.
@np.errstate(under="ignore")
def _damped(s, a, q, w):
    """e^{-as} times C and S, for any sign of w = q - a²."""
    root = np.sqrt(np.abs(w))
    divisor = np.where(root > 0, root, 1.0)
    decay = np.exp(-a * s)
    c = decay * np.cos(root * s)
    sn = decay * np.where(root > 0, np.sin(root * s) / divisor, s)
    overdamped = w < 0
    if np.any(overdamped):
        # The slow exponent √-w - a is written as -q/(√-w + a), which has no cancellation and,
        # for a > 0, no overflow.
        slow = np.exp(np.where(overdamped, -q / np.where(overdamped, root + a, 1.0) * s, 0.0))
        lost = np.expm1(np.where(overdamped, -2 * root * s, 0.0))
        c = np.where(overdamped, slow * (1 + lost / 2), c)
        sn = np.where(overdamped, -slow * lost / (2 * divisor), sn)
    return c, sn


@lru_cache(maxsize=_PANEL)
def _rule(count: int) -> tuple[np.ndarray, np.ndarray]:
    """Gauss's nodes and weights on [-1, 1]; long integrals of all lengths need few of these."""
    return np.polynomial.legendre.leggauss(count)


@lru_cache(maxsize=64)
def _gauss(radians: int) -> tuple[np.ndarray, np.ndarray]:
    """Nodes and weights on [0, 1] for an integral over this many radians of the table."""
    panels = 1 + radians // _PANEL
    # Rounded up to a whole number of radians in a panel.
    radians_each = -(-radians // panels)
    x, weight = _rule(_NODES + radians_each)
    start = np.arange(panels)[:, np.newaxis]
    nodes = ((start + (1 + x) / 2) / panels).ravel()
    return nodes, np.tile(weight / (2 * panels), panels)


@np.errstate(under="ignore")
def _integrated(nu, s, a, q, w):
    """h from its integral, for one-dimensional arrays of contacts."""
    nodes, weights = _gauss(int(np.max(np.abs(s))))
    s, a, q, w = (column[:, np.newaxis] for column in (s, a, q, w))
    impulse = _damped(s * (1 - nodes), a, q, w)[1]
    return (s * weights * impulse * np.exp(nu * s * nodes)).sum(axis=1)


@np.errstate(under="ignore")
def _exponential(nu, s, a, q, w, impulse: Response) -> Response:
    """The response to e^{νs} from rest; real for ν = 0."""
    g = impulse.value
    p = nu * nu + 2 * a * nu + q
    delicate = np.abs(p) * s * s < _CANCELLATION
    divisor = np.where(delicate, 1.0, p)
    h = np.asarray((np.exp(nu * s) - impulse.rate - (nu + 2 * a) * g) / divisor)
    which = np.flatnonzero(delicate)
    for start in range(0, which.size, _BLOCK):
        at = which[start : start + _BLOCK]
        h.flat[at] = _integrated(nu, *(x.flat[at] for x in (s, a, q, w)))
    return Response(h, nu * h + g)


def responses(time: ArrayLike, frequency_ratio: ArrayLike, damping_ratio: ArrayLike) -> Responses:
    """The responses of the contact a time s after its start.

    Parameters
    ----------
    time, frequency_ratio, damping_ratio : array_like
        s, ϖ > 0 and ζ ≥ 0, which broadcast. Their ranges are not checked.

    Examples
    --------
    At critical damping ``g = s e^{-s}``:

    >>> bool(np.isclose(responses(2.0, 1.0, 1.0).impulse.value, 2 * np.exp(-2)))
    True

    A constant unit force on a nearly free mass gives s²/2:

    >>> round(float(responses(3.0, 1e-9, 0.0).gravity.value), 12)
    4.5
    """
    columns = _columns(time, frequency_ratio, damping_ratio)
    impulse = impulse_response(time, frequency_ratio, damping_ratio)
    return Responses(
        impulse=impulse,
        gravity=_exponential(0, *columns, impulse),
        table=_exponential(1j, *columns, impulse),
    )


def impulse_response(
    time: ArrayLike, frequency_ratio: ArrayLike, damping_ratio: ArrayLike
) -> Response:
    """g and g′ alone; the arguments are those of :func:`responses`."""
    s, a, q, w = _columns(time, frequency_ratio, damping_ratio)
    c, g = _damped(s, a, q, w)
    return Response(g, c - a * g)


def _columns(
    time: ArrayLike, frequency_ratio: ArrayLike, damping_ratio: ArrayLike
) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """s, a, q and w, of one shape."""
    args = (np.asarray(x, dtype=float) for x in (time, frequency_ratio, damping_ratio))
    s, omega, zeta = np.broadcast_arrays(*args)
    # The product form of w keeps its digits near ζ = 1, where q - a² would lose them.
    return s, zeta * omega, omega * omega, omega * omega * (1 - zeta) * (1 + zeta)


def steady_response(real: Any, imaginary: Any, detuning: Any, loss: Any, gamma: Any) -> tuple:
    """The parts of (a + ib)/p(i): the steady response, divided by e^{is}, to a forcing a + ib.

    Parameters
    ----------
    real, imaginary : array_like
        a and b.
    detuning, loss, gamma : array_like
        ϖ² - 1 and 2ζϖ, the parts of p(i), and γ, the sum of their squares.
    """
    in_phase = (real * detuning + imaginary * loss) / gamma
    quadrature = (imaginary * detuning - real * loss) / gamma
    return in_phase, quadrature


def table_response(
    time: np.ndarray,
    frequency_ratio: np.ndarray | float,
    damping_ratio: np.ndarray | float,
    real: np.ndarray,
    imaginary: np.ndarray,
) -> tuple[np.ndarray, np.ndarray]:
    """Q = Re h and P = Im h from the numerator of h, which a caller has without cancellation.

    Parameters
    ----------
    time, frequency_ratio, damping_ratio : array
        s, ϖ and ζ.
    real, imaginary : ndarray
        cos s - g′ - 2ζϖ g and sin s - g, with the shape of the results.
    """
    loss = _TWO * damping_ratio * frequency_ratio
    detuning = (frequency_ratio - _ONE) * (frequency_ratio + _ONE)
    gamma = detuning * detuning + loss * loss
    square = time * time
    delicate = gamma * square * square < _SQUARED
    with np.errstate(divide="ignore", invalid="ignore"):
        found = steady_response(real, imaginary, detuning, loss, gamma)
    in_phase, quadrature = map(np.asarray, found)
    if delicate.any():
        some = _where(delicate, in_phase.shape, time, frequency_ratio, damping_ratio)
        at = np.broadcast_to(delicate, in_phase.shape)
        exact = responses(*some).table.value
        in_phase[at] = exact.real
        quadrature[at] = exact.imag
    return in_phase, quadrature


def gravity_response(
    time: np.ndarray,
    frequency_ratio: np.ndarray | float,
    damping_ratio: np.ndarray | float,
    numerator: np.ndarray,
) -> np.ndarray:
    """G from its numerator 1 - g′ - 2ζϖ g; the arguments are those of :func:`table_response`."""
    stiffness = frequency_ratio * frequency_ratio
    found = np.asarray(numerator / stiffness)
    delicate = stiffness * time * time < _OF_VALUES
    if np.any(delicate):
        some = _where(delicate, found.shape, time, frequency_ratio, damping_ratio)
        found[np.broadcast_to(delicate, found.shape)] = responses(*some).gravity.value
    return found


def _where(which, shape, *arrays) -> list[np.ndarray]:
    """The entries of arrays that broadcast to a shape, at some of its places."""
    at = np.broadcast_to(which, shape)
    return [np.broadcast_to(x, shape)[at] for x in arrays]
