"""Shares, correlations and exponents against closed forms."""

import numpy as np
import pytest
from scipy.stats import norm

from bouncing_ball.beyond.exhibits.lives import transients
from bouncing_ball.beyond.exhibits.locked_orbits import correlation, locked_orbits
from bouncing_ball.beyond.exhibits.motion_samples import uncertainty_exponent
from bouncing_ball.long_run.destination import final_motions
from bouncing_ball.models.rigid import RestitutionModel
from bouncing_ball.pipeline.configuration import typed


def test_the_limits_of_estimates_contain_the_known_values():
    random = np.random.default_rng(3)
    one, other = random.normal(size=(2, 2000))
    _, low, high = correlation(one, other, 0.95)
    # Without a correlation its standard error is 1/√(n - 3).
    assert high - low == pytest.approx(2 * norm.ppf(0.975) / np.sqrt(1997), rel=0.01)
    assert low < 0 < high
    size = 10.0 ** -np.arange(1, 5)
    changes = random.uniform(size=(4000, 1)) < size**0.3
    slope, low, high = uncertainty_exponent(changes, size, 0.95)
    assert low < 0.3 < high and high - low < 0.05 and low < slope < high


def test_a_contact_agrees_from_the_needed_ratio_on():
    place = {"restitution": 0.5, "amplitude": 2.5}
    common = {"confidence": 0.95, "seed": 5}
    balls = {"cases": [place], "frequency_ratio": [1000.0], "balls": 20, "impacts": 250}
    balls |= {"impact_speeds": {"min": 1.0, "max": 9.0}}
    of_balls = typed(transients)(balls | common, "displacement")
    given = {
        "amplitude": {"min": 2.0, "max": 4.0, "samples": 2},
        "restitution": {"min": 0.2, "max": 0.5, "samples": 2},
        "frequency_ratio": [30.0, 1000.0],
        "impacts": 200,
        "nodes": 40,
        "shifts": [1e-2, 1e-4],
    }
    data = typed(locked_orbits)({"ext_lives": of_balls}, given | common, "displacement")
    right = data.needed_ratio <= 1000
    assert 0 < right.sum() < 40
    # A second code of the restitution model: a ball that lands, in place of one that lifts off.
    rigid = RestitutionModel(data.restitution.values)
    landed = final_motions(rigid, data.amplitude.values, 0.0, -1.5)
    known = (landed.kind == "locked") & (landed.periods > 0) & (data.periods.values > 0)
    assert known.mean() > 0.5
    assert np.mean(landed.periods[known] == data.periods.values[known]) > 0.9
    assert (
        data.same[1] == right[data.periods > 0].mean() and data.jump_share[0] >= data.jump_share[1]
    )
    # What is not known is not the same, and whatever is the same is known.
    assert np.all(data.same <= data.same_known) and 0 < data.same_known[1] < 1
    sticks = data.periods > 0
    assert data.same_known[1] == data.last_known[sticks].mean()
    assert data.last_known[right].all()
    asked = data.needed_ratio[data.periods > 0]
    assert data.inner_places == ((asked > 30) & np.isfinite(asked)).sum()
    # Longer periods need a larger ϖ.
    assert data.rank_correlation > 0.5
    assert np.all(data.mean_life_low < data.mean_life)


def test_the_limits_of_a_correlation_are_those_of_bonett_and_wright():
    """In arctanh ρ the standard error is √((1 + ρ²/2)/(n - 3)); 28 pairs with one inversion."""
    ranks = np.arange(28.0)
    other = ranks.copy()
    other[[0, 27]] = other[[27, 0]]
    rho, low, high = correlation(ranks, other, 0.9)
    # Spearman's 1 - 6 Σd²/(n(n² - 1)), with two differences of 27.
    assert rho == pytest.approx(1 - 6 * 2 * 27**2 / (28 * (28**2 - 1)), rel=1e-14)
    width = 1.6448536269514722 * ((1 + rho**2 / 2) / 25) ** 0.5
    assert np.arctanh(high) - np.arctanh(rho) == pytest.approx(width, rel=1e-12)
    assert np.arctanh(rho) - np.arctanh(low) == pytest.approx(width, rel=1e-12)


def test_tied_values_are_not_ranked():
    ranks = np.arange(6.0)
    assert np.isnan(correlation(ranks, np.full(6, 10.0), 0.95)).all()
    assert np.isnan(correlation(ranks, np.repeat([10.0, 18.0], 3), 0.95)).all()
