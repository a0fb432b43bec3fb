"""The linearised return map of random and of stiff contacts."""

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from bouncing_ball.contacts.damping import damping_ratio
from bouncing_ball.contacts.spring_damper import Release, SpringDamper
from bouncing_ball.orbits.restitution_orbit import RestitutionOrbit
from bouncing_ball.orbits.restitution_orbit import phase as restitution_phase
from bouncing_ball.orbits.spring_damper_branch import branch_point
from bouncing_ball.orbits.spring_damper_limits import orbit_at
from bouncing_ball.orbits.spring_damper_orbit import SpringDamperOrbit
from bouncing_ball.orbits.stability import trace_and_determinant


@given(
    st.integers(1, 5),
    st.floats(0.05, 1.0),
    st.floats(np.log(2.0), np.log(1e4)),
    st.sampled_from(list(Release)),
    st.floats(-1.0, 1.0),
)
def test_determinant_is_the_contraction_of_the_contact(n, r, log_omega, release, share):
    zeta, omega = float(damping_ratio(r)), float(np.exp(log_omega))
    contact = SpringDamper(omega, zeta, release)
    point = branch_point(share / omega, contact, n)
    orbit = SpringDamperOrbit.from_branch(point, contact, n)
    leaving = abs(float(orbit.relative_bounce_velocity))
    assume(leaving > 1e-3)  # the contact's end is not differentiable at zero
    matrix = orbit.monodromy()
    expected = np.exp(-2 * zeta * omega * float(orbit.contact_duration))
    det = float(trace_and_determinant(matrix)[1])
    # Products of entries cancel in the determinant; each entry has lost about
    # two digits to the phase, and some to the division by the release velocity.
    scale = (1 + np.abs(matrix).max() ** 2) / min(leaving, 1.0)
    assert abs(det - expected) <= 1e-13 * scale


@pytest.mark.parametrize(("n", "r", "lam"), [(1, 0.85, 0.9), (3, 0.5, 3.5)])
def test_stiff_limit_is_the_restitution_map(n, r, lam):
    zeta = float(damping_ratio(r))
    phase = restitution_phase(n, r, lam)
    expected = np.array(RestitutionOrbit.of(n, r, lam, phase).trace_and_determinant())
    errors = []
    for omega in (1e4, 1e5):
        orbit = orbit_at(SpringDamper(omega, zeta), n, lam)
        errors.append(np.array(trace_and_determinant(orbit.monodromy())) - expected)
    # First order in 1/ϖ; the next order changes the ratio by 1e-4 or so.
    assert np.abs(errors[0]).max() < 100 / 1e4
    assert errors[1] / errors[0] == pytest.approx([0.1, 0.1], abs=2e-3)
