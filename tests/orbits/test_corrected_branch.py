"""n-T orbits of the corrected model against its map, and against the exact contact."""

import numpy as np
import pytest

from bouncing_ball.contacts.signature import Signature
from bouncing_ball.contacts.spring_damper import Release, SpringDamper
from bouncing_ball.orbits import corrected_branch
from bouncing_ball.orbits import spring_damper_limits as limits
from bouncing_ball.orbits.stability import Bifurcation

RELEASES = list(Release)


@pytest.mark.parametrize("release", RELEASES)
def test_multipliers_at_the_bifurcations(release):
    rng = np.random.default_rng(3)
    n, omega, zeta = (
        rng.integers(1, 6, 200),
        10 ** rng.uniform(1, 3, 200),
        rng.uniform(0.01, 0.6, 200),
    )
    instant = Signature(SpringDamper(omega, zeta, release))()
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
    instant = Signature(contact)()
    psi = corrected_branch.instant_phase(1, instant, 0.8)
    np.testing.assert_allclose(psi, np.pi / 2, rtol=1e-15)
    np.testing.assert_array_equal(corrected_branch.saddle_node(1, instant), 0.0)
    exact = limits.orbit_at(contact, 1, 0.8)
    np.testing.assert_allclose(exact.phase + exact.contact_duration / 2, np.pi / 2, atol=1e-12)
