"""The corrected restitution model from any state, against the exact contact."""

from dataclasses import dataclass

import numpy as np
import pytest

from bouncing_ball.contacts.corrected_map import impact, instant_jacobian, meeting, start_jacobian
from bouncing_ball.contacts.signature import Instant, LinearSignature, Signature
from bouncing_ball.contacts.spring_damper import Release, SpringDamper
from bouncing_ball.errors import ModelError
from bouncing_ball.motion import contact as contacts
from bouncing_ball.motion import restitution
from bouncing_ball.motion.corrected import corrected_cycle, simulate
from bouncing_ball.motion.sequence import Status

RELEASES = list(Release)
BALLS = 400


@dataclass(frozen=True, repr=False)
class Changed(Signature):
    """A signature with numbers multiplied, which tests must tell from the right one."""

    law: LinearSignature
    delay: float = 1.0
    load: float = 1.0
    duration: float = 1.0

    is_constant = True

    def __call__(self, speed):
        instant = self.law(speed)
        names = ("delay", "load", "duration")
        return instant._replace(**{k: getattr(self, k) * getattr(instant, k) for k in names})


@dataclass(frozen=True, repr=False)
class Viscoelastic(Signature):
    """A made-up law whose three numbers depend on the impact speed."""

    size: float = 1.0

    def __call__(self, speed):
        slow = np.asarray(speed) ** -0.2
        return Instant(
            0.03 * slow, 0.9 - 0.1 / slow, 0.02 * slow, 0.06 * slow,
            -0.2 * 0.03 * slow / speed, -0.2 * 0.1 / slow / speed, -0.2 * 0.02 * slow / speed,
        )  # fmt: skip


def cycle_jacobian(law, lam, phase, velocity):
    """Of the map from start to start of contact, through the instants."""
    cycle = corrected_cycle(law, lam, phase, velocity)
    later, faster = phase + cycle.time, cycle.relative_velocity
    first, second = (
        impact(law, lam, *meeting(law, lam, at, relative + lam * np.cos(at)))
        for at, relative in ((phase, velocity), (later, faster))
    )
    flight = second.phase - first.phase
    between = instant_jacobian(lam, first, flight, second)
    return start_jacobian(lam, second) @ between @ np.linalg.inv(start_jacobian(lam, first))


def states(seed):
    """Random amplitudes, starts of contact, damping ratios."""
    rng = np.random.default_rng(seed)
    lam, zeta = rng.uniform(0.1, 3, BALLS), rng.uniform(0, 0.6, BALLS)
    return lam, rng.uniform(-np.pi, np.pi, BALLS), -rng.uniform(1, 10, BALLS), zeta


def errors(release, omega, change=lambda law: law):
    """Of the next impact's time and velocity, one of each ball."""
    lam, phase, velocity, zeta = states(5)
    contact = SpringDamper(np.full(BALLS, omega), zeta, release)
    exact = contacts.contact_cycle(contact, lam, phase, velocity)
    got = corrected_cycle(change(LinearSignature(contact)), lam, phase, velocity)
    return np.hypot(got.time - exact.time, got.relative_velocity - exact.relative_velocity)


def orders(release, change=lambda law: law):
    return np.log2(errors(release, 400.0, change) / errors(release, 800.0, change))


@pytest.mark.parametrize("release", RELEASES)
def test_one_impact_is_of_second_order_from_any_state(release):
    found = orders(release)
    # Of 400 balls some land grazing, or have an error that passes through zero.
    assert np.all(np.isfinite(found))
    assert abs(np.median(found) - 2) < 0.01
    assert np.quantile(found, 0.05) > 1.9


@pytest.mark.parametrize("release", RELEASES)
@pytest.mark.parametrize(
    "change",
    [
        lambda law: Changed(law, load=-1.0),
        lambda law: Changed(law, load=0.0),
        lambda law: Changed(law, delay=0.0),
        lambda law: Changed(law, delay=1.01),
    ],
    ids=["sign of the load", "no load", "no delay", "delay off by 1 %"],
)
def test_the_order_is_lost_with_any_of_the_numbers(release, change):
    found = orders(release, change)
    # An elastic ball, ζ → 0, does not notice the load.
    assert np.median(found) < 1.9


@pytest.mark.parametrize("release", RELEASES)
def test_every_observable_of_an_impact_is_of_second_order(release):
    rng = np.random.default_rng(8)
    lam, phase = rng.uniform(0.1, 2, BALLS), rng.uniform(-np.pi, np.pi, BALLS)
    velocity = lam * np.cos(phase) - rng.uniform(2, 8, BALLS)
    found = []
    for omega in (500.0, 1000.0):
        contact = SpringDamper(omega, 0.2, release)
        exact = contacts.simulate(contact, lam, phase, velocity, 1)
        got = simulate(LinearSignature(contact), lam, phase, velocity, 1)
        names = ("contact_duration", "relative_release_velocity", "release_displacement")
        found.append([np.abs(getattr(got, k)[0] - getattr(exact, k)[0]) for k in names])
    first, second = np.array(found)
    assert np.all(np.abs(np.median(np.log2(first / second), axis=1) - 2) < 0.02)


