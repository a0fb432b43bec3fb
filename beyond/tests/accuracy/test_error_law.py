"""The law of the restitution model's error, from the saddle-node to the period doubling."""

import numpy as np
import pytest

from bouncing_ball_beyond.accuracy.error_law import (
    coefficients,
    law_errors,
    law_thresholds,
    permanent_contact_coefficient,
    remainder_scale,
    small_parameter,
)
from bouncing_ball_beyond.accuracy.errors import OF_IMPACTS
from bouncing_ball_beyond.accuracy.simple_models import errors
from bouncing_ball_beyond.exhibits.random_orbits import half_next_to_saddle_node, random_orbits
from bouncing_ball_beyond.inherited.accuracy.errors import Quantity
from bouncing_ball_beyond.inherited.errors import NoOrbitError
from bouncing_ball_beyond.inherited.periodic.restitution_branch import (
    restitution_period_doubling,
    restitution_saddle_node,
)
from bouncing_ball_beyond.models.contact_model import ContactModel
from bouncing_ball_beyond.models.corrected.model import CorrectedModel
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
from bouncing_ball_beyond.periodic.one_impact import n_t

RELEASES = LINEAR
every_release = pytest.mark.parametrize("release", RELEASES)
OF_ORBITS = [Quantity.MAX_HEIGHT, Quantity.PHASE, Quantity.APPARENT_RESTITUTION]


def array(law):
    return np.array([*law.values()])


def sample(seed, size, release, r, places=(0.0, 1.0)):
    rng = np.random.default_rng(seed)
    r = rng.uniform(*r, size)
    n = rng.integers(1, 6, size)
    low = restitution_saddle_node(n, r)
    high = restitution_period_doubling(n, r)
    return n, damping_ratio(r, release), low + rng.uniform(*places, size) * (high - low), rng


@every_release
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


@every_release
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


def remainders(n, zeta, lam, omega, release):
    """|error - law| of contacts and the bound S η, shape (quantity, ...)."""
    contact = SpringDamper(omega, zeta, release)
    given = n, Signature(contact)(), lam
    left = np.abs(errors(contact, n, lam)[0] - array(law_errors(*given)))
    return left, array(remainder_scale(*given)) * small_parameter(*given)


def factors(seed, size, release):
    """|error - law|/(S η) of random orbits with ϖ from 1 to 10⁴."""
    n, zeta, lam, rng = random_orbits(size, seed, release)
    r = SpringDamper(1.0, zeta, release).restitution
    lam = half_next_to_saddle_node(n, r, lam, rng)
    left, bound = remainders(n, zeta, lam, 10 ** rng.uniform(0, 4, size), release)
    return left / bound


@every_release
@pytest.mark.parametrize("size", [1500, pytest.param(20_000, marks=pytest.mark.long)])
def test_the_remainder_is_within_its_bound_from_the_saddle_node_on(release, size):
    found = factors(31, size, release)
    known = np.isfinite(found)
    # Contacts of ϖ of order 1 have no orbit at some Λ.
    assert known.mean() > 0.9
    largest = np.max(found, where=known, initial=0, axis=1)
    assert np.all(largest < 1)
    # The bound is not more than an order of magnitude too large for any quantity but the velocity.
    assert np.all(largest[[0, 2, 3, 4, 5]] > 0.1)


# Twice the durations of contacts with these ϖ, at which rounding is far below the remainders.
RATIOS = np.array([4e3, 1.6e4])


def measured_orders(release, position):
    """The order in 1/ϖ of the largest remainder over r and n, and of the law itself."""
    r, n = np.meshgrid(np.linspace(0.2, 0.95, 16), [1, 2, 3])
    zeta = damping_ratio(r, release)
    low = restitution_saddle_node(n, r)
    lam = low + position * (restitution_period_doubling(n, r) - low)
    left, size = [], []
    for omega in RATIOS:
        contact = SpringDamper(np.full(r.shape, omega), zeta, release)
        law = law_errors(n, Signature(contact)(), lam)
        exact = errors(contact, n, lam, OF_ORBITS)[0]
        left.append([np.abs(exact[k] - law[q]).max() for k, q in enumerate(OF_ORBITS)])
        size.append([np.abs(law[q]).max() for q in OF_ORBITS])
    ratio = np.log(RATIOS[1] / RATIOS[0])
    return np.log(np.array(left[0]) / left[1]) / ratio, np.log(np.array(size[0]) / size[1]) / ratio


