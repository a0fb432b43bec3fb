"""Every number of thirty answers against integrations that share no code with the package.

The motion of a ball is integrated in SI units by scipy, with the force of its law as it is written
in the literature. An engine's time step is a loop over the parameters that the recipe writes. The
tolerances: the integrations have the relative tolerance 1e-11, and a few times its size remains in
lengths, times and forces after a contact; laws whose force has an infinite slope at the surface
lose some more digits. A sample of instants misses a bound of r by at most its distance times the
slope.
"""

import math

import numpy as np
import pytest
from asked_contacts import answered
from scipy.integrate import solve_ivp

from bouncing_ball_beyond.models.damping import Release
from bouncing_ball_contacts.contact import rows

G = 9.80665
TIGHT = {"method": "DOP853", "rtol": 1e-12, "atol": 1e-16}


class Ball:
    """A ball of mass m whose contact pushes with force(p, rate, load), p the penetration."""

    def __init__(self, mass, force, pulls, accuracy):
        self.mass = mass
        self.force = force
        self.pulls = pulls
        self.accuracy = accuracy

    def contact(self, speed, table=None, gravity=G):
        """From the impact to the release: time, penetration, its rate, greatest p and force."""
        _, push = table or (None, lambda t: 0.0)

        def net(t, p, rate):
            load = gravity + push(t)
            found = self.force(max(p, 0.0), rate, load)
            return found if self.pulls else max(found, 0.0)

        def motion(t, y):
            return [y[1], gravity + push(t) - net(t, *y) / self.mass]

        def left(t, y):
            return y[0] if t > 0 else 1.0

        def free(t, y):
            return self.force(max(y[0], 0.0), y[1], gravity + push(t)) if t > 0 else 1.0

        ends = [left] if self.pulls else [left, free]
        for end in ends:
            end.terminal = True
            end.direction = -1
        longest = 1e3 * speed / G if self.longest is None else self.longest
        run = solve_ivp(
            motion, (0.0, longest), [0.0, speed], events=ends, dense_output=True,
            first_step=1e-9 * longest, **TIGHT,
        )  # fmt: skip
        # A ball that stays is deepest, and its force greatest, in the first second.
        times = np.linspace(0.0, min(run.t[-1], 1.0), 200_001)
        p, rate = run.sol(times)
        forces = [net(*each) for each in zip(times[::20], p[::20], rate[::20], strict=True)]
        top = 20 * int(np.argmax(forces))
        near = slice(max(top - 20, 0), top + 21)
        forces = [net(*each) for each in zip(times[near], p[near], rate[near], strict=True)]
        ended = run.status == 1
        return ended, run.t[-1], run.y[0, -1], run.y[1, -1], p.max(), max(forces)

    longest = None

    def rise(self, speed):
        ended, _, p, rate, *_ = self.contact(speed)
        return rate * rate / (2 * G) - p if ended and rate < 0 else 0.0


def linear(k, c):
    return lambda p, rate, load: k * p + c * rate


def impedance(m, solref, solimp):
    """MuJoCo's documentation: a₁ = (1 - d) a₀ - d (b v + κ x), with a₀ = -load."""
    stiff, lossy = (-x for x in solref)
    low, high, width = solimp

    def force(p, rate, load):
        x = min(p / width, 1.0)
        y = 2 * x * x if x <= 0.5 else 1 - 2 * (1 - x) ** 2
        d = low + (high - low) * y
        return m * (d * load + d * (lossy / high * rate + stiff * d / high**2 * p))

    return force


def tsuji(m, k, alpha):
    return lambda p, rate, load: k * p**1.5 + alpha * math.sqrt(m * k) * p**0.25 * rate


def hunt_crossley(k, c, power):
    return lambda p, rate, load: k * p**power * (1 + c * rate)


def kuwabara_kono(k, c):
    return lambda p, rate, load: k * (p**1.5 + c * math.sqrt(p) * rate)


