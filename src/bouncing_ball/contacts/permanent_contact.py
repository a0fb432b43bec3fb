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

from bouncing_ball.contacts.release import Release
from bouncing_ball.contacts.spring_damper import check_contact
from bouncing_ball.errors import require

RESTITUTION_THRESHOLD = 1.0
"""Λ_CR: the table's acceleration reaches that of gravity (Eq. 9)."""


class Minimum(NamedTuple):
    """Lowest threshold over all frequency ratios, and where it is reached."""

    threshold: np.ndarray
    frequency_ratio: np.ndarray


def permanent_contact_threshold(
    frequency_ratio: ArrayLike, damping_ratio: ArrayLike, release: Release = Release.DISPLACEMENT
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
