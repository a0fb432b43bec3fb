"""Motions of a ball by an integrator and a bracketing root finder.

It shares no formula with the package but the forces of laws: the contact is a differential equation
with an event, and a corrected impact comes from the definition of its quantities. The table is a
sine, or a sum of harmonics (k, a, p) of a sin(kτ + p).
"""

from functools import cache

import numpy as np
from scipy.integrate import solve_ivp
from scipy.optimize import brentq, fsolve, minimize_scalar

from bouncing_ball_beyond.contacts.balls import Corrected, SpringDamper

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


def touching(ball, amplitude, tau, u, harmonics=SINE, gravity=1.0):
    """The release after an impact at the time tau with the closing speed u: time, δ, δ′, and the
    motion up to it, a function of time with (δ, δ′).

    An impact with u < 0 is a contact that resumes where its force is zero.
    """
    waves = tuple(harmonics)

    def motion(t, y):
        return [y[1], -gravity - amplitude * waveform(waves, t, 2) + acceleration(ball, *y)]

    def release(t, y):
        if t < tau + 1e-6:
            return -1.0
        if ball.release == "displacement":
            return y[0]
        # A contact ends where its force ends, at the surface at the latest.
        return -1.0 if y[0] < 0 < acceleration(ball, *y) else 1.0

    release.terminal, release.direction = True, 1
    start = 2 * float(ball.zeta) / ball.frequency_ratio * u if u < 0 else 0.0
    solution = solve_ivp(
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
    return solution.t_events[0][0], *solution.y_events[0][0], solution.sol


def contact(ball, amplitude, tau, u, harmonics=SINE):
    """The release as in `touching`, with the greatest height in the contact, by samples."""
    end, gap, speed, motion = touching(ball, amplitude, tau, u, harmonics)
    times = np.linspace(tau, end, 20001)
    heights = amplitude * waveform(harmonics, times) + motion(times)[0]
    return end, gap, speed, heights.max()


def free_impact(ball, u):
    """r, D, t_c and σ of a free impact of a contact, from their definitions."""

    def impulse(speed, load=0.0):
        end, _, bounced, _ = touching(ball, 0.0, 0.0, speed, gravity=load)
        return speed + bounced + load * end

    duration, gap, w, _ = touching(ball, 0.0, 0.0, u, gravity=0.0)
    # The moment of the force ∫ t δ″ dt, by parts.
    centroid = (duration * w - gap) / (u + w)
    load, step = 1e-3 * u / duration, 1e-3 * u
    by_load = (impulse(u, load) - impulse(u, -load)) / (2 * load)
    by_speed = (impulse(u + step) - impulse(u - step)) / (2 * step)
    return w / u, duration, centroid, by_load - centroid * by_speed


def weakest_grip(ball, amplitude, harmonics=SINE):
    """The smallest depth, or force, of the steady motion in contact, divided by its value at rest.

    It is followed from rest. A ball that the amplitude reaches in one step may begin to bounce.
    """
    deep = brentq(lambda p: acceleration(ball, -p, 0.0) - 1, 0.0, 1.0, xtol=1e-16)

    def moved(y, share):
        def motion(t, y):
            pull = 1 + share * amplitude * waveform(harmonics, t, 2)
            return [y[1], acceleration(ball, *y) - pull]

        return solve_ivp(
            motion, (0, 2 * np.pi), deep * y, "DOP853", rtol=1e-12, atol=1e-15, dense_output=True
        )

    def after(y, share):
        return moved(y, share).y[:, -1] / deep - y

    # A force that pushes at the surface ends contacts there.
    surface = ball.release == "displacement" or acceleration(ball, -1e-12, 1e-6) > 0
    steady = np.array([-1.0, 0.0])
    for share in (0.5, 0.9, 0.99, 1.0):
        steady = fsolve(after, steady, (share,), xtol=1e-8, epsfcn=1e-12)
    motion = moved(steady, 1.0).sol

    def grip(t):
        gap, rate = motion(t)
        return -gap / deep if surface else acceleration(ball, gap, rate)

    times = np.linspace(0.1, 2 * np.pi + 0.1, 2001) % (2 * np.pi)
    near = times[np.argmin([grip(t) for t in times])]
    return minimize_scalar(grip, bounds=(near - 0.01, near + 0.01), options={"xatol": 1e-9}).fun


@cache
def linear_impact(ratio, zeta, release):
    """r, D, t_c and σ of a spring and a damper, which are those of every speed."""
    return free_impact(SpringDamper(ratio, damping_ratio=zeta, release=release), 1.0)


def instant(ball, amplitude, tau, u, harmonics=SINE):
    """δ and δ′ after an impact that is an instant, and the t_c of the ball: δ = -u t_c."""
    if not isinstance(ball, Corrected):
        return 0.0, ball.restitution * u, 0.0
    of = ball.of
    r, _, centroid, loss = linear_impact(float(of.frequency_ratio), float(of.zeta), of.release)
    load = 1 + amplitude * waveform(harmonics, tau, 2)
    return -u * centroid, r * u + loss * load, centroid


def flight(amplitude, leaves, gap, speed, harmonics=SINE, centroid=0.0):
    """The first landing at δ = t_c δ′ after a release: time, closing speed and greatest height."""
    height = gap + amplitude * waveform(harmonics, leaves)
    velocity = speed + amplitude * waveform(harmonics, leaves, 1)

    def above(t):
        gap = height + velocity * t - t * t / 2 - amplitude * waveform(harmonics, leaves + t)
        rate = velocity - t - amplitude * waveform(harmonics, leaves + t, 1)
        return gap - centroid * rate

    # The ball is below the lowest point of the table after this time.
    lowest = height + amplitude * sum(abs(a) for _, a, _ in harmonics)
    longest = velocity + np.sqrt(velocity**2 + 2 * lowest) + 1
    times = np.arange(1e-6, longest, 2e-3)
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
    if ball.has_duration:
        leaves, gap, speed, lifted = contact(ball, amplitude, tau, u, harmonics)
        lands, closing, summit = flight(amplitude, leaves, gap, speed, harmonics)
        return lands, closing, max(summit, lifted)
    gap, speed, centroid = instant(ball, amplitude, tau, u, harmonics)
    return flight(amplitude, tau, gap, speed, harmonics, centroid)


def heights(ball, amplitude, tau, u, times, harmonics=SINE):
    """Heights of a ball at times after an impact, in contacts and flights."""
    height = np.full(len(times), np.nan)
    while tau <= times[-1]:
        leaves = tau
        if ball.has_duration:
            leaves, gap, speed, motion = touching(ball, amplitude, tau, u, harmonics)
            during = np.flatnonzero((times >= tau) & (times < leaves))
            for i in during:
                height[i] = motion(times[i])[0] + amplitude * waveform(harmonics, times[i])
        else:
            gap, speed, _ = instant(ball, amplitude, tau, u, harmonics)
        s = times[times >= leaves] - leaves
        velocity = speed + amplitude * waveform(harmonics, leaves, 1)
        level = gap + amplitude * waveform(harmonics, leaves)
        height[times >= leaves] = level + velocity * s - s * s / 2
        tau, u, _ = leg(ball, amplitude, tau, u, harmonics)
    return height


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
