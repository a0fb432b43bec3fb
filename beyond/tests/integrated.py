"""One impact and the flight after it, by an integrator and a bracketing root finder.

It shares no formula with the package: the contact is a differential equation with an event.
"""

import numpy as np
from scipy.integrate import solve_ivp
from scipy.optimize import brentq


def contact(amplitude, tau, u, ratio, zeta, kappa):
    """The release after an impact at the phase tau with the closing speed u: time, δ, δ′, height.

    The height is the greatest one in the contact, by samples.
    """

    def motion(t, y):
        load = 1 - amplitude * np.sin(t)
        return [y[1], -load - 2 * zeta * ratio * y[1] - ratio**2 * y[0]]

    def release(t, y):
        return y[0] + kappa * y[1] if t > tau + 1e-9 else -1.0

    release.terminal, release.direction = True, 1
    found = solve_ivp(
        motion,
        (tau, tau + 60),
        [0.0, -u],
        "DOP853",
        events=release,
        rtol=1e-13,
        atol=1e-15,
        max_step=0.5 / ratio,
        dense_output=True,
    )
    end = found.t_events[0][0]
    gap, speed = found.y_events[0][0]
    times = np.linspace(tau, end, 20001)
    heights = amplitude * np.sin(times) + found.sol(times)[0]
    return end, gap, speed, heights.max()


def flight(amplitude, leaves, gap, speed):
    """The first landing at δ = 0 after a release: time and closing speed, and the greatest height."""
    height = gap + amplitude * np.sin(leaves)
    velocity = speed + amplitude * np.cos(leaves)

    def above(t):
        return height + velocity * t - t * t / 2 - amplitude * np.sin(leaves + t)

    times = np.arange(1e-6, 200.0, 2e-3)
    below = (above(times[:-1]) > 0) & (above(times[1:]) <= 0)
    first = np.flatnonzero(below)[0]
    time = brentq(above, times[first], times[first + 1], xtol=1e-14)
    closing = amplitude * np.cos(leaves + time) - velocity + time
    rise = np.clip(velocity, 0, time)
    return leaves + time, closing, height + velocity * rise - rise**2 / 2


def leg(ball, amplitude, tau, u):
    """The next impact after one of a rigid ball or one on a spring and a damper: time and speed.

    Also the greatest height up to it.
    """
    if not ball.lasts:
        leaves, gap, speed, lifted = tau, 0.0, ball.restitution * u, -np.inf
    else:
        given = float(ball.frequency_ratio), float(ball.zeta), float(ball.kappa)
        leaves, gap, speed, lifted = contact(amplitude, tau, u, *given)
    lands, closing, summit = flight(amplitude, leaves, gap, speed)
    return lands, closing, max(summit, lifted)


def around(orbit, shift=(0.0, 0.0)):
    """One period of an orbit from its first impact, moved by a shift of its time and speed.

    Returns the time and speed of the impact after it, without the periods, and the greatest height.
    """
    tau, u, highest = orbit.times[0] + shift[0], orbit.speeds[0] + shift[1], -np.inf
    for _ in range(orbit.impacts):
        tau, u, height = leg(orbit.ball, orbit.amplitude, tau, u)
        highest = max(highest, height)
    return np.array([tau - 2 * np.pi * orbit.periods, u]), highest
