"""The first-order law of the restitution model's error."""

import numpy as np
import pytest

from bouncing_ball.accuracy.errors import Quantity
from bouncing_ball.errors import NoOrbitError
from bouncing_ball.periodic.explicit import restitution_period_doubling, restitution_saddle_node
from bouncing_ball_beyond.accuracy.error_law import (
    REMAINDER,
    coefficients,
    permanent_contact_coefficient,
    remainder,
    scale,
    small_parameter,
)
from bouncing_ball_beyond.accuracy.errors import OF_IMPACTS
from bouncing_ball_beyond.accuracy.simple_models import errors
from bouncing_ball_beyond.exhibits.random_orbits import random_orbits
from bouncing_ball_beyond.models.damping import (
    LINEAR,
    Release,
    damping_ratio,
    restitution_coefficient,
)
from bouncing_ball_beyond.models.instant import Instant
from bouncing_ball_beyond.models.laws.signature import Signature
from bouncing_ball_beyond.models.permanent_contact import permanent_contact_threshold
from bouncing_ball_beyond.models.spring_damper import SpringDamper

RELEASES = LINEAR


def array(law):
    return np.array([*law.values()])


def sample(seed, size, release, r, places=(0.0, 1.0)):
    rng = np.random.default_rng(seed)
    r = rng.uniform(*r, size)
    n = rng.integers(1, 6, size)
    low = restitution_saddle_node(n, r)
    high = restitution_period_doubling(n, r)
    return n, damping_ratio(r, release), low + rng.uniform(*places, size) * (high - low), rng


@pytest.mark.parametrize("release", RELEASES)
def test_the_coefficients_are_the_limits_of_the_exact_errors(release):
    """K is the limit of q = ϖ times the error; (8 q(4ϖ) - 6 q(2ϖ) + q(ϖ))/3 eliminates two
    orders.
    """
    n, zeta, lam, _ = sample(21, 200, release, (0.25, 0.97), (0.2, 1.0))
    base = 2000.0
    once, twice, four = (
        errors(SpringDamper(np.full(lam.shape, k * base), zeta, release), n, lam)[0] * k * base
        for k in (1, 2, 4)
    )
    limit = (8 * four - 6 * twice + once) / 3
    expected = array(coefficients(n, zeta, lam, release))
    error = np.abs(limit - expected) / np.maximum(np.abs(expected), 0.01)
    # The third order left is (1/ϖ)² of series whose ratio is 1/(r ϖ), or that of
    # the distance to the saddle-node; measured: all but the worst 2 % below 1e-5.
    assert np.all(np.quantile(error, 0.98, axis=1) < 1e-5), np.quantile(error, 0.98, axis=1)
    assert np.all(error < 2e-3), error.max(axis=1)


@pytest.mark.parametrize("release", RELEASES)
def test_the_errors_of_the_corrected_model_are_of_second_order(release):
    """Doubling ϖ halves the restitution model's error, and quarters the corrected model's."""
    n, zeta, lam, _ = sample(22, 200, release, (0.25, 0.97), (0.2, 0.95))
    once, twice = (
        np.abs(errors(SpringDamper(np.full(lam.shape, ratio), zeta, release), n, lam))
        for ratio in (1000.0, 2000.0)
    )
    middle = np.median(np.log2(once / twice), axis=-1)
    # The apparent restitution's first order is small next to its second.
    loose = np.array([q == Quantity.APPARENT_RESTITUTION for q in OF_IMPACTS])
    assert np.all(np.abs(middle - [[1], [2]]) < np.where(loose, 0.1, 0.01)), middle


def factors(seed, size, release):
    """|error - K|/(S δ) of random orbits with ϖ from 1 to 10⁴, and the arguments of the law."""
    n, zeta, lam, rng = random_orbits(size, seed, release)
    contact = SpringDamper(10 ** rng.uniform(0, 4, size), zeta, release)
    arguments = n, Signature(contact)(), lam
    return remainder(*arguments, errors(contact, n, lam)[0]), arguments


