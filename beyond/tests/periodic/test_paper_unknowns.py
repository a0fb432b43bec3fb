"""The paper's equations as a problem of the continuation."""

import numpy as np
import pytest
from bounds_of_branches import parameter_bound
from hypothesis import assume, given
from hypothesis import strategies as st
from one_branch import continue_branch
from scipy.optimize import brentq

from bouncing_ball_beyond.inherited.numerics.steps import StepControl
from bouncing_ball_beyond.models.contact_model import ContactModel
from bouncing_ball_beyond.models.damping import LINEAR, Release, damping_ratio
from bouncing_ball_beyond.models.permanent_contact import permanent_contact_threshold
from bouncing_ball_beyond.models.spring_damper import SpringDamper
from bouncing_ball_beyond.periodic.branches.following import orbits_on
from bouncing_ball_beyond.periodic.one_impact.paper_unknowns import PaperUnknowns
from bouncing_ball_beyond.periodic.one_impact.spring_damper_bifurcations import orbit_at
from bouncing_ball_beyond.periodic.one_impact.spring_damper_branch import (
    branch_point,
    orbits_of_points,
)
from bouncing_ball_beyond.periodic.orbits.ends import (
    MERGES,
    AtMargin,
    ends_of_one_impact,
    with_explained_ends,
)
from bouncing_ball_beyond.periodic.orbits.orbit import Orbit
from bouncing_ball_beyond.periodic.orbits.special import bifurcations

releases = st.sampled_from(LINEAR)


@given(
    n=st.integers(1, 3),
    zeta=st.one_of(st.just(0.0), st.floats(0.0, 0.9)),
    omega=st.floats(np.log(0.7), np.log(1e4)).map(lambda x: float(np.exp(x))),
    lam=st.floats(0.1, 3.0),
    release=releases,
    phase=st.floats(-3, 3),
    impact=st.floats(-12, -0.5),
    # A duration that is off by this number moves the release by its square, which is below the
    # rounding errors.
    longer=st.floats(-1e-7, 1e-7),
)
def test_the_residual_is_that_of_the_papers_solution(
    reference, n, zeta, omega, lam, release, phase, impact, longer
):
    if abs(omega - 1) < 0.05:  # the paper's form is singular at the resonance
        omega = 1.1

    def released(s, u):
        d, v = reference.paper_contact(u, phase, lam, omega, zeta)(s)
        return omega * d + (2 * zeta * v if release is Release.FORCE else 0.0)

    # The first release of the contact in samples, each a small part of it.
    time = np.linspace(0, 8 * np.pi, 2001)[1:] / omega
    u = impact - lam * np.cos(phase)
    signal = np.array([released(s, u) for s in time])
    (up,) = np.nonzero((signal[:-1] < 0) & (signal[1:] >= 0))
    assume(up.size)
    k = up[0]
    duration = brentq(released, time[k], time[k + 1], args=(u,), xtol=1e-15, rtol=1e-15)
    rate = (released(time[k + 1], u) - released(time[k], u)) / (time[k + 1] - time[k])
    assume(rate > 0.1 * omega)
    flight = 2 * np.pi * n - duration
    d, v = reference.paper_contact(u, phase, lam, omega, zeta)(duration)
    bounce = v + lam * np.cos(phase + duration)
    height = d + lam * (np.sin(phase + duration) - np.sin(phase))
    height += bounce * flight - flight**2 / 2
    off = longer / np.hypot(1, omega * duration)  # of arsinh ϖD
    expected = [-height, bounce - flight - lam * np.cos(phase) - u, off]
    system = PaperUnknowns.of(
        Orbit.of(
            ContactModel(SpringDamper(omega, zeta, release)),
            n,
            lam,
            phase,
            duration,
            impact,
        )
    )
    # The paper's constants lose 1/√γ at ϖ ≈ 1: some hundred roundings of
    # velocities of order 20 and heights of order 400.
    y = np.array([phase, impact, omega * duration + longer, lam])
    assert system.residual(y) == pytest.approx(np.array(expected), abs=3e-11)


def events_of(system):
    events = (*bifurcations(system.equations), *ends_of_one_impact(system.equations))
    return tuple(system.event(event) for event in events)


def follow_unstable_side(n, omega, r, lam, largest=0.2):
    orbit = orbit_at(SpringDamper(omega, float(damping_ratio(r))), n, lam)
    system = PaperUnknowns.of(orbit)
    events = (*events_of(system), parameter_bound(10.0, True, "window"))
    return system, continue_branch(
        system,
        system.point(orbit),
        increasing=False,
        events=events,
        control=StepControl(largest=largest),
    )


@pytest.mark.parametrize(
    ("omega", "r", "largest", "margins"),
    [
        (1.5, 0.65, 0.2, {AtMargin.IMPACT}),
        (2.0, 0.85, 0.1, {AtMargin.IMPACT}),
        # Both vanish together there: which is met first is a matter of 1e-4.
        (2.0, 0.85, 0.2, set(AtMargin)),
    ],
)
def test_the_branch_ends_in_permanent_contact(omega, r, largest, margins):
    system, branch = follow_unstable_side(1, omega, r, 0.9, largest)
    assert branch.end.event in margins
    assert str(with_explained_ends(system, branch).end) == MERGES
    # Where impact velocity and flight vanish the ball just stays on the table.
    # Λ is off by the square of the flight left: up to 4e-5 at ϖ = 10, where
    # the impact velocity meets its margin of 1e-4.
    end = orbits_on(system, branch.points[-1])
    expected = float(permanent_contact_threshold(omega, damping_ratio(r)))
    assert branch.points[-1, 3] == pytest.approx(expected, abs=float(end.flight_time) ** 2 + 1e-12)
    assert float(end.flight_time) < 1e-2
    if branch.end.event == AtMargin.IMPACT:
        assert float(end.relative_impact_velocity) == pytest.approx(-1e-4, abs=1e-10)


def test_a_branch_may_end_where_the_contact_fills_the_cycle():
    # ϖ = 0.6, n = 2: a branch that reaches contacts as long as the cycle.
    zeta = float(damping_ratio(0.3))
    n, omega = 2, 0.6
    contact = SpringDamper(omega, zeta)
    fill = (2 * np.pi * n - 0.1) * omega
    point = branch_point(fill * np.sqrt(1 - zeta**2) - np.pi, contact, n)
    orbit = orbits_of_points(point, contact, n)
    system = PaperUnknowns.of(orbit)
    start = system.point(orbit)
    events = events_of(system)
    branches = [
        continue_branch(system, start, increasing=up, events=events) for up in (True, False)
    ]
    ends = [with_explained_ends(system, branch).end for branch in branches]
    assert (MERGES, AtMargin.FLIGHT) in {(str(end), end.event) for end in ends}


def test_the_branch_ends_where_the_ball_no_longer_leaves_the_table():
    # Far up the unstable side the relative velocity at release falls to zero;
    # beyond, the contact would have ended earlier and r_a is negative. The
    # branch then turns in Λ without a saddle-node of the return map.
    system, branch = follow_unstable_side(1, 10.0, 0.85, 0.9)
    assert np.all(orbits_on(system, branch.points).apparent_restitution >= -1e-6)
