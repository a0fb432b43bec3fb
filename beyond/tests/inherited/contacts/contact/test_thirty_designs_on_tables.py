"""The bifurcations and the chaotic means of thirty answers, by integrations that share no code.

A ball is integrated in SI units: its contacts by scipy, or, for means, with all balls of a sample
by classical Runge-Kutta steps of a sixtieth of a contact; its flights are parabolas. A branch of
n-T orbits is found by shooting, with the amplitude of the table as an unknown at a given phase: the
saddle-node is its least amplitude, and at the period doubling a multiplier is -1. The multipliers
are those of central differences.
"""

import math

import numpy as np
import pytest
from asked_contacts import assessed
from scipy.integrate import solve_ivp
from scipy.optimize import brentq, minimize_scalar

G = 9.80665
PERIOD = 0.05
OMEGA = 2 * math.pi / PERIOD
TABLE = {"mass": 0.5, "frequency": 1 / PERIOD, "acceleration": "0.8 g", "n": 1}


def linear(k, c):
    return lambda p, rate: k * p + c * rate


def on_approach(k, c):
    return lambda p, rate: k * p + c * max(rate, 0.0)


def hunt_crossley(k, c):
    return lambda p, rate: k * max(p, 0.0) ** 1.5 * (1 + c * rate)


def tsuji(k, c):
    # The damper of Tsuji is that of a mass m.
    return lambda p, rate: (
        k * max(p, 0.0) ** 1.5 + c * math.sqrt(0.5 * k) * max(p, 0.0) ** 0.25 * rate
    )


class Ball:
    """The map of a ball from one impact to the next, with the amplitude of the table."""

    def __init__(self, force, pulls, mass=0.5):
        self.force = force
        self.pulls = pulls
        self.mass = mass

    def next(self, t, v, amplitude):
        """Time and velocity of the next impact."""

        def motion(s, y):
            push = self.force(-y[0], -y[1])
            push = push if self.pulls else max(push, 0.0)
            return [y[1], push / self.mass - G + amplitude * OMEGA**2 * math.sin(OMEGA * (t + s))]

        def ended(s, y):
            if s == 0:
                return 1.0
            return -y[0] if self.pulls else self.force(-y[0], -y[1])

        ended.terminal = True
        ended.direction = -1
        rate = v - amplitude * OMEGA * math.cos(OMEGA * t)
        run = solve_ivp(motion, (0.0, PERIOD), [0.0, rate], events=ended, method="DOP853",
                        rtol=1e-11, atol=1e-14, first_step=1e-8)  # fmt: skip
        start = t + run.t[-1]
        height = run.y[0, -1] + amplitude * math.sin(OMEGA * start)
        up = run.y[1, -1] + amplitude * OMEGA * math.cos(OMEGA * start)

        def gap(s):
            return height + up * s - G * s * s / 2 - amplitude * math.sin(OMEGA * (start + s))

        # The flight of an n-T orbit is long: its end is the last crossing.
        top = max(up / G, PERIOD / 100)
        flight = brentq(gap, top, 4 * top + PERIOD, xtol=1e-15, rtol=1e-14)
        return start + flight, up - G * flight

    def orbit(self, phase, guess, n):
        """Velocity and amplitude of the n-T orbit with an impact at this phase."""
        t = phase / OMEGA
        v, amplitude = guess

        def missed(v, amplitude):
            later, arrives = self.next(t, v, amplitude)
            return np.array([OMEGA * (later - t) - 2 * math.pi * n, (arrives - v) / G * OMEGA])

        for _ in range(12):
            here = missed(v, amplitude)
            size = np.array([1e-6 * G / OMEGA, 1e-6 * G / OMEGA**2])
            slopes = np.stack([
                (missed(v + size[0], amplitude) - missed(v - size[0], amplitude)) / 2e-6,
                (missed(v, amplitude + size[1]) - missed(v, amplitude - size[1])) / 2e-6,
            ], axis=1)  # fmt: skip
            step = np.linalg.solve(slopes, -here)
            v += step[0] * G / OMEGA
            amplitude += step[1] * G / OMEGA**2
            if np.abs(step).max() < 1e-8:
                break
        return v, amplitude

    def doubling(self, phase, v, amplitude):
        """1 + trace + determinant of the map, which vanishes at a period doubling."""
        t = phase / OMEGA
        unit = np.array([1 / OMEGA, G / OMEGA])
        columns = []
        for k in range(2):
            moved = [np.array([t, v]) + sign * 1e-5 * unit * np.eye(2)[k] for sign in (1, -1)]
            ahead, behind = (np.array(self.next(*each, amplitude)) for each in moved)
            columns.append((ahead - behind) / unit / 2e-5)
        jacobian = np.stack(columns, axis=1)
        return 1 + np.trace(jacobian) + np.linalg.det(jacobian)


