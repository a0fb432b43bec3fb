"""Contact laws beside the impacts of a recording, by r over the speed.

A law is judged by how much worse it fits than the nearest smooth curve, which is one of those of
:mod:`.intervals` or a parabola in ln v, for each ratio ρ of scatter to errors: with m impacts more
than the three parameters of the curve, and sums of squares Q of the law and P of the curve, its
probability is (P/Q)^(m/2), that of the F distribution with 2 and m degrees of freedom. The largest
one counts of those ρ that are at least 1/20 as likely as the likeliest one. If the errors are known
it is e^(-(Q - P)/2τ²), that of the χ² distribution, averaged over ρ. Scatter alone, which the curve
has as well, therefore rejects no law. Without given errors a systematic error of the measurement
does not show in the scatter: a law is then not called incompatible, but said to deviate.
"""

import functools
import math
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from scipy import integrate, interpolate, special

from bouncing_ball_contacts.intervals import ACCEPTED, Curves, Impacts, deviations
from bouncing_ball_contacts.schemes import Array

REJECTED = 0.005
"""The probability below which a law is rejected."""


@dataclass(frozen=True)
class ContactLaw:
    """A contact that pushes with K (p^n + A p^m p′), and never pulls.

    In the units L = (M v²/K)^(1/(n + 1)) and L/v the ball arrives with the speed 1, and only the
    damping x = A v L^(m - n) is left, which goes as v to the power of ``speed``.
    """

    n: float
    m: float

    @property
    def speed(self) -> float:
        """The power of the speed with which the damping x goes."""
        return (1 + 2 * self.m - self.n) / (1 + self.n)

    @functools.cached_property
    def by_damping(self) -> Any:
        """The curve over x of ln r and of the contact time over L/v, down to r = 0.005.

        The impacts of all x are one system p″ = -(pⁿ + x p^m p′)₊, p′ = 1 at first, which is
        followed until all balls fly. Their flight leads back to the release, where pⁿ = x p^m r.
        Errors of ln r are below 1e-5, and those of the contact time below 2e-4 of it.
        """
        x = np.array([0.0, *np.geomspace(1e-3, 200.0, 120)])
        end = 40.0

        def rate(_: float, state: Array) -> Array:
            p, w = np.split(state, 2)
            inside = np.maximum(p, 0.0)
            force = inside**self.n + x * inside**self.m * w
            return np.concatenate([w, -np.maximum(force, 0.0)])

        states = integrate.solve_ivp(
            rate, (0.0, end), np.repeat([0.0, 1.0], len(x)), rtol=1e-8, atol=1e-11
        ).y
        p, w = np.split(states[:, -1], 2)
        released = (-x * w) ** (1 / (self.n - self.m)) if self.n > self.m else 0.0
        # The first ball has no damping, and its r is 1.
        values = np.column_stack([np.log(w / w[0]), end + (released - p) / w])
        return interpolate.CubicSpline(x, values)

    def x(self, a: Array | float, v: Array) -> Array:
        """Return the damping x = a v^speed at speeds in m/s, at most that of the curve."""
        return np.minimum(a * v**self.speed, self.by_damping.x[-1])

    def log_r(self, a: Array | float, v: Array) -> Array:
        """Return ln r at speeds in m/s if x = a v^speed."""
        return self.by_damping(self.x(a, v))[..., 0]

    def duration(self, a: Array | float, v: Array) -> Array:
        """Return the contact time at speeds in m/s, over L/v."""
        return self.by_damping(self.x(a, v))[..., 1]

    def damping(self, restitution: float) -> float:
        """Return the x with a restitution coefficient."""
        x = self.by_damping.x
        return float(np.interp(-math.log(restitution), -self.by_damping(x)[:, 0], x))


LINEAR = ContactLaw(1.0, 0.0)
LAWS = {
    "constant r (linear; Hertz with Tsuji)": LINEAR,
    "Hertz with Kuwabara and Kono": ContactLaw(1.5, 0.5),
    "Hunt and Crossley": ContactLaw(1.0, 1.0),
}


