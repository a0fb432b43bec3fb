"""Random designs against scipy's integration of a ball on a contact, which shares no code.

The ball is integrated in SI units, from an impact on the orbit of the answer and from a start
beside it, with events at the touch and at the release. The restitution model is integrated in the
same way, with an instant in place of the contact.
"""

import math
from typing import NamedTuple

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

from bouncing_ball_beyond.inherited.contacts import Contact, Question, Table, assess_contact
from bouncing_ball_beyond.inherited.errors import NoOrbitError
from bouncing_ball_beyond.periodic.one_impact import n_t

G = 9.80665
PRECISE = {"rtol": 1e-11, "atol": 1e-14, "method": "DOP853"}
SEED = 37


class Case(NamedTuple):
    mass: float
    stiffness: float
    damping: float
    release: str
    amplitude: float
    omega: float


def contact(case, start, speed):
    """Time, height and velocity of the ball where a contact ends that begins at a time."""

    def table(t):
        return (
            case.amplitude * math.sin(case.omega * t),
            case.amplitude * case.omega * math.cos(case.omega * t),
        )

    def push(t, y):
        level, rate = table(t)
        return case.stiffness * (level - y[0]) + case.damping * (rate - y[1])

    def motion(t, y):
        return y[1], push(t, y) / case.mass - G

    def ends(t, y):
        return push(t, y) if case.release == "force" else table(t)[0] - y[0]

    ends.terminal = True
    ends.direction = -1
    unit = math.sqrt(case.mass / case.stiffness)
    # A first small part, because the penetration is zero at the start, too.
    first = solve_ivp(motion, [start, start + 1e-4 * unit], [table(start)[0], speed], **PRECISE)
    now = first.t[-1]
    run = solve_ivp(motion, [now, now + 50 * unit], first.y[:, -1], events=ends, **PRECISE)
    assert len(run.t_events[0]) == 1
    return run.t_events[0][0], *run.y_events[0][0]


def flight(case, start, height, speed):
    """Time and velocity of the next touch of a ball that flies from a height above the table."""

    def gap(t):
        fallen = height + speed * (t - start) - G * (t - start) ** 2 / 2
        return fallen - case.amplitude * math.sin(case.omega * t)

    step = 2 * math.pi / case.omega / 2000
    t = start + step / 50
    # Released by its force, the ball is still below the table's level.
    while gap(t) <= 0:
        t += step
    while gap(t + step) > 0:
        t += step
    hit = brentq(gap, t, t + step, xtol=1e-15, rtol=1e-14)
    return hit, speed - G * (hit - start)


def heights(case, start, speed, impacts, restitution=None):
    """Greatest heights of the flights after impacts, with a contact or with a coefficient."""
    found = []
    for _ in range(impacts):
        if restitution is None:
            end, height, rise = contact(case, start, speed)
        else:
            end = start
            height = case.amplitude * math.sin(case.omega * start)
            rate = case.amplitude * case.omega * math.cos(case.omega * start)
            rise = rate - restitution * (speed - rate)
        found.append(height + rise**2 / (2 * G))
        start, speed = flight(case, end, height, rise)
    return np.array(found)


def designs(count):
    """Random designs that have a stable orbit in both models."""
    rng = np.random.default_rng(SEED)
    found = []
    while len(found) < count:
        frequency = 10 ** rng.uniform(0.7, 2.3)
        ratio = 10 ** rng.uniform(0.6, 2.0)
        mass = 10 ** rng.uniform(-3, 0.5)
        given = {
            "stiffness": mass * (2 * math.pi * frequency * ratio) ** 2,
            "measured_restitution": rng.uniform(0.3, 0.9),
            "release": ("displacement", "force")[rng.integers(2)],
        }
        table = Table(frequency=frequency, acceleration=rng.uniform(0.7, 3.0) * G)
        n = int(rng.integers(1, 4))
        try:
            answer = assess_contact(table, Contact(mass=mass, **given), Question(n=n))
        except NoOrbitError:
            continue
        standing = answer.judged.standing
        if all(each.is_stable and each.is_admissible for each in standing.values()):
            found.append((answer, given["release"]))
    return found


@pytest.mark.slow
@pytest.mark.parametrize(
    ("count", "impacts"), [(1, 14), pytest.param(12, 24, marks=pytest.mark.long)]
)
def test_the_heights_of_random_designs_are_those_of_an_integration(count, impacts, short_runs):
    for answer, release in designs(count):
        table = answer.case.table
        case = Case(
            mass=answer.case.mass,
            stiffness=answer.stiffness,
            damping=answer.damping,
            release=release,
            amplitude=table.table_amplitude,
            omega=table.angular_frequency,
        )
        true, predicted, *_ = answer.judged.values["max_height"].values()
        for name, height, r in (
            ("spring-damper", true, None),
            ("restitution", predicted, answer.measured_restitution),
        ):
            orbit = n_t.orbit(answer.case.models[name], answer.n, answer.amplitude)
            start = float(orbit.phase) / case.omega
            speed = float(orbit.impact_velocity) * G / case.omega
            # The orbit repeats: the errors of integration are 1e-11 in each contact.
            assert heights(case, start, speed, 3, r) == pytest.approx(height, rel=1e-8), name
            # A ball beside a stable orbit approaches it, as fast as its multipliers say.
            factor = float(np.abs(orbit.multipliers()).max())
            beside = heights(case, start, 1.0001 * speed, impacts, r)
            far = np.abs(beside / height - 1)
            assert far[-3:].max() < 3 * factor ** (impacts - 4) * far[:3].max() + 1e-8, name
        # The sentence of the verdict has this error, with its sign.
        error = predicted / true - 1
        assert answer.judged.errors["max_height"] == pytest.approx(error, rel=1e-9)
        assert answer.is_good_enough is (abs(error) <= 0.01)
        assert ("+" if error > 0 else "-") in answer.verdict
