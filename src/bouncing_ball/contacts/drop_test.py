r"""A drop test on a spring and a damper with gravity, on a table at rest, in SI units.

A ball that is dropped from the height h touches the table with the speed v = √(2gh). In contact
its penetration x obeys ::

    x″ + 2ζω x′ + ω² x = g,   x(0) = 0,   x′(0) = v

With the static deflection s = g/ω² and ω_d = ω√(1 - ζ²) it is ::

    x = s + e^{-ζωt} [-s cos ω_d t + (v - ζω s)/ω_d sin ω_d t]

The contact ends where x = 0, or where the force ω² x + 2ζω x′ vanishes. If the ball is then at the
penetration x_e with the upward speed u, it rises to the height u²/(2g) - x_e above the table's
level. If the damper acts on approach only, energy is conserved from the greatest penetration P on,
and the ball rises to ω² P²/(2g) - P.

The restitution coefficient of a free impact, without gravity, is larger than √(h′/h), the more so
the slower the impact and the more compliant the contact.
"""

import math
from collections.abc import Callable

import scipy

from bouncing_ball.errors import ParameterError
from bouncing_ball.models.damping import Release

# The largest damping ratio of a fit: a contact with ζ ≥ 1 has no orbit on a vibrating table.
_MOST = 1 - 1e-9
# How much less a ball bounces than a free impact at the speed of `slowed_speed`.
SLOWED = 0.01
# Steps of the search for that speed, each to half of the speed before, from the largest down.
_HALVES = 200


def rebound(
    omega: float, zeta: float, height: float, gravity: float, release: Release
) -> float | None:
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
    float or None
        The height above the level of the table; None if the ball does not leave it.

    Examples
    --------
    >>> round(rebound(50.0, 0.0, 0.2, 9.81, Release.DISPLACEMENT), 12)
    0.2

    From a small height the ball does not leave a damped contact again:

    >>> round(rebound(50.0, 0.3, 0.2, 9.81, Release.DISPLACEMENT), 4)
    0.0153
    >>> rebound(50.0, 0.3, 0.002, 9.81, Release.DISPLACEMENT) is None
    True
    """
    speed = math.sqrt(2 * gravity * height)
    sink = gravity / omega**2
    damped = omega * math.sqrt((1 - zeta) * (1 + zeta))
    decay = zeta * omega
    # Coefficients of e^{-ζωt} cos ω_d t and e^{-ζωt} sin ω_d t of x and of x′.
    x_cosine = -sink
    x_sine = (speed - decay * sink) / damped
    v_cosine = -decay * x_cosine + damped * x_sine
    v_sine = -decay * x_sine - damped * x_cosine

    def state(angle: float) -> tuple[float, float]:
        shrunk = math.exp(-zeta * omega / damped * angle)
        cosine = math.cos(angle)
        sine = math.sin(angle)
        depth = sink + shrunk * (x_cosine * cosine + x_sine * sine)
        return depth, shrunk * (v_cosine * cosine + v_sine * sine)

    if not release.is_linear:
        turn = math.atan2(v_cosine, -v_sine) % math.pi
        deepest, _ = state(turn)
        rise = (omega * deepest) ** 2 / (2 * gravity) - deepest
        return rise if rise > 0 else None

    # The contact holds while x + lag x′ > 0. This function oscillates about `sink`, and falls to
    # its first minimum, where it is lowest.
    lag = 2 * zeta / omega if release is Release.FORCE else 0.0
    cosine = x_cosine + lag * v_cosine
    sine = x_sine + lag * v_sine
    slope_cosine = damped * sine - decay * cosine
    slope_sine = -decay * sine - damped * cosine
    lowest = (math.atan2(slope_sine, slope_cosine) - math.pi / 2) % (2 * math.pi)
    highest = max(lowest - math.pi, 0.0)

    def grip(angle: float) -> float:
        depth, rate = state(angle)
        return depth + lag * rate

    if grip(lowest) >= 0 or grip(highest) <= 0:
        return None
    # Without damping the end is nearly a double zero, next to `lowest`.
    end = float(scipy.optimize.brentq(grip, highest, lowest, xtol=1e-15, rtol=1e-15, maxiter=1000))
    depth, rate = state(end)
    if rate >= 0:
        return None
    return rate * rate / (2 * gravity) - depth


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
        return (-drop if found is None else found) - wanted

    if surplus(_MOST) > 0:
        least = surplus(_MOST) + wanted
        raise ParameterError(
            f"no contact rebounds from {{drop_height}} {drop:g} m to {{rebound_height}} "
            f"{wanted:g} m: with a {release} release and ζ < 1 it rises to {least:.3g} m at least"
        )
    if surplus(0.0) < 0:
        return 0.0
    return float(scipy.optimize.brentq(surplus, 0.0, _MOST, xtol=1e-16, rtol=1e-14))


def slowed_speed(
    omega: float, zeta: float, free: float, gravity: float, release: Release
) -> float | None:
    """The impact speed in m/s at which gravity makes √(h′/h) smaller than the r of a free impact
    by one part in a hundred; None without damping, where it never does.

    Faster impacts have the r of a free impact more closely, slower ones are below it.

    Examples
    --------
    >>> speed = slowed_speed(65.0, 0.2, 0.526657, 9.81, Release.DISPLACEMENT)
    >>> drop = speed**2 / (2 * 9.81)
    >>> height = rebound(65.0, 0.2, drop, 9.81, Release.DISPLACEMENT)
    >>> round(math.sqrt(height / drop) / 0.526657, 4)
    0.99
    """
    if zeta <= 0 or free >= 1:
        return None

    def surplus(logarithm: float) -> float:
        drop = math.exp(2 * logarithm) / (2 * gravity)
        height = rebound(omega, zeta, drop, gravity, release) or 0.0
        return math.sqrt(max(height, 0.0) / drop) - (1 - SLOWED) * free

    # At speeds far above g/ω gravity is not felt.
    fast = math.log(gravity / omega) + 12
    for _ in range(_HALVES):
        slow = fast - math.log(2)
        if surplus(slow) < 0 <= surplus(fast):
            return math.exp(scipy.optimize.brentq(surplus, slow, fast, xtol=1e-12))
        fast = slow
    return None
