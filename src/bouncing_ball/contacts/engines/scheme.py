r"""A free impact as the time stepping of an engine computes it.

In a free impact p″ = -p - 2ζ p′, where time is in units of 1/ω, ω = √(k/m). The height x = -p
of the ball above the wall and its velocity v are advanced by a step h in one of two ways. Engines
implement their contacts differently, but each contact is equivalent to one of these maps:

* *semi-implicit Euler*: ``v⁺ = v - h(x + 2ζv)``, ``x⁺ = x + h v⁺``. MuJoCo's Euler integrator
  with its constraint force; also LAMMPS, LIGGGHTS and MercuryDPM, whose velocity Verlet takes
  the damper's speed from the last half step: v is then that of the half steps.
* *implicit Euler*: ``v⁺ = v - h(x⁺ + 2ζv⁺)``, ``x⁺ = x + h v⁺``. Drake's discrete contact.
* *compensated implicit Euler*: the same with parameters that take back the damping of the step, in
  place of 1 and 2ζ. Drake's linear contact (SAP), and Bullet's springs, which are constraints with
  ``cfm`` and ``erp``.

A ball is in contact during a step if x < 0 before this step. A contact with the force release only
pushes, and a damper that acts on approach only is left out of the steps that begin with v ≥ 0.
Because r depends on the instant within a step at which the ball meets the wall, it is computed for
many such instants.

The compensation follows from the rates μ of a contact ``x″ = -c x′ - k x``, ``μ² + c μ + k = 0``:
its motion is a sum of ``exp(μt)``. Implicit Euler with a step h multiplies each part by
``1/(1 - hμ)`` in place of ``exp(hμ)``, which damps the motion to first order. With the rates ::

    μ′ = (1 - exp(-hμ))/h,   μ = -ln(1 - hμ′)/h

both are equal, so that the computed positions are those of the exact contact with the rates μ. The
two rates are conjugate or real, so that k′ = μ′₁μ′₂ and c′ = -μ′₁ - μ′₂ are real. Here all k and c
are per unit of mass.

The compensated positions are those of an exact contact, which begins in the middle of the step
before the first one in contact: up to half a step before or after the ball meets the wall. The
damper therefore acts for up to half a step more or less, so that r has the errors ``±ζhr``, and a
mean error of second order in h. The force release, where v is greatest, adds a second order only.
"""

from collections.abc import Callable
from enum import StrEnum
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from bouncing_ball.errors import ModelError, require
from bouncing_ball.models.damping import Release, restitution_coefficient


def _with_rates(
    stiffness: float, damping: float, rates: Callable[[np.ndarray], np.ndarray]
) -> tuple[float, float]:
    """k and c of the contact whose rates are a function of the rates of this one."""
    # Real if ζ ≥ 1; the rate of the smaller amount from the product, because the sum would cancel.
    larger = -damping / 2 - np.emath.sqrt(damping * damping / 4 - stiffness)
    found = rates(np.array([larger, stiffness / larger]))
    return float(np.prod(found).real), float(-np.sum(found).real)


def compensated(stiffness: float, damping: float, step: float) -> tuple[float, float]:
    """k′ and c′ with which implicit Euler has the positions of the exact contact.

    If the step alone damps more than the contact, about from h√k = 2ζ on, c′ is 0, because engines
    have no negative damping.

    Examples
    --------
    >>> k, c = compensated(100.0, 2.0, 0.01)
    >>> bool(np.allclose(represented(k, c, 0.01), (100.0, 2.0), rtol=1e-12))
    True
    """
    k, c = _with_rates(stiffness, damping, lambda rate: -np.expm1(-step * rate) / step)
    return k, max(0.0, c)


def represented(stiffness: float, damping: float, step: float) -> tuple[float, float]:
    """k and c of the exact contact that implicit Euler computes with k′ and c′.

    Examples
    --------
    Without a damper the step damps like c = kh, to first order:

    >>> [round(value, 3) for value in represented(100.0, 0.0, 1e-3)]
    [99.996, 0.1]
    """
    return _with_rates(stiffness, damping, lambda rate: -np.log1p(-step * rate) / step)


