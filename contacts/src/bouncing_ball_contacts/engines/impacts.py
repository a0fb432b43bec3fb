"""Free impacts on a spring and a damper in time steps, and the number of steps that r needs.

Because r depends on the instant within a step at which the ball meets the wall, it is computed for
many such instants.
"""

from collections.abc import Callable
from functools import lru_cache

import numpy as np
from numpy.typing import ArrayLike

from bouncing_ball_beyond.inherited.errors import ModelError, require
from bouncing_ball_beyond.models.damping import Release, restitution_coefficient
from bouncing_ball_contacts.engines.physical import free_duration
from bouncing_ball_contacts.engines.scheme import Scheme
from bouncing_ball_contacts.engines.steps import LinearStep, patience, until_outside

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


def restitution_in_steps(
    scheme: Scheme,
    damping_ratio: float,
    release: Release,
    steps: float,
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
    steps : float
        N, the number of steps in a contact.
    fraction : array_like
        Time, in steps and in (0, 1], from meeting the wall to the first step that begins inside.
        If contacts are found ahead, the step before is in contact as well.

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
    duration = free_duration(float(damping_ratio), release)
    return impacts_in_steps(scheme, damping_ratio, release, duration / steps, fraction)


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
    >>> h = free_duration(0.1, Release.FORCE) / 50
    >>> many = impacts_in_steps(Scheme.SEMI_IMPLICIT, 0.1, Release.FORCE, h)
    >>> bool(np.all(many == restitution_in_steps(Scheme.SEMI_IMPLICIT, 0.1, Release.FORCE, 50)))
    True

    Beyond the limit of stability an impact gains energy:

    >>> bool(impacts_in_steps(Scheme.SEMI_IMPLICIT, 0.1, Release.FORCE, 5.0).max() > 20)
    True
    """
    duration = free_duration(float(damping_ratio), release)
    linear = _linear_step(scheme, float(damping_ratio), release, float(step))
    start = np.asarray(fraction, dtype=float).ravel()
    state = np.stack([step * (linear.ahead - start), -np.ones_like(start)])
    if duration / step < FEWEST:
        place, velocity = state
        x, v = until_outside(linear, place, velocity, patience(duration / step))
    else:
        x, v = _by_powers(linear, state, 2 * round(duration / step))
    return np.where(x < 0, -1.0, v).reshape(np.shape(fraction))


# The ball approaches while this times (x, v) is negative; and a state of a ball that stays.
_APPROACH = np.array([0.0, 1.0])
_STAYS = np.array([[-1.0], [-1.0]])


def _by_powers(step: LinearStep, state: np.ndarray, most: int) -> tuple[np.ndarray, np.ndarray]:
    """What :func:`.steps.until_outside` returns for contacts of many steps, whose force acts
    without a break.

    Each step is then the same matrix, and the number of steps is found by its powers: the ranges of
    r take thousands of instants, and contacts up to 10⁸ steps.
    """
    if not step.release.is_linear:
        state = _ended(step, _APPROACH, state, most)
        state = np.where(_APPROACH @ state < -_TIE, _STAYS, state)
        step = step.elastic
    state = _ended(step, step.ending, state, most)
    # At a jump of the number of steps, rounding decides whether the last one ends the contact.
    stays = step.ending @ state < -_TIE
    return np.where(stays, -1.0, 0.0), state[1]


def _ended(step: LinearStep, ending: np.ndarray, state: np.ndarray, most: int) -> np.ndarray:
    """States at the end of motions that end once within so many steps, where ``ending`` ≥ 0."""
    *powers, matrix = _halves(step, most)
    for power in powers:
        later = power @ state
        state = np.where(ending @ later < 0, later, state)
    return matrix @ state


# The range of r asks for the impacts of the same steps again and again.
@lru_cache(maxsize=4)
def _halves(step: LinearStep, most: int) -> list[np.ndarray]:
    """The powers of the matrix of a step that halve a number of steps, and the matrix itself."""
    powers = []
    while most > 1:
        half = most // 2
        powers.append(np.linalg.matrix_power(step.matrix, half))
        most -= half
    return [*powers, step.matrix]


@lru_cache(maxsize=4)
def _linear_step(scheme: Scheme, damping_ratio: float, release: Release, size: float) -> LinearStep:
    """The step of a contact with ω = 1, which keeps its matrix."""
    return LinearStep.of(scheme, 1.0, 2 * damping_ratio, release, size)


def has_stable_steps(scheme: Scheme, damping_ratio: float, step: float) -> bool:
    """Whether the steps h = ωΔt of a lasting contact do not grow: no eigenvalue of a step above 1.

    For semi-implicit Euler the limit is ``h = 2(√(1 + ζ²) - ζ)``; the others have none.

    Examples
    --------
    >>> [has_stable_steps(Scheme.SEMI_IMPLICIT, 0.75, h) for h in (0.999, 1.001)]
    [True, False]
    """
    linear = LinearStep.of(scheme, 1.0, 2 * float(damping_ratio), Release.FORCE, step)
    return bool(np.abs(np.linalg.eigvals(linear.matrix)).max() <= 1 + _ROUNDING)


def error_in_steps(scheme: Scheme, damping_ratio: float, release: Release, steps: float) -> float:
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
    exact = float(restitution_coefficient(damping_ratio, release))
    return float(np.max(np.abs(computed - exact)))


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

    def is_within(number: float) -> bool:
        return error_in_steps(scheme, damping_ratio, release, number) <= error

    return bisected(is_within, good, good - 1, _FINE)


def bisected(is_within: Callable[[float], bool], good: float, bad: float, fine: float) -> float:
    """The least number that is within an error, up to ``fine``, between one that is and one that is
    not.
    """
    while good - bad > fine:
        middle = (good + bad) / 2
        if is_within(middle):
            good = middle
        else:
            bad = middle
    return good