def ball_of(answer):
    """The ball of an answer, from the parameters that it gives."""
    found = answer.found
    law = dict(found.law or {})
    mass = found.case.mass
    name = law.pop("name", "linear")
    if name == "linear":
        pulls = str(found.case.equivalent.release) == "displacement"
        return Ball(mass, linear(found.stiffness, found.damping), pulls, 1e-8)
    if name == "impedance":
        solref = [
            -(law["frequency_ratio"] ** 2),
            -2 * law["damping_ratio"] * law["frequency_ratio"],
        ]
        solimp = law["at_surface"], law["share"], law["width"]
        return Ball(mass, impedance(mass, solref, solimp), False, 1e-7)
    k = law["stiffness"]
    c = law["damping"]
    made = {
        "tsuji": (tsuji(mass, k, c), True),
        "hunt-crossley": (hunt_crossley(k, c, 1.5), True),
        "hunt-crossley-linear": (hunt_crossley(k, c, 1.0), True),
        "kuwabara-kono": (kuwabara_kono(k, c), False),
    }
    force, pulls = made[name]
    return Ball(mass, force, pulls, 1e-6)


BALL = {"mass": "500 g"}
SMALL = {"mass": "4 g"}
DROPS = [
    BALL | {"stiffness": "100 kN/m", "restitution": 0.75, "speed": "1.015 m/s"},
    BALL | {"stiffness": "100 kN/m", "restitution": 0.75, "release": "force", "speed": "3 m/s"},
    BALL | {"stiffness": "2 kN/m", "restitution": 0.5, "speed": "1 m/s"},
    BALL | {"stiffness": "300 N/m", "restitution": 0.4, "release": "force", "speed": "1 m/s"},
    BALL | {"contact_time": "7 ms", "damping_ratio": 0.1, "speed": "2 m/s"},
    BALL | {"stiffness": "100 kN/m", "damping": 0, "speed": "1 m/s"},
    {"mass": 1, "from_engine": "mujoco", "solref": "-1000 -10", "speed": "1 m/s"},
    {"mass": 1, "from_engine": "mujoco", "solref": "0.02 0.2", "speed": "0.1 m/s"},
    {"mass": 1, "from_engine": "mujoco", "solref": "0.02 0.5", "solimp": "0.5 0.9 0.01",
     "speed": "2 m/s"},
    {"mass": 1, "from_engine": "mujoco", "solref": "0.02 0.2", "solimp": "0.9 0.9",
     "speed": "1 m/s"},
    SMALL | {"radius": "5 mm", "reduced_modulus": "50 GPa", "restitution": 0.9, "speed": "1 m/s"},
    SMALL | {"radius": "5 mm", "reduced_modulus": "1 MPa", "restitution": 0.6, "speed": "2 m/s"},
    SMALL | {"law": "hunt-crossley", "contact_time": "1 ms", "restitution": 0.8, "speed": "1 m/s"},
    SMALL | {"law": "kuwabara-kono", "contact_time": "1 ms", "restitution": 0.7, "speed": "1 m/s"},
    {"mass": 0.5, "from_engine": "drake", "speed": "1 m/s",
     "parameters": {"point_contact_stiffness": 2e5, "hunt_crossley_dissipation": 0.5}},
]  # fmt: skip


@pytest.mark.long
@pytest.mark.parametrize("given", DROPS)
def test_a_drop(given):
    answer = answered(**given)
    compare(answer.found, answer.dropped, ball_of(answer))


# The rows of a contact without a table that are printed.
OF_CONTACT = {
    "mass", "stiffness", "natural_frequency", "damping", "damping_ratio", "contact_time",
    "measured_restitution", "slowed_speed", "static_deflection",
}  # fmt: skip
OF_DROP = {
    "speed", "drop_height", "rebound_height", "second_rise", "third_rise", "restitution",
    "at_half", "at_tenth", "greatest_compression", "peak_force",
}  # fmt: skip


