r"""When the ball never leaves the table (Eq. 9 and Eqs. 28-36).

A ball without contact stiffness stays down for Λ ≤ Λ_CR = 1. A ball on a
spring-damper oscillates steadily, and with the displacement release it stays
down while its displacement relative to the table never becomes positive::

    Λ ≤ Λ_SD(ϖ) = √γ/ϖ² = √((1 - x)² + 4ζ² x),     x = 1/ϖ²       (Eq. 33)

With the force release it stays down while the table always pushes. The force
over the weight is 1 + z″, and the table's motion reaches the ball with the
transmissibility (1 + 2iζ√x)/(1 - x + 2iζ√x), so that ::

    Λ ≤ Λ_F(ϖ) = √[((1 - x)² + 4ζ² x)/(1 + 4ζ² x)]

All quantities are dimensionless.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from bouncing_ball.errors import require
from bouncing_ball.impacts.release import Release
from bouncing_ball.impacts.spring_damper import check_contact

RESTITUTION_THRESHOLD = 1.0
"""Λ_CR: the table's acceleration reaches that of gravity (Eq. 9)."""


class Minimum(NamedTuple):
    """Lowest threshold over all frequency ratios, and where it is reached."""

    threshold: np.ndarray
    frequency_ratio: np.ndarray


def permanent_contact_threshold(
    frequency_ratio: ArrayLike,
    damping_ratio: ArrayLike,
    release: Release = Release.DISPLACEMENT,
) -> np.ndarray:
    """Largest Λ of permanent contact, Λ_SD(ϖ) (Eq. 33) or Λ_F(ϖ).

    Raises
    ------
    ModelError
        If ϖ ≤ 0 or ζ < 0.

    Examples
    --------
    >>> float(permanent_contact_threshold(1.0, 0.25))
    0.5
    """
    check_contact(frequency_ratio, damping_ratio)
    omega = np.asarray(frequency_ratio, dtype=float)
    loss = 2 * np.asarray(damping_ratio) / omega
    lag = 2 * Release.of(release).sine(damping_ratio) / omega
    return np.hypot((1 - 1 / omega) * (1 + 1 / omega), loss) / np.hypot(1, lag)


def permanent_contact_minimum(
    damping_ratio: ArrayLike, release: Release = Release.DISPLACEMENT
) -> Minimum:
    """Lowest threshold over ϖ: its derivative along x vanishes at ::

        x = 2m/(1 + √(1 + 8 sin²α m)),     m = 1 - 2ζ² + 2 sin²α

    For the displacement release 2ζ√(1 - ζ²) at ϖ = 1/√(1 - 2ζ²) (Eq. 36).

    Raises
    ------
    ModelError
        If ζ ≥ 1/√2 with the displacement release: Λ_SD then falls towards 1
        for all ϖ and has no minimum.

    Examples
    --------
    >>> round(float(permanent_contact_minimum(0.6).threshold), 15)
    0.96
    """
    zeta, sine = np.asarray(damping_ratio, dtype=float), Release.of(release).sine(damping_ratio)
    centre = 1 - 2 * (zeta - sine) * (zeta + sine)
    allowed = "in [0, 1/√2): the permanent-contact threshold has no minimum over ϖ there"
    require((zeta >= 0) & (centre > 0), zeta, "damping ratio ζ", allowed)
    x = 2 * centre / (1 + np.sqrt(1 + 8 * sine * sine * centre))
    omega = 1 / np.sqrt(x)
    return Minimum(permanent_contact_threshold(omega, zeta, release), omega)


def permanent_contact_frequency_ratios(
    threshold: ArrayLike,
    damping_ratio: ArrayLike,
    release: Release = Release.DISPLACEMENT,
) -> tuple[np.ndarray, np.ndarray]:
    """Frequency ratios (ϖ₋, ϖ₊) at which the threshold takes a value (Eqs. 34-35).

    With x = 1/ϖ², ``x = m ± √(m² + Λ² - 1)`` and m = 1 - 2(ζ² - Λ² sin²α); the
    larger x is the smaller ϖ. Where no such ϖ exists the entry is NaN, and
    infinite where it is reached only in the limit ϖ → ∞.

    The paper's form divides by 1 - Λ² and fails at Λ = 1; this one does not.

    Examples
    --------
    Undamped, Λ_SD = 1 at ϖ = 1/√2 and in the limit:

    >>> low, high = permanent_contact_frequency_ratios(1.0, 0.0)
    >>> round(float(low) ** 2, 15), float(high)
    (0.5, inf)
    """
    zeta = np.asarray(damping_ratio, dtype=float)
    lam = np.asarray(threshold, dtype=float)
    # The smaller root comes from the product of both, 1 - Λ²: no cancellation.
    product = (1 - lam) * (1 + lam)
    lift = Release.of(release).sine(zeta) * lam
    centre = 1 - 2 * (zeta - lift) * (zeta + lift)
    inside = centre * centre - product
    # At the minimum the two roots meet; rounding must not push them apart into
    # the complex plane.
    inside = np.where(np.abs(inside) <= 8 * np.finfo(float).eps, 0.0, inside)
    root = np.sqrt(np.where((inside >= 0) & (lam >= 0), inside, np.nan))
    outer = centre + root
    inner = np.where(outer > 0, product / np.where(outer > 0, outer, 1.0), centre - root)

    def frequency(x):
        positive = x > 0
        found = 1 / np.sqrt(np.where(positive, x, 1.0))
        # x = 0 is ϖ = ∞; a negative or NaN x is not a frequency.
        return np.where(positive, found, np.where(x == 0, np.inf, np.nan))

    return frequency(outer), frequency(inner)
