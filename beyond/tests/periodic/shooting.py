"""Orbits by shooting with a general integrator, independent of the package's formulas."""

import numpy as np
from scipy.integrate import solve_ivp
from scipy.optimize import fsolve

EXACT = {"rtol": 1e-12, "atol": 1e-13, "method": "DOP853"}


def table(time, amplitude):
    return amplitude * np.sin(time), amplitude * np.cos(time)


def flown(time, height, velocity, amplitude, lag):
    """Time, height and velocity of the first landing, by the integrator's events.

    Below the table's level a contact resumes where its force, δ + lag δ′, becomes negative.
    """

    def gap(t, y):
        level, rate = table(t, amplitude)
        return max(y[0] - level, y[0] - level + lag * (y[1] - rate))

    gap.terminal = True
    gap.direction = -1
    # Off the table, where the gap is zero.
    step = 1e-9
    start = [height + velocity * step, velocity - step]
    run = solve_ivp(
        lambda t, y: [y[1], -1.0], (time + step, time + 90), start, events=gap, max_step=0.2,
        **EXACT,
    )  # fmt: skip
    return run.t[-1], run.y[0, -1], run.y[1, -1]


def contact(time, height, velocity, amplitude, ratio, zeta, by_force):
    """Time, height and velocity at the end of a contact that starts at the table's level."""

    def relative(t, y):
        level, rate = table(t, amplitude)
        return y[0] - level, y[1] - rate

    def pull(t, y):
        p, v = relative(t, y)
        return [y[1], -1.0 - 2 * zeta * ratio * v - ratio**2 * p]

    def end(t, y):
        p, v = relative(t, y)
        return p + (2 * zeta / ratio * v if by_force else 0.0)

    end.terminal = True
    end.direction = 1
    run = solve_ivp(pull, (time, time + 60), [height, velocity], events=end,
                    max_step=0.2 / ratio, **EXACT)  # fmt: skip
    return run.t[-1], run.y[0, -1], run.y[1, -1]


def turn(phase, velocity, impacts, name, restitution, ratio, amplitude):
    """Time and velocity of the impact after so many impacts, before the impact."""
    time = phase
    height, _ = table(time, amplitude)
    zeta = -np.log(restitution) / np.hypot(np.pi, np.log(restitution))
    lag = 2 * zeta / ratio if name == "force release" else 0.0
    for _ in range(impacts):
        if name == "restitution":
            _, rate = table(time, amplitude)
            velocity = rate - restitution * (velocity - rate)
        else:
            by_force = name == "force release"
            time, height, velocity = contact(
                time,
                height,
                velocity,
                amplitude=amplitude,
                ratio=ratio,
                zeta=zeta,
                by_force=by_force,
            )
        time, height, velocity = flown(time, height, velocity, amplitude, lag)
    return time, velocity


def orbit(phase, velocity, impacts, periods, *ball):
    """φ and z′ of the orbit near an impact."""

    def missed(state):
        start, before = state
        time, after = turn(start, before, impacts, *ball)
        return [time - start - 2 * np.pi * periods, after - before]

    return fsolve(missed, [phase, velocity], xtol=1e-10)
