"""n-T orbits of the corrected model against its map, and against the exact contact."""

import numpy as np
import pytest

from bouncing_ball.contacts.signature import Signature
from bouncing_ball.contacts.spring_damper import Release, SpringDamper
from bouncing_ball.orbits import corrected_branch
from bouncing_ball.orbits import spring_damper_limits as limits

RELEASES = list(Release)


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
