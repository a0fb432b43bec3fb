"""Drop tests and orbits of designs against an integration by scipy, which shares no code."""

import math

import numpy as np
import pytest
from asked_contacts import answered, assessed, described
from scipy.integrate import solve_ivp

from bouncing_ball_beyond.inherited.contacts.contact.drop_test import rebound
from bouncing_ball_beyond.inherited.contacts.contact.rebounds import rises, slowed
from bouncing_ball_beyond.inherited.errors import ModelError
from bouncing_ball_beyond.models.damping import LINEAR, Release
from bouncing_ball_beyond.models.laws.hertzian import KuwabaraKono, Tsuji
from bouncing_ball_beyond.periodic.one_impact import n_t

G = 9.80665
PRECISE = {"rtol": 1e-11, "atol": 1e-15, "method": "DOP853"}


def ended(event):
    event.terminal = True
    event.direction = -1
    return event


def one_contact(m, k, c, release, table, start, speed):
    """Time, height and velocity of the ball at the end of a contact with a moving table."""
    amplitude, omega = table

    def grip(t, y):
        depth = amplitude * math.sin(omega * t) - y[0]
        rate = amplitude * omega * math.cos(omega * t) - y[1]
        return depth, rate

    def motion(t, y):
        depth, rate = grip(t, y)
        return y[1], (k * depth + c * rate) / m - G

    def holds(t, y):
        depth, rate = grip(t, y)
        return k * depth + c * rate if release == "force" else depth

    # A first small part, because the penetration is zero at the start, too.
    length = math.sqrt(m / k)
    y = [amplitude * math.sin(omega * start), speed]
    first = solve_ivp(motion, [start, start + 1e-4 * length], y, **PRECISE)
    time = first.t[-1]
    y = first.y[:, -1]
    run = solve_ivp(motion, [time, time + 40 * length], y, events=ended(holds), **PRECISE)
    assert len(run.t_events[0]) == 1
    return run.t_events[0][0], *run.y_events[0][0]


def rise(found, mass, drop):
    """The height to which the ball of a design rises after a drop onto a table at rest."""
    release = str(found.case.equivalent.release)
    speed = -math.sqrt(2 * G * drop)
    numbers = (mass, found.stiffness, found.damping)
    _, height, velocity = one_contact(*numbers, release, (0.0, 1.0), 0.0, speed)
    return height + velocity**2 / (2 * G)


DROP = {"mass": 0.02, "drop_height": "20 cm", "rebound_height": "4 cm"}
SHAKEN = {"frequency": "20 Hz", "acceleration": "1.5 g"}


@pytest.mark.parametrize(
    ("given", "drop", "height"),
    [
        (DROP | {"contact_time": "50 ms"}, 0.2, 0.04),
        (DROP | {"contact_time": "50 ms", "release": "force"}, 0.2, 0.04),
        (
            DROP | {"contact_time": 0.05, "drop_height": 0.1, "rebound_height": "9 mm"}, 0.1, 0.009,
        ),
        (DROP | {"stiffness": "90 N/m", "release": "force"}, 0.2, 0.04),
        (DROP | SHAKEN | {"stiffness": "2 kN/m", "n": 1, "rebound_height": "10 cm"}, 0.2, 0.1),
        # A stiffness that is chosen for a tolerance.
        (
            DROP | SHAKEN | {"rebound_height": "10 cm", "n": 1, "tolerance": "20 %"}, 0.2, 0.1,
        ),
    ],
)  # fmt: skip
def test_a_ball_that_is_dropped_with_gravity_rises_as_measured(given, drop, height, short_runs):
    found = answered(**given).found
    assert rise(found, 0.02, drop) == pytest.approx(height, rel=1e-7)
    if "contact_time" in given:
        assert found.contact_time == pytest.approx(0.05, rel=1e-9)
    (note,) = [x for x in found.notes if x.startswith("dropped from")]
    assert f"r = {found.measured_restitution:.4g} without gravity" in note