def compare(found, dropped, ball):
    """All printed numbers of a contact without a table and of a drop onto it."""
    # A new row needs a comparison.
    assert {row.key[0] for row in rows.rows(found) if row.words} == OF_CONTACT
    assert {row.key[0] for row in rows.rows(dropped) if row.words} == OF_DROP
    speed = dropped.speed
    k = found.stiffness
    c = found.damping
    assert found.natural_frequency == pytest.approx(math.sqrt(k / ball.mass), rel=1e-12)
    assert found.damping_ratio == pytest.approx(c / 2 / math.sqrt(k * ball.mass), rel=1e-9)
    if (found.law or {}).get("name") == "impedance":
        # Those of the depths at which the impedance is constant.
        assert found.natural_frequency == pytest.approx(found.law["frequency_ratio"], rel=1e-12)
        assert found.damping_ratio == pytest.approx(found.law["damping_ratio"], rel=1e-12)
    else:
        # Of a law they are those of the linear contact with its r and duration.
        spring = Ball(ball.mass, linear(k, c), found.release == "displacement", 1e-8)
        _, time, _, rate, *_ = spring.contact(speed, gravity=0.0)
        assert found.measured_restitution == pytest.approx(-rate / speed, rel=1e-6)
        assert found.contact_time == pytest.approx(time, rel=1e-6)
    near = {"rel": ball.accuracy, "abs": 1e-9}
    first = ball.rise(speed)
    second = ball.rise(math.sqrt(2 * G * first)) if first else 0.0
    third = ball.rise(math.sqrt(2 * G * second)) if second else 0.0
    rises = dropped.rebound_height, dropped.second_rise, dropped.third_rise
    assert rises == pytest.approx((first, second, third), **near)
    assert dropped.drop_height == pytest.approx(speed**2 / (2 * G), rel=1e-14)
    for part, of in (
        (1, dropped.restitution),
        (2, dropped.at_half),
        (10, dropped.at_tenth),
    ):
        drop = (speed / part) ** 2 / (2 * G)
        assert of == pytest.approx(math.sqrt(ball.rise(speed / part) / drop), abs=1e-6)
    *_, deepest, force = ball.contact(speed)
    assert dropped.greatest_compression == pytest.approx(deepest, rel=1e-7)
    assert dropped.peak_force == pytest.approx(force, rel=1e-6)
    # At rest the force is the weight.
    at_rest = ball.force(found.static_deflection, 0.0, G)
    assert at_rest == pytest.approx(ball.mass * G, rel=1e-3 if found.law else 1e-12)
    # A free impact, of the same speed where r depends on it.
    ended, time, _, rate, *_ = ball.contact(speed, gravity=0.0)
    assert ended and found.measured_restitution == pytest.approx(-rate / speed, rel=1e-7)
    assert found.contact_time == pytest.approx(time, rel=1e-6)
    if found.slowed_speed:
        slow = found.slowed_speed
        free = -ball.contact(slow, gravity=0.0)[3] / slow
        # The speed is found to 1e-10, and the ratio changes by 1 % over a speed of this size.
        assert math.sqrt(2 * G * ball.rise(slow)) / slow / free == pytest.approx(0.99, abs=1e-6)


TABLE = {"frequency": "20 Hz", "acceleration": "0.8 g", "n": 1}
SHAKEN = [
    BALL | TABLE | {"stiffness": "1e6", "restitution": 0.75},
    BALL | TABLE | {"stiffness": "50 kN/m", "restitution": 0.75, "release": "force"},
    BALL | TABLE | {"stiffness": "50 kN/m", "restitution": 0.9, "n": 2},
    BALL | TABLE | {"stiffness": "1e6", "restitution": 0.75, "engine": "mujoco"},
    SMALL | TABLE | {"radius": "5 mm", "reduced_modulus": "1 GPa", "restitution": 0.8},
    SMALL | TABLE | {"law": "hunt-crossley", "contact_time": "2 ms", "restitution": 0.8},
    {"mass": 1, **TABLE, "from_engine": "mujoco", "solref": "-1e5 -60"},
]


@pytest.mark.long
@pytest.mark.usefixtures("short_runs")
@pytest.mark.parametrize("given", SHAKEN)
def test_an_orbit_on_a_table(given):
    answer = answered(**given)
    found = answer.found
    one = found.judged
    ball = ball_of(answer)
    omega = 40 * math.pi
    amplitude = 0.8 * G / omega**2
    exact, simple, _ = one.values["phase"].values()

    def lift(t):
        return amplitude * math.sin(omega * t + exact)

    def push(t):
        return -amplitude * omega**2 * math.sin(omega * t + exact)

    def rate(t):
        return amplitude * omega * math.cos(omega * t + exact)

    ball.longest = 0.02
    ended, time, p, going, deepest, force = ball.contact(one.impact_speed, (lift, push))
    assert ended
    assert one.contact_duration == pytest.approx(time, rel=1e-6)
    assert one.greatest_compression == pytest.approx(deepest, rel=1e-6)
    assert one.peak_force == pytest.approx(force, rel=1e-6)
    assert one.peak_force_over_weight == pytest.approx(force / ball.mass / G, rel=1e-6)
    # The flight leads to the same impact n periods later.
    up = rate(time) - going
    level = lift(time) - p
    flight = one.n / 20 - time
    landing = level + up * flight - G * flight**2 / 2
    assert landing == pytest.approx(lift(0.0), abs=1e-7 * amplitude)
    arrives = rate(0.0) - (up - G * flight)
    assert arrives == pytest.approx(one.impact_speed, rel=1e-6)
    assert one.max_height == pytest.approx(level + up**2 / (2 * G), rel=1e-7)
    assert one.values["bounce_velocity"][next(iter(one.standing))] == pytest.approx(up, rel=1e-6)
    # The restitution model: v = nπ g/Ω and Λ cos φ = nπ (1 - r)/(1 + r).
    r = found.measured_restitution
    bounce = one.n * math.pi * G / omega
    phase = math.acos(one.n * math.pi * (1 - r) / (1 + r) / 0.8)
    height = amplitude * math.sin(phase) + bounce**2 / (2 * G)
    assert simple == pytest.approx(phase, rel=1e-9)
    assert one.values["max_height"]["restitution"] == pytest.approx(height, rel=1e-9)
    assert one.errors["max_height"] == pytest.approx(height / one.max_height - 1, abs=1e-6)


