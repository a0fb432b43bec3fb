"""Thresholds of permanent contact of both models (Eqs. 9, 28-36)."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from bouncing_ball.errors import require
from bouncing_ball.paper.contact.damping import Release, check_damping, check_positive


def permanent_contact_threshold(
    frequency_ratio: ArrayLike, damping_ratio: ArrayLike, release: Release = Release.DISPLACEMENT
) -> np.ndarray:
    """Largest Λ of permanent contact: Λ_SD(ϖ) (Eq. 33) or, with the force release, Λ_F(ϖ).

    Raises
    ------
    ModelError
        If ϖ ≤ 0 or ζ < 0, or the release is unknown.

    Examples
    --------
    >>> float(permanent_contact_threshold(1.0, 0.25))
    0.5
    """
    check_positive(frequency_ratio, "frequency ratio ϖ")
    check_damping(damping_ratio, "damping ratio ζ")
    omega = np.asarray(frequency_ratio, dtype=float)
    loss = 2 * np.asarray(damping_ratio) / omega
    lag = 2 * Release.of(release).sine(damping_ratio) / omega
    return np.hypot((1 - 1 / omega) * (1 + 1 / omega), loss) / np.hypot(1, lag)


class Minimum(NamedTuple):
    """Lowest threshold over all frequency ratios, and the ϖ at which it is reached."""

    threshold: np.ndarray
    frequency_ratio: np.ndarray


def permanent_contact_minimum(
    damping_ratio: ArrayLike, release: Release = Release.DISPLACEMENT
) -> Minimum:
    """Lowest threshold over ϖ, where its derivative with respect to x = 1/ϖ² vanishes ::

        x = 2m/(1 + √(1 + 8 sin²α m)),     m = 1 - 2ζ² + 2 sin²α

    For the displacement release it is 2ζ√(1 - ζ²) at ϖ = 1/√(1 - 2ζ²) (Eq. 36).

    Raises
    ------
    ModelError
        If ζ < 0, or if ζ ≥ 1/√2 with the displacement release: Λ_SD then
        decreases towards 1 as ϖ grows, and has no minimum.

    Examples
    --------
    >>> round(float(permanent_contact_minimum(0.6).threshold), 15)
    0.96
    """
    zeta = np.asarray(damping_ratio, dtype=float)
    sine = Release.of(release).sine(zeta)
    centre = 1 - 2 * (zeta - sine) * (zeta + sine)
    allowed = "in [0, 1/√2): the permanent-contact threshold has no minimum over ϖ there"
    require((zeta >= 0) & (centre > 0), zeta, "damping ratio ζ", allowed)
    x = 2 * centre / (1 + np.sqrt(1 + 8 * sine * sine * centre))
    omega = 1 / np.sqrt(x)
    return Minimum(permanent_contact_threshold(omega, zeta, release), omega)


RESTITUTION_THRESHOLD = 1.0
"""Λ_CR, at which the greatest acceleration of the table equals that of gravity (Eq. 9)."""
