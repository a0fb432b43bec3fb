"""The threshold of permanent contact of a spring and a damper, also of overdamped ones.

The inherited library has Eqs. 28-36 for ζ < 1
(:mod:`bouncing_ball_beyond.inherited.models.permanent_contact`). The steady motion has the same
amplitude for every ζ, so that ``Λ_SD² = (1 - 1/ϖ²)² + (2ζ/ϖ)²`` also holds for overdamped contacts.
"""

import numpy as np
from numpy.typing import ArrayLike

from bouncing_ball_beyond.inherited.models import permanent_contact as underdamped
from bouncing_ball_beyond.models.damping import Release, check_damping


def permanent_contact_threshold(
    frequency_ratio: ArrayLike, damping_ratio: ArrayLike, release: str = Release.DISPLACEMENT
) -> np.ndarray:
    """Largest Λ of permanent contact for any ζ ≥ 0: Λ_SD(ϖ) or, with the force release, Λ_F(ϖ).

    Raises
    ------
    ModelError
        If ϖ ≤ 0 or ζ < 0, or the release is unknown.

    Examples
    --------
    >>> float(permanent_contact_threshold(1.0, 0.25)), float(permanent_contact_threshold(1.0, 2.0))
    (0.5, 4.0)
    """
    elastic = underdamped.permanent_contact_threshold(frequency_ratio, 0.0)
    zeta = check_damping(damping_ratio, "damping ratio ζ")
    loss = 2 * zeta / np.asarray(frequency_ratio)
    lag = 2 * Release.of(release).sine(zeta) / np.asarray(frequency_ratio)
    return np.hypot(elastic, loss) / np.hypot(1, lag)
