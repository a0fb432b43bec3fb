"""A damper that acts on approach only: against an integration that knows none of the formulas."""

from time import process_time

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from bouncing_ball_beyond import contact_law, corrected, orbit, rigid, spring_damper
from bouncing_ball_beyond.inherited.errors import ModelError
from bouncing_ball_beyond.models.damping import (
    LINEAR,
    Release,
    damping_ratio,
    restitution_coefficient,
)
from bouncing_ball_beyond.models.laws.signature import computed
from bouncing_ball_beyond.models.laws.steady_contact import permanent_contact
from bouncing_ball_beyond.models.spring_damper import SpringDamper

APPROACH = Release.APPROACH


def integrated(omega, zeta, speed, amplitude=0.0, phase=0.0, gravity=1.0):
    """Duration of a contact and the relative speed at its end, from turn to turn of the ball."""

    def motion(t, state, damped):
        p, rate = state
        load = gravity - amplitude * np.sin(t + phase)
        return [rate, load - omega**2 * p - (2 * zeta * omega * rate if damped else 0.0)]

    time = 0.0
    state = [0.0, speed]
    damped = True
    for _ in range(50):

        def turn(_, state):
            return state[1]

        def end(t, state, begin=time):
            # The start of the contact is none of its ends.
            return state[0] if t > begin else 1.0

        turn.terminal = end.terminal = True
        end.direction = -1
        turn.direction = -1 if damped else 1
        run = solve_ivp(
            lambda t, y, damped=damped: motion(t, y, damped), (time, time + 20), state,
            method="DOP853", events=(turn, end), rtol=1e-12, atol=1e-14, max_step=0.1 / omega,
        )  # fmt: skip
        time = run.t[-1]
        state = run.y[:, -1]
        if run.t_events[1].size:
            return time, -state[1]
        damped = not damped
    raise AssertionError("no end")


@pytest.mark.parametrize("zeta", [0.0, 0.1, 0.2, 0.3, 0.7, 0.95])
def test_the_free_impact_is_that_of_an_integration(zeta):
    duration, speed = integrated(3.0, zeta, 1.0, gravity=0.0)
    contact = SpringDamper(3.0, zeta, "approach")
    assert float(contact.restitution) == pytest.approx(speed, rel=1e-10)
    assert float(contact.free_duration) == pytest.approx(duration, rel=1e-9)
    assert float(contact.restitution) ** 2 == pytest.approx(
        float(restitution_coefficient(zeta, "force")), rel=1e-13
    )


@pytest.mark.parametrize("r", [1.0, 0.99999, 0.9, 0.5, 0.37])
def test_the_damping_ratio_has_the_restitution(r):
    zeta = damping_ratio(r, "approach")
    assert float(restitution_coefficient(zeta, "approach")) == pytest.approx(r, rel=1e-14)


def test_a_loss_that_no_underdamped_approach_has_is_refused(refusal):
    with refusal(ModelError, "0.36 is not in (e⁻¹, 1]"):
        damping_ratio(0.36, "approach")


@pytest.mark.parametrize("zeta", [0.0, 0.1, 0.5, 0.9])
def test_the_signature_in_closed_form_is_the_computed_one(zeta):
    contact = SpringDamper(3.0, zeta, "approach")
    known = contact.constant_signature
    found = computed(contact, np.array(1.7))
    for one, other in zip(known[:4], found[:4], strict=True):
        assert float(one) == pytest.approx(float(other), abs=1e-12)


@pytest.mark.parametrize("phase", [0.3, 1.2, 2.5, 4.0])
def test_a_contact_on_a_vibrating_table_is_that_of_an_integration(phase):
    contact = SpringDamper(4.0, 0.2, "approach")
    dynamics = contact.dynamics(np.array([0.8]))
    impact = dynamics.start(np.array([phase]), np.array([-2.0]))
    found = dynamics.depart(impact)
    duration, speed = integrated(4.0, 0.2, 2.0, 0.8, phase)
    assert float(found.duration[0]) == pytest.approx(duration, rel=1e-8)
    assert float(found.flight.velocity[0]) == pytest.approx(speed, rel=1e-8)


def test_orbits_are_those_of_the_corrected_model_to_second_order():
    errors = []
    for ratio in (10.0, 20.0):
        ball = contact_law("linear", frequency_ratio=ratio, damping_ratio=0.1, release="approach")
        exact = orbit(ball, n=1, amplitude=0.8)
        assert exact.is_stable()
        r = float(restitution_coefficient(0.1, "approach"))
        simple = orbit(rigid(restitution=r), n=1, amplitude=0.8)
        better = orbit(corrected(ball), n=1, amplitude=0.8)
        errors.append([abs(float(x.max_height / exact.max_height) - 1) for x in (simple, better)])
    (coarse, fine), (coarse_stiff, fine_stiff) = errors
    assert fine < coarse / 100 and 1.5 < coarse / coarse_stiff < 3
    assert fine / fine_stiff > 3


def test_a_ball_stays_on_its_orbit():
    ball = contact_law("linear", frequency_ratio=10.0, damping_ratio=0.1, release="approach")
    found = orbit(ball, n=1, amplitude=0.8)
    run = ball.simulate(
        0.8, phase=float(found.phase) + 0.02, velocity=float(found.impact_velocity), impacts=60
    )
    turned = np.mod(run.phase[-1] - float(found.phase) + np.pi, 2 * np.pi) - np.pi
    assert abs(float(turned)) < 1e-3


def test_the_linear_model_refuses_it_in_one_line(refusal):
    assert APPROACH not in LINEAR
    with refusal(ModelError, "release"):
        spring_damper(frequency_ratio=10.0, restitution=0.9, release="approach")


@pytest.mark.parametrize(("omega", "zeta"), [
    (0.6, 0.3), (3.3, 0.1), (7.0, 0.9), pytest.param(20.0, 0.1, marks=pytest.mark.long),
])  # fmt: skip
def test_the_threshold_of_permanent_contact_is_that_of_an_integration(omega, zeta):
    def motion(time, state):
        y, rate = state
        return [rate, np.sin(time) - omega**2 * y - 2 * zeta * omega * min(rate, 0.0)]

    # The steady motion at Λ = 1, less its depth at rest: a transient falls by exp(-2πζϖ/2) or so.
    periods = int(np.ceil(30 / (np.pi * zeta * omega))) + 2
    last = 2 * np.pi * np.array([periods - 1, periods])
    run = solve_ivp(motion, (0.0, last[1]), [0.0, 0.0], method="LSODA", rtol=1e-11, atol=1e-15,
                    dense_output=True)  # fmt: skip
    top = run.sol(np.linspace(*last, 50_001))[0].max()
    contact = SpringDamper(omega, zeta, "approach")
    assert permanent_contact(contact) == pytest.approx(1 / (omega**2 * top), rel=1e-7)


def test_the_threshold_of_a_stiff_contact_is_found_at_once():
    start = process_time()
    # A slow table: δ = -(1 - Λ sin t)/ϖ² up to the next order, and 1 - Λ is of the order ϖ⁻².
    for omega in (200.0, 1000.0):
        found = permanent_contact(SpringDamper(omega, 0.1, "approach"))
        assert 0 < (1 - found) * omega**2 < 2
    # Hundredths of a second here; a search by collocation took 28 s.
    assert process_time() - start < 5
