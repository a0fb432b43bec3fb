"""n-T orbits of the corrected model against its map, and against the exact contact."""

import numpy as np
import pytest

from bouncing_ball.contacts.signature import LinearSignature
from bouncing_ball.contacts.spring_damper import Release, SpringDamper
from bouncing_ball.orbits import corrected_branch
from bouncing_ball.orbits import spring_damper_limits as limits
from bouncing_ball.orbits.spring_damper_branch import branch_point
from bouncing_ball.orbits.stability import Bifurcation

RELEASES = list(Release)


def sample(seed, size, release, ratios=(1.0, 3.0)):
    """Random (n, contact, Λ) within the stable range of the corrected model."""
    rng = np.random.default_rng(seed)
    n = rng.integers(1, 6, size)
    contact = SpringDamper(10 ** rng.uniform(*ratios, size), rng.uniform(0.01, 0.6, size), release)
    instant = LinearSignature(contact)()
    low = corrected_branch.saddle_node(n, instant)
    high, _ = corrected_branch.period_doubling(n, instant)
    return n, contact, instant, low + rng.uniform(0.05, 0.95, size) * (high - low)


def start_of_contact(n, instant, amplitude, stable_side=True):
    """φ and δ′ of the orbit."""
    phase = corrected_branch.instant_phase(n, instant, amplitude, stable_side) - instant.delay
    return phase, instant.delay - n * np.pi - amplitude * np.cos(phase)


@pytest.mark.parametrize("release", RELEASES)
def test_multipliers_at_the_bifurcations(release):
    n, _, instant, _ = sample(3, 200, release)
    fold = corrected_branch.saddle_node(n, instant)
    psi = corrected_branch.instant_phase(n, instant, fold * (1 + 1e-15))
    trace, det = corrected_branch.trace_and_determinant(n, instant, fold, psi)
    # The phase at the fold has half the digits, and so has the test function.
    assert np.all(np.abs(Bifurcation.SADDLE_NODE.test(trace, det)) < 1e-6)
    lam, psi = corrected_branch.period_doubling(n, instant)
    np.testing.assert_allclose(corrected_branch.instant_phase(n, instant, lam), psi, atol=1e-12)
    trace, det = corrected_branch.trace_and_determinant(n, instant, lam, psi)
    assert np.all(np.abs(Bifurcation.PERIOD_DOUBLING.test(trace, det)) < 1e-12)


@pytest.mark.parametrize("release", RELEASES)
def test_elastic_orbits_hit_at_the_top_of_the_table(release):
    """r = 1: time reversal puts the instant at ψ = π/2 in the exact model too."""
    contact = SpringDamper(np.array([3.0, 10.0, 100.0]), 0.0, release)
    instant = LinearSignature(contact)()
    psi = corrected_branch.instant_phase(1, instant, 0.8)
    np.testing.assert_allclose(psi, np.pi / 2, rtol=1e-15)
    np.testing.assert_array_equal(corrected_branch.saddle_node(1, instant), 0.0)
    exact = limits.orbit_at(contact, 1, 0.8)
    np.testing.assert_allclose(exact.phase + exact.contact_duration / 2, np.pi / 2, atol=1e-12)


@pytest.mark.parametrize("release", RELEASES)
def test_the_branch_of_the_exact_contact_is_met_to_second_order(release):
    n, contact, _, lam = sample(5, 60, release)
    errors = []
    for omega in (400.0, 800.0):
        stiff = SpringDamper(np.full(60, omega), contact.damping_ratio, release)
        instant = LinearSignature(stiff)()
        low = corrected_branch.saddle_node(n, instant)
        high, _ = corrected_branch.period_doubling(n, instant)
        # The same place of the stable range, away from the boundary layer.
        lam = low + np.linspace(0.2, 0.95, 60) * (high - low)
        phase, velocity = start_of_contact(n, instant, lam)
        exact = limits.orbit_at(stiff, n, lam)
        fold = branch_point(limits.saddle_node(stiff, n), stiff, n).amplitude
        flip = branch_point(limits.period_doubling(stiff, n), stiff, n).amplitude
        errors.append(
            [
                phase - exact.phase,
                velocity - exact.relative_impact_velocity,
                instant.duration - exact.contact_duration,
                low - fold,
                high - flip,
            ]
        )
    first, second = np.abs(np.array(errors))
    order = np.log2(first / second)
    assert np.all(np.abs(np.median(order, axis=1) - 2) < 0.02), np.median(order, axis=1)
