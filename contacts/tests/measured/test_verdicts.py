"""Verdicts on laws, from simulated experiments and from those of the package."""

from itertools import product

import numpy as np
import pytest
import scipy

from bouncing_ball_contacts.measured.curves import curve_named
from bouncing_ball_contacts.measured.experiment import experiment
from bouncing_ball_contacts.measured.fit import fit_contact
from bouncing_ball_contacts.measured.flights import by_height
from bouncing_ball_contacts.measured.law_fit import MeasuredPoints
from bouncing_ball_contacts.measured.verdicts import (
    REJECTED,
    Compatibility,
    error_size,
    extrapolation_errors,
    judge,
    left_out,
    noise,
    restitution_at_speed,
    scatter,
    smooth_interval,
    trend_of_scatter,
)

SPEEDS = np.geomspace(0.5, 6.0, 12)


def sample(law, noise, count, known):
    """Simulated experiments with a law."""
    generator = np.random.default_rng(5)
    curve = curve_named(law)
    exact = curve.restitution(curve.parameter(0.8), SPEEDS / np.exp(np.mean(np.log(SPEEDS))))
    spread = np.eye(SPEEDS.size) * noise**2 if known else None
    for _ in range(count):
        yield MeasuredPoints(SPEEDS, exact + noise * generator.standard_normal(SPEEDS.size), spread)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("law", "known"),
    [
        ("linear", True),
        ("linear", False),
        pytest.param("kuwabara-kono", True, marks=pytest.mark.long),
        pytest.param("kuwabara-kono", False, marks=pytest.mark.long),
    ],
)
def test_a_true_law_is_rarely_rejected(law, known):
    curve = curve_named(law)
    tests = [
        [
            test(curve, points).probability(*noise(points))
            for test in (left_out, extrapolation_errors)
        ]
        for points in sample(law, 0.003, 60, known)
    ]
    for p in np.transpose(tests):
        # A test with the level 0.05 rejects 3 of 60; more than 10 have a probability of 2e-4.
        # With the scatter about a smooth curve the probabilities may be too large, never too small.
        assert np.count_nonzero(p < 0.05) <= 10
        if known:
            # Fewer than 17 of 60 halves have one of 2e-4.
            assert np.count_nonzero(p < 0.5) >= 17


@pytest.mark.parametrize(
    ("law", "others"),
    [("linear", ("kuwabara-kono", "hunt-crossley")), ("kuwabara-kono", ("linear", "tsuji"))],
)
def test_a_false_law_is_incompatible_and_the_true_one_compatible(law, others):
    (points,) = sample(law, 0.001, 1, True)
    found = judge(fit_contact(points.speeds, points.restitutions, uncertainties=points.covariance))
    assert found[law].verdict is Compatibility.COMPATIBLE
    assert {found[other].verdict for other in others} == {Compatibility.INCOMPATIBLE}


def test_without_uncertainties_no_law_is_incompatible():
    """The scatter alone does not show a systematic error, so that a law can only deviate."""
    (points,) = sample("linear", 0.001, 1, False)
    found = judge(fit_contact(points.speeds, points.restitutions))
    assert found["linear"].verdict is Compatibility.COMPATIBLE
    assert found["kuwabara-kono"].verdict is Compatibility.DEVIATES


# Each experiment and each law, and all pairs weekly.
PAIRS = product(
    ("croquet", "bouncy_ball", "viscous_drop"), ("linear", "kuwabara-kono", "hunt-crossley")
)
OFTEN = [(0, 1), (1, 2), (2, 0), (2, 1)]


@pytest.mark.parametrize(
    ("name", "law"),
    [
        pytest.param(*pair, marks=() if divmod(k, 3) in OFTEN else pytest.mark.long)
        for k, pair in enumerate(PAIRS)
    ],
)
def test_with_the_errors_needed_a_law_is_just_not_rejected(name, law):
    points = experiment(name).fit((law,)).points
    needed = judge(experiment(name).fit((law,)))[law].needed
    # The same ratios of the errors, with this root mean square, as known uncertainties.
    size = points.deviations * needed / np.sqrt(np.mean(points.deviations**2))
    for factor, is_rejected in ((0.999, True), (1.001, False)):
        again = fit_contact(
            points.speeds, points.restitutions, uncertainties=factor * size, laws=(law,)
        )
        assert error_size(again.points) == pytest.approx(factor * needed)
        found = judge(again)[law]
        assert (min(found.left_out, found.extrapolated) < REJECTED / 2) is is_rejected


