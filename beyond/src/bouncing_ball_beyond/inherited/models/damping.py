"""Damping, restitution and the release rule of a contact with a spring and a damper (Eqs. 16, 23).

A contact ends where ``δ + κ δ′ = 0``. With κ = 0 the ball is back at the table's level; with
κ = 2ζ/ϖ the contact force vanishes. Formulas contain the condition as ``sin α = κϖ/2``, which is 0
or ζ, so that both releases have the same formulas; a free contact ends at the angle π - 2α.

During half a period of a free damped oscillator, without gravity, the speed is multiplied by
``r = exp(-π ζ / √(1 - ζ²))`` (Nagurka and Huang). If instead the contact ends where its force
vanishes, at the angle π - 2 arcsin ζ, the speed is multiplied by
``exp(-ζ (π - 2 arcsin ζ) / √(1 - ζ²))`` (Schwager and Pöschel, Granular Matter 9, 2007).

All functions are evaluated by :mod:`bouncing_ball_beyond.inherited.numerics.elementary`, so that a
contact has the same ζ on every processor: a chaotic motion turns another last digit into another
motion.
"""

from enum import StrEnum

import numpy as np
from numpy.typing import ArrayLike

from bouncing_ball_beyond.inherited.errors import RESTITUTION, Range, one_of, require
from bouncing_ball_beyond.inherited.numerics.arrays import as_numbers
from bouncing_ball_beyond.inherited.numerics.elementary import (
    arctangent,
    exponential,
    logarithm,
    sine_and_versine,
)

# Newton steps for ζ of the force release. The initial error is below 10 %, and each step doubles
# the number of correct digits.
_NEWTON_STEPS = 6
# The difference between π/2 and the double nearest to it.
_REST = 6.123233995736766e-17


class Release(StrEnum):
    """The condition that ends a contact."""

    DISPLACEMENT = "displacement"
    """The ball is back at the table's level, δ = 0 (Eq. 23, the paper's)."""
    FORCE = "force"
    """The contact force vanishes, 2ζϖ δ′ + ϖ² δ = 0, so that it never pulls the ball."""

    @classmethod
    def of(cls, rule: str) -> "Release":
        """The release with this name.

        Raises
        ------
        ModelError
            If there is no such release.

        Examples
        --------
        >>> Release.of("force")
        <Release.FORCE: 'force'>
        """
        return one_of("release", rule, {str(each): each for each in cls})

    def sine(self, damping_ratio: ArrayLike) -> np.ndarray:
        """``sin α = κϖ/2``: ζ for the force release, 0 at the table's level.

        Examples
        --------
        >>> float(Release.DISPLACEMENT.sine(0.3)), float(Release.FORCE.sine(0.3))
        (0.0, 0.3)
        """
        zeta = np.asarray(damping_ratio, dtype=float)
        return zeta if self is Release.FORCE else np.zeros_like(zeta)

    def free_angle(self, damping_ratio: ArrayLike) -> np.ndarray:
        """The angle ϖ_d s at which a free contact with ζ < 1 ends, π - 2α.

        Examples
        --------
        >>> [round(float(rule.free_angle(0.5)) / np.pi, 12) for rule in Release]
        [1.0, 0.666666666667]
        """
        # This form, 2 arccos, keeps its digits as ζ → 1, where π - 2 arcsin ζ would lose them.
        sine = self.sine(damping_ratio)
        return 2 * arctangent(np.sqrt((1 - sine) * (1 + sine)), sine)


def check_positive(value: ArrayLike, name: str) -> np.ndarray:
    """A parameter as an array.

    Raises
    ------
    ModelError
        Unless all its entries are finite positive numbers.

    Examples
    --------
    >>> check_positive(-1.0, "frequency ratio ϖ")
    Traceback (most recent call last):
    ...
    bouncing_ball_beyond.inherited.errors.ModelError: frequency ratio ϖ = -1.0 is not a finite \
number > 0
    """
    allowed = "a finite number > 0"
    x = as_numbers(value, name, allowed)
    require(np.isfinite(x) & (x > 0), x, name, allowed)
    return x


def check_damping(value: ArrayLike) -> np.ndarray:
    """The damping ratio ζ of an oscillating contact as an array.

    Raises
    ------
    ModelError
        Unless 0 ≤ ζ < 1: an overdamped contact does not oscillate, and has no restitution
        coefficient in the sense of Eq. 16.

    Examples
    --------
    >>> float(check_damping(0.25))
    0.25
    """
    name = "damping ratio ζ"
    allowed = "in [0, 1): an overdamped contact has no restitution coefficient"
    zeta = as_numbers(value, name, allowed)
    require((zeta >= 0) & (zeta < 1), zeta, name, allowed)
    return zeta