# Times from meeting the wall to the first step that begins in contact, in steps.
_FRACTIONS = np.linspace(1e-9, 1.0, 33)
# With this number N of steps or more, the error falls at least as 1/N.
_ASYMPTOTIC = 4096
# How exactly a real number of steps is found.
_FINE = 1e-6
FEWEST = 8
"""The smallest number of steps that resolve a contact."""
# Rounding errors of the state of a contact of many steps.
_TIE = 1e-10
# An undamped contact has eigenvalues of the amount 1, to rounding of a double root.
_ROUNDING = 1e-7


class Scheme(StrEnum):
    """The time-stepping scheme of an engine for a ball in contact, and the choice of parameters."""

    SEMI_IMPLICIT = "semi-implicit Euler"
    IMPLICIT = "implicit Euler"
    COMPENSATED = "compensated implicit Euler"


class FreeImpact(NamedTuple):
    """Duration T in units of 1/ω and restitution of a free impact."""

    duration: float
    restitution: float


def free_impact(damping_ratio: float, release: Release) -> FreeImpact:
    """The exact free impact, whose restitution is exp(-ζT) if the damper acts all the time T.

    For ζ < 1, T = (π - 2α)/√(1 - ζ²) (:mod:`bouncing_ball.models.damping`). With the force
    release the ball rebounds for ζ ≥ 1 as well, after T = 2 arcosh ζ/√(ζ² - 1), which is 2 at
    ζ = 1. A damper that acts on approach only acts for half of that time, and the spring alone for
    π/2.

    Raises
    ------
    ModelError
        If ζ is negative, or ζ ≥ 1 with the displacement release.

    Examples
    --------
    >>> duration, r = free_impact(1.0, Release.FORCE)
    >>> bool(duration == 2 and r == np.exp(-2))
    True
    """
    zeta = float(damping_ratio)
    if zeta < 1 or release is Release.DISPLACEMENT:
        r = float(restitution_coefficient(zeta, release))
        duration = release.free_angle(zeta) / np.sqrt((1 - zeta) * (1 + zeta))
        return FreeImpact(float(duration), r)
    root = np.sqrt((zeta - 1) * (zeta + 1))
    duration = 2 * np.arcsinh(root) / root if root > 0 else 2.0
    if not release.is_linear:
        half = duration / 2
        return FreeImpact(float(half + np.pi / 2), float(np.exp(-zeta * half)))
    return FreeImpact(float(duration), float(np.exp(-zeta * duration)))


def _step(scheme: Scheme, loss: float, h: float) -> tuple[np.ndarray, float]:
    """The matrix of one step of (x, v), and the λ for which the contact pushes if x + λv < 0."""
    if scheme is Scheme.SEMI_IMPLICIT:
        return np.array([[1 - h * h, h - loss * h * h], [-h, 1 - loss * h]]), loss
    k, c = compensated(1.0, loss, h) if scheme is Scheme.COMPENSATED else (1.0, loss)
    q = 1 + c * h + k * h * h
    return np.array([[1 - k * h * h / q, h / q], [-k * h / q, 1 / q]]), c / k + h


