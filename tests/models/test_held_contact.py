"""Contacts of finite duration on other tables, with drag and springs: a second code and limits."""

import numpy as np
import pytest
from contacts_by_quadrature import leg, linear, of_force
from settings_by_quadrature import table_of
from side_by_side import VELOCITY, checked_deviations

import bouncing_ball
from bouncing_ball import Drag, Spring, Waveform, contact_law, rigid, spring_damper
from bouncing_ball.errors import ModelError
from bouncing_ball.models.contact import ContactSpan
from bouncing_ball.models.held_contact import gap_in_contact, held_threshold
from bouncing_ball.models.sequence import Status
from bouncing_ball.models.setting import setting_of
from bouncing_ball.models.spring_damper import SpringDamper
from bouncing_ball.models.waveform import largest

TWO = ([1.0, 0.3], [0.0, 0.2])
THREE = ([0.7, 0.0, 0.2], [0.1, -0.15, 0.0])
FLIGHTS = {
    "gravity": (Drag(0.0), ("drag", 0.0)),
    "drag": (Drag(0.3), ("drag", 0.3)),
    "spring": (Spring(0.5, 0.1, -3.0), ("spring", 0.5, 0.1, -3.0)),
}
# The integrator takes some hundred steps with a tolerance of 1e-13; the error of a height is
# divided by the speed at the event.
_SECOND_CODE = 3e-11


@pytest.mark.parametrize("flight", FLIGHTS)
@pytest.mark.parametrize("release", ["displacement", "force"])
@pytest.mark.parametrize("ratio", [2.0, 15.0])
def test_legs_are_those_of_a_second_code(flight, release, ratio):
    zeta = 0.2
    kind, numbers = FLIGHTS[flight]
    for harmonics, amplitude in ((TWO, 0.8), (THREE, 1.9)):
        table = table_of(amplitude, *harmonics)
        ball = spring_damper(
            frequency_ratio=ratio,
            damping_ratio=zeta,
            release=release,
            table=Waveform(*harmonics),
            flight=kind,
        )
        lag = 2 * zeta / ratio if release == "force" else 0.0
        scene = linear(table, ratio, zeta, lag, numbers)
        found = ball.simulate(amplitude, 0.3, -4.0 + table(0.3, 1), 3)
        for k in range(2):
            state = found.phase[k], found.displacement[k], found.relative_velocity[k]
            duration, passed, gap, rate = leg(scene, *state)
            slow = _SECOND_CODE * (1 + 1 / abs(rate))
            assert abs(found.contact_duration[k] - duration) < slow
            assert abs(found.time[k + 1] - found.time[k] - passed) < slow
            assert abs(found.displacement[k + 1] - gap) < slow
            assert abs(found.relative_velocity[k + 1] - rate) < slow
        of_table = np.array([table(0.3 + t, 1) for t in found.time])
        assert np.allclose(found.impact_velocity, found.relative_velocity + of_table, atol=1e-12)


LAWS = {
    "hunt-crossley": (
        {"stiffness": 800.0, "damping": 0.1},
        lambda p, u: 800 * p**1.5 * (1 + 0.1 * u),
        lambda p, u: p,
    ),
    "kuwabara-kono": (
        {"stiffness": 800.0, "damping": 0.03},
        lambda p, u: 800 * (p**1.5 + 0.03 * np.sqrt(p) * u),
        lambda p, u: p + 0.03 * u,
    ),
    "linear": (
        {"frequency_ratio": 12.0, "damping_ratio": 0.2, "release": "approach"},
        lambda p, u: 144 * p + 4.8 * max(u, 0.0),
        lambda p, u: p,
    ),
}


@pytest.mark.parametrize("name", LAWS)
def test_legs_of_laws_are_those_of_a_second_code(name):
    parameters, force, grip = LAWS[name]
    for harmonics, amplitude in ((TWO, 0.8), (THREE, 1.9)):
        table = table_of(amplitude, *harmonics)
        scene = of_force(table, force, grip)
        ball = contact_law(name, **parameters, table=Waveform(*harmonics))
        found = ball.simulate(amplitude, 0.3, -4.0 + table(0.3, 1), 3)
        for k in range(2):
            state = found.phase[k], found.displacement[k], found.relative_velocity[k]
            duration, passed, _, rate = leg(scene, *state)
            # The kinks of the force, and p^1.5 at its ends, cost the integrator some digits.
            slow = 1e-9 * (1 + 1 / abs(rate))
            assert abs(found.contact_duration[k] - duration) < slow
            assert abs(found.time[k + 1] - found.time[k] - passed) < slow
            assert abs(found.relative_velocity[k + 1] - rate) < slow