@dataclass(frozen=True)
class Judged:
    """A law beside the impacts.

    ``rms`` is the root mean square of the errors of r, ``needed`` the size of independent errors of
    r with which the law would not be rejected, ``probability`` that of a larger deviation from the
    smooth curve.
    """

    law: str
    parameter: float
    restitution: float
    rms: float
    needed: float
    probability: float
    verdict: str = "undecided"


def _least_squares(law: ContactLaw, impacts: Impacts, curves: Curves) -> tuple[Array, Array]:
    """Return a of a law for each ratio, and what it misses of ln r.

    It is found by Gauss's method: ln r is a convex curve over a, which is approached from below.
    """
    v = impacts.speed
    a = np.zeros((len(curves.variances), 1))
    for _ in range(20):
        missed = impacts.log_r - law.log_r(a, v)
        slope = law.by_damping(law.x(a, v), 1)[..., 0] * v**law.speed
        pull = slope @ curves.basis / curves.variances
        step = np.sum(pull * (missed @ curves.basis), axis=1)
        step /= np.sum(pull * (slope @ curves.basis), axis=1)
        # r is at most 1.
        a = np.maximum(a + step[:, None], 0.0)
    return a, missed


def _judged(
    name: str, impacts: Impacts, curves: Curves, at: float, weights: Array, nearest: Array
) -> Judged:
    """Return a law beside the impacts.

    ``weights`` are those of the ratios, and ``nearest`` has the squares of the nearest curve for
    each. The last row of variances is beside the ratios.
    """
    law = LAWS[name]
    r = impacts.restitution
    a, missed = _least_squares(law, impacts, curves)
    squares = np.sum((missed @ curves.basis) ** 2 / curves.variances, axis=1)
    # A law may fit better than the curves.
    worse = np.maximum(squares - nearest, 0.0)
    if curves.is_known:
        of_ratios = np.exp(-worse[1:-1] / (2 * curves.sizes[0] ** 2))
        probability = np.average(of_ratios, weights=weights[1:])
    else:
        least = nearest[:-1]
        of_ratios = (least / (least + worse[:-1])) ** (max(len(r) - 3, 0) / 2)
        probability = np.max(of_ratios[weights > np.max(weights) / 20])
    best = int(np.argmax(weights))
    return Judged(
        law=name,
        parameter=float(a[best, 0]),
        restitution=float(np.exp(law.log_r(a[best, 0], np.array(at)))),
        rms=math.sqrt(float(np.mean((r * np.expm1(-missed[best])) ** 2))),
        needed=math.sqrt(worse[-1] / (-2 * math.log(REJECTED))) * float(np.mean(r)),
        probability=float(probability),
    )


def _verdict(probability: float, is_any_rejected: bool, is_known: bool) -> str:
    if probability < REJECTED:
        return "incompatible" if is_known else "deviates"
    return "compatible" if probability > ACCEPTED and is_any_rejected else "undecided"


def judge(impacts: Impacts, curves: Curves, at: float) -> list[Judged]:
    """Return the laws with their verdicts, that of the smallest errors first."""
    weights = special.softmax(curves.posterior).sum(axis=(1, 2))
    # One more row has independent errors of ln r.
    rows = [curves.variances, np.ones(len(impacts.log_r))]
    curves = replace(curves, variances=np.vstack(rows))
    x = np.log(impacts.speed / at)
    powers = curves.basis.T @ np.column_stack([np.ones_like(x), x, x**2])
    y = impacts.log_r @ curves.basis
    columns = (curves.columns, powers[None])
    left_over = [deviations(1 / curves.variances, each, y)[0] for each in columns]
    squares = np.sum(np.concatenate(left_over, axis=1) ** 2, axis=(2, 3))
    nearest = np.min(squares, axis=1)
    # Rounded readings may be alike by chance, and leave a curve less than their own errors.
    left = np.mean(curves.rounded**2 * curves.variances[0] / curves.variances[:-1], axis=1)
    nearest[:-1] = np.maximum(nearest[:-1], max(len(x) - 3, 1) * left)
    found = [_judged(name, impacts, curves, at, weights, nearest) for name in LAWS]
    is_any_rejected = any(each.probability < REJECTED for each in found)
    return sorted(
        (
            replace(each, verdict=_verdict(each.probability, is_any_rejected, curves.is_known))
            for each in found
        ),
        key=lambda each: each.rms,
    )