def test_an_experiment_that_rejects_no_law_confirms_none():
    fit = fit_contact([1.0, 1.1, 1.2, 1.3], [0.8, 0.78, 0.81, 0.79], uncertainties=0.05)
    assert {each.verdict for each in judge(fit).values()} == {Compatibility.UNDECIDED}


@pytest.mark.parametrize("count", [1, 2, 3, 4])
def test_few_points_without_uncertainties_decide_nothing(count):
    fit = fit_contact(SPEEDS[:count], np.linspace(0.9, 0.5, count))
    found = judge(fit)
    assert {each.verdict for each in found.values()} == {Compatibility.UNDECIDED}
    assert np.isnan(noise(fit.points)[0])


def test_equal_speeds_decide_nothing():
    fit = fit_contact([2.0] * 8, np.linspace(0.7, 0.9, 8))
    assert {each.verdict for each in judge(fit).values()} == {Compatibility.UNDECIDED}


def test_the_scatter_about_a_smooth_curve_is_the_variance():
    generator = np.random.default_rng(2)
    speeds = np.geomspace(0.5, 5.0, 400)
    points = MeasuredPoints(
        speeds, 0.8 - 0.03 * np.log(speeds) + 0.01 * generator.standard_normal(400)
    )
    variance, freedom = noise(points)
    # The relative error of a variance with f degrees of freedom is √(2/f).
    assert freedom == 397 and variance == pytest.approx(1e-4, rel=4 * np.sqrt(2 / 397))


def test_the_extrapolation_is_that_of_a_fit_to_the_slower_half():
    croquet = experiment("croquet")
    points = MeasuredPoints(croquet.speeds, croquet.restitutions)
    size = extrapolation_errors(curve_named("linear"), points).size
    order = np.argsort(croquet.speeds)
    slow = croquet.restitutions[order[:5]]
    fast = croquet.restitutions[order[5:]]
    assert size == pytest.approx(np.sqrt(np.mean((fast - slow.mean()) ** 2)), rel=1e-9)


def test_the_scatter_of_points_of_unequal_errors_is_that_of_their_ratios():
    generator = np.random.default_rng(3)
    speeds = np.geomspace(0.5, 5.0, 400)
    ratios = speeds**-2.0
    points = fit_contact(
        speeds,
        0.8 - 0.03 * np.log(speeds) + 0.01 * ratios * generator.standard_normal(400),
        uncertainties=ratios,
        absolute_uncertainties=False,
    ).points
    variance, freedom = scatter(points)
    assert freedom == 397 and variance == pytest.approx(1e-4, rel=4 * np.sqrt(2 / 397))


def test_a_trend_of_the_scatter_is_found_as_often_as_its_level_says():
    generator = np.random.default_rng(4)
    speeds = np.geomspace(0.5, 5.0, 50)
    found = [
        trend_of_scatter(MeasuredPoints(speeds, 0.8 + 0.01 * generator.standard_normal(50)))
        for _ in range(400)
    ]
    # 5 % of 400 are 20; more than 35 or fewer than 7 have probabilities of 1e-3.
    assert 7 <= np.count_nonzero(np.array(found) < 0.05) <= 35


def test_the_errors_of_heights_explain_the_unequal_scatter_of_the_bouncy_ball():
    """At 1.4 m/s e was 0.707, 0.775 and 0.707, by heights that were read to 1 cm."""
    ball = experiment("bouncy_ball")
    equal = MeasuredPoints(ball.speeds, ball.restitutions)
    by_height = ball.fit(("linear",)).points
    assert trend_of_scatter(equal) < 1e-20 and trend_of_scatter(by_height) > 0.05
    # Half a unit of the last digit.
    height = np.sqrt(scatter(by_height)[0])
    assert 0.01 / np.sqrt(12) < height < 0.01
    bars = height * by_height.deviations
    apart = np.ptp(ball.restitutions[ball.speeds < 1.5])
    assert apart < 2.5 * bars.max() and bars.max() > 15 * bars.min()
    golf = experiment("golf_ball")
    assert trend_of_scatter(MeasuredPoints(golf.speeds, golf.restitutions)) < 1e-3
    assert trend_of_scatter(golf.fit(("linear",)).points) > 0.05