@every_release
def test_far_above_the_saddle_node_the_law_is_right_to_the_second_order(release):
    left, size = measured_orders(release, 0.5)
    # The next order is a share 1/ϖ of the last, times numbers below ten.
    np.testing.assert_allclose(left, 2, atol=0.01)
    np.testing.assert_allclose(size, 1, atol=0.01)


@every_release
def test_at_the_saddle_node_the_height_is_right_to_the_order_three_halves(release):
    # Not at 0, where rounding of r puts Λ below the saddle-node; 2Cs is above 10⁻⁵ here.
    left, size = measured_orders(release, 1e-12)
    # The next terms are a share √(1/ϖ) of the last, and the order tends to its limit with it.
    np.testing.assert_allclose(left[0], 1.5, atol=0.05)
    np.testing.assert_allclose(size[0], 0.5, atol=0.05)
    # The apparent restitution has no root in its error, and keeps the second order.
    np.testing.assert_allclose([left[2], size[2]], [2, 1], atol=0.05)


@every_release
def test_the_corrected_model_is_of_the_first_order_at_its_own_saddle_node(release):
    """Two saddle-nodes that differ by O(γ²) are roots that differ by O(γ) where one of them is; at
    that of the restitution model the height is right to the order 3/2 only.
    """
    n, r = (axis.ravel() for axis in np.meshgrid([1, 2, 3], np.linspace(0.2, 0.9, 8)))
    zeta = damping_ratio(r, release)
    left = []
    for ratio in RATIOS:
        contact = SpringDamper(np.full(r.shape, ratio), zeta, release)
        own = np.maximum(
            n_t.saddle_node(ContactModel(contact), n).amplitude,
            n_t.saddle_node(CorrectedModel(Signature(contact)), n).amplitude,
        )
        # Next to a fold the height changes with the root of the distance.
        places = (own * (1 + 1e-13), restitution_saddle_node(n, r) * (1 + 1e-12))
        left.append([np.abs(errors(contact, n, lam)[1][0]) for lam in places])
    at_own, at_other = np.log(np.divide(*left)) / np.log(RATIOS[1] / RATIOS[0])
    np.testing.assert_allclose(np.median(at_own), 1.0, atol=0.05)
    np.testing.assert_allclose(np.median(at_other), 1.5, atol=0.05)


@every_release
def test_between_the_orders_pass_from_three_halves_to_two(release):
    """The phase has the orders of the height where it is not relative to 0."""
    orders = np.array([measured_orders(release, p)[0][:2] for p in (1e-8, 1e-6, 1e-4, 1e-2, 0.3)])
    assert np.all(np.diff(orders, axis=0) > -0.01)
    assert np.all(orders[0] < 1.6) and np.all(orders[-1] > 1.95)


def test_at_the_saddle_node_the_height_needs_a_contact_that_is_stiffer_by_the_square():
    """ϖ = 2Cσ₁/((1 + r)(εH)²), of the order ε⁻², for small ε."""
    r = np.array([0.05, 0.3, 0.65])
    unit = Signature(SpringDamper(1.0, damping_ratio(r)))()
    fold = restitution_saddle_node(1, unit.restitution)
    for small in (1e-4, 1e-5):
        found = law_thresholds(1, unit, fold, (-small, small))
        rule = 2 * fold * unit.load / ((1 + r) * (small * np.pi**2 / 2) ** 2)
        # The next term is a share √u of the first: u k against √(2Cs₁u).
        share = 20 / np.sqrt(rule)
        assert np.all(np.abs(found[Quantity.MAX_HEIGHT] / rule - 1) < share)
        assert np.all(np.isinf(found[Quantity.PHASE]))


