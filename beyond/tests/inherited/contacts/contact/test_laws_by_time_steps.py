"""The shares of starts and the chaotic means of contact laws, by time steps that share no code.

Many balls are stepped at once, in SI units, by classical Runge-Kutta steps of a fortieth of a
contact or less. The forces are written here again, with the parameters that the answer prints.
"""

import math
import re
from collections import Counter

import numpy as np
import pytest
from asked_contacts import assessed

from bouncing_ball_beyond.motions.basins import fastest

G = 9.80665
# Steps in a contact for means, and for states that are compared: a contact begins within a step.
STEPS = 40
FINER = 100
EDGE = 6
# A contact begins within a step, so that the states of a motion that repeats scatter by this part.
SAME = 0.03


def hunt_crossley(p, rate, stiffness, damping):
    return stiffness * p**1.5 * (1 + damping * rate)


def tsuji(p, rate, stiffness, damping, mass):
    return stiffness * p**1.5 + damping * math.sqrt(mass * stiffness) * p**0.25 * rate


def kuwabara_kono(p, rate, stiffness, damping):
    return stiffness * (p**1.5 + damping * np.sqrt(p) * rate)


def spring_damper(p, rate, stiffness, damping):
    return stiffness * p + damping * rate


FORCES = {"hunt-crossley": hunt_crossley, "tsuji": tsuji, "kuwabara-kono": kuwabara_kono}


class Shaken:
    """Balls on the table of an answer, with the law that it prints."""

    def __init__(self, found, steps=STEPS):
        self.mass = found.case.mass
        self.omega = found.case.table.angular_frequency
        self.amplitude = found.amplitude * G / self.omega**2
        values = dict(found.law or {"stiffness": found.stiffness, "damping": found.damping})
        self.law = FORCES.get(values.pop("name", None), spring_damper)
        self.values = values | ({"mass": self.mass} if self.law is tsuji else {})
        self.h = found.contact_time / steps

    def table(self, t):
        angle = self.omega * t
        return self.amplitude * np.sin(angle), self.amplitude * self.omega * np.cos(angle)

    def push(self, z, v, t):
        """The force of the table; a contact that ends by its force does not pull."""
        w, w_rate = self.table(t)
        force = self.law(np.maximum(w - z, 0.0), w_rate - v, **self.values)
        return np.where(z < w, np.maximum(force, 0.0) if self.law is kuwabara_kono else force, 0.0)

    def step(self, z, v, t):
        h = self.h
        k1 = self.push(z, v, t) / self.mass - G
        k2 = self.push(z + h / 2 * v, v + h / 2 * k1, t + h / 2) / self.mass - G
        k3 = self.push(z + h / 2 * v + h * h / 4 * k1, v + h / 2 * k2, t + h / 2) / self.mass - G
        k4 = self.push(z + h * v + h * h / 2 * k2, v + h * k3, t + h) / self.mass - G
        return (
            z + h * v + h * h / 6 * (k1 + k2 + k3),
            v + h / 6 * (k1 + 2 * k2 + 2 * k3 + k4),
            t + h,
        )


def grid(found, shaken):
    """Height, velocity and time of the starts: six phases and six speeds, an even grid."""
    middle = (np.arange(EDGE) + 0.5) / EDGE
    model = next(iter(found.case.models.values()))
    fast = float(fastest(model, found.amplitude)) * G / shaken.omega
    phase, speed = np.meshgrid(2 * math.pi * middle - math.pi, fast * middle)
    t = phase.ravel() / shaken.omega
    z, rate = shaken.table(t)
    return z, rate - speed.ravel(), t


def motion_names(shaken, start, periods, longest=6):
    """The motions of balls after so many periods, by the names of the answer."""
    z, v, t = start
    per_period = round(2 * math.pi / shaken.omega / shaken.h)
    # A whole number of steps in a period, so that the states of all periods can be compared.
    shaken.h = 2 * math.pi / shaken.omega / per_period
    states = []
    began = np.zeros((longest, z.size), dtype=int)
    always = np.ones(z.size, dtype=bool)
    touches = np.ones(z.size, dtype=bool)
    for period in range(periods):
        counts = began[period % longest]
        counts[:] = 0
        always[:] = True
        for _ in range(per_period):
            z, v, t = shaken.step(z, v, t)
            now = z < shaken.table(t)[0]
            counts += now & ~touches
            always &= now
            touches = now
        states.append(np.array([z, v / shaken.omega]))
    names = []
    for ball in range(z.size):
        if always[ball]:
            names.append("permanent contact")
            continue
        apart = [np.abs(states[-1] - states[-1 - n])[:, ball].max() for n in range(1, longest + 1)]
        repeats = [n for n, far in enumerate(apart, 1) if far < SAME * shaken.amplitude]
        if not repeats:
            names.append("other")
            continue
        last = [began[(periods - 1 - k) % longest][ball] for k in range(repeats[0])]
        names.append(f"orbit {repeats[0]}/{sum(last)}")
    return names


STARTED = [
    {"law": "hunt-crossley", "contact_time": "1 ms", "restitution": 0.6, "acceleration": "0.9 g"},
    {"law": "kuwabara-kono", "contact_time": "2 ms", "restitution": 0.6, "acceleration": "1.1 g"},
    {"law": "tsuji", "contact_time": "1 ms", "restitution": 0.7, "acceleration": "0.8 g"},
]


@pytest.mark.long
@pytest.mark.parametrize("given", STARTED)
def test_the_shares_of_starts_are_those_of_the_law(given):
    found = assessed(mass="20 g", frequency="50 Hz", **given)
    shaken = Shaken(found, FINER)
    names = Counter(motion_names(shaken, grid(found, shaken), periods=60))
    stated: Counter = Counter()
    for name, share in found.starts.items():
        # Locked and doubled motions repeat as orbits do.
        stated["orbit".join(re.split("locked|subharmonic", name))] += round(share * EDGE * EDGE)
    assert found.ends.balls == EDGE * EDGE
    assert f"Of {EDGE * EDGE} balls with other starts, " in found.ends.sentence
    # A ball next to the edge of a basin may end on its other side.
    assert (names - stated).total() <= 1, (names, stated)
