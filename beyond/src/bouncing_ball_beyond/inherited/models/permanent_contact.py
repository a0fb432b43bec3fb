r"""Permanent contact in both models: the thresholds Λ_CR and Λ_SD (Eqs. 9, 28-36).

A ball that rests on the table of the restitution model stays there as long as the table's downward
acceleration does not exceed gravity, up to ``Λ_CR = 1`` (Eq. 9).

In the spring-damper model, the displacement δ of a ball that never leaves oscillates about -1/ϖ²
(Eqs. 28-31). It stays below zero, where the contact would end, up to Λ_SD (Eqs. 32-33). For
ζ < 1/√2, Λ_SD falls with ϖ from ∞ to its minimum 2ζ√(1 - ζ²) (Eq. 36) and then rises to 1. Each
threshold between the minimum and 1 therefore belongs to two frequency ratios, ϖ₋ and ϖ₊
(Eqs. 34-35).

With the force release, a contact ends where δ + κ δ′ = 0, and δ + κ δ′ oscillates instead of δ. The
threshold is then ``Λ_F = Λ_SD/√(1 + κ²)``, which is not in the paper.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from bouncing_ball_beyond.inherited.errors import require, suggesting
from bouncing_ball_beyond.inherited.models.damping import Release, check_damping, check_positive

if TYPE_CHECKING:
    from bouncing_ball_beyond.inherited.drawing.result import Result
    from bouncing_ball_beyond.inherited.models.model import Model

RESTITUTION_THRESHOLD = 1.0
"""Λ_CR. A ball at rest stays on the table if ``|w″| = |Λ sin τ| ≤ 1`` at all times, that is for
Λ ≤ 1 (Eq. 9)."""


def permanent_contact_threshold(
    frequency_ratio: ArrayLike, damping_ratio: ArrayLike, release: Release = Release.DISPLACEMENT
) -> np.ndarray:
    """Largest Λ of permanent contact: Λ_SD(ϖ) or, with the force release, Λ_F(ϖ).

    In the paper, the steady motion stays below the table's level if ::

        -1/ϖ² + Λ/√γ ≤ 0,   γ = (ϖ² - 1)² + (2ζϖ)²          (32)
        Λ ≤ Λ_SD = √γ/ϖ² = √(1 + (4ζ² - 2)/ϖ² + 1/ϖ⁴)       (33)

    The code has γ/ϖ⁴ as (1 - 1/ϖ²)² + (2ζ/ϖ)², which loses no digits near ϖ = 1.

    Raises
    ------
    ModelError
        If ϖ ≤ 0 or ζ is not in [0, 1), or the release is unknown.

    Examples
    --------
    >>> float(permanent_contact_threshold(1.0, 0.25))
    0.5
    """
    omega = check_positive(frequency_ratio, "frequency ratio ϖ")
    zeta = check_damping(damping_ratio)
    lag = 2 * Release.of(release).sine(zeta) / omega
    detuning = (1 - 1 / omega) * (1 + 1 / omega)
    return np.hypot(detuning, 2 * zeta / omega) / np.hypot(1, lag)


class FrequencyRatios(NamedTuple):
    """The two frequency ratios ϖ₋ ≤ ϖ₊ with the same threshold Λ_SD; NaN where there is none."""

    lower: np.ndarray
    upper: np.ndarray


@np.errstate(divide="ignore", invalid="ignore")  # where there is no such ϖ
def permanent_contact_frequency_ratios(
    threshold: ArrayLike, damping_ratio: ArrayLike
) -> FrequencyRatios:
    """The ϖ at which Λ_SD has a given value Λ, the inverse of Eq. 33 (Eqs. 34-35)::

        ϖ±² = [1 - 2ζ² ± √((1 - 2ζ²)² + Λ² - 1)]/(1 - Λ²)

    Λ_SD approaches 1 from below as ϖ → ∞ if ζ < 1/√2, so that ϖ₊ is infinite at Λ = 1. Larger
    thresholds have ϖ₋ only. Thresholds below the minimum have neither; nor do those of 1 and
    below if ζ ≥ 1/√2, because Λ_SD then stays above 1.

    Parameters
    ----------
    threshold, damping_ratio : array_like
        Λ > 0 and ζ, which broadcast. The contact ends at the displacement release.

    Raises
    ------
    ModelError
        If Λ ≤ 0 or ζ is not in [0, 1).

    Examples
    --------
    For r = 0.65 the thresholds of both models differ by 1 % at ϖ = 9.81 (Fig. 16):

    >>> ratios = permanent_contact_frequency_ratios(0.99, 0.1359)
    >>> round(float(ratios.lower), 3), round(float(ratios.upper), 2)
    (0.722, 9.81)
    """
    lam = check_positive(threshold, "threshold Λ")
    zeta = check_damping(damping_ratio)
    centre = 1 - 2 * zeta * zeta
    divisor = (1 - lam) * (1 + lam)
    # (1 - 2ζ²)² + Λ² - 1, the square of Λ minus that of the minimum.
    root = np.sqrt(lam * lam - 4 * zeta * zeta * (1 - zeta) * (1 + zeta))
    upper = np.where((centre > 0) & (lam <= 1), (centre + root) / divisor, np.nan)
    # ϖ₋² = 1/((1 - Λ²) ϖ₊²), where the difference in Eq. 35 would lose digits.
    without_minimum = np.where(lam > 1, (centre - root) / divisor, np.nan)
    lower = np.where(centre > 0, 1 / (centre + root), without_minimum)
    return FrequencyRatios(np.sqrt(lower), np.sqrt(upper))


class Minimum(NamedTuple):
    """The lowest threshold of permanent contact, and the ϖ at which it is reached."""

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
        If ζ is not in [0, 1), or if ζ ≥ 1/√2 with the displacement release: Λ_SD then decreases
        towards 1 as ϖ grows, and has no minimum.

    Examples
    --------
    >>> round(float(permanent_contact_minimum(0.6).threshold), 15)
    0.96
    """
    zeta = check_damping(damping_ratio)
    sine = Release.of(release).sine(zeta)
    centre = 1 - 2 * (zeta - sine) * (zeta + sine)
    allowed = "in [0, 1/√2): the permanent-contact threshold has no minimum over ϖ there"
    require(centre > 0, zeta, "damping ratio ζ", allowed)
    x = 2 * centre / (1 + np.sqrt(1 + 8 * sine * sine * centre))
    omega = 1 / np.sqrt(x)
    return Minimum(permanent_contact_threshold(omega, zeta, release), omega)


@suggesting
def permanent_contact(ball: Model) -> float | Result:
    """The Λ up to which a ball at rest stays on the table.

    Parameters
    ----------
    ball : Model
        The threshold is 1 for a rigid ball (Eq. 9), and Λ_SD for a contact with a spring and a
        damper (Eq. 33).

    Returns
    -------
    float or Result
        If a parameter of the ball is an array, a dataset with an axis named after each array.

    Raises
    ------
    ModelError
        If the argument is no ball.

    Examples
    --------
    >>> from bouncing_ball_beyond.inherited import spring_damper
    >>> permanent_contact(spring_damper(frequency_ratio=2.0, damping_ratio=0.0))
    0.75
    """
    from bouncing_ball_beyond.inherited.models.model import a_ball

    threshold: Any = a_ball(ball).permanent_contact_threshold()
    if not np.ndim(threshold):
        return float(threshold)
    from bouncing_ball_beyond.inherited.datasets.labelled import Grid
    from bouncing_ball_beyond.inherited.drawing.result import Result

    grid = Grid(**ball.parameters)
    return Result.on_grid(grid, {"threshold_amplitude": threshold}, "permanent-contact")