@every_release
@pytest.mark.parametrize("allowed", [(-0.01, 0.01), (-0.2, 0.3), (-1e-4, 2e-4)])
def test_from_the_threshold_on_the_errors_of_the_law_are_allowed(release, allowed):
    n, zeta, lam, rng = random_orbits(300, 5, release)
    r = SpringDamper(1.0, zeta, release).restitution
    low = restitution_saddle_node(n, r)
    lam = low + np.where(rng.random(300) < 0.5, 1, 1e-4) * (lam - low)
    unit = Signature(SpringDamper(1.0, zeta, release))()
    needed = law_thresholds(n, unit, lam, allowed)

    def at(share, name):
        omega = needed[name] / share
        return law_errors(n, Signature(SpringDamper(omega, zeta, release))(), lam)[name]

    height = at(1.0, Quantity.MAX_HEIGHT)
    off = np.minimum(np.abs(height - allowed[0]), np.abs(height - allowed[1]))
    # Where the orbits on the moved line end first, there is no such error.
    ends = np.isnan(height)
    assert np.all(ends | (off < 1e-9 * max(allowed))) and ends.mean() < 0.1
    for share in np.linspace(0.02, 0.98, 25):
        for name in (Quantity.MAX_HEIGHT, Quantity.BOUNCE_VELOCITY):
            error = at(share, name)
            assert np.all((error >= allowed[0]) & (error <= allowed[1]))


def test_the_phase_has_its_allowed_error_to_the_order_of_the_law():
    n, zeta, lam, _ = random_orbits(300, 6, Release.DISPLACEMENT, (0.05, 1.0))
    left = []
    for small in (1e-2, 1e-3):
        needed = law_thresholds(n, Signature(SpringDamper(1.0, zeta))(), lam, (-small, small))
        omega = needed[Quantity.PHASE]
        error = law_errors(n, Signature(SpringDamper(omega, zeta))(), lam)[Quantity.PHASE]
        left.append(np.abs(np.abs(error) / small - 1))
    # Of third order in 1/ϖ, and hence of second order relative to the error.
    assert np.all(np.median(left, axis=1) < [2e-4, 2e-6])


def test_a_contact_whose_saddle_node_is_higher_has_no_orbit_at_that_of_the_restitution_model():
    instant = Instant(0.01, 0.5, -0.01, 0.02)
    fold = float(restitution_saddle_node(1, 0.5))
    own = fold * (1 + float(law_errors(1, instant, fold)[Quantity.SADDLE_NODE]))
    assert own > fold
    below, above = (law_errors(1, instant, lam) for lam in (fold, own * (1 + 1e-9)))
    for name in OF_ORBITS:
        assert np.isnan(below[name]) and np.isfinite(above[name])


@every_release
def test_the_coefficients_are_the_limits_of_the_law(release):
    n, zeta, lam, _ = sample(23, 200, release, (0.25, 0.97), (0.2, 1.0))
    expected = array(coefficients(n, zeta, lam, release))
    found = [
        omega * array(law_errors(n, Signature(SpringDamper(omega, zeta, release))(), lam))
        for omega in (1e4, 2e4)
    ]
    # Without the next order, the third is (1/ϖ)² over the powers of the distance from the fold.
    np.testing.assert_allclose(2 * found[1] - found[0], expected, rtol=1e-4, atol=1e-6)


def test_the_bound_is_the_one_found_by_hand():
    """Λ sin ψ₀ = 0.4, so that 1 + |1 - Y₀| = 1.6; the line moves from 2π/3 by 0.1/1.5."""
    half = 2 * np.pi
    line = half / 3
    lam = np.hypot(line, 0.4)
    instant = Instant(delay=0.05, restitution=0.5, load=0.1, duration=0.1)
    shift = 0.1 / 1.5
    later = shift * 1.6 / np.sqrt(lam**2 - (line - shift) ** 2)
    speed = 2 * half / 1.5
    of_load = 0.1 * 1.6 / (0.5 * speed)
    expected = [
        (line * later + speed * 0.05) / (0.4 + half**2 / 2),
        0.05 / half,
        (later + 0.05) / np.arctan2(0.4, line),
        of_load,
        0.1 / (half * 0.5),
        0.1 / (half * 0.5) + 0.05 / half,
    ]
    np.testing.assert_allclose(array(remainder_scale(2, instant, lam)), expected, rtol=1e-13)
    assert small_parameter(2, instant, lam) == pytest.approx(of_load + 0.1 * lam, rel=1e-13)


@every_release
def test_the_height_error_of_nearly_elastic_orbits_has_its_limit(release):
    """K → -1/n over 1 + 2Λ sin φ/(nπ)² as r → 1."""
    n = np.array([1, 2, 5])
    lam = 0.9
    law = coefficients(n, 1e-9, lam, release)
    expected = -1 / (n * (1 + 2 * lam / (n * np.pi) ** 2))
    np.testing.assert_allclose(law[Quantity.MAX_HEIGHT], expected, rtol=1e-7)


@every_release
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
