"""What is read from an orbit of the spring-damper model."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

from bouncing_ball.contacts.damping import damping_ratio
from bouncing_ball.contacts.spring_damper import Release, SpringDamper
from bouncing_ball.orbits.spring_damper_branch import branch_point
from bouncing_ball.orbits.spring_damper_limits import orbit_at
from bouncing_ball.orbits.spring_damper_orbit import SpringDamperOrbit

CASES = [
    # n, r, ϖ, Λ, release
    (1, 0.85, 2.0, 0.9, Release.DISPLACEMENT),
    (1, 0.65, 20.0, 1.0, Release.DISPLACEMENT),
    (2, 0.65, 10.0, 1.5, Release.DISPLACEMENT),
    (3, 1.0, 5.0, 0.5, Release.DISPLACEMENT),
    (1, 0.65, 3.0, 1.0, Release.FORCE),
    (2, 0.85, 50.0, 0.9, Release.FORCE),
]


def build(case):
    n, r, omega, lam, release = case
    return orbit_at(SpringDamper(omega, float(damping_ratio(r)), release), n, lam)


@pytest.mark.parametrize("case", CASES)
def test_one_cycle_by_numerical_integration(case):
    """The orbit, integrated from its start alone, closes after 2πn."""
    n, _, omega, lam, release = case
    orbit = build(case)
    zeta, phase = float(orbit.law.damping_ratio), float(orbit.phase)

    def table(t):
        return lam * np.sin(t + phase), lam * np.cos(t + phase)

    def touching(t, y):
        w, wdot = table(t)
        return [y[1], -1 - 2 * zeta * omega * (y[1] - wdot) - omega**2 * (y[0] - w)]

    def released(t, y):
        w, wdot = table(t)
        if release is Release.FORCE:
            return omega * (y[0] - w) + 2 * zeta * (y[1] - wdot)
        return omega * (y[0] - w) if t > 1e-6 else -1.0

    released.terminal, released.direction = True, 1

    def landed(t, y):
        return y[0] - table(t)[0] if t > float(orbit.contact_duration) + 0.1 else 1.0

    landed.terminal, landed.direction = True, -1
    options = {"method": "DOP853", "rtol": 1e-13, "atol": 1e-14}
    start = [table(0)[0], float(orbit.impact_velocity)]
    contact = solve_ivp(touching, (0, 2 * np.pi), start, events=released, **options)
    t_b, at_b = contact.t_events[0][0], contact.y_events[0][0]
    flight = solve_ivp(
        lambda t, y: [y[1], -1.0],
        (t_b, 2 * np.pi * n + 1),
        at_b,
        events=landed,
        max_step=0.05,
        **options,
    )
    t_2, at_2 = flight.t_events[0][0], flight.y_events[0][0]
    # The integrator's tolerance over the cycle, and that of its dense output,
    # of order 1e-11 for these steps; times the flight of at most 20.
    assert t_b == pytest.approx(float(orbit.contact_duration), abs=1e-10)
    assert at_b[1] == pytest.approx(float(orbit.bounce_velocity), abs=1e-9)
    assert at_b[0] == pytest.approx(float(orbit.bounce_height), abs=1e-8)
    assert t_2 == pytest.approx(2 * np.pi * n, abs=1e-8)
    assert at_2[1] == pytest.approx(float(orbit.impact_velocity), abs=1e-8)
    assert at_2[0] == pytest.approx(table(0)[0], abs=1e-8)
    # Its greatest height, from the integrated flight's own parabola.
    assert at_b[0] + at_b[1] ** 2 / 2 == pytest.approx(float(orbit.max_height), abs=1e-8)


def test_max_height_of_a_ball_released_downwards():
    # A stable orbit of a soft contact: the ball turns round before release, so
    # its greatest height lies in the contact.
    r, omega, lam = 0.1546, 0.3691, 10.5378
    orbit = orbit_at(SpringDamper(omega, float(damping_ratio(r))), 1, lam)
    assert float(orbit.bounce_velocity) < 0
    time = np.linspace(0, float(orbit.contact_duration), 201)
    k = np.argmax(orbit.contact_path(time)[0])
    top = brentq(lambda at: orbit.contact_path(at)[1], time[k - 1], time[k + 1])
    # A height of order one, with the square of the time's error.
    assert float(orbit.max_height) == pytest.approx(orbit.contact_path(top)[0], abs=1e-13)


def test_distance_is_the_largest_difference():
    contact = SpringDamper(10.0, 0.05)
    point = branch_point(0.02, contact, 1)
    base = {
        "n": 1,
        "law": contact,
        "amplitude": point.amplitude,
        "phase": point.phase + 2 * np.pi,  # the same table
        "contact_duration": point.contact_duration,
        "impact_velocity": point.u + point.x,
    }
    orbit = SpringDamperOrbit.from_branch(point, contact, 1)
    assert float(SpringDamperOrbit(**base).distance(orbit)) < 1e-14
    sizes = {"amplitude": 1, "phase": 1, "contact_duration": 10, "impact_velocity": 1}
    for name, size in sizes.items():
        moved = base | {name: base[name] + 1e-3}
        found = SpringDamperOrbit(**moved).distance(orbit)
        assert float(found) == pytest.approx(size * 1e-3, rel=1e-9)
