"""Shares, correlations and exponents against closed forms."""

from itertools import combinations

import numpy as np
import pytest
import scipy

from bouncing_ball.beyond.exhibits.lives import transients
from bouncing_ball.beyond.exhibits.locked_orbits import (
    concordance,
    concordance_with_limits,
    locked_orbits,
)
from bouncing_ball.beyond.exhibits.locking import laps_by_many_digits
from bouncing_ball.beyond.exhibits.motion_samples import uncertainty_exponent
from bouncing_ball.beyond.motions.lift_off import laps
from bouncing_ball.long_run.destination import final_motions
from bouncing_ball.models.rigid import RestitutionModel
from bouncing_ball.pipeline.configuration import typed


def test_the_limits_of_an_exponent_contain_the_known_one():
    random = np.random.default_rng(1)
    size = 10.0 ** -np.arange(1, 5)
    changes = random.uniform(size=(4000, 1)) < size**0.3
    slope, low, high = uncertainty_exponent(changes, size, 0.95)
    assert low < 0.3 < high and high - low < 0.05 and low < slope < high


def test_a_contact_agrees_from_the_needed_ratio_on():
    place = {"restitution": 0.5, "amplitude": 2.5}
    common = {"confidence": 0.95, "seed": 5}
    balls = {"cases": [place], "frequency_ratio": [1000.0], "balls": 20, "impacts": 100}
    balls |= {"impact_speeds": {"min": 1.0, "max": 9.0}}
    of_balls = typed(transients)(balls | common, "displacement")
    given = {
        "amplitude": {"min": 2.0, "max": 4.0, "samples": 2},
        "restitution": {"min": 0.2, "max": 0.5, "samples": 2},
        "frequency_ratio": [30.0, 1000.0],
        "impacts": 200,
        "nodes": 24,
        "shifts": [1e-2, 1e-4],
    }
    data = typed(locked_orbits)({"ext_lives": of_balls}, given | common, "displacement")
    right = data.needed_ratio <= 1000
    assert 0 < right.sum() < 24
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
    # What is known lies in order, and longer periods need a larger ϖ.
    assert np.all(data.refuted_ratio[sticks] < data.needed_ratio[sticks])
    assert 0.5 < data.concordance_low[0] <= data.concordance[0] <= data.concordance_high[0]
    assert 0 < data.ordered_pairs[1] < data.ordered_pairs[0]
    assert np.all(data.mean_life_low < data.mean_life)


def pairs_one_by_one(period, low, high):
    """Concordant and discordant pairs whose order is known, counted in two loops."""
    counts = [0, 0]
    for i, j in combinations(range(len(period)), 2):
        if period[i] == period[j]:
            continue
        shorter, longer = (i, j) if period[i] < period[j] else (j, i)
        if high[shorter] <= low[longer]:
            counts[0] += 1
        elif high[longer] <= low[shorter]:
            counts[1] += 1
    return counts


def test_without_censoring_the_share_of_pairs_is_that_of_kendall():
    """If every ϖ is known between neighbours, all pairs are ordered: (1 + τ)/2."""
    random = np.random.default_rng(5)
    period = random.permutation(60)
    needed = np.argsort(np.argsort(period + 20 * random.normal(size=60))) + 1.0
    pairs, found = concordance(period, needed - 1, needed)
    assert pairs == 60 * 59 / 2
    assert found == pytest.approx((1 + scipy.stats.kendalltau(period, needed).statistic) / 2)


def test_pairs_whose_order_is_not_known_are_left_out():
    random = np.random.default_rng(6)
    period = random.integers(1, 12, 80)
    low = random.choice([0.0, 10.0, 30.0, 100.0], 80)
    high = np.where(random.random(80) < 0.3, np.inf, low * random.choice([3, 10], 80) + 10)
    agree, differ = pairs_one_by_one(period, low, high)
    pairs, found = concordance(period, low, high)
    assert (pairs, found) == (agree + differ, agree / (agree + differ))
    assert 0 < differ < agree + differ < 80 * 79 / 2
    # All are one tie.
    assert concordance(period, np.zeros(80), np.full(80, np.inf))[0] == 0
    assert np.isnan(concordance_with_limits(period, np.zeros(80), high, 0.95)[1]).all()


def test_the_interval_of_the_concordance_contains_the_true_share():
    """x and x + noise: of two independent pairs arcsin(ρ)/π + 1/2 agree (W. F. Sheppard, 1899)."""
    random = np.random.default_rng(7)
    truth = 0.5 + np.arcsin(np.sqrt(0.5)) / np.pi
    hits = 0
    for _ in range(60):
        one, noise = random.normal(size=(2, 80))
        needed = one + noise
        _, (_, low, high) = concordance_with_limits(one, needed - 1e-12, needed, 0.95)
        hits += low < truth < high
    # Four standard deviations of the binomial count below 57.
    assert hits >= 57 - 4 * np.sqrt(60 * 0.95 * 0.05)


def test_many_digits_find_the_laps_that_doubles_know():
    """Up to 15 impacts a double keeps digits; longer laps are in tests/long_run."""
    random = np.random.default_rng(8)
    r = random.uniform(0.1, 0.6, 40)
    lam = random.uniform(1.2, 5.0, 40)
    by_doubles = laps(r, lam, 15)
    short = np.flatnonzero(by_doubles.periods)[:10]
    assert short.size == 10
    periods, impacts = laps_by_many_digits(r[short], lam[short], 15)
    assert periods.tolist() == by_doubles.periods[short].tolist()
    assert impacts.tolist() == by_doubles.impacts[short].tolist()