def restitution_in_steps(
    scheme: Scheme,
    damping_ratio: float,
    release: Release,
    steps: int,
    fraction: ArrayLike = _FRACTIONS,
) -> np.ndarray:
    """Restitution of free impacts computed with N time steps in the duration of the contact.

    Parameters
    ----------
    scheme : Scheme
    damping_ratio : float
        ζ, below 1 with the displacement release.
    release : Release
        The rule that ends the contact.
    steps : int
        N, the number of steps in a contact.
    fraction : array_like
        Time, in steps and in (0, 1], from meeting the wall to the first step that begins in
        contact.

    Returns
    -------
    ndarray
        Of the shape of ``fraction``.

    Raises
    ------
    ModelError
        If there are fewer than eight steps in a contact, or ζ is out of range.

    Examples
    --------
    Without damping semi-implicit Euler conserves x² - h x v + v², and therefore the speed of a ball
    that arrives and leaves at the same |x|; implicit Euler damps the motion:

    >>> r = restitution_in_steps(Scheme.SEMI_IMPLICIT, 0.0, Release.DISPLACEMENT, 50)
    >>> bool(abs(r.mean() - 1) < 1e-3)
    True
    >>> r = restitution_in_steps(Scheme.IMPLICIT, 0.0, Release.DISPLACEMENT, 50)
    >>> round(float(r.mean()), 2)
    0.91
    """
    if steps < FEWEST:
        raise ModelError(f"{steps} steps in a contact are too few: use at least {FEWEST}")
    zeta = float(damping_ratio)
    return impacts_in_steps(
        scheme, zeta, release, free_impact(zeta, release).duration / steps, fraction
    )


def impacts_in_steps(
    scheme: Scheme,
    damping_ratio: float,
    release: Release,
    step: float,
    fraction: ArrayLike = _FRACTIONS,
) -> np.ndarray:
    """Restitution of free impacts computed with a step h = ωΔt of any length.

    The arguments are those of :func:`restitution_in_steps`, with the step in units of 1/ω. A ball
    that does not leave within twice the duration of the contact has r = -1.

    Examples
    --------
    >>> h = free_impact(0.1, Release.FORCE).duration / 50
    >>> many = impacts_in_steps(Scheme.SEMI_IMPLICIT, 0.1, Release.FORCE, h)
    >>> bool(np.all(many == restitution_in_steps(Scheme.SEMI_IMPLICIT, 0.1, Release.FORCE, 50)))
    True

    Beyond the limit of stability an impact gains energy:

    >>> bool(impacts_in_steps(Scheme.SEMI_IMPLICIT, 0.1, Release.FORCE, 5.0).max() > 20)
    True
    """
    zeta = float(damping_ratio)
    if not release.is_linear and scheme is not Scheme.SEMI_IMPLICIT:
        raise ModelError(f"no scheme is known for {scheme} with the release {release}")
    matrix, lag = _step(scheme, 2 * zeta, step)
    start = np.asarray(fraction, dtype=float).ravel()
    grip = np.array([1.0, lag if release is Release.FORCE else 0.0])
    state = np.stack([-step * start, -np.ones_like(start)])
    steps = free_impact(zeta, release).duration / step
    few = steps < FEWEST
    further = 2 * round(steps)
    if not release.is_linear:
        spring, _ = _step(scheme, 0.0, step)
        if not few:
            state = _by_powers(matrix, _APPROACH, state, further)
            state = np.where(_APPROACH @ state < -_TIE, _STUCK, state)
        matrix = matrix if few else spring
    if few:
        away = matrix if release.is_linear else spring
        found = _step_by_step(matrix, away, grip, state, step)
    else:
        state = _by_powers(matrix, grip, state, further)
        # At a jump of the number of steps, rounding decides whether the last one ends the contact.
        found = np.where(grip @ state < -_TIE, -1.0, state[1])
    return found.reshape(np.shape(fraction))


# The ball approaches while this times (x, v) is negative; and a state of a ball that stays.
_APPROACH = np.array([0.0, 1.0])
_STUCK = np.array([[-1.0], [-1.0]])


def _by_powers(matrix: np.ndarray, grip: np.ndarray, state: np.ndarray, further: int) -> np.ndarray:
    """States at the end of motions that end once within so many further steps, where grip ≥ 0."""
    # The number of steps is halved by a power of the matrix.
    while further > 1:
        half = further // 2
        later = np.linalg.matrix_power(matrix, half) @ state
        state = np.where(grip @ later < 0, later, state)
        further -= half
    return matrix @ state


# A ball that has not left within so many coarse steps does not leave.
_PATIENCE = 200


