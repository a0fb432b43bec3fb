"""No impact is missed: against half the tolerances, and against samples of each flight."""

import mpmath
import numpy as np
import pytest

from bouncing_ball_beyond.inherited.numerics import first_zero
from bouncing_ball_beyond.models.contact_model import ContactModel
from bouncing_ball_beyond.models.corrected.model import CorrectedModel
from bouncing_ball_beyond.models.rigid import RestitutionModel
from bouncing_ball_beyond.models.spring_damper import SpringDamper

MODELS = ("restitution", "spring-damper", "corrected")


def starts(balls, rng):
    """r, Λ, ϖ and states over several orders of magnitude."""
    lam = 10 ** rng.uniform(-1, 1, balls)
    ratio = 10 ** rng.uniform(1, 4, balls)
    phase = rng.uniform(-np.pi, np.pi, balls)
    velocity = -(10 ** rng.uniform(-4, 1.5, balls))
    return rng.uniform(0.05, 1, balls), lam, ratio, phase, velocity


def model_of(model, r, ratio):
    contact = SpringDamper.from_restitution(r, ratio)
    return {
        "restitution": RestitutionModel(r),
        "spring-damper": ContactModel(contact),
        "corrected": CorrectedModel.of_contact(contact),
    }[model]


def compare(model, balls, monkeypatch, rows=3):
    """Three impacts of each ball, each compared from the same state."""
    r, lam, ratio, phase, velocity = starts(balls, np.random.default_rng(11))
    law = model_of(model, r, ratio)
    for _ in range(rows):
        whole = law.cycle(lam, phase, velocity)
        with monkeypatch.context() as patch:
            for name in ("_SIMPLE", "_CLOSE", "_REACH"):
                patch.setattr(first_zero, name, getattr(first_zero, name) / 2)
            half = law.cycle(lam, phase, velocity)
        lands = np.isfinite(whole.time)
        np.testing.assert_array_equal(lands, np.isfinite(half.time))
        # Rounding of the state, grown at a grazing landing; a missed impact is far off.
        late = np.abs(whole.time[lands] - half.time[lands]) / (1 + whole.time[lands])
        assert late.max() < 1e-8
        phase = np.where(lands, whole.phase, phase)
        velocity = np.where(lands, np.minimum(whole.relative_velocity, -1e-12), velocity)


@pytest.mark.parametrize("model", MODELS)
def test_half_the_tolerances_find_the_same_impacts(model, monkeypatch):
    compare(model, 3000, monkeypatch)


@pytest.mark.long
@pytest.mark.parametrize("model", MODELS)
def test_a_million_balls_miss_no_impact(model, monkeypatch):
    compare(model, 1_000_000, monkeypatch, rows=1)


def test_the_first_landing_agrees_with_thirty_digits():
    """Of the restitution model, by subdivision with the bound on the curvature alone."""
    r, lam, _, phase, velocity = starts(40, np.random.default_rng(4))
    r = np.maximum(r, 0.5)
    found = RestitutionModel(r).cycle(lam, phase, velocity)
    checked = 0
    for k in np.flatnonzero(np.isfinite(found.time) & (velocity < -0.05)):
        with mpmath.workdps(30):
            values = (float(x[k]) for x in (lam, phase, velocity, r))
            table, start, speed, loss = (mpmath.mpf(x) for x in values)

            def gap(s, table=table, start=start, up=-loss * speed):
                level = table * (mpmath.sin(start + s) - mpmath.sin(start))
                rate = up + table * (mpmath.cos(start) - mpmath.cos(start + s)) - s
                return (up + table * mpmath.cos(start)) * s - s * s / 2 - level, rate

            # From a rising start no landing comes before 2v/(1 + Λ).
            time = 2 * -loss * speed / (1 + table)
            fall = 1 + table
            for _ in range(100_000):
                height, rate = gap(time)
                if height < mpmath.mpf(10) ** -20:
                    break
                time += (rate + mpmath.sqrt(rate * rate + 2 * fall * height)) / fall
            assert float(time) == pytest.approx(float(found.time[k]), abs=1e-9, rel=1e-12)
            checked += 1
    assert checked > 20