@pytest.mark.parametrize("flight", FLIGHTS)
def test_the_stiff_limit_is_the_rigid_ball(flight):
    kind, _ = FLIGHTS[flight]
    where = {"table": Waveform(*TWO), "flight": kind}
    limit = rigid(restitution=0.6, **where).simulate(0.9, 0.3, -3.0, 4).time
    apart = []
    for ratio in (1e4, 2e4):
        ball = spring_damper(frequency_ratio=ratio, restitution=0.6, **where)
        apart.append(np.abs(ball.simulate(0.9, 0.3, -3.0, 4).time - limit).max())
    # The difference is that of the duration of the contact, π/ϖ_d, which is halved.
    assert 0 < apart[0] < 1e-2
    assert abs(apart[0] / apart[1] - 2) < 1e-2


@pytest.mark.parametrize(
    ("flight", "lag"), [("gravity", 0.0), ("drag", 0.04), ("spring", 0.0), ("spring", 0.04)]
)
def test_bounds_of_the_motion_in_contact(flight, lag):
    kind, _ = FLIGHTS[flight]
    rng = np.random.default_rng(1)
    none = np.zeros(40)
    span = ContactSpan(
        displacement=none,
        phase=rng.uniform(-3, 3, 40),
        velocity=-rng.uniform(0.1, 5, 40),
        amplitude=none + 1.2,
        duration=none,
        release_displacement=none,
        release_velocity=none,
    )
    law = SpringDamper(7.0, 0.1)
    path = gap_in_contact(law, setting_of(Waveform(*TWO), kind), span, 1.2)
    start = rng.uniform(0, 3, 40)
    at = path.lagged(start, lag)
    step = 1e-4
    low, high = (path.lagged(start + j * step, lag).values for j in (-1, 1))
    for order in range(3):
        slope = (high[order] - low[order]) / (2 * step)
        # The central difference has an error of step² times the third derivative.
        size = np.abs(at.values[3]).max() * law.stiffness
        assert np.abs(slope - at.values[order + 1]).max() < step**2 * size
    for later in np.linspace(0, 20, 800):
        _, _, second, third = path.lagged(start + later, lag).values
        assert np.all(np.abs(second) <= at.bounds[0] * (1 + 1e-12))
        assert np.all(np.abs(third) <= at.bounds[1] * (1 + 1e-12))


def test_the_largest_value_of_a_sum_of_harmonics():
    rng = np.random.default_rng(2)
    rows = rng.normal(size=(6, 4)) + 1j * rng.normal(size=(6, 4))
    phase = np.linspace(-np.pi, np.pi, 200_001)
    k = np.arange(1, 5)
    value = np.imag(rows[:, np.newaxis] * np.exp(1j * k * phase[:, np.newaxis])).sum(axis=-1)
    most = largest(rows)
    assert np.all(most >= value.max(axis=1))
    # The samples miss the maximum by the square of their distance.
    assert np.all(most - value.max(axis=1) < 1e-8)


@pytest.mark.parametrize("release", ["displacement", "force"])
@pytest.mark.parametrize("flight", FLIGHTS)
def test_a_ball_lies_still_up_to_the_threshold(flight, release):
    kind, _ = FLIGHTS[flight]
    where = {"table": Waveform(*TWO), "flight": kind}
    ball = spring_damper(frequency_ratio=5.0, damping_ratio=0.3, release=release, **where)
    threshold = float(ball.permanent_contact_threshold())
    # The ball is laid on the table, and has to settle first.
    speed = ball.place.waveform.velocity(0.0)
    for factor, status in ((0.999, Status.PERMANENT_CONTACT), (1.001, Status.BOUNCING)):
        lam = factor * threshold
        assert ball.simulate(lam, 0.0, lam * speed, 20).status == status
    assert bouncing_ball.permanent_contact(ball) == threshold


def test_threshold_of_one_harmonic_is_that_of_the_paper():
    for release in ("displacement", "force"):
        law = SpringDamper(np.array([0.8, 3.0, 40.0]), 0.2, release)
        of_paper = law.permanent_contact
        found = held_threshold(law, setting_of(Waveform([0.0], [1.0]), None))
        assert np.abs(found / of_paper - 1).max() < 1e-12


