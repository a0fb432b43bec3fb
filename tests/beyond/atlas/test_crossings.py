import numpy as np
import pytest

from bouncing_ball.accuracy.errors import OF_ORBITS
from bouncing_ball.accuracy.simple_models import orbit_errors, search
from bouncing_ball.accuracy.thresholds import ThresholdStatus
from bouncing_ball.beyond.atlas.answers import last_crossings
from bouncing_ball.beyond.atlas.walk import walk

RATIOS = np.geomspace(1.0, 1e3, 61)
STEP = RATIOS[1] / RATIOS[0]


def found(function, *tolerances, ratios=RATIOS):
    errors = np.array([[function(ratio)] for ratio in ratios[::-1]])
    return last_crossings(ratios[::-1], errors, np.array(tolerances))[:, 0]


def test_the_threshold_of_a_power_law_is_exact():
    assert found(lambda w: w**-2.0, 0.01, 0.0004) == pytest.approx([10.0, 50.0], rel=1e-12)


def test_the_last_crossing_counts_and_not_the_first():
    # Within 0.05 below ϖ = 20 and from 100 on, where the error has passed through zero.
    def error(w):
        return 0.1 if 20 < w < 50 else 0.01

    assert 50 / STEP < found(error, 0.05)[0] < 50 * STEP


def test_the_threshold_of_an_error_that_changes_its_sign_lies_between_the_ratios():
    # Straight along ln ϖ below 32: 0.05 at 30 e^(-0.1), between the ratios 10 and 31.6.
    def error(w):
        return 0.5 * np.log(30 / min(w, 32.0))

    threshold = found(error, 0.05, ratios=np.geomspace(1.0, 1e3, 7))[0]
    assert threshold == pytest.approx(30 * np.exp(-0.1), rel=1e-12)


def test_an_excursion_between_two_ratios_is_seen():
    # A bump whose top, 0.0101, is midway between two ratios of the grid.
    middle = np.sqrt(RATIOS[30] * RATIOS[31])

    def error(w):
        return max(0.0101 - 0.1 * np.log(w / middle) ** 2, 0.0)

    assert max(error(RATIOS[30]), error(RATIOS[31])) < 0.01
    threshold = found(error, 0.01)[0]
    exact = middle * np.exp(np.sqrt(0.0001 / 0.1))
    assert threshold == pytest.approx(exact, rel=1e-9)
    assert found(lambda w: -error(w), 0.01)[0] == pytest.approx(exact, rel=1e-9)


def test_where_a_model_has_no_orbit_the_error_is_not_tolerated():
    threshold = found(lambda w: np.nan if w < 10 else 1e-6, 0.01)[0]
    assert 10 / STEP <= threshold <= 10 * STEP
    assert found(lambda w: np.nan, 0.01)[0] == np.inf
    assert found(lambda w: 1e-6, 0.01)[0] == RATIOS[0]


def test_an_error_beyond_the_tolerance_at_the_largest_ratio_has_no_threshold():
    for error in (1.0, -1.0, 0.02):
        assert found(lambda w, error=error: error, 0.01)[0] == np.inf


def test_errors_side_by_side_have_the_thresholds_that_each_has_alone():
    # Errors that come and go, some of them with excursions, zeros and places without orbit.
    random = np.random.default_rng(6)
    waves = random.normal(size=(61, 200)).cumsum(axis=0) * random.uniform(0.001, 0.1, 200)
    errors = np.where(random.uniform(size=waves.shape) < 0.01, np.nan, waves)
    tolerances = np.array([0.3, 0.1, 0.01])
    together = last_crossings(RATIOS[::-1], errors, tolerances)
    alone = [last_crossings(RATIOS[::-1], errors[:, [k]], tolerances) for k in range(200)]
    assert np.array_equal(together, np.hstack(alone))
    assert len(np.unique(together)) > 300


@pytest.mark.slow
def test_thresholds_are_those_of_a_search(small):
    plan = small()
    random = np.random.default_rng(3)
    fine = np.geomspace(plan.ratios[0], plan.ratios[-1], 121)
    for _ in range(2):
        one = plan.nodes(random.choice(plan.rows), random.integers(plan.nodes_per_row, size=1))
        error = [np.moveaxis(orbit_errors(step.orbit), 2, 0) for step in walk(one, plan.ratios)]
        tolerances = np.array(plan.tolerances)
        thresholds = last_crossings(plan.ratios[::-1], np.concatenate(error), tolerances)
        arguments = one.damping_ratio, one.release, one.n, one.amplitude, fine
        for ours, tolerance in zip(thresholds, plan.tolerances, strict=True):
            found = search(*arguments, tolerance, OF_ORBITS)
            ends = {
                ThresholdStatus.ALWAYS_WITHIN: plan.ratios[0],
                ThresholdStatus.NEVER_WITHIN: np.inf,
            }
            for k, status in np.ndenumerate(found.status):
                assert ours[k] == pytest.approx(
                    ends.get(status, found.threshold[k]), rel=plan.resolution
                )
