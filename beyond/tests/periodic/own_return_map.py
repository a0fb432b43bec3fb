"""The return map of a ball by a code of its own, without derivatives: plain equations of motion.

Contacts of a spring and a damper are integrated by scipy's DOP853 in the absolute height z ::

    z″ = -1 - 2ζϖ (z′ - w′) - ϖ² (z - w),    w = Λ sin τ

until z = w or until the force vanishes, and flights are parabolas up to their first landing.
"""

import numpy as np
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

# The time between samples in which a landing is sought, and the first sample after a release.
_SAMPLE = 0.02
_LEFT = 1e-3
# Steps of the integration are short against a cycle of the contact.
_SHORT = 0.35


def landed(time, height, velocity, amplitude):
    """The time of the first landing after a release, and z′ before it."""

    def gap(after):
        return height + (velocity - after / 2) * after - amplitude * np.sin(time + after)

    after = _LEFT
    while gap(after + _SAMPLE) > 0:
        after += _SAMPLE
    flight = brentq(gap, after, after + _SAMPLE, xtol=1e-15, rtol=1e-15)
    return time + flight, velocity - flight


def after_contact(law, amplitude, time, velocity):
    """τ, z and z′ at the release after an impact."""
    omega = float(law.frequency_ratio)
    loss = 2 * float(law.damping_ratio) * omega

    def motion(tau, state):
        rate = state[1] - amplitude * np.cos(tau)
        return state[1], -1 - loss * rate - omega**2 * (state[0] - amplitude * np.sin(tau))

    def release(tau, state):
        gap = state[0] - amplitude * np.sin(tau)
        rate = state[1] - amplitude * np.cos(tau)
        # Negative at the impact itself.
        if tau - time < 1e-9:
            return -1.0
        return omega**2 * gap + loss * rate if law.release == "force" else gap

    release.terminal = True
    release.direction = 1
    start = amplitude * np.sin(time), velocity
    run = solve_ivp(
        motion,
        (time, time + 40.0),
        start,
        method="DOP853",
        rtol=1e-13,
        atol=1e-14,
        events=release,
        max_step=_SHORT / omega,
    )
    return run.t_events[0][0], *run.y_events[0][0]


def returned(model, amplitude, state, impacts, periods):
    """(τ - 2πm, z′) of the impact that is k impacts after one with this state."""
    time, velocity = state
    for _ in range(impacts):
        if model.name == "restitution":
            of_table = amplitude * np.cos(time)
            bounce = of_table - float(model.restitution) * (velocity - of_table)
            release = time, amplitude * np.sin(time), bounce
        else:
            release = after_contact(model.law, amplitude, time, velocity)
        time, velocity = landed(*release, amplitude)
    return np.array([time - 2 * np.pi * periods, velocity])


def differences(function, x, step):
    """The Jacobian of a function at x by central differences of the fourth order."""
    columns = []
    for unit in step * np.eye(x.size):
        near = function(x + unit) - function(x - unit)
        far = function(x + 2 * unit) - function(x - 2 * unit)
        columns.append((8 * near - far) / (12 * step))
    return np.stack(columns, axis=-1)


def solved(function, guess, step, rounds=5):
    """A zero of a function near a guess, by Newton's method with differences."""
    x = np.array(guess, dtype=float)
    for _ in range(rounds):
        x = x - np.linalg.solve(differences(function, x, step), function(x))
    return x
