"""Damping ratio and restitution coefficient of a linear contact (Eq. 16).

Half a period of a free damped oscillator, without gravity, returns the
velocity multiplied by ``r = exp(-π ζ / √(1 - ζ²))`` (Nagurka and Huang). If the
contact ends where its force vanishes instead, at the angle π - 2 arcsin ζ, the
velocity is multiplied by ``exp(-ζ (π - 2 arcsin ζ) / √(1 - ζ²))`` (Schwager and
Pöschel, Granular Matter 9, 2007). Everything here is dimensionless.
"""

import numpy as np
from numpy.typing import ArrayLike

from bouncing_ball.errors import require
from bouncing_ball.impacts.release import Release


def damping_ratio(restitution: ArrayLike) -> np.ndarray:
    """Damping ratio ζ that gives the restitution coefficient r (Eq. 16).

    ``ζ = -ln r / √(π² + ln² r)``

    Parameters
    ----------
    restitution : array_like
        r in (0, 1].

    Raises
    ------
    ModelError
        If any r lies outside (0, 1]: no linear contact has r = 0, which is
        the limit ζ → 1.

    Examples
    --------
    >>> float(damping_ratio(1.0))
    0.0
    >>> round(float(damping_ratio(0.65)), 4)
    0.1359
    """
    r = np.asarray(restitution, dtype=float)
    require((r > 0) & (r <= 1), r, "restitution coefficient r", "in (0, 1]")
    decrement = -np.log(r) + 0.0  # + 0.0 turns -0 into 0 at r = 1
    return decrement / np.hypot(np.pi, decrement)


def restitution_coefficient(
    damping: ArrayLike, release: Release = Release.DISPLACEMENT
) -> np.ndarray:
    """Restitution coefficient of a free, underdamped linear contact.

    The inverse of Eq. 16 for the displacement release; greater for the force
    release, whose contact ends before it pulls.

    Parameters
    ----------
    damping : array_like
        ζ in [0, 1).
    release : Release
        What ends the contact.

    Raises
    ------
    ModelError
        If any ζ lies outside [0, 1): at ζ ≥ 1 a free contact never returns.

    Examples
    --------
    >>> float(restitution_coefficient(0.0))
    1.0
    """
    zeta = np.asarray(damping, dtype=float)
    allowed = "in [0, 1): an overdamped contact has no restitution coefficient"
    require((zeta >= 0) & (zeta < 1), zeta, "damping ratio ζ", allowed)
    angle = np.pi - 2 * np.arcsin(zeta) if release is Release.FORCE else np.pi
    return np.exp(-angle * zeta / np.sqrt((1 - zeta) * (1 + zeta)))