def check_restitution(value: ArrayLike, interval: Range = RESTITUTION) -> np.ndarray:
    """The restitution coefficient r as an array.

    Raises
    ------
    ModelError
        If any r lies outside of its range or is no number.

    Examples
    --------
    >>> check_restitution("x")
    Traceback (most recent call last):
    ...
    bouncing_ball_beyond.inherited.errors.ModelError: restitution coefficient r = 'x' is not in \
(0, 1]
    """
    name = "restitution coefficient r"
    allowed = f"in {interval.interval}"
    r = as_numbers(value, name, allowed)
    low = r > interval.low if interval.ends[0] == "(" else r >= interval.low
    require(low & (r <= interval.high), r, name, allowed)
    return r


def damped_frequency(damping_ratio: ArrayLike, frequency_ratio: ArrayLike = 1.0) -> np.ndarray:
    """ϖ_d = ϖ√(1 - ζ²), the frequency with which a damped contact oscillates.

    Examples
    --------
    >>> float(damped_frequency(0.6, 10.0))
    8.0
    """
    zeta = np.asarray(damping_ratio)
    # As a product the difference has no cancellation for ζ next to 1.
    return np.asarray(frequency_ratio) * np.sqrt((1 - zeta) * (1 + zeta))


def damping_ratio(restitution: ArrayLike, release: str = Release.DISPLACEMENT) -> np.ndarray:
    """Damping ratio ζ of a free contact with the restitution coefficient r.

    ``ζ = -ln r / √(π² + ln² r)`` (Eq. 16) for the displacement release. For the force release
    ζ = cos β with ``2β cot β = -ln r``.

    Parameters
    ----------
    restitution : array_like
        r in (0, 1] for the displacement release, in (e⁻², 1] for the force release.
    release : Release or str
        The condition that ends the contact in which r is measured.

    Raises
    ------
    ModelError
        If any r lies outside its range, or the release is unknown. The lower bounds are the
        limits for ζ → 1.

    Examples
    --------
    >>> float(damping_ratio(1.0))
    0.0
    >>> round(float(damping_ratio(0.65)), 4), round(float(damping_ratio(0.65, Release.FORCE)), 4)
    (0.1359, 0.1499)
    """
    r = check_restitution(restitution)
    decrement = np.abs(logarithm(r))
    if Release.of(release) is Release.DISPLACEMENT:
        return decrement / np.sqrt(np.pi * np.pi + decrement * decrement)
    allowed = "in (e⁻², 1], the range of the force release with ζ < 1"
    require(decrement < 2, r, "restitution coefficient r", allowed)
    return force_damping_ratio(decrement)


def force_damping_ratio(decrement: np.ndarray) -> np.ndarray:
    """ζ = cos β with ``2β cot β = decrement``, -ln r of the force release, in [0, 2).

    Newton's method finds β in (0, π/2]. The left side falls from 2 to 0 and is concave, so that the
    steps converge from the right without leaving the interval. The starting point replaces it by
    the parabola 2 - 8 (β/π)², which agrees with it at both ends.

    Examples
    --------
    >>> round(float(force_damping_ratio(np.array(np.pi / 2)) ** 2), 12)
    0.5
    """
    beta = np.maximum(np.pi / 2 * np.sqrt(1 - decrement / 2), np.finfo(float).tiny)
    for _ in range(_NEWTON_STEPS):
        sine = sine_and_versine(beta)[0]
        cosine = _cosine(beta)
        value = 2 * beta * cosine / sine - decrement
        # The bound of the slope is its limit at β = 0, where rounding leaves no slope.
        slope = np.minimum(2 * (cosine * sine - beta) / (sine * sine), -4 / 3 * beta)
        beta = beta - value / slope
    # cos(π/2) gives the rounding of π/2, which is below the rounding of r = 1.
    return np.where(decrement > 0, _cosine(beta), 0.0)[()]


def _cosine(beta: np.ndarray) -> np.ndarray:
    """cos β, accurate near π/2 because the rounding error of π/2 is added."""
    return sine_and_versine((np.pi / 2 - beta) + _REST)[0]


def restitution_coefficient(damping: ArrayLike, release: str = Release.DISPLACEMENT) -> np.ndarray:
    """Restitution coefficient of a free contact, ``r = exp(-(π - 2α) ζ/√(1 - ζ²))``.

    The inverse of :func:`damping_ratio`, with α = 0 for the displacement release of Eq. 16. For the
    force release r is greater, because the contact ends before its force pulls the ball.

    Parameters
    ----------
    damping : array_like
        ζ in [0, 1).
    release : Release or str
        The condition that ends the contact.

    Raises
    ------
    ModelError
        If any ζ lies outside this range, or the release is unknown.

    Examples
    --------
    >>> float(restitution_coefficient(0.0))
    1.0
    >>> [round(float(restitution_coefficient(0.2, rule)), 4) for rule in Release]
    [0.5266, 0.5717]
    """
    rule = Release.of(release)
    zeta = check_damping(damping)
    return exponential(-rule.free_angle(zeta) * zeta / damped_frequency(zeta))
