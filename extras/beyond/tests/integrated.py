"""One impact and the flight after it, by an integrator and a bracketing root finder.

It shares no formula with the package but the forces of laws: the contact is a differential equation
with an event. The table is a sine, or a sum of harmonics (k, a, p) of a sin(kτ + p).
"""

import numpy as np
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

from bouncing_ball_beyond.balls import SpringDamper

SINE = ((1, 1.0, 0.0),)


def waveform(harmonics, tau, order=0):
    """W or a derivative of it."""
    turned = order * np.pi / 2
    return sum(a * k**order * np.sin(k * tau + p + turned) for k, a, p in harmonics)


def acceleration(ball, gap, rate):
    """δ″ by the contact alone, from the definitions of the balls."""
    if isinstance(ball, SpringDamper):
        ratio = float(ball.frequency_ratio)
        return -2 * float(ball.zeta) * ratio * rate - ratio**2 * gap
    return ball.force(max(-gap, 0.0), -rate, **ball.values)


def contact(ball, amplitude, tau, u, harmonics=SINE):
    """The release after an impact at the time tau with the closing speed u: time, δ, δ′, height.

    An impact with u < 0 is a contact that resumes where its force is zero. The height is the
    greatest one in the contact, by samples.
    """

    def motion(t, y):
        return [y[1], -1 - amplitude * waveform(harmonics, t, 2) + acceleration(ball, *y)]

    def release(t, y):
        if t < tau + 1e-6:
            return -1.0
        return y[0] if ball.release == "displacement" else -acceleration(ball, *y)

    release.terminal, release.direction = True, 1
    start = 2 * float(ball.zeta) / ball.frequency_ratio * u if u < 0 else 0.0
    found = solve_ivp(
        motion,
        (tau, tau + 60),
        [start, -u],
        "DOP853",
        events=release,
        rtol=1e-13,
        atol=1e-15,
        first_step=1e-5,
        max_step=0.02,
        dense_output=True,
    )
    end = found.t_events[0][0]
    gap, speed = found.y_events[0][0]
    times = np.linspace(tau, end, 20001)
    heights = amplitude * waveform(harmonics, times) + found.sol(times)[0]
    return end, gap, speed, heights.max()


def flight(amplitude, leaves, gap, speed, harmonics=SINE):
    """The first landing at δ = 0 after a release: time, closing speed and greatest height."""
    height = gap + amplitude * waveform(harmonics, leaves)
    velocity = speed + amplitude * waveform(harmonics, leaves, 1)

    def above(t):
        return height + velocity * t - t * t / 2 - amplitude * waveform(harmonics, leaves + t)

    times = np.arange(1e-6, 200.0, 2e-3)
    below = (above(times[:-1]) > 0) & (above(times[1:]) <= 0)
    first = np.flatnonzero(below)[0]
    time = brentq(above, times[first], times[first + 1], xtol=1e-14)
    closing = amplitude * waveform(harmonics, leaves + time, 1) - velocity + time
    rise = np.clip(velocity, 0, time)
    return leaves + time, closing, height + velocity * rise - rise**2 / 2


def leg(ball, amplitude, tau, u, harmonics=SINE):
    """The next impact after one of a ball: time and speed.

    Also the greatest height up to it.
    """
    leaves, gap, speed, lifted = tau, 0.0, 0.0, -np.inf
    if ball.has_duration:
        leaves, gap, speed, lifted = contact(ball, amplitude, tau, u, harmonics)
    else:
        speed = ball.restitution * u
    lands, closing, summit = flight(amplitude, leaves, gap, speed, harmonics)
    return lands, closing, max(summit, lifted)


def around(orbit, shift=(0.0, 0.0)):
    """One period of an orbit from its first impact, moved by a shift of its time and speed.

    Returns the time and speed of the impact after it, without the periods, and the greatest height.
    """
    harmonics = tuple(orbit.table.harmonics)
    tau, u, highest = orbit.times[0] + shift[0], orbit.speeds[0] + shift[1], -np.inf
    for _ in range(orbit.impacts):
        tau, u, height = leg(orbit.ball, orbit.amplitude, tau, u, harmonics)
        highest = max(highest, height)
    return np.array([tau - 2 * np.pi * orbit.periods, u]), highest
