"""Means over time from samples of balls, against long runs and against the scatter of samples."""

import numpy as np
import pytest

from bouncing_ball.long_run.destination import final_motions
from bouncing_ball.long_run.sampled_means import (
    Estimate,
    Starts,
    advance,
    quantile,
    sample_sizes,
    sections,
    start,
    sums_at,
)
from bouncing_ball.models.contact_model import ContactModel
from bouncing_ball.models.rigid import RestitutionModel
from bouncing_ball.models.spring_damper import SpringDamper

LAMBDA = 4.0
MODELS = [
    RestitutionModel(0.85),
    ContactModel(SpringDamper.from_restitution(0.85, 70.0)),
]


def impacts_of(model):
    """Impacts of a chaotic ball."""
    path = np.empty((3, 600))
    found = final_motions(model, LAMBDA, 1.0, -8.0, impacts=600, path=path)
    assert found.kind == "chaotic"
    return Starts.of_path(path[1:, 300:], LAMBDA)


def impacts_of_locked(model):
    """Impacts of a ball that sticks again and again."""
    path = np.empty((3, 600))
    found = final_motions(model, LAMBDA, 1.0, -8.0, impacts=600, path=path)
    assert found.is_unresolved()
    return Starts.of_path(path[1:, : int(found.followed)], LAMBDA)


# The samples are those of one loop for all models; weekly on a contact, too.
@pytest.mark.parametrize("model", [MODELS[0], pytest.param(MODELS[1], marks=pytest.mark.long)])
def test_the_error_of_a_mean_is_the_scatter_of_means_about_that_of_a_long_run(model):
    """Thirty-two samples of 128 balls each, with 25 impacts: short, so that a mean of ratios would
    be off by several errors.
    """
    starts = impacts_of(model).beside(4096, LAMBDA, 1e-3)
    (sums,) = sums_at(sample_sizes(4096, 4096, (25,)), starts, model, LAMBDA, 50)
    samples = [Estimate.of(each) for each in np.split(sums, 32, axis=1)]
    means = np.array([each.mean for each in samples])
    errors = np.array([each.error for each in samples])
    # The standard deviation of 32 numbers has a relative error of 1/8.
    ratio = means.std(axis=0, ddof=1) / np.sqrt(np.mean(errors**2, axis=0))
    assert np.all(np.abs(ratio - 1) < 4 / 8)
    whole = Estimate.of(sums)
    dynamics, impact = start(model, LAMBDA, starts)
    impact, _ = advance(dynamics, impact, 50)
    long = Estimate.of(advance(dynamics, impact, 150)[1])
    assert np.all(np.abs(whole.mean - long.mean) < 4 * np.hypot(whole.error, long.error))
    # The mean of the ratios of the heights is off.
    time, height, _ = sums
    assert abs(np.mean(height / time) - long.mean[0]) > 4 * np.hypot(whole.error, long.error)[0]


def test_a_sample_that_grows_is_the_sample_of_its_last_look():
    model = MODELS[0]
    starts = impacts_of(model).beside(60, LAMBDA, 1e-3)
    *_, grown = sums_at(sample_sizes(60, 20, (5, 10)), starts, model, LAMBDA, 3)
    (at_once,) = sums_at(sample_sizes(60, 60, (10,)), starts, model, LAMBDA, 3)
    assert grown == pytest.approx(at_once, rel=1e-9)


def test_the_means_are_examined_with_less_and_less_care():
    found = sample_sizes(30_000, 1000, (50, 100))
    assert [each.balls for each in found[:5]] == [1000, 1000, 2000, 4000, 8000]
    # At most 8192 balls are added at once.
    assert [each.balls for each in found[5:]] == [16_000, 24_192, 30_000]
    levels = [each.level for each in found]
    assert sum(levels) == pytest.approx(0.05) and levels[0] < 1e-4
    # Boole: a look whose share of the sample is x brings the sum of the levels to 0.05 x².
    assert sum(levels[:3]) == pytest.approx(0.05 * (2 / 30) ** 2)
    widths = [quantile(each.level, each.balls - 1) for each in found]
    assert widths == sorted(widths, reverse=True) or widths[-1] > 2


def test_balls_that_stick_do_not_follow_one_another():
    """All of them have stuck after a hundred impacts, and then have left in one state."""
    model = RestitutionModel(0.5)
    dynamics, impact = start(model, LAMBDA, impacts_of_locked(model).beside(50, LAMBDA, 1e-3))
    together, _ = advance(dynamics, impact, 300)
    alone, _ = advance(dynamics, impact, 300, 1e-9 * np.arange(50) / 50)
    assert np.unique(together.velocity).size < 50
    assert np.unique(alone.velocity).size == 50


def test_sections_cover_all_impacts_of_a_ball():
    model = MODELS[0]
    once = impacts_of(model).first()
    _, whole = advance(*start(model, LAMBDA, once), 90)
    parts = sections(*start(model, LAMBDA, once), 90)
    assert parts.shape == (3, 10)
    assert parts.sum(axis=1) == pytest.approx(whole[:, 0], rel=1e-12)


def test_balls_that_come_to_rest_have_no_means():
    model = RestitutionModel(0.3)
    starts = Starts(np.zeros(2), np.array([-0.5, -1.0]))
    (sums,) = sums_at(sample_sizes(2, 2, (50,)), starts, model, 0.8, 5)
    assert np.all(np.isnan(sums))


def test_a_contact_that_resumes_is_no_start():
    """There the ball rises relative to the table."""
    path = np.array([[0.0, 0.0], [-1.0, 3.0]])
    assert Starts.of_path(path, 2.0).velocity.tolist() == [-1.0]
