r"""Exact response of a damped linear oscillator, for every damping.

The contact is a linear oscillator, ``y″ + 2a y′ + q y = f(s)`` with
``a = ζϖ`` and ``q = ϖ²``. Two responses are all that the model needs:

* the impulse response *g* (f = 0, y(0) = 0, y′(0) = 1);
* the exponential response *h* (f = e^{νs}, y(0) = y′(0) = 0), with ν = 0 for
  gravity and ν = i for the table.

With ``w = q - a²``, ``C = cos(√w s)``, ``S = sin(√w s)/√w`` and
``R = (S - sC)/w``, all three entire functions of w, so that under-, critical
and overdamped contacts are one case::

    g  = e^{-as} S                g′ = e^{-as} (C - a S)
    h  = [e^{νs} - g′ - (ν + 2a) g] / p(ν),      p(ν) = ν² + 2aν + q
    h′ = ν h + g

*h* has a removable singularity at resonance, p(ν) = 0 (ζ = 0, ϖ = 1 for the
table), and loses digits to cancellation for short times. As *h* is an entire
function of ν, its value there is its mean over a circle around ν on which the
formula is well conditioned (Cauchy's integral; Kassam and Trefethen, SIAM J.
Sci. Comput. 26, 2005, use the same device).

All quantities are dimensionless; all functions broadcast.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

# Below this |p(ν)| s² the quotient for h is taken on a circle instead: there
# the terms of the numerator exceed the result, of order s²/2, by 4 or more.
_CANCELLATION = 4.0
# Trapezoidal points on the circle: with |radius · s| ≤ 4 the first neglected
# term is 4⁴⁰/40! < 2e-24.
_CIRCLE_POINTS = 40
_CIRCLE_RADII = (1.0, 2.0, 4.0)
# (z - ν) s for the points z of each circle, and its exponential.
_CIRCLES = np.outer(
    _CIRCLE_RADII, np.exp(2j * np.pi * (np.arange(_CIRCLE_POINTS) + 0.5) / _CIRCLE_POINTS)
)
_WAVES = np.exp(_CIRCLES)
# Circles at once: as many as keep what is computed on them in the cache.
_BLOCK = 512
# |w| s² below which C, S and R are summed as series; the first neglected term
# of the slowest, R, is 2·(k+1)/(2k+3)! < 1e-20 at k = 10.
_SERIES_RANGE = 1.0
_SERIES_TERMS = 10


class Response(NamedTuple):
    """A response and its partial derivatives.

    ``value`` and ``rate`` are y(s) and y′(s); ``d_a``, ``d_q`` the
    derivatives of the value and ``rate_d_a``, ``rate_d_q`` those of the rate
    with respect to a = ζϖ and q = ϖ².
    """

    value: np.ndarray
    rate: np.ndarray
    d_a: np.ndarray
    d_q: np.ndarray
    rate_d_a: np.ndarray
    rate_d_q: np.ndarray


def _damped_csr(s, a, q, w):
    """e^{-as} times C, S and R, for any sign of w = q - a²."""
    w_s2 = w * s * s
    root = np.sqrt(np.abs(w))
    safe_root = np.where(root > 0, root, 1.0)
    safe_w = np.where(w != 0, w, 1.0)
    decay = np.exp(-a * s)
    c = decay * np.cos(root * s)
    sn = decay * np.sin(root * s) / safe_root
    over = w < 0
    if np.any(over):
        # The slow exponent κ - a is written -q/(κ + a): no cancellation and,
        # for a > 0, no overflow.
        total = np.where(over, root + a, 1.0)
        slow = np.exp(np.where(over, -q / total * s, 0.0))
        fast = np.exp(np.where(over, -total * s, 0.0))
        c = np.where(over, (slow + fast) / 2, c)
        sn = np.where(over, (slow - fast) / (2 * safe_root), sn)
    r = (sn - s * c) / safe_w
    small = np.abs(w_s2) < _SERIES_RANGE
    if np.any(small):
        x = np.where(small, -w_s2, 0.0)
        cs, ss, rs = np.zeros_like(x), np.zeros_like(x), np.zeros_like(x)
        # Horner, from 1/(2k)!, 1/(2k+1)! and 2(k+1)/(2k+3)!.
        for k in reversed(range(_SERIES_TERMS)):
            cs = 1 + x / ((2 * k + 1) * (2 * k + 2)) * cs
            ss = 1 + x / ((2 * k + 2) * (2 * k + 3)) * ss
            rs = 1 + x / ((2 * k + 2) * (2 * k + 5)) * rs
        c = np.where(small, decay * cs, c)
        sn = np.where(small, decay * s * ss, sn)
        r = np.where(small, decay * s**3 / 3 * rs, r)
    return c, sn, r


def impulse_response(s: ArrayLike, a: ArrayLike, q: ArrayLike, w: ArrayLike) -> Response:
    """Impulse response g of ``y″ + 2a y′ + q y = 0`` and its derivatives.

    Parameters
    ----------
    s, a, q, w : array_like
        Time, a = ζϖ, q = ϖ² and w = ϖ²(1 - ζ²), the last given by the caller
        because q - a² loses digits near ζ = 1.

    Examples
    --------
    At critical damping, a = √q = 1, ``g = s e^{-s}``:

    >>> float(impulse_response(0.0, 1.0, 1.0, 0.0).rate)
    1.0
    >>> bool(np.isclose(impulse_response(2.0, 1.0, 1.0, 0.0).value, 2 * np.exp(-2)))
    True
    """
    s, a, q, w = (np.asarray(x, dtype=float) for x in (s, a, q, w))
    s, a, q, w = np.broadcast_arrays(s, a, q, w)
    c, sn, r = _damped_csr(s, a, q, w)
    value, rate = sn, c - a * sn
    return Response(
        value=value,
        rate=rate,
        d_a=a * r - s * value,
        d_q=-r / 2,
        rate_d_a=-value - s * rate - a * a * r + a * s * value,
        rate_d_q=-(s * value - a * r) / 2,
    )


def _quotient(nu, wave, a, q, g: Response):
    """h, ∂h/∂a and ∂h/∂q by the closed formula, where p(ν) is not small; ``wave`` is e^{νs}."""
    p = nu * nu + 2 * a * nu + q
    h = (wave - g.rate - (nu + 2 * a) * g.value) / p
    h_a = (-g.rate_d_a - 2 * g.value - (nu + 2 * a) * g.d_a - 2 * nu * h) / p
    h_q = (-g.rate_d_q - (nu + 2 * a) * g.d_q - h) / p
    return h, h_a, h_q


def _circle_mean(nu, s, a, q, g: Response):
    """The same three as means over a circle around ν (removable singularity)."""

    def column(x):
        return x[..., np.newaxis]

    # Below 1e-100, h = s²/2 underflows anyway.
    short = np.where(np.abs(s) < 1e-100, 1e-100, s)
    root = np.sqrt(a * a - q + 0j)
    distance = np.abs(nu - np.stack([-a + root, -a - root]))
    radii = np.stack([radius / np.abs(short) for radius in _CIRCLE_RADII])
    # The radius whose circle stays farthest, in proportion, from both poles.
    clearance = np.min(np.abs(radii[:, np.newaxis] - distance) / radii[:, np.newaxis], axis=1)
    which = np.argmax(clearance, axis=0)
    nodes = nu + _CIRCLES[which] / column(short)
    wave = column(np.exp(nu * short)) * _WAVES[which]
    wide = Response(*(column(x) for x in g))
    on_circle = _quotient(nodes, wave, column(a), column(q), wide)
    return tuple(np.mean(x, axis=-1) for x in on_circle)


def exponential_response(
    nu: complex, s: ArrayLike, a: ArrayLike, q: ArrayLike, g: Response
) -> Response:
    """Response h to e^{νs} from rest, and its derivatives.

    Parameters
    ----------
    nu : complex
        0 for a constant force, 1j for the table.
    s, a, q : array_like
        Time, a = ζϖ, q = ϖ².
    g : Response
        The impulse response at the same (s, a, q).

    Returns
    -------
    Response
        Real for ν = 0. For ν = i the real part answers cos s and the
        imaginary part sin s.

    Examples
    --------
    A constant unit force on a free mass (q → 0) gives s²/2:

    >>> g = impulse_response(3.0, 0.0, 0.0, 0.0)
    >>> round(float(exponential_response(0, 3.0, 0.0, 0.0, g).value), 12)
    4.5
    """
    s, a, q = np.broadcast_arrays(*(np.asarray(x, dtype=float) for x in (s, a, q)))
    p = nu * nu + 2 * a * nu + q
    delicate = np.abs(p) * s * s < _CANCELLATION
    if np.any(delicate):
        safe = np.where(delicate, 1e300, q)  # value unused; avoids 0/0
        h, h_a, h_q = (np.array(x) for x in _quotient(nu, np.exp(nu * s), a, safe, g))
        known = [np.ravel(x) for x in (s, a, q, *g)]
        which = np.flatnonzero(delicate)
        for start in range(0, which.size, _BLOCK):
            at = which[start : start + _BLOCK]
            time, damping, stiffness, *part = (x[at] for x in known)
            means = _circle_mean(nu, time, damping, stiffness, Response(*part))
            for target, mean in zip((h, h_a, h_q), means, strict=True):
                target.reshape(-1)[at] = mean if np.iscomplexobj(target) else mean.real
    else:
        h, h_a, h_q = _quotient(nu, np.exp(nu * s), a, q, g)
    return Response(
        value=h,
        rate=nu * h + g.value,
        d_a=h_a,
        d_q=h_q,
        rate_d_a=nu * h_a + g.d_a,
        rate_d_q=nu * h_q + g.d_q,
    )
