"""The first-order law of the restitution model's error."""

import numpy as np
import pytest

from bouncing_ball.contacts.damping import damping_ratio, restitution_coefficient
from bouncing_ball.contacts.permanent_contact import permanent_contact_threshold
from bouncing_ball.contacts.signature import LinearSignature
from bouncing_ball.contacts.spring_damper import Release, SpringDamper
from bouncing_ball.errors import NoOrbitError
from bouncing_ball.orbits import restitution_orbit
from bouncing_ball.orbits import spring_damper_limits as limits
from bouncing_ball.orbits.error_law import (
    STATED,
    FirstOrder,
    coefficients,
    first_order,
    permanent_contact_coefficient,
    scale,
    small_parameter,
)
from bouncing_ball.orbits.spring_damper_branch import branch_point

RELEASES = list(Release)
OF_ORBITS = ("max_height", "bounce_velocity", "phase", "apparent_restitution")


def sample(seed, size, release):
    rng = np.random.default_rng(seed)
    zeta, n = rng.uniform(0.01, 0.6, size), rng.integers(1, 6, size)
    r = restitution_coefficient(zeta, release)
    low, high = restitution_orbit.saddle_node(n, r), restitution_orbit.period_doubling(n, r)
    return n, zeta, r, low + rng.uniform(0.2, 1.0, size) * (high - low)


def relative_errors(n, contact, r, lam):
    """Exact over restitution model, minus one, as a :class:`FirstOrder`."""
    orbit = limits.orbit_at(contact, n, lam)
    phase = restitution_orbit.phase(n, r, lam)
    fold = branch_point(limits.saddle_node(contact, n), contact, n).amplitude
    flip = branch_point(limits.period_doubling(contact, n), contact, n).amplitude
    return FirstOrder(
        max_height=orbit.max_height / restitution_orbit.max_height(n, lam, phase) - 1,
        bounce_velocity=orbit.bounce_velocity / (n * np.pi) - 1,
        phase=orbit.phase / phase - 1,
        apparent_restitution=orbit.apparent_restitution / r - 1,
        saddle_node=fold / restitution_orbit.saddle_node(n, r) - 1,
        period_doubling=flip / restitution_orbit.period_doubling(n, r) - 1,
    )


@pytest.mark.parametrize("release", RELEASES)
def test_the_coefficients_are_the_limits_of_the_exact_errors(release):
    """ϖ times the error, extrapolated: 4q(4ϖ) - ... removes the next two orders."""
    size = 200
    n, zeta, r, lam = sample(21, size, release)
    base = 2000.0
    parts = [
        np.array(relative_errors(n, SpringDamper(np.full(size, k * base), zeta, release), r, lam))
        * (k * base)
        for k in (1, 2, 4)
    ]
    limit = (8 * parts[2] - 6 * parts[1] + parts[0]) / 3
    expected = np.array(coefficients(n, zeta, lam, release))
    scale = np.maximum(np.abs(expected), 0.01)
    error = np.abs(limit - expected) / scale
    # The third order left is (1/ϖ)² of series whose ratio is 1/(r ϖ), or that of
    # the distance to the saddle-node; measured: all but the worst 2 % below 1e-5.
    assert np.all(np.quantile(error, 0.98, axis=1) < 1e-5), np.quantile(error, 0.98, axis=1)
    assert np.all(error < 2e-3), error.max(axis=1)


def test_the_papers_orbit():
    """ϖ_1% ≈ 100 K of Figs. 12-14, next to the exact thresholds (82.18, 61.22, ...)."""
    law = coefficients(1, damping_ratio(0.65), 1.0)
    found = {name: round(-100 * float(k), 1) for name, k in law._asdict().items()}
    assert found == {
        "max_height": 82.1,
        "bounce_velocity": 61.2,
        "phase": 132.2,
        "apparent_restitution": 4.6,
        "saddle_node": 60.2,
        "period_doubling": 15.8,
    }


@pytest.mark.parametrize("release", RELEASES)
def test_the_remainder_where_the_law_is_stated_to_hold(release):
    """|error - K| ≤ M S δ for δ < 0.3, in the whole stable range, ϖ from 1 to 10⁴."""
    rng = np.random.default_rng(31)
    size = 2000
    r = rng.uniform(0.05 if release is Release.DISPLACEMENT else 0.14, 0.98, size)
    n, zeta = rng.integers(1, 6, size), damping_ratio(r, release)
    low, high = restitution_orbit.saddle_node(n, r), restitution_orbit.period_doubling(n, r)
    lam = low + rng.uniform(0, 1, size) * (high - low)
    contact = SpringDamper(10 ** rng.uniform(0, 4, size), zeta, release)
    instant = LinearSignature(contact)()
    small = small_parameter(n, instant, lam)
    stated = small < STATED
    assert stated.mean() > 0.5
    errors = np.array(relative_errors(n, contact, r, lam))
    off = np.abs(errors - np.array(first_order(n, instant, lam)))
    factor = off / (np.array(scale(n, instant, lam)) * small)
    bound = {name: 4.0 if name == "phase" else 2.0 for name in FirstOrder._fields}
    for name, values in zip(FirstOrder._fields, factor, strict=True):
        assert np.all(values[stated] < bound[name]), (name, values[stated].max())


@pytest.mark.parametrize("release", RELEASES)
def test_the_height_of_nearly_elastic_orbits(release):
    """K → -1/n over 1 + 2Λ sin φ/(nπ)² as r → 1."""
    n, lam = np.array([1, 2, 5]), 0.9
    law = coefficients(n, 1e-9, lam, release)
    expected = -1 / (n * (1 + 2 * lam / (n * np.pi) ** 2))
    np.testing.assert_allclose(law.max_height, expected, rtol=1e-7)


@pytest.mark.parametrize("release", RELEASES)
def test_the_law_takes_any_signature(release):
    """At ϖ the first-order errors are K/ϖ."""
    instant = LinearSignature(SpringDamper(50.0, 0.2, release))()
    law, k = first_order(2, instant, 2.0), coefficients(2, 0.2, 2.0, release)
    np.testing.assert_allclose(np.array(law), np.array(k) / 50, rtol=1e-13)


@pytest.mark.parametrize("release", RELEASES)
def test_the_permanent_contact_is_right_to_second_order(release):
    zeta = np.array([0.0, 0.1359, 0.5, 0.9])
    found = 1e6 * (permanent_contact_threshold(1e3, zeta, release) - 1)
    expected = permanent_contact_coefficient(zeta, release)
    # The next order, 4ζ² or less, times 1/ϖ².
    np.testing.assert_allclose(found, expected, rtol=0, atol=4e-6)


def test_nothing_to_be_relative_to():
    """At r = 1 the saddle-node is at Λ = 0; at the saddle-node the phase is 0."""
    assert not np.isfinite(coefficients(1, 0.0, 1.0).saddle_node)
    r = float(restitution_coefficient(0.1))
    assert not np.isfinite(coefficients(1, 0.1, float(restitution_orbit.saddle_node(1, r))).phase)


def test_no_law_below_the_saddle_node(one_line):
    with pytest.raises(NoOrbitError) as error:
        coefficients(1, 0.2, 0.1)
    one_line(error, "below the saddle-node")


def test_names_are_those_of_the_orbits():
    orbit = limits.orbit_at(SpringDamper(10.0, 0.1), 1, 1.0)
    assert all(hasattr(orbit, name) for name in OF_ORBITS)
    assert set(OF_ORBITS) < set(FirstOrder._fields)
