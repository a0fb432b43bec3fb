"""A second code for periodic orbits of all models, which shares nothing with the package.

Contacts and flights are integrated by scipy's DOP853 in the distance δ from the table ::

    δ″ = f(δ, δ′) - 1 + Λ sin φ

with the force f of the contact. An orbit is given by its phases, velocities and durations, and the
code says by how much it fails to close. The delay, the restitution, the load sensitivity and the
duration of the corrected model are integrals of a contact too.
"""

from typing import NamedTuple

import numpy as np
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

EXACT = {"rtol": 1e-12, "atol": 1e-14, "method": "DOP853"}


def pull(amplitude, phase):
    """δ″ in flight."""
    return amplitude * np.sin(phase) - 1


def moved(amplitude, start, lasts, force=None):
    """δ and δ′ after a time from a phase, δ and δ′ on, with the force of a contact or none."""
    phase, gap, rate = start

    def motion(t, y):
        away = pull(amplitude, phase + t)
        return [y[1], away if force is None else away + force(y[0], y[1])]

    run = solve_ivp(motion, (0.0, lasts), [gap, rate], **EXACT)
    return run.y[0, -1], run.y[1, -1]


def _force(orbit):
    """The force of a contact: a function of δ and δ′."""
    law = orbit.model.impact_law
    if type(law).__name__ == "SpringDamper":
        ratio = float(law.frequency_ratio)
        zeta = float(law.damping_ratio)
        return lambda x, v: -(ratio**2) * x - 2 * zeta * ratio * v
    stiffness = float(law.stiffness)
    damping = float(law.damping)
    return lambda x, v: stiffness * max(-x, 0.0) ** 1.5 * (1 - damping * v)


def closing_of(orbit):
    """δ′ at the impacts of an orbit."""
    return orbit.velocities - orbit.amplitude * np.cos(orbit.phases)


def _released(orbit, k):
    """δ and δ′ at the release of one impact, and the time of the contact."""
    phase = float(orbit.phases[k])
    lasts = float(orbit.durations[k])
    closing = float(closing_of(orbit)[k])
    if orbit.model.name == "restitution":
        if lasts > 0:
            return 0.0, 0.0, lasts
        return 0.0, -float(orbit.model.impact_law) * closing, 0.0
    start = 0.0
    if np.broadcast_to(orbit.resumes, (orbit.impacts,))[k]:
        law = orbit.model.impact_law
        start = -2 * float(law.damping_ratio) / float(law.frequency_ratio) * closing
    return *moved(float(orbit.amplitude), (phase, start, closing), lasts, _force(orbit)), lasts


def defect_of(orbit):
    """The largest distance of the landings of the second code from the next impacts."""
    lam = float(orbit.amplitude)
    closing = closing_of(orbit)
    k = orbit.impacts
    turns = np.broadcast_to(orbit.turns, (k,))
    worst = 0.0
    for i in range(k):
        gap, rate, lasts = _released(orbit, i)
        after = (i + 1) % k
        whole = float(orbit.phases[after] - orbit.phases[i]) + 2 * np.pi * int(turns[i])
        leave = float(orbit.phases[i]) + lasts
        if orbit.model.name == "restitution" and lasts > 0:
            worst = max(worst, abs(pull(lam, leave)))
        here, arrives = moved(lam, (leave, gap, rate), whole - lasts)
        expected = 0.0
        if np.broadcast_to(orbit.resumes, (k,))[after]:
            law = orbit.model.impact_law
            lag = 2 * float(law.damping_ratio) / float(law.frequency_ratio)
            expected = -lag * closing[after]
        worst = max(worst, abs(here - expected), abs(arrives - closing[after]))
    return worst


def rates_of_release(orbit):
    """The rates at which the release functions δ + κ δ′ of an orbit pass 0; κ is 0 for the release
    by displacement.
    """
    law = orbit.model.impact_law
    lag = 0.0
    if type(law).__name__ == "SpringDamper" and str(law.release) == "force":
        lag = 2 * float(law.damping_ratio) / float(law.frequency_ratio)
    rates = []
    for k in range(orbit.impacts):
        _, rate, lasts = _released(orbit, k)
        away = pull(float(orbit.amplitude), float(orbit.phases[k]) + lasts)
        rates.append(rate + lag * away)
    return np.array(rates)