def test_a_drop_on_a_damper_that_acts_on_approach_alone_is_read_with_gravity_as_well():
    given = DROP | {"contact_time": "50 ms", "rebound_height": "10 cm", "release": "approach"}
    found = answered(**given).found
    (note,) = [x for x in found.notes if x.startswith("dropped from")]
    assert f"r = {found.measured_restitution:.4g} without gravity" in note
    assert found.measured_restitution > math.sqrt(0.5) + 0.01


@pytest.mark.parametrize("release", LINEAR)
def test_gravity_lowers_the_restitution_by_one_percent_at_the_speed_that_is_given(release):
    found = described(mass=0.02, stiffness=2000.0, measured_restitution=0.7, release=release)
    drop = found.slowed_speed**2 / (2 * G)
    assert math.sqrt(rise(found, 0.02, drop) / drop) == pytest.approx(0.99 * 0.7, rel=1e-7)
    elastic = described(mass=0.02, stiffness=2000.0, restitution=1.0, release=release)
    assert elastic.slowed_speed == 0


def test_a_drop_that_no_contact_has_is_refused_in_one_line():
    low = DROP | {"stiffness": 1e6, "release": "force", "rebound_height": "1 mm"}
    with pytest.raises(ModelError, match=r"no contact rebounds from drop_height 0\.2 m to reb"):
        described(**low)
    # It is the rebound of the strongest damping: e⁻⁴ of the height, for a very stiff contact.
    least = rebound(math.sqrt(1e10 / 0.02), 1 - 1e-9, 0.2, G, Release.FORCE)
    assert least == pytest.approx(0.2 * math.exp(-4), rel=0.01)


@pytest.mark.parametrize(
    ("stiffness", "restitution", "acceleration", "release"),
    [
        (2e3, 0.65, "1 g", "displacement"),
        (2e4, 0.65, "1 g", "force"),
        (5e3, 0.8, "0.9 g", "displacement"),
    ],
)
def test_the_orbit_of_a_design_is_that_of_an_integration(
    stiffness, restitution, acceleration, release, short_runs
):
    found = assessed(
        mass=0.02, frequency="20 Hz", acceleration=acceleration, n=1, stiffness=stiffness,
        restitution=restitution, release=release,
    )  # fmt: skip
    one = found.judged
    assert one.is_stable
    table = (found.case.table.table_amplitude, found.case.table.angular_frequency)
    orbit = n_t.orbit(found.case.models["spring-damper"], 1, found.amplitude)
    start = float(orbit.phase) / table[1]
    speed = float(orbit.impact_velocity) * G / table[1]
    numbers = (0.02, found.stiffness, found.damping)
    end, height, velocity = one_contact(*numbers, release, table, start, speed)
    top = height + velocity**2 / (2 * G)
    assert top == pytest.approx(one.max_height, rel=1e-8)
    assert end - start == pytest.approx(one.contact_duration, rel=1e-7)
    # After a period the ball meets the table again, with the same velocity.
    flight = start + 0.05 - end
    back = height + velocity * flight - G * flight**2 / 2
    assert back == pytest.approx(table[0] * math.sin(table[1] * start), abs=1e-9)
    assert velocity - G * flight == pytest.approx(speed, rel=1e-7)
    simple = n_t.orbit(found.case.models["restitution"], 1, found.amplitude).max_height
    predicted = float(simple) * found.case.table.length
    assert one.errors["max_height"] == pytest.approx(predicted / top - 1, abs=1e-7)
    assert np.sign(one.errors["max_height"]) == np.sign(predicted - top)


@pytest.mark.parametrize("law", [Tsuji(100.0, 0.3), KuwabaraKono(100.0, 0.01)])
def test_at_the_speed_at_which_gravity_is_felt_r_is_lowered_by_one_percent_for_a_law(law):
    speed = np.array([slowed(law, 1e5)])
    share = np.sqrt(2 * rises(law, speed)) / speed / law.signature(speed).restitution
    assert share == pytest.approx(0.99, rel=1e-9)