@pytest.mark.parametrize("size", [3000, pytest.param(20_000, marks=pytest.mark.long)])
def test_the_bound_of_the_remainder_is_the_next_power_of_two(size):
    """M is the next power of two above the largest factor, of the height and of the phase."""
    left, _ = factors(1, size, Release.DISPLACEMENT)
    largest = np.nanmax(left.factor, axis=1)
    bound = array(REMAINDER)
    assert bound.tolist() == [2, 2, 4, 2, 2, 2] and np.all(largest < bound)
    np.testing.assert_array_equal(2 ** np.ceil(np.log2(largest))[[0, 2]], bound[[0, 2]])


@pytest.mark.parametrize("release", RELEASES)
def test_the_bound_of_the_remainder_holds_on_other_samples(release):
    """|error - K| ≤ M S δ in the whole stable range, whatever δ is."""
    left, arguments = factors(31, 2000, release)
    known = np.isfinite(left.law)
    assert known.mean() > 0.9 and not np.any(left.exceeded)
    assert np.mean(left.small > 0.3) > 0.2
    np.testing.assert_array_equal(left.is_valid, np.isfinite(left.factor) & (left.small < 0.3))
    size = array(scale(*arguments)) * small_parameter(*arguments)
    # An error of twice the remainder is beyond it.
    far = left.law + 1.001 * array(REMAINDER)[:, np.newaxis] * size
    assert np.all(remainder(*arguments, far).exceeded[np.isfinite(size)])


def test_the_small_parameter_is_the_one_found_by_hand():
    """Λ sin ψ₀ = 0.4, so that a₀ = 0.6 and the load moves ψ by σ a₀/((1 + r) Λ sin ψ₀) = 0.1."""
    half = 2 * np.pi
    delay = 0.05
    r = 0.5
    load = 0.1
    duration = 0.1
    fold = half / 3
    speed = 2 * half / 1.5
    lift = 0.4
    instant = Instant(delay, r, load, duration)
    lam = np.hypot(fold, lift)
    node = load / (half * (1 - r))
    whole = duration * (1 + 0.6) / (r * speed)
    expected = [
        (fold * 0.1 + (half + fold) * delay) / (lift + half**2 / 2),
        (duration - delay) / half,
        (0.1 + delay) / np.arctan2(lift, fold),
        whole,
        node,
        node + delay / half,
    ]
    np.testing.assert_allclose(array(scale(2, instant, lam)), expected, rtol=1e-13)
    # δ_SN + δ_load + δ_period.
    small = 0.1 * lam / lift + whole + duration * lam
    assert small_parameter(2, instant, lam) == pytest.approx(small, rel=1e-13)


@pytest.mark.parametrize("release", RELEASES)
def test_the_height_error_of_nearly_elastic_orbits_has_its_limit(release):
    """K → -1/n over 1 + 2Λ sin φ/(nπ)² as r → 1."""
    n = np.array([1, 2, 5])
    lam = 0.9
    law = coefficients(n, 1e-9, lam, release)
    expected = -1 / (n * (1 + 2 * lam / (n * np.pi) ** 2))
    np.testing.assert_allclose(law[Quantity.MAX_HEIGHT], expected, rtol=1e-7)


@pytest.mark.parametrize("release", RELEASES)
def test_the_permanent_contact_is_right_to_second_order(release):
    zeta = np.array([0.0, 0.1359, 0.5, 0.9])
    found = 1e6 * (permanent_contact_threshold(1e3, zeta, release) - 1)
    expected = permanent_contact_coefficient(zeta, release)
    # The next order, 4ζ² or less, times 1/ϖ².
    np.testing.assert_allclose(found, expected, rtol=0, atol=4e-6)


def test_an_error_relative_to_zero_is_not_a_number():
    """Errors relative to 0: at r = 1 the saddle-node is at Λ = 0; at the saddle-node the phase is
    0.
    """
    assert not np.isfinite(coefficients(1, 0.0, 1.0)["saddle_node"])
    r = float(restitution_coefficient(0.1))
    assert not np.isfinite(coefficients(1, 0.1, float(restitution_saddle_node(1, r)))["phase"])


def test_below_the_saddle_node_the_error_law_is_refused(refusal):
    with refusal(NoOrbitError, "below the saddle-node"):
        coefficients(1, 0.2, 0.1)