class Numbers(NamedTuple):
    """The delay t_c, r, the load sensitivity σ and the duration D of a linear contact."""

    delay: float
    restitution: float
    load: float
    duration: float


def numbers_of(ratio, zeta):
    """The numbers of a linear contact, integrated together with its derivative by the load."""

    def force(x, v):
        return -(ratio**2) * x - 2 * zeta * ratio * v

    def motion(t, y):
        return [y[1], force(y[0], y[1]), y[3], force(y[2], y[3]) - 1]

    def opens(t, y):
        return y[0]

    opens.direction = 1
    span = (0.0, 1.5 * np.pi / (ratio * np.sqrt(1 - zeta**2)))

    def run(delay):
        # With a load a the contact starts with the speed 1 - a t_c.
        found = solve_ivp(motion, span, [0.0, -1.0, 0.0, delay], events=opens, **EXACT)
        return found.t_events[0][-1], found.y_events[0][-1]

    duration, (_, after, _, _) = run(0.0)
    delay = duration * after / (1 + after)
    _, (_, _, moved, faster) = run(delay)
    later = -moved / after
    load = faster + force(0.0, after) * later + duration - delay
    return Numbers(delay, after, load, duration)


def corrected_defect(orbit):
    """The largest defect of an orbit of the corrected model, and the smallest distance of its balls
    from the border between leaving and staying: the height to which they rise above the table
    after a contact, or the speed of a rise that begins above it.
    """
    given = orbit.model.numbers()
    log = np.log(float(given["restitution"]))
    numbers = numbers_of(float(given["frequency_ratio"]), -log / np.hypot(np.pi, log))
    lam = float(orbit.amplitude)
    turns = np.broadcast_to(orbit.turns, (orbit.impacts,))
    worst = 0.0
    border = np.inf
    for i in range(orbit.impacts):
        after = (i + 1) % orbit.impacts
        phase = float(orbit.phases[i]) + numbers.delay
        closing = lam * np.cos(phase) - (float(orbit.velocities[i]) - numbers.delay)
        height = lam * np.sin(phase) - closing * numbers.delay
        velocity = lam * np.cos(phase) + numbers.restitution * closing
        velocity += numbers.load * (1 - lam * np.sin(phase))
        border = min(border, _border(lam, phase, height, velocity, numbers))
        if float(orbit.durations[i]) > numbers.duration * (1 + 1e-6):
            phase = float(orbit.phases[i] + orbit.durations[i])
            worst = max(worst, abs(lam * np.sin(phase) - 1))
            height = lam * np.sin(phase)
            velocity = lam * np.cos(phase)
        lands = float(orbit.phases[after]) + 2 * np.pi * int(turns[i]) + numbers.delay
        t = lands - phase
        arrives = velocity - t
        meets = lam * np.cos(lands) - arrives
        gap = height + velocity * t - t * t / 2 - lam * np.sin(lands) + meets * numbers.delay
        expected = float(orbit.velocities[after]) - numbers.delay
        worst = max(worst, abs(gap), abs(arrives - expected))
    return worst, border


def _border(lam, phase, height, velocity, numbers):
    """How far a ball is from the border between leaving and staying after one contact."""
    begins = numbers.duration - numbers.delay

    def rate(t):
        return velocity - t - lam * np.cos(phase + t)

    def gap(t):
        return height + velocity * t - t * t / 2 - lam * np.sin(phase + t)

    if rate(begins) <= 0 or gap(begins) > 0:
        return abs(rate(begins))
    t = begins + np.linspace(0.0, np.pi, 2001)
    falls = int(np.argmax(rate(t) <= 0))
    return abs(gap(brentq(rate, t[falls - 1], t[falls], xtol=1e-15))) if falls else np.inf