def test_the_second_and_third_rise_are_those_of_the_next_bounces():
    r = 0.8
    found = answered(mass=0.1, stiffness=1e9, restitution=r, speed="2 m/s").dropped
    rises = found.rebound_height, found.second_rise, found.third_rise
    # Gravity takes 2ζ(1 + r) g/(ωv) of r, and v is at least 1 m/s.
    taken = 2 * 0.1 * (1 + r) * G / 1e5
    for k, rise in enumerate(rises, 1):
        assert rise == pytest.approx(found.drop_height * r ** (2 * k), rel=2 * k * taken / r)
    # A ball that does not rebound has no further bounces.
    soft = answered(mass=1.0, stiffness=1e3, restitution=0.4, speed="1 m/s").dropped
    assert soft.rebound_height == soft.second_rise == soft.third_rise == 0


@pytest.mark.parametrize("release", ["displacement", "force", "approach"])
@pytest.mark.parametrize("loss", [{"restitution": 0.5}, {"damping_ratio": 0.02}])
def test_a_contact_of_a_penetration_sinks_in_by_it(release, loss):
    given = {"mass": 0.3, "penetration": "2 mm", **loss, "release": release}
    found = answered(**given, speed="1.5 m/s")
    assert found.dropped.greatest_compression == pytest.approx(2e-3, rel=1e-9)
    # A drop from the same height asks for the same contact.
    r = loss.get("restitution", 0.9)
    drop = answered(mass=0.3, penetration="2 mm", drop_height=1.0, rebound_height=r**2)
    again = answered(
        mass=0.3, stiffness=drop.found.stiffness, damping=drop.found.damping,
        speed=math.sqrt(2 * G),
    )  # fmt: skip
    assert again.dropped.greatest_compression == pytest.approx(2e-3, rel=1e-9)
    assert again.dropped.rebound_height == pytest.approx(r**2, rel=1e-9)


def test_a_penetration_needs_an_impact(refusal):
    ball = {"mass": 1.0, "restitution": 0.5, "penetration": "2 mm"}
    for more in ({}, {"frequency": 50.0, "acceleration": "2 g", "speed": 1.0}):
        with refusal(ModelError, "penetration needs speed of an impact on a table at rest"):
            answered(**ball, **more)
    with refusal(ModelError, "contradict each other, because each gives the stiffness"):
        answered(**ball, stiffness=1e5, speed=1.0)
    with refusal(ModelError, "penetration is not allowed with law hunt-crossley"):
        answered(**ball, law="hunt-crossley", contact_time=1e-3, speed=1.0)


def test_never_and_always_are_two_answers(said):
    elastic = said("design", "--mass=1", "--stiffness=1e4", "--restitution=1")
    assert "gravity lowers r by 1 % at            no speed" in elastic
    # Fast impacts on this law hardly rebound, and slow ones are elastic.
    damped = said("design", "--mass=1", "--law=hunt-crossley", "--contact-time=1 ms",
                  "--restitution=0.1", "--speed=1 m/s")  # fmt: skip
    assert "gravity lowers r by 1 % at            every speed" in damped


@pytest.mark.parametrize("zeta", [1.0, 2.0])
def test_gravity_also_slows_what_is_overdamped(zeta):
    omega = 100.0
    found = described(
        mass=1.0, stiffness=omega**2, damping_ratio=zeta, release="force"
    ).slowed_speed

    def left(_, y):
        return omega * y[0] + 2 * zeta * y[1]

    left.terminal = True
    left.direction = -1

    def contact(gravity):
        def motion(_, y):
            return [y[1], gravity - omega * left(_, y)]

        run = solve_ivp(
            motion, (0.0, 1e3), [0.0, found], events=left, method="DOP853", rtol=1e-12, atol=1e-14
        )
        return run.y[:, -1]

    depth, rate = contact(G)
    _, free = contact(0.0)
    # The speed is found to 1e-10, and the rise with the integration's error.
    lowered = math.sqrt(rate * rate - 2 * G * depth) / -free
    assert lowered == pytest.approx(0.99, abs=1e-6)
