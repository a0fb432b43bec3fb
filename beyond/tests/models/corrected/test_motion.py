"""The corrected restitution model from any state, against the exact contact."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
import pytest

from bouncing_ball_beyond.inherited.models.model import Status
from bouncing_ball_beyond.models.corrected.model import CorrectedModel
from bouncing_ball_beyond.models.damping import LINEAR
from bouncing_ball_beyond.models.laws.hertzian import HuntCrossley
from bouncing_ball_beyond.models.laws.signature import Signature
from bouncing_ball_beyond.models.rigid import RestitutionModel
from bouncing_ball_beyond.models.spring_damper import SpringDamper

RELEASES = LINEAR
BALLS = 400


@dataclass(frozen=True, repr=False)
class Changed(Signature):
    """A signature with numbers multiplied, which tests must tell from the right one."""

    law: Signature
    delay: float = 1.0
    load: float = 1.0
    duration: float = 1.0

    is_constant = True

    def __call__(self, speed):
        instant = self.law(speed)
        names = ("delay", "load", "duration")
        return instant._replace(**{k: getattr(self, k) * getattr(instant, k) for k in names})


def states(seed):
    """Random amplitudes, starts of contact, damping ratios."""
    rng = np.random.default_rng(seed)
    lam = rng.uniform(0.1, 3, BALLS)
    zeta = rng.uniform(0, 0.6, BALLS)
    return lam, rng.uniform(-np.pi, np.pi, BALLS), -rng.uniform(1, 10, BALLS), zeta


def errors(release, omega, change=lambda law: law):
    """Of the next impact's time and velocity, one of each ball."""
    lam, phase, velocity, zeta = states(5)
    contact = SpringDamper(np.full(BALLS, omega), zeta, release)
    exact = contact.dynamics(lam).next_impact(phase, velocity)
    got = CorrectedModel(change(Signature(contact))).cycle(lam, phase, velocity)
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
def test_without_any_one_of_its_numbers_the_model_is_not_of_second_order(release, change):
    found = orders(release, change)
    # An elastic ball, ζ → 0, does not notice the load.
    assert np.median(found) < 1.9


def test_without_delay_and_load_the_corrected_model_is_the_restitution_model():
    lam, phase, velocity, _ = states(7)
    law = Changed(Signature(SpringDamper(5.0, 0.2)), delay=0.0, load=0.0, duration=0.0)
    r = float(law(1.0).restitution)
    got = CorrectedModel(law).cycle(lam, phase, velocity)
    known = RestitutionModel(r).cycle(lam, phase, velocity)
    np.testing.assert_allclose(got.time, known.time, atol=1e-12)
    np.testing.assert_allclose(got.relative_velocity, known.relative_velocity, atol=1e-12)


def test_at_every_impact_the_ball_falls_and_time_has_passed():
    rng = np.random.default_rng(10)
    lam = rng.uniform(0.3, 4, 300)
    phase = rng.uniform(-3, 3, 300)
    velocity = lam * np.cos(phase) - rng.uniform(0.1, 6, 300)
    run = CorrectedModel(Signature(SpringDamper(20.0, 0.1))).simulate(lam, phase, velocity, 300)
    there = np.isfinite(run.time)
    assert np.all(run.relative_velocity[there] <= 0)
    assert np.all(np.diff(run.time, axis=0)[there[1:]] > 0)
    ends = run.status == Status.PERMANENT_CONTACT
    assert np.any(ends) and np.all((lam <= 1)[ends])
    assert np.all(run.impacts[~ends] == 300)


def test_after_a_weak_impact_the_ball_stays_until_the_table_falls_away():
    """A ball set down gently stays until the table recedes with more than gravity."""
    model = CorrectedModel(Signature(SpringDamper(20.0, 0.3)))
    resting = model.simulate(0.9, 0.0, 0.9 - 1e-3, 5)
    assert resting.status == Status.PERMANENT_CONTACT and resting.impacts == 1
    lifted = model.simulate(1.5, 0.0, 1.5 - 1e-3, 2)
    phase = float(lifted.release_phase[0])
    assert phase == pytest.approx(np.arcsin(1 / 1.5), abs=1e-14)
    assert lifted.relative_bounce_velocity[0] == 0
    # In the exact contact the same ball leaves at the same moment, but for the
    # spring, which lets go where its force has gone: a delay of order 1/ϖ.
    exact = SpringDamper(20.0, 0.3).dynamics(1.5).simulate(0.0, 1.5 - 1e-3, 1)
    assert float(exact.contact_duration[0]) == pytest.approx(phase, abs=4 / 20)


class Falling(NamedTuple):
    """A ball that lands at a phase of the table with a speed, and its delay t_c(v)."""

    amplitude: float
    phase: float
    speed: float
    delay: Callable

    def missing(self, t):
        """δ + h(v) after a time t, and its rounding error."""
        lam = self.amplitude
        phase = self.phase
        speed = self.speed + t + lam * (np.cos(phase + t) - np.cos(phase))
        delay = self.delay(speed)
        falls = (lam * np.cos(phase) - self.speed) * t - t * t / 2
        moved = lam * (np.sin(phase + t) - np.sin(phase))
        rounding = 8 * np.finfo(float).eps * (1 + lam) * (1 + delay)
        return falls - moved + speed * delay, rounding


@pytest.mark.parametrize(
    ("contact", "count"),
    [
        (SpringDamper.from_restitution, 300),
        (lambda r, ratio: HuntCrossley(ratio**2.5, (1 - r) / 3), 25),
    ],
    ids=["linear", "Hunt-Crossley"],
)
def test_the_instant_after_a_slow_landing_is_the_first(contact, count):
    """At the instant δ + h is 0 up to rounding, and before it positive."""
    rng = np.random.default_rng(8)
    for _ in range(count):
        r = rng.uniform(0.05, 1.0)
        ratio = np.exp(rng.uniform(np.log(2.2), np.log(200.0)))
        model = CorrectedModel.of_contact(contact(r, ratio))
        lam = rng.uniform(0.0, 4.0)
        phase = rng.uniform(-np.pi, np.pi)
        delay = float(model.signature(1.0).delay)
        speed = delay * np.exp(rng.uniform(np.log(1e-3), np.log(4 * (1 + lam))))
        descent = model.dynamics(np.array([lam]))._descent
        found = float(descent(np.array([phase]), np.array([-speed]))[0])

        def at(v, model=model):
            return model.signature(np.maximum(v, 1e-30)).delay

        ball = Falling(lam, phase, speed, at)
        at_instant, rounding = ball.missing(found)
        assert abs(at_instant) <= rounding
        before, _ = ball.missing(np.linspace(0.0, found, 2001)[:-1])
        assert np.all(before > -rounding)
