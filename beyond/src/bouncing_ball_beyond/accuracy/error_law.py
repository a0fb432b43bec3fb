r"""The error of the restitution model, to first order in the contact duration.

It is the paper's error (Eqs. 37-38), relative to the value of the restitution model
(:func:`~bouncing_ball_beyond.accuracy.errors.paper_error`). The deviation from the contact is to
first order the same with the other sign.

The corrected model (:mod:`bouncing_ball_beyond.periodic.one_impact.corrected_branch`) differs from
the exact model in the second order, and from the restitution model in the first order, through the
delay t_c and the load sensitivity σ. The first-order error of the restitution model is therefore
the derivative of the closed forms along (t_c, σ, D) at 0. With ``X₀ = nπ (1 - r)/(1 + r)``, ``cos
ψ₀ = X₀/Λ``, ``Y₀ = Λ sin ψ₀`` and ``q₀ = 1 - Y₀`` of the restitution model's orbit ::

    ψ = ψ₀ + σ q₀/((1 + r) Y₀)                (the line, at fixed Λ)
    φ = ψ - t_c
    max z = Λ sin ψ - v₀ t_c + (nπ)²/2,   v₀ = nπ + X₀ = 2nπ/(1 + r)
    z′_b = nπ - (D - t_c)
    r_a = r + [σ - D + (1 + r) t_c] q₀/v₀
    Λ_SN = (nπ(1 - r) - σ)/√((1 + r)² + σ²)

and at the period doubling, with ``Y₀ - 1 = (1 - r)²/(1 + r)²`` there, from its
two straight lines ::

    δX = σ (Y₀ - 1)/(1 + r)
    δY = [2 t_c (Y₀ - 1) - nπ σ X₀ + (1 - r) δX]/(nπ (1 + r))
    δΛ = (X₀ δX + Y₀ δY)/Λ_PD

For a linear contact t_c, σ and D are inversely proportional to ϖ, so that the
signature at ϖ = 1 gives the K of a relative error K/ϖ + O(1/ϖ²). The contact
is compared with the restitution model whose r is that of a free impact on the contact. With the
force release, the r of Eq. 16 differs from it, and its restitution model is not the limit of the
contact.

Permanent contact has no impact to correct, and its error is of the second
order: ``Λ_SD = 1 + K₂/ϖ² + O(1/ϖ⁴)`` with K₂ = -(1 - 2ζ²) for the
displacement release and -1 for the force release.

The remainder is bounded by three numbers, η = η_SN + η_load + η_period::

    η_SN = |σ q₀| Λ/((1 + r) Y₀²)    shift of ψ over tan ψ₀, the distance to the fold
    η_load = D (1 + |q₀|)/(r v₀)     load against the speed of the ball that leaves
    η_period = D max(1, Λ)           contact against the period

``|error - K| ≤ M S η``, with all terms at the ϖ of the contact, where S is the :func:`scale` of K
and M = 4 for the phase and 2 for the other quantities. M is fitted: the largest factor among 20 000
random orbits is 3.0 for the phase and 1.6 for the others, and no other sample has exceeded M at any
η. The law gives no useful bound where η is of order 1: next to the saddle-node, within
Λ - Λ_SN ~ 1/ϖ, for grazing and slow impacts, and for small r.
"""

from collections.abc import Iterable
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from bouncing_ball.accuracy.errors import Quantity
from bouncing_ball.periodic.explicit import period_doubling_lift, restitution_saddle_node
from bouncing_ball_beyond.accuracy.errors import OF_IMPACTS
from bouncing_ball_beyond.models.damping import Release
from bouncing_ball_beyond.models.instant import Instant
from bouncing_ball_beyond.models.laws.signature import Signature
from bouncing_ball_beyond.models.spring_damper import SpringDamper
from bouncing_ball_beyond.periodic.one_impact.restitution_branch import phase

VALID_BELOW = 0.3
"""η below which the law is considered useful: the remainder is then less than 0.6 times the scale,
or 1.2 times for the phase."""

ByQuantity = dict[Quantity, np.ndarray]
"""One array for each quantity of an impact, in the order of :data:`OF_IMPACTS`."""

REMAINDER = dict.fromkeys(OF_IMPACTS, 2.0) | {Quantity.PHASE: 4.0}
"""M of each quantity: the remainder is at most M S η. M is fitted to a sample and not proved."""


