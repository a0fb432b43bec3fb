"""Whether an algebraic orbit is one of the ball, against fine sampling."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from bouncing_ball.models.contact import Contact, Release, contact_flow, contact_force
from bouncing_ball.models.damping import damping_ratio
from bouncing_ball.orbits import restitution as restitution_orbits
from bouncing_ball.orbits.admissibility import is_admissible, restitution_is_admissible
from bouncing_ball.orbits.limits import Side, orbit_at


def reserves(orbit):
    """Smallest distances from a release in contact and a landing in flight.

    Both signals vanish at the ends; they are divided by the distance from
    there, so that a sign near the ends is seen as well.
    """
    share = np.linspace(0, 1, 4001)[1:-1]
    near = share * (1 - share)
    s = share * float(orbit.duration)
    omega, zeta = orbit.contact.frequency_ratio, orbit.contact.damping_ratio
    lam, phase = orbit.amplitude, orbit.phase
    u = orbit.relative_impact_velocity
    flow = contact_flow(s, 0.0, u, phase, lam, omega, zeta)
    if orbit.contact.release is Release.FORCE:
        touching = contact_force(flow.displacement, flow.velocity, omega, zeta)
        touching = touching / (1 - share)  # it starts at -2ζϖ u > 0
    else:
        touching = -flow.displacement / near
    t = orbit.duration + share * orbit.flight_time
    gap = orbit.flight_path(t)[0] - lam * np.sin(phase + t)
    return touching.min(), (gap / near).min(), gap.min()


@given(
    st.integers(1, 3),
    st.floats(0.1, 0.98),
    st.floats(np.log(1.2), np.log(1e3)),
    st.floats(0.05, 4.0),
    st.sampled_from(list(Side)),
)
def test_displacement_release_against_sampling(n, r, log_omega, excess, side):
    contact = Contact(float(np.exp(log_omega)), float(damping_ratio(r)))
    lam = float(restitution_orbits.saddle_node(n, r)) + excess
    orbit = orbit_at(contact, n, lam, side)
    if np.isnan(orbit.duration):
        assert not bool(is_admissible(orbit))
        return
    closing = float(orbit.relative_impact_velocity) < 0
    touching, clear, _ = reserves(orbit)
    # Grazing orbits themselves are not decided by samples.
    if min(abs(touching) * contact.frequency_ratio, abs(clear)) > 1e-3:
        assert bool(is_admissible(orbit)) == (closing and touching > 0 and clear > 0)


@pytest.mark.parametrize("release", list(Release))
def test_stable_orbits_of_the_paper_are_admissible(release):
    for n, r, lam in ((1, 0.85, 1.0), (1, 0.65, 1.0), (2, 0.85, 0.9), (1, 0.65, 1.2)):
        for omega in (2.0, 10.0, 1e4):
            contact = Contact(omega, float(damping_ratio(r)), release)
            orbit = orbit_at(contact, n, lam)
            assert bool(is_admissible(orbit))
            assert reserves(orbit)[0] > 0


@given(st.integers(1, 3), st.floats(0.3, 0.98), st.floats(0.05, 6.0), st.booleans())
def test_restitution_orbits_against_sampling(n, r, excess, stable):
    lam = float(restitution_orbits.saddle_node(n, r)) + excess
    phase = float(restitution_orbits.phase(n, r, lam, stable))
    share = np.linspace(0, 1, 8001)[1:-1]
    s = 2 * np.pi * n * share
    height, _ = restitution_orbits.path(n, lam, phase, s)
    clear = ((height - lam * np.sin(phase + s)) / (share * (1 - share))).min()
    if abs(clear) > 1e-3:
        assert bool(restitution_is_admissible(n, lam, phase)) == (clear > 0)


def test_arrays_of_orbits():
    contact = Contact(np.array([5.0, 50.0]), 0.05)
    orbits = orbit_at(contact, 1, np.array([[0.05], [0.9], [2.3]]), Side.UNSTABLE)
    result = is_admissible(orbits)
    assert result.shape == (3, 2)
    assert not result[0].any()  # there is none
    for i, lam in enumerate((0.9, 2.3), start=1):
        for j, omega in enumerate((5.0, 50.0)):
            single = orbit_at(Contact(omega, 0.05), 1, lam, Side.UNSTABLE)
            assert bool(result[i, j]) == bool(is_admissible(single))