SHAKEN = [
    ({"stiffness": 5e4, "restitution": 0.75}, "linear"),
    ({"stiffness": 1e5, "restitution": 0.5, "release": "force"}, "linear"),
    ({"stiffness": 5e4, "restitution": 0.8, "release": "approach"}, "approach"),
    ({"law": "hunt-crossley", "contact_time": "6 ms", "restitution": 0.7}, "hunt-crossley"),
    ({"law": "tsuji", "contact_time": "6 ms", "restitution": 0.7}, "tsuji"),
]


def ball_of(found, name):
    """The ball of an answer, from the parameters that it gives."""
    if name in ("linear", "approach"):
        force = linear if name == "linear" else on_approach
        return Ball(
            force(found.stiffness, found.damping), str(found.case.equivalent.release) != "force"
        )
    law = found.law
    made = {"hunt-crossley": hunt_crossley, "tsuji": tsuji}[name]
    return Ball(made(law["stiffness"], law["damping"]), True)


@pytest.mark.long
@pytest.mark.usefixtures("short_runs")
@pytest.mark.parametrize(("given", "name"), SHAKEN)
def test_the_bifurcations_are_those_of_shooting(given, name):
    found = assessed(**TABLE | given)
    one = found.judged
    ball = ball_of(found, name)
    exact = next(iter(one.standing))
    limits = one.standing[exact]
    branch = {}

    def at(phase):
        # From the nearest point that is known.
        near = min(branch, key=lambda known: abs(known - phase))
        branch[phase] = ball.orbit(phase, branch[near], found.n)
        return branch[phase]

    start = one.values["phase"][exact]
    # Where the iteration starts decides about no digit.
    rate = 0.8 * G / OMEGA * math.cos(start)
    branch[start] = (rate - one.impact_speed, 0.8 * G / OMEGA**2)
    _, amplitude = at(start)
    assert amplitude * OMEGA**2 / G == pytest.approx(0.8, rel=1e-6)
    phase = start
    while at(phase - 0.1)[1] < branch[phase][1]:
        phase -= 0.1
    ends = phase - 0.1, phase + 0.1
    lowest = minimize_scalar(
        lambda phase: at(phase)[1], bounds=ends, method="bounded", options={"xatol": 1e-4}
    )
    # Near a minimum the amplitude is flat: 1e-4 in phase are 1e-8 in amplitude.
    assert limits.saddle_node == pytest.approx(lowest.fun * OMEGA**2 / G, rel=1e-6)
    phase = start
    while ball.doubling(phase + 0.1, *at(phase + 0.1)) > 0:
        phase += 0.1
    doubled = brentq(lambda phase: ball.doubling(phase, *at(phase)), phase, phase + 0.1, xtol=1e-7)
    # Differences of a map that is integrated to 1e-11 know the multiplier to 1e-6.
    assert limits.period_doubling == pytest.approx(at(doubled)[1] * OMEGA**2 / G, rel=1e-5)