def _step_by_step(
    matrix: np.ndarray, away: np.ndarray, grip: np.ndarray, state: np.ndarray, step: float
) -> np.ndarray:
    """Velocities at the end of contacts of few steps, in which the force may stop and act again.

    The matrices are those of a step that begins with v < 0, and of one with v ≥ 0.
    """
    free = np.array([[1.0, step], [0.0, 1.0]])
    for _ in range(_PATIENCE):
        inside = state[0] < 0
        if not inside.any():
            break
        moved = np.where(state[1] < 0, matrix @ state, away @ state)
        pushed = np.where(grip @ state < 0, moved, free @ state)
        state = np.where(inside, pushed, state)
    return np.where(state[0] < 0, -1.0, state[1])


def is_stable(scheme: Scheme, damping_ratio: float, step: float) -> bool:
    """Whether the steps h = ωΔt of a lasting contact do not grow: no eigenvalue of a step above 1.

    For semi-implicit Euler the limit is ``h = 2(√(1 + ζ²) - ζ)``; the others have none.

    Examples
    --------
    >>> [is_stable(Scheme.SEMI_IMPLICIT, 0.75, h) for h in (0.999, 1.001)]
    [True, False]
    """
    matrix, _ = _step(scheme, 2 * float(damping_ratio), step)
    return bool(np.abs(np.linalg.eigvals(matrix)).max() <= 1 + _ROUNDING)


def error_in_steps(scheme: Scheme, damping_ratio: float, release: Release, steps: int) -> float:
    """The largest |r_N - r| of a contact with N steps, over the instants of contact in a step.

    Raises
    ------
    ModelError
        If there are fewer than eight steps in a contact, or ζ is out of range.

    Examples
    --------
    >>> round(error_in_steps(Scheme.SEMI_IMPLICIT, 0.1, Release.FORCE, 100), 4)
    0.0025
    """
    computed = restitution_in_steps(scheme, damping_ratio, release, steps)
    return float(np.max(np.abs(computed - free_impact(damping_ratio, release).restitution)))


def steps_for(scheme: Scheme, damping_ratio: float, release: Release, error: float) -> int:
    """The smallest number N of steps in a contact for which r is within an error.

    The error falls as 1/N or faster. Below 4096, N is found by doubling and bisection, and above
    from 1/N.

    Raises
    ------
    ModelError
        If the error is not positive, or ζ is out of range.

    Examples
    --------
    >>> steps_for(Scheme.SEMI_IMPLICIT, 0.1, Release.FORCE, 0.0025)
    99
    """
    require(error > 0, error, "error of r", "positive")
    last = error_in_steps(scheme, damping_ratio, release, _ASYMPTOTIC)
    if last > error:
        return int(np.ceil(_ASYMPTOTIC * last / error))
    good = _ASYMPTOTIC
    bad = FEWEST - 1
    while good - bad > 1:
        # Halve until the number is bracketed, because the error at few steps follows no simple law.
        middle = max(good // 2, bad + 1) if bad < FEWEST else (good + bad) // 2
        if error_in_steps(scheme, damping_ratio, release, middle) <= error:
            good = middle
        else:
            bad = middle
    return good


def fewest_steps(scheme: Scheme, damping_ratio: float, release: Release, error: float) -> float:
    """The smallest real number of steps in a contact for which r is within an error.

    The step of a simulation is given, and the contact is as stiff as it can be. The number is
    between the whole numbers N - 1 and N of :func:`steps_for`, or eight.

    Examples
    --------
    >>> round(fewest_steps(Scheme.SEMI_IMPLICIT, 0.1, Release.FORCE, 0.0025), 1)
    98.3
    """
    good = float(steps_for(scheme, damping_ratio, release, error))
    if good in (FEWEST, _ASYMPTOTIC) or good > _ASYMPTOTIC:
        return good
    duration, exact = free_impact(damping_ratio, release)
    bad = good - 1
    while good - bad > _FINE:
        middle = (good + bad) / 2
        computed = impacts_in_steps(scheme, damping_ratio, release, duration / middle)
        if np.max(np.abs(computed - exact)) <= error:
            good = middle
        else:
            bad = middle
    return good
