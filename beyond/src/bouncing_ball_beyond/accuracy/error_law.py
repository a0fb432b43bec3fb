r"""The error of the restitution model, uniformly from its saddle-node to its period doubling.

It is the paper's error (Eqs. 37-38), relative to the value of the restitution model
(:func:`~bouncing_ball_beyond.accuracy.errors.paper_error`).

The restitution model's n-T orbits lie on the line ``X = C = nπ(1 - r)/(1 + r)`` of the plane
``(X, Y) = Λ (cos ψ, sin ψ)``. The load of a contact moves this line by s and turns it by the angle
s ::

    X = C - s(1 - Y),        s = σ/(1 + b),  b = d(r v)/dv

at the speed ``v₀ = 2nπ/(1 + r)`` at which the restitution model has all its n-T orbits. The law is
the restitution model's orbit on the line ``C - s``, turned by -s and delayed by t_c. With
``Y₀ = √(Λ² - C²)``, ``Y₁ = √(Λ² - (C - s)²)``, ``cos ψ₁ = (C - s)/Λ`` and ``H = Y₀ + (nπ)²/2`` ::

    max z                  E = (Y₁ - Y₀ - sC - v₀ t_c)/H
    bouncing-off velocity  E = -(D - t_c)/(nπ)
    phase                  E = (ψ₁ - ψ₀ - s - t_c)/ψ₀
    apparent restitution   E = [σ - D + (1 + r) t_c - (b - r) s] (1 - Y₁ + sC)/(r v₀)
    saddle-node            E = -s/C
    period doubling        E = (C δX + Y_D δY)/(C² + Y_D²)

Y_D, δX and δY, and the theorem with its proof, are in docs/error-law.md. Next to the saddle-node
the height and the phase change with the root of the contact's duration, and the law is right to the
order 3/2; elsewhere, and for the other quantities everywhere, to the second order. Far above the
saddle-node the law is K/ϖ with the K of :func:`coefficients`.

For r(v) the restitution model has the same r(v), which matters for its period doubling only. With
the force release, the r of Eq. 16 differs from that of a free impact on the contact, and its
restitution model is not the limit of the contact.

Permanent contact has no impact to correct, and its error is of the second
order: ``Λ_SD = 1 + K₂/ϖ² + O(1/ϖ⁴)`` with K₂ = -(1 - 2ζ²) for the
displacement release and -1 for the force release.

The remainder is at most ``S η`` with the :func:`remainder_scale` S of each quantity and the sum η
of two numbers ::

    D (1 + |1 - Y₀|)/(r v₀)    load against the speed of the ball that leaves
    D max(1, Λ)                contact against the period

The theorem has the orders of this bound, but its factor 1 is fitted and not proved: the largest
remainder among 40 000 random orbits with ϖ from 1 to 10⁴, half of them next to the saddle-node, is
0.18 S η of the height, 0.28 S η of the phase and 0.66 S η of the saddle-node.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from bouncing_ball_beyond.inherited.accuracy.errors import Quantity
from bouncing_ball_beyond.inherited.periodic.restitution_branch import restitution_saddle_node
from bouncing_ball_beyond.models.damping import Release
from bouncing_ball_beyond.models.instant import Instant
from bouncing_ball_beyond.models.laws.signature import Signature
from bouncing_ball_beyond.models.spring_damper import SpringDamper
from bouncing_ball_beyond.periodic.one_impact.restitution_branch import phase, rigid_speed

VALID_BELOW = 0.3
"""η below which the law is considered useful: the remainder is then below 0.3 times its scale."""

ByQuantity = dict[Quantity, np.ndarray]
"""One array for each quantity of an impact, in the order of
:data:`~bouncing_ball_beyond.accuracy.errors.OF_IMPACTS`."""


class _Terms(NamedTuple):
    """The signature of a contact, and the restitution model's orbit at the same Λ.

    ``slope`` is b, ``shift`` s; ``half`` is nπ, ``line`` C, ``speed`` v₀, ``lift`` Y₀ and ``psi``
    ψ₀.
    """

    instant: Instant
    slope: np.ndarray
    shift: np.ndarray
    half: np.ndarray
    line: np.ndarray
    speed: np.ndarray
    amplitude: np.ndarray
    lift: np.ndarray
    psi: np.ndarray

    @classmethod
    def of(cls, n: ArrayLike, instant: Instant, amplitude: ArrayLike) -> _Terms:
        signature = Instant(*(np.asarray(x, dtype=float) for x in instant))
        r = signature.restitution
        lam = np.asarray(amplitude, dtype=float)
        psi = phase(n, r, lam)
        line = restitution_saddle_node(n, r)
        speed = rigid_speed(n, r)
        slope = r + signature.d_restitution * speed
        return cls(
            instant=signature,
            slope=slope,
            shift=signature.load / (1 + slope),
            half=np.asarray(n) * np.pi,
            line=line,
            speed=speed,
            amplitude=lam,
            lift=np.sqrt((lam - line) * (lam + line)),
            psi=psi,
        )

    @property
    def height(self) -> np.ndarray:
        """The greatest height of the restitution model."""
        return self.lift + self.half * self.half / 2

    @property
    def unloaded(self) -> np.ndarray:
        """The change of the apparent restitution by the load, over load and speed."""
        delay, r, load, duration = self.instant[:4]
        return load - duration + (1 + r) * delay - (self.slope - r) * self.shift


def law_errors(
    n: ArrayLike, instant: Instant, amplitude: ArrayLike, curvature: ArrayLike = 0.0
) -> ByQuantity:
    """The errors of the restitution model at its orbit on the stable side.

    They are the paper's, relative to the value of the restitution model. The error of the
    saddle-node is therefore infinite at r = 1, and that of the phase at the saddle-node, where this
    value is 0. Height, phase and apparent restitution are NaN where the contact has no orbit by the
    law, below its saddle-node ``Λ = C - s``.

    Parameters
    ----------
    n : array_like of int
        Index of the family.
    instant : Instant
        Signature of the contact at the speed v₀.
    amplitude : array_like
        Λ, at or above the saddle-node of the restitution model.
    curvature : array_like
        d²(r v)/dv² at v₀, on which the period doubling depends (:func:`curvature_of`); 0 if r does
        not depend on the speed.

    Returns
    -------
    dict
        One array for each quantity of an impact, with the shape to which the arguments broadcast.

    Raises
    ------
    NoOrbitError
        If Λ lies below the saddle-node.

    Examples
    --------
    A contact of duration 0.1 that has no other effect:

    >>> law = law_errors(1, Instant(0.0, 0.5, 0.0, 0.1), 1.5)
    >>> abs(float(law["max_height"])), round(float(law["bounce_velocity"]) * np.pi, 15)
    (0.0, -0.1)

    At the restitution model's saddle-node Y₁ is the root of 2Cs:

    >>> loads = np.array([1e-6, 4e-6])
    >>> one, two = law_errors(1, Instant(0.0, 0.5, loads, 0.0), np.pi / 3)["max_height"]
    >>> round(float(two / one), 2)
    2.0
    """
    return _over_share(_Terms.of(n, instant, amplitude), curvature, share=1.0)


def coefficients(
    n: ArrayLike,
    damping_ratio: ArrayLike,
    amplitude: ArrayLike,
    release: Release = Release.DISPLACEMENT,
) -> ByQuantity:
    """K of each quantity for a linear contact: the limit of ϖ times the law as ϖ → ∞.

    K of the height and of the phase is infinite at the saddle-node.

    Parameters
    ----------
    n, damping_ratio, amplitude : array_like
        Index of the family, ζ < 1 and Λ.
    release : Release

    Raises
    ------
    NoOrbitError
        If Λ lies below the saddle-node of the restitution model.
    ModelError
        If ζ is outside [0, 1).

    Examples
    --------
    The limit of the rule of thumb ϖ = 1/(nε), r → 1, at an orbit with Λ sin φ = 1:

    >>> law = coefficients(1, 0.0, 1.0)
    >>> round(float(law["max_height"]) * (1 + 2 / np.pi**2), 14)
    -1.0
    """
    contact = SpringDamper(1.0, np.asarray(damping_ratio, dtype=float), release)
    terms = _Terms.of(n, Signature(contact)(), amplitude)
    return _over_share(terms, curvature=0.0, share=0.0)


def _over_share(t: _Terms, curvature: ArrayLike, share: float) -> ByQuantity:
    """The errors over ``share`` of a contact whose t_c, σ and D are this share of those given.

    At the share 0 it is their limit.
    """
    delay, r, _, duration = t.instant[:4]
    s = share * t.shift
    with np.errstate(divide="ignore", invalid="ignore"):
        moved = np.sqrt((t.amplitude - t.line + s) * (t.amplitude + t.line - s))
        higher = t.shift * (2 * t.line - s) / (moved + t.lift)
        # tan(ψ₁ - ψ₀) is the share of a quotient that remains finite.
        across = t.line * higher + t.shift * t.lift
        along = t.line * (t.line - s) + moved * t.lift
        angle = np.arctan2(share * across, along) / share if share else across / along
        pull = 1 - moved + s * t.line
        return {
            Quantity.MAX_HEIGHT: (higher - t.shift * t.line - t.speed * delay) / t.height,
            Quantity.BOUNCE_VELOCITY: (delay - duration) / t.half,
            Quantity.PHASE: (angle - t.shift - delay) / t.psi,
            Quantity.APPARENT_RESTITUTION: t.unloaded * pull / (r * t.speed),
            Quantity.SADDLE_NODE: -t.shift / t.line,
            Quantity.PERIOD_DOUBLING: _period_doubling(t, curvature),
        }


def _period_doubling(t: _Terms, curvature: ArrayLike) -> np.ndarray:
    r = t.instant.restitution
    b = t.slope
    depth = t.instant.delay + t.instant.d_delay * t.speed
    lift = doubling_lift(r, b)
    excess = (1 - r) * (1 - b) / ((1 + r) * (1 + b))
    d_x = t.shift * excess
    d_slope = curvature * d_x - t.instant.d_load * excess
    by_slope = d_slope * (t.half * (2 - lift) - t.speed)
    sum_of_terms = (1 - b) * d_x + 2 * depth * excess - t.half * t.instant.load * t.line + by_slope
    d_y = sum_of_terms / (t.half * (1 + b))
    return (t.line * d_x + lift * d_y) / (t.line * t.line + lift * lift)


def doubling_lift(restitution: ArrayLike, slope: ArrayLike) -> np.ndarray:
    """Y_D = Λ sin ψ of the period doubling of impacts without duration, ``b = d(r v)/dv`` of r(v).

    Examples
    --------
    >>> float(doubling_lift(0.5, 0.5)) == 2 * (1 + 0.25) / 1.5**2
    True
    """
    r, b = np.asarray(restitution, dtype=float), np.asarray(slope, dtype=float)
    return 2 * (1 + r * b) / ((1 + r) * (1 + b))


def curvature_of(signature: Callable[[np.ndarray], Instant], speed: ArrayLike) -> np.ndarray:
    """d²(r v)/dv² at speeds v, by a central difference of d(r v)/dv over the cube root of rounding.

    Examples
    --------
    >>> float(curvature_of(Signature(SpringDamper(10.0, 0.1)), 3.0))
    0.0
    """
    v = np.asarray(speed, dtype=float)
    step = np.cbrt(np.finfo(float).eps) * v

    def slope(at: np.ndarray) -> np.ndarray:
        instant = signature(at)
        return instant.restitution + instant.d_restitution * at

    return (slope(v + step) - slope(v - step)) / (2 * step)


def law_thresholds(
    n: ArrayLike, instant: Instant, amplitude: ArrayLike, allowed: tuple[float, float]
) -> ByQuantity:
    """The ϖ from which on each error is within the allowed ones by the law.

    For the height, ``u = 1/ϖ`` is the smallest root of ``(Y₀ + E H + ku)² = Λ² - (C - s₁u)²`` for
    one of the allowed errors E, with ``k = s₁C + v₀t₁`` and the signature of ϖ = 1: a quadratic
    equation. So is that of the phase, ``Λ cos(ψ₀(1 + E) + mu) = C - s₁u`` with ``m = s₁ + t₁``, if
    the cosine is expanded to the second order. The other thresholds are K/E. At the saddle-node
    that of the phase is infinite.

    Parameters
    ----------
    n, amplitude : array_like
        As in :func:`law_errors`.
    instant : Instant
        The signature of the contact with ϖ = 1. With the signature of another contact of constant
        signature, the result is in units of its ϖ.
    allowed : tuple of float
        The lowest error, between -1 and 0, and the highest, above 0.

    Returns
    -------
    dict
        One array for each quantity of an impact.

    Raises
    ------
    NoOrbitError
        If Λ lies below the saddle-node of the restitution model.

    Examples
    --------
    >>> unit = Signature(SpringDamper(1.0, 0.0))()
    >>> law = law_thresholds(1, unit, 1.0, (-0.01, 0.01))
    >>> round(float(law["bounce_velocity"]), 12)
    50.0

    At the saddle-node K is infinite, but a contact can be stiff enough for the height:

    >>> from bouncing_ball_beyond.models.damping import damping_ratio
    >>> unit = Signature(SpringDamper(1.0, damping_ratio(0.05)))()
    >>> fold = restitution_saddle_node(1, unit.restitution)
    >>> round(float(law_thresholds(1, unit, fold, (-0.01, 0.01))["max_height"]))
    5597
    """
    t = _Terms.of(n, instant, amplitude)
    # With the sign of K an error grows towards one of the allowed ones.
    needed = {
        name: k / np.where(k > 0, allowed[1], allowed[0])
        for name, k in _over_share(t, curvature=0.0, share=0.0).items()
    }
    with np.errstate(divide="ignore", invalid="ignore"):
        # The orbits on the line C - s end where it no longer meets the circle of radius Λ.
        end = np.where(t.shift < 0, t.line - t.amplitude, t.line + t.amplitude) / t.shift
        for name, exit_at in ((Quantity.MAX_HEIGHT, _height_exit), (Quantity.PHASE, _phase_exit)):
            first = np.minimum(*(exit_at(t, error) for error in allowed))
            needed[name] = 1 / np.fmin(first, np.where(end > 0, end, np.inf))
    return needed


def _height_exit(t: _Terms, error: float) -> np.ndarray:
    """The smallest u = 1/ϖ at which the height has the error; infinite if there is none."""
    higher = error * t.height
    fall = t.shift * t.line + t.speed * t.instant.delay
    roots = _roots(
        fall * fall + t.shift * t.shift,
        fall * (t.lift + higher) - t.line * t.shift,
        higher * (2 * t.lift + higher),
    )
    return _smallest(roots, [t.lift + higher + fall * u >= 0 for u in roots])


def _phase_exit(t: _Terms, error: float) -> np.ndarray:
    """The smallest u = 1/ϖ at which the phase has the error; infinite if there is none."""
    later = t.shift + t.instant.delay
    psi = t.psi * (1 + error)
    cosine = t.amplitude * np.cos(psi)
    roots = _roots(
        cosine * later * later / 2,
        (t.amplitude * np.sin(psi) * later - t.shift) / 2,
        t.line - cosine,
    )
    return _smallest(roots, [psi + later * u >= 0 for u in roots])


def _roots(a: np.ndarray, b: np.ndarray, c: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Both roots of ``a u² + 2 b u + c``, without cancellation; NaN if they are not real."""
    sum_of_parts = -(b + np.copysign(np.sqrt(b * b - a * c), b))
    return sum_of_parts / a, c / sum_of_parts