@pytest.mark.parametrize("zeta", [2e-3, 0.05])
def test_a_stiff_contact_that_lies_on_the_table_ends_where_the_load_does(zeta):
    # Thousands of oscillations pass before the table leaves the ball behind.
    where = {"table": Waveform(*TWO)}
    ball = spring_damper(frequency_ratio=1e4, damping_ratio=zeta, **where)
    dead = rigid(restitution=0.5, **where)
    lam = 1.5
    phase = -2.0
    lift = dead.place.lift_off(np.array([phase]), np.array([lam])).wait[0]
    found = ball.simulate(lam, phase, lam * ball.place.waveform.velocity(phase), 1)
    assert found.status == Status.BOUNCING
    # A damped contact follows its load with a lag of 2ζ/ϖ, and the ball has inertia.
    assert abs(found.contact_duration[0] - lift) < 2e-5


# A contact law has no other flight than the free one.
@pytest.mark.parametrize(
    ("case", "flight"), [*(("held", flight) for flight in FLIGHTS), ("law", "gravity")]
)
def test_a_deviation_grows_as_side_by_side_balls_do(case, flight):
    kind, _ = FLIGHTS[flight]
    if case == "law":
        ball = contact_law("hunt-crossley", stiffness=500.0, damping=0.1, table=Waveform(*TWO))
    else:
        where = {"table": Waveform(*TWO), "flight": kind}
        ball = spring_damper(frequency_ratio=6.0, damping_ratio=0.1, release="force", **where)
    dynamics = ball.dynamics(1.7)
    start, leg, determinant = checked_deviations(dynamics)
    contraction = dynamics.contraction(start, leg.departure)[0]
    contraction *= dynamics.setting.contraction(leg.passed - leg.departure.duration)[()]
    released = leg.departure.flight
    # A step of the force at the release multiplies areas too; here there is none.
    expected = contraction * VELOCITY / leg.after.velocity
    assert released.velocity[0] > 0
    assert abs(np.ravel(determinant - expected)[0]) < 1e-9 * (1 + abs(np.ravel(expected)[0]))


def test_one_harmonic_is_the_table_of_the_paper():
    phase = np.linspace(-2.0, 2.0, 7)
    for make, numbers in (
        (spring_damper, {"frequency_ratio": 8.0, "restitution": 0.7}),
        (lambda **more: contact_law("tsuji", **more), {"stiffness": 500.0, "damping": 0.3}),
    ):
        paper = make(**numbers).simulate(1.4, phase, -4.0, 6)
        other = make(**numbers, table=Waveform([1.0, 1e-300])).simulate(1.4, phase, -4.0, 6)
        # Six impacts multiply a rounding error by less than 10³.
        assert np.abs(paper.time - other.time).max() < 1e-11
        assert np.array_equal(paper.status, other.status)


def test_threshold_of_a_law_on_another_table():
    # As ϖ grows, the threshold tends to that of a rigid ball, whose table falls with g.
    table = Waveform(*TWO)
    ball = contact_law("hunt-crossley", stiffness=1e5, damping=0.1, table=table)
    limit = float(rigid(restitution=0.5, table=table).permanent_contact_threshold())
    assert abs(float(ball.permanent_contact_threshold()[()]) / limit - 1) < 1e-2


def test_refusals_are_one_line():
    table = Waveform(*TWO)
    ball = spring_damper(frequency_ratio=10.0, restitution=0.8, table=table)
    cases = {
        "period doublings of limits": lambda: bouncing_ball.limits(ball),
        "whole branches": lambda: bouncing_ball.branch(ball),
        "corrected restitution model": lambda: bouncing_ball.corrected(ball),
        "not for contact laws": lambda: contact_law(
            "tsuji", stiffness=10.0, damping=0.1, flight=Drag(0.1)
        ),
        "resonance": lambda: spring_damper(frequency_ratio=2.0, damping_ratio=0.0, table=table),
        "overdamped": lambda: spring_damper(
            frequency_ratio=2.0, damping_ratio=0.9, flight=Drag(1.0)
        ),
        "is not a Waveform": lambda: spring_damper(
            frequency_ratio=2.0, damping_ratio=0.1, table=[1.0]
        ),
        "speed at an orbit": lambda: bouncing_ball.orbit(
            contact_law("tsuji", restitution=0.8, duration=0.1, table=table), amplitude=1.0
        ),
    }
    for words, call in cases.items():
        with pytest.raises(ModelError, match=words) as caught:
            call()
        assert "\n" not in str(caught.value)
