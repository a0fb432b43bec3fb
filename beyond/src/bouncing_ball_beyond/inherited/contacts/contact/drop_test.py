r"""A drop test in SI units: the rebound of a ball on a spring and a damper, with gravity.

The restitution coefficient of a free impact, without gravity, is larger than √(h′/h), the more so
the slower the impact and the more compliant the contact. The damping ratio of a contact that is
known by a drop test therefore depends on its stiffness. In units of 1/ω and g/ω² the contact has
ϖ = 1, and its table is at rest.
"""

import math
from collections.abc import Callable

import numpy as np
import scipy

from bouncing_ball_beyond.inherited.contacts.contact.rebounds import rises
from bouncing_ball_beyond.inherited.errors import ParameterError
from bouncing_ball_beyond.models.damping import Release
from bouncing_ball_beyond.models.spring_damper import SpringDamper

# The largest damping ratio of a fit: a contact with ζ ≥ 1 has no orbit on a vibrating table.
_MOST = 1 - 1e-9


def rebound(omega: float, zeta: float, height: float, gravity: float, release: Release) -> float:
    """The height to which a ball rises that is dropped onto a table at rest, in m.

    Parameters
    ----------
    omega, zeta : float
        ω = √(k/m) in rad/s, and ζ in [0, 1).
    height : float
        Height of the drop in m.
    gravity : float
        g in m/s².
    release : Release

    Returns
    -------
    float
        The height above the level of the table; 0 if the ball does not leave it.

    Examples
    --------
    >>> round(rebound(50.0, 0.0, 0.2, 9.81, Release.DISPLACEMENT), 12)
    0.2

    From a small height the ball does not leave a damped contact again:

    >>> round(rebound(50.0, 0.3, 0.2, 9.81, Release.DISPLACEMENT), 4)
    0.0153
    >>> rebound(50.0, 0.3, 0.002, 9.81, Release.DISPLACEMENT)
    0.0
    """
    unit = gravity / omega**2
    speed = np.array([math.sqrt(2 * height / unit)])
    (found,) = rises(SpringDamper(1.0, zeta, release), speed)
    return float(found) * unit


def fitted_damping_ratio(
    omega_of: Callable[[float], float],
    drop: float,
    wanted: float,
    gravity: float,
    release: Release,
) -> float:
    """ζ of the contact that lets a ball rise to a given height after a drop with gravity.

    Parameters
    ----------
    omega_of : callable
        ω = √(k/m) in rad/s as a function of ζ: a constant for a given stiffness.
    drop, wanted : float
        Heights of the drop and of the rebound in m, of which the drop is not the lower one.
    gravity : float
    release : Release

    Raises
    ------
    ModelError
        If the rebound is lower than that of every contact with ζ < 1.

    Examples
    --------
    >>> zeta = fitted_damping_ratio(lambda zeta: 65.0, 0.2, 0.04, 9.81, Release.FORCE)
    >>> round(rebound(65.0, zeta, 0.2, 9.81, Release.FORCE), 12)
    0.04
    """
    if wanted == drop:
        return 0.0

    def surplus(zeta: float) -> float:
        found = rebound(omega_of(zeta), zeta, drop, gravity, release)
        # A ball that does not leave the table again is far from every rebound that was measured.
        return (found or -drop) - wanted

    if surplus(_MOST) > 0:
        least = surplus(_MOST) + wanted
        raise ParameterError(
            f"no contact rebounds from {{drop_height}} {drop:g} m to {{rebound_height}} "
            f"{wanted:g} m: with a {release} release and ζ < 1 it rises to {least:.3g} m at least"
        )
    if surplus(0.0) < 0:
        return 0.0
    return float(scipy.optimize.brentq(surplus, 0.0, _MOST, xtol=1e-16, rtol=1e-14))
