"""The numbers that ``design`` prints for a contact law on a table, by an integration by scipy.

A contact is integrated in SI units with the force that the answer names, and the flight is a
parabola; the orbit is found by Newton's method on the map from impact to impact. Nothing of it is
shared with the package. The integration is good to 1e-11; the peak of the force is a sample of
ten thousand, whose error is of the second order in their distance.
"""

import math

import numpy as np
import pytest
from asked_contacts import assessed
from scipy.integrate import solve_ivp
from scipy.optimize import brentq, fsolve

G = 9.80665
MASS = 0.02
PERIOD = 0.02
OMEGA = 2 * math.pi / PERIOD
TABLE = {"mass": MASS, "frequency": 1 / PERIOD, "acceleration": "0.8 g", "n": 1}
AMPLITUDE = 0.8 * G / OMEGA**2
SOLIDS = {
    "radius": "5 mm",
    "youngs_modulus": "210 GPa",
    "poissons_ratio": 0.3,
    "table_youngs_modulus": "70 GPa",
    "table_poissons_ratio": 0.33,
}


def hunt_crossley(k, c, power=1.5):
    return lambda p, rate: k * max(p, 0.0) ** power * (1 + c * rate)


def tsuji(k, c):
    damper = c * math.sqrt(MASS * k)
    return lambda p, rate: k * max(p, 0.0) ** 1.5 + damper * max(p, 0.0) ** 0.25 * rate


def kuwabara_kono(k, c):
    return lambda p, rate: k * (max(p, 0.0) ** 1.5 + c * math.sqrt(max(p, 0.0)) * rate)


FORCES = {
    "hunt-crossley": hunt_crossley,
    "hunt-crossley-linear": lambda k, c: hunt_crossley(k, c, power=1),
    "tsuji": tsuji,
    "kuwabara-kono": kuwabara_kono,
}


class Law:
    """The contact of an answer: its force, and the way in which it releases the ball."""

    def __init__(self, found):
        law = found.law
        self.damping = law["damping"]
        self.force = FORCES[law["name"]](law["stiffness"], self.damping)
        self.ends_by_force = law["name"] == "kuwabara-kono"
        self.step = found.contact_time / 40

    def contact(self, t, speed, gravity=G, amplitude=AMPLITUDE):
        """The depth and its rate over a contact, as a solution of scipy."""

        def motion(s, y):
            shaken = amplitude * OMEGA**2 * math.sin(OMEGA * (t + s))
            return [y[1], gravity - shaken - self.force(*y) / MASS]

        def ended(s, y):
            if s == 0:
                return 1.0
            return (y[0] + self.damping * y[1]) / self.damping if self.ends_by_force else y[0]

        ended.terminal = True
        ended.direction = -1
        return solve_ivp(motion, (0.0, PERIOD), [0.0, speed], events=ended, method="DOP853",
                         rtol=1e-12, atol=[1e-16, 1e-14], first_step=1e-9, max_step=self.step,
                         dense_output=True)  # fmt: skip

    def next(self, phase, velocity):
        """Phase and velocity of the next impact, in units of g/Ω, and the top of the flight."""
        t = phase / OMEGA
        run = self.contact(t, AMPLITUDE * OMEGA * math.cos(phase) - velocity * G / OMEGA)
        start = t + run.t[-1]
        height = AMPLITUDE * math.sin(OMEGA * start) - run.y[0, -1]
        up = AMPLITUDE * OMEGA * math.cos(OMEGA * start) - run.y[1, -1]

        def gap(s):
            table = AMPLITUDE * math.sin(OMEGA * (start + s))
            return height + up * s - G * s * s / 2 - table

        top = max(up / G, PERIOD / 100)
        flight = brentq(gap, top, 4 * top + PERIOD, xtol=1e-16, rtol=1e-14)
        arrives = (up - G * flight) * OMEGA / G
        return OMEGA * (start + flight), arrives, height + up * up / (2 * G)


DESIGNS = [
    {"law": "kuwabara-kono", "contact_time": "2 ms", "restitution": 0.8},
    *(
        pytest.param(given, marks=pytest.mark.long)
        for given in (
            {"law": "hunt-crossley", "contact_time": "2 ms", "restitution": 0.8},
            {"law": "hunt-crossley-linear", "contact_time": "2 ms", "restitution": 0.8},
            {"law": "tsuji", "contact_time": "2 ms", "restitution": 0.8},
            {"restitution": 0.9, **SOLIDS},
        )
    ),
]


@pytest.mark.usefixtures("short_runs")
@pytest.mark.parametrize("given", DESIGNS)
def test_the_numbers_are_those_of_the_law(given):
    found = assessed(**TABLE | given)
    own = Law(found)
    one = found.judged

    def missed(state):
        later, arrives, _ = own.next(*state)
        return [later - state[0] - 2 * math.pi, arrives - state[1]]

    phase = one.values["phase"][next(iter(one.standing))]
    guess = [phase, 0.8 * math.cos(phase) - one.impact_speed * OMEGA / G]
    phase, velocity = fsolve(missed, guess, xtol=1e-13)
    speed = (0.8 * math.cos(phase) - velocity) * G / OMEGA
    run = own.contact(phase / OMEGA, speed)
    depth, rate = run.sol(np.linspace(0, run.t[-1], 10001))
    peak = max(map(own.force, depth, rate))
    orbit = (one.impact_speed, one.contact_duration, one.max_height)
    assert orbit == pytest.approx((speed, run.t[-1], own.next(phase, velocity)[2]), rel=1e-9)
    loads = (one.greatest_compression, one.peak_force, one.peak_force_over_weight)
    assert loads == pytest.approx((depth.max(), peak, peak / (MASS * G)), rel=1e-6)
    at_rest = brentq(lambda p: own.force(p, 0.0) - MASS * G, 1e-12, 1e-2, xtol=1e-20)
    assert found.static_deflection == pytest.approx(at_rest, rel=1e-10)

    # The r and the duration are those of a free impact at the speed of the law.
    fast = found.case.law_speed
    free = own.contact(0.0, fast, gravity=0.0, amplitude=0.0)
    r = -free.y[1, -1] / fast
    ends = ("displacement", "force") if own.ends_by_force else ("force", "displacement")
    assert found.restitution[ends[0]] is None
    assert found.restitution[ends[1]] == found.measured_restitution == pytest.approx(r, rel=1e-9)
    assert found.contact_time == pytest.approx(free.t[-1], rel=1e-9)
    assert any("the force of" in note for note in found.notes)

    # Dropped at this speed, gravity lowers r by 1 %.
    if not (slow := found.slowed_speed):
        return
    depth, rate = own.contact(0.0, slow, amplitude=0.0).y[:, -1]
    rises = rate * rate / (2 * G) - depth
    free = own.contact(0.0, slow, gravity=0.0, amplitude=0.0)
    lowered = math.sqrt(2 * G * rises) / -free.y[1, -1]
    assert lowered == pytest.approx(0.99, abs=1e-8)