def in_steps(scheme, m, k, c, h, fractions, *, pulls, drop=None):
    """r of free impacts, or rises of drops, by the steps of an engine."""
    found = []
    for f in fractions:
        g = 0.0 if drop is None else G
        x = -1.0 * f * h
        v = -1.0
        if drop is not None:
            start = drop + math.sqrt(2 * G * drop) * h * (f - 0.5)
            x = start
            v = 0.0
        was_in = False
        for _ in range(1_000_000):
            if x < 0:
                was_in = True
                away = v - g * h
                if scheme == "semi":
                    force = -(k * x + c * v)
                    force = force if pulls else max(force, 0.0)
                    v = away + h * force / m
                else:
                    v = (away - h * k / m * x) / (1 + h * c / m + h * h * k / m)
                    v = max(v, away) if not pulls else v
            elif was_in and (drop is None or v <= 0):
                break
            else:
                v -= g * h
            x += h * v
            if was_in and x >= 0 and drop is None:
                break
            if was_in and x < 0 and abs(v) < 1e-7 * math.sqrt(2 * G):
                break
        found.append(v if drop is None else x * drop / start)
    return np.array(found)


STEPPED = [
    ("mujoco", "1 ms", 0.75), ("mujoco", "0.2 ms", 0.9), ("generic", "0.5 ms", 0.6),
    ("lammps", "1 ms", 0.9), ("liggghts", "0.3 ms", 0.75), ("mercurydpm", "0.7 ms", 0.8),
    ("pybullet", "1 ms", 0.75), ("drake", "0.5 ms", 0.6),
]  # fmt: skip


@pytest.mark.long
@pytest.mark.parametrize(("name", "step", "r"), STEPPED)
def test_a_time_step_that_is_given(name, step, r):
    given = BALL | {"stiffness": "100 kN/m", "restitution": r, "engine": name}
    answer = answered(**given, time_step=step, speed="1 m/s")
    h = answer.engine.time_step
    fractions = np.linspace(1e-6, 1.0, 2001)
    settings = answer.engine
    at = settings.at_step
    k, c = written(name, settings)
    scheme = "implicit" if name in ("pybullet", "drake") else "semi"
    pulls = Release(settings.release) is Release.DISPLACEMENT
    many = in_steps(scheme, 0.5, k, c, h, fractions, pulls=pulls)
    # Instants 5e-4 apart; r changes by less than 2 over one step.
    assert at.least == pytest.approx(many.min(), abs=1e-3)
    assert at.most == pytest.approx(many.max(), abs=1e-3)
    assert at.mean == pytest.approx(many.mean(), abs=1e-3)
    rises = in_steps(
        scheme, 0.5, k, c, h, np.linspace(0.0, 1.0, 301), pulls=pulls, drop=1 / (2 * G)
    )
    # 300 places within the last step, and the top between two steps; velocities of half steps fall
    # by half a step less.
    near = 0.03 if name in ("lammps", "liggghts", "mercurydpm") else 0.01
    assert settings.drop.rise == pytest.approx((rises.min(), rises.max()), rel=near)


def written(name, settings):
    """k and c of the implicit or explicit spring and damper that an engine computes."""
    found = settings.parameters
    if name == "mujoco":
        return tuple(-0.5 * x for x in found["solref"])
    if name == "pybullet":
        return found["contactStiffness"] / 2, found["contactDamping"] * 2
    if name == "drake":
        double, time = found.values()
        return double / 2, double * time
    if name in ("lammps", "liggghts"):
        k, per_mass = found.values()
        return k, 0.5 * per_mass
    return tuple(found.values())[-2:]