def test_hunt_and_crossleys_law_deviates_from_most_experiments():
    verdicts = {
        name: judge(experiment(name).fit()) for name in ("croquet", "bouncy_ball", "plastic_ball")
    }
    for found in verdicts.values():
        assert found["hunt-crossley"].verdict is Compatibility.DEVIATES
    assert verdicts["croquet"]["restitution"].verdict is Compatibility.DEVIATES
    assert verdicts["bouncy_ball"]["restitution"].verdict is Compatibility.COMPATIBLE


def test_the_interval_of_a_rejected_law_is_widened_by_the_scatter():
    """The numbers of the interval by hand: Student's, of a single impact about a constant."""
    speeds = np.geomspace(0.5, 6.0, 12)
    e = 0.9 - 0.06 * np.log(speeds)
    away = scipy.stats.t.ppf(0.975, 11) * e.std(ddof=1)
    for errors, verdict in ((1e-3, Compatibility.INCOMPATIBLE), (None, Compatibility.DEVIATES)):
        fit = fit_contact(speeds, e, uncertainties=errors)
        judged = judge(fit)["tsuji"]
        assert judged.verdict is verdict and judged.is_rejected
        assert judged.interval == pytest.approx((e.mean() - away, e.mean() + away), rel=1e-9)
        # More points narrow the interval of the law only.
        assert np.ptp(fit.law("tsuji").interval) < 0.3 * np.ptp(judged.interval)
    # A law that is not rejected keeps the interval of the given uncertainties.
    same = np.full(12, 0.8) + 1e-3 * np.resize([1, -1], 12)
    kept = fit_contact(speeds, same, uncertainties=1e-3)
    assert judge(kept)["tsuji"].interval == kept.law("tsuji").interval


def falling(noise, count=3):
    """Drops whose e falls linearly with v, as no law does, and the errors of heights."""
    generator = np.random.default_rng(7)
    v = np.repeat(np.sqrt(2 * 9.80665 * np.array([0.05, 0.1, 0.2, 0.4, 0.8, 1.2, 1.6, 2.0])), count)
    errors = by_height(v, 0.9 - 0.0314 * v)
    e = 0.9 - 0.0314 * v + noise * errors * generator.standard_normal(v.size)
    return v, e, errors


@pytest.mark.parametrize("is_known", [True, False])
def test_where_no_law_fits_r_is_that_of_a_smooth_curve(is_known):
    v, e, errors = falling(2e-3)
    fit = fit_contact(v, e, uncertainties=2e-3 * errors, absolute_uncertainties=is_known)
    judged = judge(fit)
    assert all(each.is_rejected for each in judged.values())
    for speed in (2.0, 3.24, 5.0):
        true = 0.9 - 0.0314 * speed
        found = restitution_at_speed(fit, judged, speed)
        assert found.law is None and not found.is_of_a_law_that_fits
        assert found.interval[0] < true < found.interval[1]
        # The error of one impact is 2 mm of height: some standard errors to each side.
        size = 2e-3 * float(by_height(speed, true))
        assert 2 * size < np.ptp(found.interval) < 10 * size
    at = {each.law: float(each.restitution_at(3.24)) for each in fit.laws}
    # The best law alone would be wrong by much more than its interval says.
    low, high = fit.best.band(3.24)
    assert not low < 0.9 - 0.0314 * 3.24 < high
    assert abs(at[fit.best.law] - 0.9 + 0.0314 * 3.24) > 0.01


