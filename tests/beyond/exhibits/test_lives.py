"""Times until balls stick, against the contacts of a simulation, and means of known lives."""

import numpy as np
import pytest

from bouncing_ball.beyond.exhibits import lives
from bouncing_ball.beyond.exhibits.motion_samples import three_models
from bouncing_ball.long_run.motions import Kind
from bouncing_ball.models.damping import Release

PLACE = {"restitution": 0.6, "amplitude": 3.0}
BALLS = {"cases": [PLACE], "frequency_ratio": [100.0], "balls": 40, "impacts": 300}
BALLS |= {"impact_speeds": {"min": 1.0, "max": 9.0}}
ASKED = lives.Transients(**BALLS, confidence=0.95, seed=1)


@pytest.fixture(scope="module")
def found():
    return lives.lives(ASKED, Release.DISPLACEMENT)


def test_the_interval_of_a_mean_life_holds_for_lives_that_are_not_exponential():
    """Of 400 means of lives with a dead time, some 95 % of the intervals contain the true mean."""
    random = np.random.default_rng(3)
    hits = 0
    for _ in range(400):
        life = 20 + random.gamma(0.5, 10.0, 200)
        mean, low, high = lives.mean_with_limits(life, 0.95)
        assert low < mean < high
        hits += low < 25 < high
    # Four standard deviations of the binomial count.
    assert abs(hits - 380) < 4 * np.sqrt(400 * 0.95 * 0.05)
    assert np.isnan(lives.mean_with_limits(life[:0], 0.95)).all()
    assert np.isnan(lives.mean_with_limits(life[:1], 0.95)[1:]).all()


def test_the_interval_of_few_lives_is_that_of_students_distribution_in_closed_form():
    # With one degree of freedom it is Cauchy's, and with two its quantiles are algebraic.
    mean, low, high = lives.mean_with_limits(np.array([1.0, 3.0]), 0.95)
    width = np.tan(0.95 * np.pi / 2)
    assert (mean, low, high) == pytest.approx((2, 2 - width, 2 + width), rel=1e-12)
    mean, low, high = lives.mean_with_limits(np.array([1.0, 2.0, 3.0]), 0.9)
    width = 0.9 * np.sqrt(2 / (1 - 0.9**2)) / np.sqrt(3)
    assert (mean, low, high) == pytest.approx((2, 2 - width, 2 + width), rel=1e-12)


def test_a_life_ends_where_the_first_sticking_of_a_simulation_ends(found):
    """After an instant a ball that sticks has a contact of its own; on a contact of finite
    stiffness the contact lasts longer than one damped oscillation.
    """
    random = np.random.default_rng(ASKED.seed)
    phase = random.uniform(-np.pi, np.pi, ASKED.balls)
    speed = random.uniform(1, 9, ASKED.balls)
    r, lam = PLACE.values()
    models = three_models(r, 100.0, Release.DISPLACEMENT)
    zeta = -np.log(r) / np.hypot(np.pi, np.log(r))
    oscillation = 2 * np.pi / (100.0 * np.sqrt(1 - zeta**2))
    for place, (model, longest) in enumerate(
        ((models.contact, oscillation), (models.restitution, 0))
    ):
        way = model.simulate(lam, phase, lam * np.cos(phase) - speed, ASKED.impacts)
        sticks = (way.contact_duration > longest) & np.isfinite(way.contact_duration)
        first = sticks.argmax(axis=0)
        ball = np.arange(ASKED.balls)
        ends = (way.time + way.contact_duration)[first, ball] / (2 * np.pi)
        life = found["life"][0, place]
        known = np.isfinite(life)
        assert known.sum() > 20
        assert np.allclose(life[known], ends[known], rtol=1e-12)
        # A ball that is not found to stick has not stuck in the simulation either.
        assert not sticks[:, ~known].any()


def test_a_ball_that_has_not_stuck_is_censored_and_in_no_mean():
    """Of ten balls five stick, at 1 to 5 T, three are chaotic, and two end on an orbit."""
    life = np.array([1.0, 2, 3, 4, 5, *[np.nan] * 5]).reshape(1, 1, 10)
    kind = np.array([Kind.LOCKED] * 4 + [Kind.CHAOTIC] * 4 + [Kind.ORBIT] * 2).reshape(1, 1, 10)
    known = {"life": life, "life_followed": np.full((1, 1, 10), 2000.0), "life_kind": kind}
    asked = ASKED.model_copy(update={"frequency_ratio": []})
    data = lives.transients(asked, Release.DISPLACEMENT, known).isel(case=0, life_ratio=0)
    assert data.mean_life == 3
    assert (data.unstuck_share, data.lock_share) == (0.3, 0.4)
    # Eight balls may stick.
    at = data.survival.sel(life=[0.5, 2.5, 100], method="nearest")
    assert at.values.tolist() == [1, 6 / 8, 3 / 8]


def test_differences_are_of_balls_that_stick_in_both_models():
    """Two contacts and the restitution model; four intervals that hold together are wider."""
    life = np.array([[[3.0, 6, 8, np.nan], [5, 5, 5, 5], [1, 2, 6, 4]]] * 2)
    found, pairs = lives.paired_differences(life, 0.95)
    assert pairs.tolist() == [[3, 4, 0]] * 2
    assert found[0, :2, 0].tolist() == [np.mean([2, 4, 2]), np.mean([4, 3, -1, 1])]
    assert np.isnan(found[:, 2]).all()
    # Student's quantile with two degrees of freedom has a closed form.
    level = 1 - 0.05 / 4
    quantile = level * np.sqrt(2 / (1 - level**2))
    width = quantile * np.std([2, 4, 2], ddof=1) / np.sqrt(3)
    assert np.allclose(found[0, 0, 1:] - found[0, 0, 0], [-width, width])


def test_the_intervals_of_differences_hold_together():
    """In 300 samples all twelve intervals contain their means in some 95 % or more."""
    random = np.random.default_rng(4)
    hits = 0
    for _ in range(300):
        common = random.exponential(5.0, size=(3, 1, 60))
        life = common + random.exponential(3.0, size=(3, 5, 60))
        found, _ = lives.paired_differences(life, 0.95)
        low = found[:, :-1, 1]
        high = found[:, :-1, 2]
        hits += bool(np.all((low < 0) & (high > 0)))
    # Four standard deviations of the binomial count; Bonferroni may be wider than it has to.
    assert hits >= 285 - 4 * np.sqrt(300 * 0.95 * 0.05)