@pytest.mark.parametrize("release", RELEASES)
def test_jacobian_against_differences(release):
    lam, phase, velocity, zeta = states(6)
    laws = LinearSignature(SpringDamper(np.full(BALLS, 20.0), zeta, release)), Viscoelastic()
    for law in laws:
        exact = cycle_jacobian(law, lam, phase, velocity)

        def next_impact(phase, velocity, law=law):
            after = corrected_cycle(law, lam, phase, velocity)
            return np.stack([phase + after.time, after.relative_velocity], axis=-1)

        h = 1e-6
        differences = np.stack(
            [
                (next_impact(phase + h, velocity) - next_impact(phase - h, velocity)) / (2 * h),
                (next_impact(phase, velocity + h) - next_impact(phase, velocity - h)) / (2 * h),
            ],
            axis=-1,
        )
        error = np.abs(exact - differences).max((1, 2)) / np.abs(exact).max((1, 2))
        # Rounding 1e-15/h, and h² times a third derivative that grazing makes large.
        assert np.quantile(error, 0.98) < 1e-8


def test_without_delay_and_load_it_is_the_restitution_model():
    lam, phase, velocity, _ = states(7)
    law = Changed(LinearSignature(SpringDamper(5.0, 0.2)), delay=0.0, load=0.0, duration=0.0)
    r = float(law(1.0).restitution)
    got = corrected_cycle(law, lam, phase, velocity)
    thrown = lam * np.cos(phase) - r * velocity
    known = restitution.impact_cycle(r, lam, phase, thrown)
    bounced = lam * np.cos(got.phase) - r * got.relative_velocity
    np.testing.assert_allclose(got.time, known.time, atol=1e-12)
    np.testing.assert_allclose(bounced, known.velocity, atol=1e-12)


def test_one_ball_alone_and_among_others_is_the_same():
    rng = np.random.default_rng(9)
    lam, phase = rng.uniform(0.3, 4, 50), rng.uniform(-3, 3, 50)
    velocity = lam * np.cos(phase) - rng.uniform(0.1, 6, 50)
    contact = SpringDamper(np.linspace(5, 50, 50), 0.15)
    many = simulate(LinearSignature(contact), lam, phase, velocity, 200)
    for k in (0, 17, 49):
        one = SpringDamper(float(contact.frequency_ratio[k]), 0.15)
        alone = simulate(LinearSignature(one), lam[k], phase[k], velocity[k], 200)
        np.testing.assert_array_equal(alone.time, many.time[:, k])
        np.testing.assert_array_equal(alone.relative_velocity, many.relative_velocity[:, k])


def test_a_ball_above_the_table_at_every_landing():
    rng = np.random.default_rng(10)
    lam, phase = rng.uniform(0.3, 4, 300), rng.uniform(-3, 3, 300)
    velocity = lam * np.cos(phase) - rng.uniform(0.1, 6, 300)
    run = simulate(LinearSignature(SpringDamper(20.0, 0.1)), lam, phase, velocity, 300)
    there = np.isfinite(run.time)
    assert np.all(run.relative_velocity[there] <= 0)
    assert np.all(np.diff(run.time, axis=0)[there[1:]] > 0)
    ends = run.status == Status.PERMANENT_CONTACT
    assert np.any(ends) and np.all((lam <= 1)[ends])
    assert np.all(run.impacts[~ends] == 300)


def test_a_weak_impact_stays_and_lifts_off():
    """A ball set down gently stays until the table recedes with more than gravity."""
    law = LinearSignature(SpringDamper(20.0, 0.3))
    resting = simulate(law, 0.9, 0.0, 0.9 - 1e-3, 5)
    assert resting.status == Status.PERMANENT_CONTACT and resting.impacts == 1
    lifted = simulate(law, 1.5, 0.0, 1.5 - 1e-3, 2)
    phase = float(lifted.release_phase[0])
    assert phase == pytest.approx(np.arcsin(1 / 1.5), abs=1e-14)
    assert lifted.relative_release_velocity[0] == 0
    # In the exact contact the same ball leaves at the same moment, but for the
    # spring, which lets go where its force has gone: a delay of order 1/ϖ.
    exact = contacts.simulate(SpringDamper(20.0, 0.3), 1.5, 0.0, 1.5 - 1e-3, 1)
    assert float(exact.contact_duration[0]) == pytest.approx(phase, abs=4 / 20)


def test_bad_states_are_refused(one_line):
    law = LinearSignature(SpringDamper(20.0, 0.1))
    for arguments, part in (
        ((1.0, 0.0, 2.0), "rises from the table"),
        ((-1.0, 0.0, -2.0), "amplitude"),
        ((1.0, np.nan, -2.0), "finite"),
    ):
        with pytest.raises(ModelError) as error:
            simulate(law, *arguments, 3)
        one_line(error, part)