def test_beyond_the_points_r_is_that_of_the_law_with_the_smallest_rms():
    v, e, _ = falling(1e-4)
    fit = fit_contact(v, e, uncertainties=1e-4)
    judged = judge(fit)
    for speed in (0.5 * v.min(), 1.5 * v.max()):
        found = restitution_at_speed(fit, judged, speed)
        least = min(fit.laws, key=lambda each: each.rms)
        assert found.law == least.law and not found.is_of_a_law_that_fits
        assert found.restitution == float(least.restitution_at(speed))
        spread = scipy.stats.t.ppf(0.975, v.size - 1) * least.rms * np.sqrt(v.size / (v.size - 1))
        low, high = found.interval
        assert found.restitution - low == pytest.approx(spread, rel=1e-9)
        assert high == pytest.approx(min(found.restitution + spread, 1.0), rel=1e-9)
    # Four points have no smooth curve.
    few = fit_contact([1.0, 2.0, 3.0, 4.0], [0.9, 0.8, 0.65, 0.4], uncertainties=1e-3)
    found = restitution_at_speed(few, judge(few), 2.0)
    assert found.law is not None and not found.is_of_a_law_that_fits


def test_a_law_that_fits_gives_r_and_its_band():
    (points,) = sample("kuwabara-kono", 0.001, 1, True)
    fit = fit_contact(points.speeds, points.restitutions, uncertainties=points.covariance)
    found = restitution_at_speed(fit, judge(fit), 3.0)
    assert found.law == fit.best.law and found.is_of_a_law_that_fits
    assert found.restitution == float(fit.best.restitution_at(3.0))
    assert found.interval == tuple(map(float, fit.best.band(3.0)))


def test_the_interval_of_the_smooth_curve_has_its_probability():
    """Of a new impact at a speed between the points."""
    generator = np.random.default_rng(8)
    v = np.geomspace(0.5, 5.0, 12)
    hits = 0
    for _ in range(400):
        points = MeasuredPoints(v, 0.8 - 0.03 * np.log(v) + 0.01 * generator.standard_normal(12))
        low, high = smooth_interval(points, 3.0)
        hits += low < 0.8 - 0.03 * np.log(3.0) + 0.01 * generator.standard_normal() < high
    # 380 of 400 expected; fewer than 366 or more than 393 have probabilities of about 1e-3.
    assert 366 <= hits <= 393


@pytest.mark.parametrize(("share", "is_rejected"), [(0.6, False), (0.4, True)])
def test_a_law_is_rejected_below_half_of_the_level(share, is_rejected):
    """Bonferroni: errors at 0.6 and 0.4 of the level 0.01, of which one test alone rejects both."""
    speeds = np.array([1.0, 2.0, 3.0])
    pattern = np.array([1.0, -2.0, 1.0])
    curve = curve_named("tsuji")

    def least(size):
        points = MeasuredPoints(speeds, 0.8 + size * pattern, 1e-6 * np.eye(3))
        return left_out(curve, points).probability(*noise(points))

    size = scipy.optimize.brentq(lambda x: least(x) - share * 0.01, 1e-5, 1e-2, xtol=1e-12)
    fit = fit_contact(speeds, 0.8 + size * pattern, uncertainties=1e-3, laws=["tsuji"])
    judged = judge(fit)["tsuji"]
    assert judged.left_out == pytest.approx(share * 0.01, rel=1e-6)
    # The other test does not decide.
    assert not judged.extrapolated < 0.01
    assert (judged.verdict is Compatibility.INCOMPATIBLE) is is_rejected


@pytest.mark.parametrize(("count", "known"), [(5, True), (5, False), (9, True), (9, False)])
def test_the_criterion_is_akaikes_with_the_correction_for_few_points(count, known):
    """2K - 2 ln L + 2K(K + 1)/(n - K - 1) (Hurvich and Tsai), up to constants of the points."""
    speeds = np.geomspace(1.0, 4.0, count)
    e = 0.8 + 0.01 * np.resize([1, -1, 2], count)
    fit = fit_contact(speeds, e, uncertainties=0.01 if known else None, laws=["tsuji"]).laws[0]
    square = ((e - e.mean()) ** 2).sum()
    parameters = 1 if known else 2
    deviance = square / 1e-4 if known else count * np.log(square / count)
    correction = 2 * parameters * (parameters + 1) / (count - parameters - 1)
    assert fit.criterion == pytest.approx(deviance + 2 * parameters + correction, rel=1e-12)