def _of_orbit(n: ArrayLike, instant: Instant, amplitude: ArrayLike) -> tuple[np.ndarray, ...]:
    """t_c, r, σ and D of the signature, and nπ, ψ, Λ_SN and Λ sin ψ of the restitution orbit."""
    r = instant.restitution
    lam = np.asarray(amplitude, dtype=float)
    psi = phase(n, r, lam)
    fold = restitution_saddle_node(n, r)
    orbit = np.asarray(n) * np.pi, psi, fold, lam * np.sin(psi)
    return *(np.asarray(x, dtype=float) for x in instant[:4]), *orbit


def first_order(n: ArrayLike, instant: Instant, amplitude: ArrayLike) -> ByQuantity:
    """First-order errors of the restitution model at its orbit on the stable side.

    They are the paper's, relative to the value of the restitution model. The error of the
    saddle-node is therefore infinite at r = 1, and that of the phase at the saddle-node, where this
    value is 0.

    Parameters
    ----------
    n : array_like of int
        Index of the family.
    instant : Instant
        Signature of the contact at the orbit's impact speed.
    amplitude : array_like
        Λ, at or above the saddle-node of the restitution model.

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

    >>> law = first_order(1, Instant(0.0, 0.5, 0.0, 0.1), 1.5)
    >>> abs(float(law["max_height"])), round(float(law["bounce_velocity"]) * np.pi, 15)
    (0.0, -0.1)
    """
    delay, r, load, duration, half, psi, fold, lift = _of_orbit(n, instant, amplitude)
    with np.errstate(divide="ignore", invalid="ignore"):
        later = load * (1 - lift) / ((1 + r) * lift) - delay
        higher = fold * later - half * delay
        unloaded = load - duration + (1 + r) * delay
        doubling = _period_doubling(half, r, delay, load, fold)
        return {
            Quantity.MAX_HEIGHT: higher / (lift + half * half / 2),
            Quantity.BOUNCE_VELOCITY: (delay - duration) / half,
            Quantity.PHASE: later / psi,
            Quantity.APPARENT_RESTITUTION: unloaded * (1 - lift) * (1 + r) / (2 * half * r),
            Quantity.SADDLE_NODE: -load / (half * (1 - r)),
            Quantity.PERIOD_DOUBLING: doubling,
        }


def _period_doubling(half, r, delay, load, fold):
    lift = period_doubling_lift(r)
    excess = ((1 - r) / (1 + r)) ** 2
    d_x = load * excess / (1 + r)
    d_y = (2 * delay * excess - half * load * fold + (1 - r) * d_x) / (half * (1 + r))
    return (fold * d_x + lift * d_y) / (fold * fold + lift * lift)


def small_parameter(n: ArrayLike, instant: Instant, amplitude: ArrayLike) -> np.ndarray:
    """The small parameter η of the bound of the remainder; infinite at the saddle-node.

    Arguments, shape and errors are those of :func:`first_order`.

    Examples
    --------
    >>> bool(small_parameter(1, Instant(0.05, 1.0, 0.0, 0.1), 1.0) < 0.3)
    True
    """
    _, r, load, duration, half, _, _, lift = _of_orbit(n, instant, amplitude)
    lam = np.asarray(amplitude, dtype=float)
    pull = np.abs(1 - lift)
    with np.errstate(divide="ignore", invalid="ignore"):
        fold = np.abs(load) * pull * lam / ((1 + r) * lift * lift)
    return fold + duration * (1 + pull) * (1 + r) / (2 * half * r) + duration * np.maximum(1, lam)


def scale(n: ArrayLike, instant: Instant, amplitude: ArrayLike) -> ByQuantity:
    """The scale S of each quantity: the sum of the moduli of the terms of K.

    The apparent restitution is an exception, because for a linear contact the terms of its K cancel
    up to κ - 2ζ(1 + r)/ϖ. Its scale is the effect of the load over the entire contact,
    D (1 + |a₀|)/(r v₀). Arguments, shape and errors are those of :func:`first_order`.

    Examples
    --------
    >>> instant = Instant(0.05, 0.5, 0.1, 0.1)
    >>> size = scale(1, instant, 1.3)
    >>> all(abs(k) <= size[q] * (1 + 1e-15) for q, k in first_order(1, instant, 1.3).items())
    True
    """
    delay, r, load, duration, half, psi, fold, lift = _of_orbit(n, instant, amplitude)
    with np.errstate(divide="ignore", invalid="ignore"):
        shift = np.abs(load * (1 - lift)) / ((1 + r) * lift)
        node = np.abs(load) / (half * (1 - r))
        whole = duration * (1 + np.abs(1 - lift))
        return {
            Quantity.MAX_HEIGHT: (fold * shift + (half + fold) * delay) / (lift + half * half / 2),
            Quantity.BOUNCE_VELOCITY: (duration - delay) / half,
            Quantity.PHASE: (shift + delay) / psi,
            Quantity.APPARENT_RESTITUTION: whole * (1 + r) / (2 * half * r),
            Quantity.SADDLE_NODE: node,
            Quantity.PERIOD_DOUBLING: node + delay / half,
        }