def _smallest(roots: tuple[np.ndarray, np.ndarray], on_branch: list[np.ndarray]) -> np.ndarray:
    return np.minimum(
        *(np.where((u >= 0) & on, u, np.inf) for u, on in zip(roots, on_branch, strict=True))
    )


def small_parameter(n: ArrayLike, instant: Instant, amplitude: ArrayLike) -> np.ndarray:
    """The small parameter η of the bound S η of the remainder.

    Arguments, shape and errors are those of :func:`law_errors`.

    Examples
    --------
    >>> bool(small_parameter(1, Instant(0.05, 1.0, 0.0, 0.1), 1.0) < 0.3)
    True
    """
    t = _Terms.of(n, instant, amplitude)
    return _of_load(t) + t.instant.duration * np.maximum(1, t.amplitude)


def _of_load(t: _Terms) -> np.ndarray:
    return t.instant.duration * (1 + np.abs(1 - t.lift)) / (t.instant.restitution * t.speed)


def remainder_scale(n: ArrayLike, instant: Instant, amplitude: ArrayLike) -> ByQuantity:
    """The scale S of each quantity, of which the remainder is at most η.

    It is the sum of the moduli of the terms of the law, with Y₁ of the contact in place of Y₀ in
    the divisors and with ``1 + |1 - Y₀|`` in place of ``1 - Y₀``. The apparent restitution is an
    exception, because for a linear contact the terms of its K cancel up to κ - 2ζ(1 + r)/ϖ. Its
    scale is the effect of the load over the entire contact. Arguments, shape and errors are those
    of :func:`law_errors`.

    Examples
    --------
    >>> size = remainder_scale(1, Instant(0.05, 0.5, 0.1, 0.1), 1.3)
    >>> round(float(size["bounce_velocity"]) * np.pi, 15)
    0.05
    """
    t = _Terms.of(n, instant, amplitude)
    delay, _, _, duration = t.instant[:4]
    shift = np.abs(t.shift)
    with np.errstate(divide="ignore", invalid="ignore"):
        moved = np.sqrt((t.amplitude - t.line + t.shift) * (t.amplitude + t.line - t.shift))
        later = shift * (1 + np.abs(1 - t.lift)) / moved
        node = shift / t.line
        return {
            Quantity.MAX_HEIGHT: (t.line * later + t.speed * delay) / t.height,
            Quantity.BOUNCE_VELOCITY: (duration - delay) / t.half,
            Quantity.PHASE: (later + delay) / t.psi,
            Quantity.APPARENT_RESTITUTION: _of_load(t),
            Quantity.SADDLE_NODE: node,
            Quantity.PERIOD_DOUBLING: node + delay / t.half,
        }


def permanent_contact_coefficient(
    damping_ratio: ArrayLike, release: Release = Release.DISPLACEMENT
) -> np.ndarray:
    """K₂ of the permanent contact: the paper's error is K₂/ϖ² + O(1/ϖ⁴).

    Examples
    --------
    >>> float(permanent_contact_coefficient(0.5)), float(permanent_contact_coefficient(0.0))
    (-0.5, -1.0)
    """
    zeta = np.asarray(damping_ratio, dtype=float)
    if release is Release.FORCE:
        return np.full_like(zeta, -1.0)
    return 2 * zeta * zeta - 1


def permanent_contact_ratio(
    damping_ratio: ArrayLike, release: Release, allowed: tuple[float, float]
) -> np.ndarray:
    """The ϖ from which on the error K₂/ϖ² of the permanent contact is within the allowed ones.

    Examples
    --------
    >>> float(permanent_contact_ratio(0.0, Release.DISPLACEMENT, (-0.01, 0.01)))
    10.0
    """
    k = permanent_contact_coefficient(damping_ratio, release)
    return np.sqrt(k / np.where(k > 0, allowed[1], allowed[0]))