class Remainder(NamedTuple):
    """Errors compared with the law, which states that ``factor`` is at most M."""

    law: np.ndarray
    """The first-order errors by the law, shape (quantity, ...)."""
    factor: np.ndarray
    """|error - law|/(S η) of each quantity; NaN where the error is NaN."""
    small: np.ndarray
    """η, without the axis of quantities."""
    is_valid: np.ndarray
    """Whether the error is finite and η is below :data:`VALID_BELOW`, so that the law is useful."""
    exceeded: np.ndarray
    """Whether the factor is above M, at any η."""


def remainder(
    n: ArrayLike,
    instant: Instant,
    amplitude: ArrayLike,
    error: np.ndarray,
    quantities: Iterable[Quantity] = OF_IMPACTS,
) -> Remainder:
    """Errors of the restitution model against the law, shape (quantity, ...).

    Parameters
    ----------
    n, instant, amplitude
        As in :func:`first_order`.
    error : ndarray, shape (quantity, ...)
        The paper's errors of the ``quantities``; NaN where an error is missing.
    quantities : iterable of Quantity

    Raises
    ------
    NoOrbitError
        If Λ lies below the saddle-node.

    Examples
    --------
    >>> instant, error = Instant(0.05, 0.5, 0.1, 0.1), np.array([-0.016, np.nan])
    >>> left = remainder(1, instant, 1.3, error, OF_IMPACTS[1:3])
    >>> float(left.law[0].round(5)), left.is_valid.tolist(), left.exceeded.tolist()
    (-0.01592, [True, False], [False, False])
    """
    asked = tuple(quantities)
    first, size = (f(n, instant, amplitude) for f in (first_order, scale))
    law = np.stack([first[q] for q in asked])
    small = small_parameter(n, instant, amplitude)
    with np.errstate(invalid="ignore", divide="ignore"):
        factor = np.abs(error - law) / (np.stack([size[q] for q in asked]) * small)
    bound = np.reshape([REMAINDER[q] for q in asked], (-1,) + (1,) * (law.ndim - 1))
    return Remainder(law, factor, small, np.isfinite(error) & (small < VALID_BELOW), factor > bound)


def coefficients(
    n: ArrayLike,
    damping_ratio: ArrayLike,
    amplitude: ArrayLike,
    release: Release = Release.DISPLACEMENT,
) -> ByQuantity:
    """K of each quantity for a linear contact: the paper's error is K/ϖ + O(1/ϖ²).

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
    return first_order(n, Signature(contact)(), amplitude)


def law_thresholds(
    n: ArrayLike, damping_ratio: ArrayLike, amplitude: ArrayLike, release: Release, tolerance: float
) -> ByQuantity:
    """The ϖ at which each error falls to a tolerance ε by the law, |K|/ε or √(|K₂|/ε).

    These are estimates and no bounds, because the law neglects the terms of order 1/ϖ². Arguments
    and errors are those of :func:`coefficients`. The result has one array for each of the seven
    quantities.

    Examples
    --------
    >>> law = law_thresholds(1, 0.0, 1.0, Release.DISPLACEMENT, 0.01)
    >>> [round(float(law[q]), 12) for q in ("bounce_velocity", "permanent_contact")]
    [50.0, 10.0]
    """
    first = coefficients(n, damping_ratio, amplitude, release)
    still = permanent_contact_coefficient(damping_ratio, release)
    needed = {quantity: np.abs(k) / tolerance for quantity, k in first.items()}
    return needed | {Quantity.PERMANENT_CONTACT: np.sqrt(np.abs(still) / tolerance)}


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
