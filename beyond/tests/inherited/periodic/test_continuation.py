"""The paper's six equations, and branches by continuation."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from bouncing_ball_beyond.inherited.errors import NoOrbitError
from bouncing_ball_beyond.inherited.models.damping import Release, damping_ratio
from bouncing_ball_beyond.inherited.models.permanent_contact import permanent_contact_threshold
from bouncing_ball_beyond.inherited.models.spring_damper import SpringDamper
from bouncing_ball_beyond.inherited.numerics.corrector import NewtonSettings, newton, plane
from bouncing_ball_beyond.inherited.periodic.continuation import (
    PaperEquations,
    Special,
    default_top,
    follow_branches,
)
from bouncing_ball_beyond.inherited.periodic.explicit import explicit_branch
from bouncing_ball_beyond.inherited.periodic.orbit import Bifurcation, Side, multipliers
from bouncing_ball_beyond.inherited.periodic.spring_damper_branch import (
    SpringDamperBranch,
    branch_point,
)

EPS = np.finfo(float).eps

every_release = pytest.mark.parametrize("release", Release)
unknowns = st.tuples(
    st.floats(-3, 3),  # φ
    st.floats(-9, -0.5),  # z′_i
    st.floats(0.5, 6),  # ϖτ_b
    st.floats(0.5, 9),  # z′_b
    st.floats(-4, 4),  # ϖA
    st.floats(-9, 9),  # ϖB
    st.floats(0.1, 3),  # Λ
).map(np.array)
equations = st.builds(
    lambda omega, zeta, release, n: PaperEquations(
        SpringDamper(float(np.exp(omega)), zeta, release), n
    ),
    # The paper's constants have no values at the undamped resonance.
    st.floats(np.log(1.1), np.log(300)),
    st.one_of(st.just(0.0), st.floats(0, 0.9)),
    st.sampled_from(Release),
    st.integers(1, 3),
)


def printed(system, y):
    """Eqs. 21-26 as the paper prints them, with z in contact by Eq. 12, in numbers of the paper."""
    phase, impact, theta, bounce, a, b, lam = y
    omega, zeta = system.contact.frequency_ratio, system.contact.damping_ratio
    omega_d = omega * np.sqrt(1 - zeta**2)
    end = theta / omega
    gamma = (omega**2 - 1) ** 2 + (2 * zeta * omega) ** 2
    beta = -2 * zeta * omega / gamma
    chi = 1 + (omega**2 - 1) / gamma
    a, b = a / omega, b / omega

    def height(time):
        decay = np.exp(-zeta * omega * time)
        free = decay * (a * np.cos(omega_d * time) + b * np.sin(omega_d * time))
        tau = time + phase
        return free - 1 / omega**2 + lam * (beta * np.cos(tau) + chi * np.sin(tau))

    def velocity(time):
        decay = np.exp(-zeta * omega * time)
        by_cosine = omega_d * b - zeta * omega * a
        by_sine = -omega_d * a - zeta * omega * b
        free = decay * (by_cosine * np.cos(omega_d * time) + by_sine * np.sin(omega_d * time))
        tau = time + phase
        return free + lam * (chi * np.cos(tau) - beta * np.sin(tau))

    period = 2 * np.pi * system.n
    level = lam * np.sin(end + phase)
    lag = system.contact.lag
    gap_rate = velocity(end) - lam * np.cos(end + phase)
    flight = period - end
    released = level - lag * (bounce - lam * np.cos(end + phase))
    return np.array(
        [
            omega * (height(0.0) - lam * np.sin(phase)),
            velocity(0.0) - impact,
            omega * (height(end) - level + lag * gap_rate),
            velocity(end) - bounce,
            released + bounce * flight - flight**2 / 2 - lam * np.sin(period + phase),
            bounce - flight - impact,
        ]
    )


@given(equations, unknowns)
def test_the_residual_is_that_of_the_printed_equations(system, y):
    expected = printed(system, y)
    # Some roundings of the terms, of which the squares of the flight time are the largest, and in
    # the first rows those of ϖΛ.
    size = 400 + 10 * system.contact.frequency_ratio + np.abs(expected)
    assert np.all(np.abs(system.residual(y) - expected) <= 20 * EPS * size)


@given(equations, unknowns)
def test_the_jacobian_is_the_difference_quotient_of_the_residual(system, y):
    step = 1e-4
    columns = [
        np.array([-1, 8, -8, 1])
        @ np.array([system.residual(y + k * step * unit) for k in (2, 1, -1, -2)])
        / (12 * step)
        for unit in np.eye(7)
    ]
    expected = np.array(columns).T
    found = system.jacobian(y)
    # The fourth power of the step times fifth derivatives, and rounding over the step, of numbers
    # up to 400 and ϖΛ.
    size = 1 + np.abs(expected)
    rounding = EPS * (400 + 10 * system.contact.frequency_ratio) / step
    assert np.all(np.abs(found - expected) <= 4 * rounding + 1e-11 * size)


@given(equations, unknowns)
def test_a_point_has_the_numbers_of_its_orbit_and_fulfils_what_defines_a_and_b(system, y):
    orbit = system.orbit(y)
    again = system.point(orbit)
    # A and B follow from Eqs. 21 and 22, and z′_b from Eq. 26.
    assert again[[0, 1, 2, 6]] == pytest.approx(y[[0, 1, 2, 6]], rel=4 * EPS)
    defects = system.residual(again)
    allowed = 40 * EPS * (10 + 10 * system.contact.frequency_ratio + np.abs(again).max())
    assert np.all(np.abs(defects[[0, 1, 5]]) < allowed)


@every_release
def test_orbits_in_closed_form_solve_the_six_equations(release):
    rng = np.random.default_rng(4)
    size = 200
    contact = SpringDamper(10 ** rng.uniform(0.1, 4, size), rng.uniform(0.0, 0.8, size), release)
    n = rng.integers(1, 5, size)
    excess = rng.uniform(-1, 1, size) / contact.frequency_ratio
    orbit = branch_point(excess, contact, n).orbit
    system = PaperEquations(contact, n)
    defect = np.abs(system.residual(system.point(orbit))).max(axis=-1)
    # The rounding of the solution, of the phase ϖτ_b, and of flights of the duration 2πn.
    speed = 1 + np.abs(orbit.relative_impact_velocity) + orbit.amplitude + 2 * np.pi * n
    assert np.all(defect < 1e-13 * speed * 2 * np.pi * n)


@every_release
@pytest.mark.parametrize("side", Side)
def test_newtons_method_on_the_six_equations_returns_to_the_branch(release, side):
    rng = np.random.default_rng([1, list(Side).index(side)])
    size = 400
    r = rng.uniform(0.05, 0.999, size)
    n = rng.integers(1, 6, size)
    contact = SpringDamper(10 ** rng.uniform(0.1, 5, size), damping_ratio(r), release)
    fold = n * np.pi * (1 - r) / (1 + r)
    lam = rng.uniform(fold / 2, 1.5 * np.hypot(1.0, fold))
    every = SpringDamperBranch(contact).orbit(n, lam, side)
    there = np.flatnonzero(every.exists)
    assert there.size > size / 2
    system = PaperEquations(contact[there], n[there])
    y = system.point(every[there])
    # Off the branch by a thousandth, and back onto it in the plane across it: at a fixed Λ the fold
    # would amplify rounding to its square root.
    normal = np.linalg.svd(system.jacobian(y))[2][..., -1, :]
    guess = y + 1e-3 * rng.uniform(-1, 1, y.shape) * np.minimum(1, np.abs(y))
    found = newton(system, guess, plane(normal, y), NewtonSettings(max_iterations=20))
    returns = found.converged
    returns &= np.max(np.abs(found.point - y) / (1 + np.abs(y)), axis=-1) < 1e-10
    # A release without speed is a double zero, whose time keeps half the digits and has no slope.
    slow = np.abs(every[there].relative_bounce_velocity) < 10 * np.sqrt(EPS)
    assert np.mean(returns | slow) == 1.0


# Branches.


def followed(r, omega, n=1, top=1.5, release="displacement", **options):
    (found,) = follow_branches(
        SpringDamper([omega], damping_ratio(r), release), [n], top, **options
    )
    return found


@every_release
@pytest.mark.parametrize(("r", "omega", "n"), [(0.85, 10.0, 1), (0.65, 30.0, 2), (0.85, 2.0, 1)])
def test_a_branch_is_the_one_in_closed_form_with_its_bifurcations(r, omega, n, release):
    contact = SpringDamper(omega, damping_ratio(r), release)
    top = default_top(contact, n)
    found = followed(r, omega, n, top, release)
    for kind in Bifurcation:
        expected = explicit_branch(contact).bifurcation(kind, n)
        # A compliant contact has more of them on the other side, of which these are the last.
        place = [each.point for each in found.special if each.name == kind][-1]
        assert place[-1] == pytest.approx(float(expected.amplitude), abs=1e-11)
        assert place[0] == pytest.approx(float(expected.phase), abs=1e-8)
    y = found.at_equal_steps(101)
    rows = found.equations.orbit(y)
    excess = rows.contact_duration * contact.damped_frequency - contact.free_angle
    expected = branch_point(excess, contact, n).orbit
    # D has few digits of the excess of a stiff contact: Λ changes by its slope in ε, of order ϖ.
    assert rows.amplitude == pytest.approx(expected.amplitude, abs=1e-12 * omega**2)
    steps = np.linalg.norm(np.diff(found.measured(y), axis=0), axis=-1)
    # The chord is shorter than the arc by the square of the step times the curvature.
    assert steps == pytest.approx(np.full(100, steps.mean()), rel=0.05)
    assert not rows.stable[-1]
    assert str(found.branch.end) == f"amplitude = {top:g} is reached"


@pytest.mark.parametrize(("omega", "r"), [(1.5, 0.65), (2.0, 0.85)])
def test_a_branch_ends_in_permanent_contact(omega, r):
    found = followed(r, omega, top=10.0)
    assert "merges with permanent contact" in str(found.branch.start)
    # Where impact velocity and flight vanish the ball just stays on the table; Λ is off by the
    # square of the flight that is left.
    end = found.equations.orbit(found.branch.points[0])
    flight = float(end.flight_time)
    assert 0 < flight < 0.1
    expected = float(permanent_contact_threshold(omega, damping_ratio(r)))
    assert float(end.amplitude) == pytest.approx(expected, abs=flight**2 + 1e-12)


def test_a_branch_ends_where_the_ball_no_longer_leaves_the_table():
    found = followed(0.85, 10.0, top=10.0)
    assert "release lost" in str(found.branch.start)
    y = found.branch.points
    leaving = found.equations.orbit(y).apparent_restitution
    # Beyond the end the contact would end earlier, and r_a would be negative.
    assert np.all(leaving >= -1e-6) and abs(leaving[0]) < 1e-6


@pytest.mark.parametrize("release", Release)
def test_the_grazing_orbits_of_a_branch_are_the_limits_of_admissible_orbits(release):
    found = followed(0.85, 10.0, top=4.0, release=release)
    y = found.at_equal_steps(2001)
    admissible = found.equations.orbit(y).admissible
    amplitude = y[:, -1]
    changes = np.flatnonzero(admissible[:-1] != admissible[1:])
    kinds = (Special.GRAZING_FLIGHT, Special.GRAZING_RELEASE)
    grazing = [each.point for each in found.special if each.name in kinds]
    assert changes.size >= 1
    for k in changes:
        low, high = sorted(amplitude[k : k + 2])
        near = [float(p[-1]) for p in grazing if low - 1e-9 <= p[-1] <= high + 1e-9]
        assert near, (k, low, high)


def test_a_terminal_bifurcation_ends_a_branch():
    ends = [Bifurcation.SADDLE_NODE, Bifurcation.PERIOD_DOUBLING]
    found = followed(0.85, 10.0, ends=ends)
    y = found.branch.points
    first, last = (multipliers(found.equations.orbit(y[k])) for k in (0, -1))
    assert np.abs(first - 1).min() < 1e-7 and np.abs(last + 1).min() < 1e-7


def test_branches_side_by_side_are_those_of_each_alone():
    omega = [3.0, 10.0, 50.0]
    row = SpringDamper(omega, damping_ratio(0.85))
    together = follow_branches(row, [1, 2, 1], 1.6)
    for k, each in enumerate(together):
        alone = followed(0.85, omega[k], [1, 2, 1][k], 1.6)
        assert [s.name for s in each.special] == [s.name for s in alone.special]
        for one, other in zip(each.special, alone.special, strict=True):
            assert one.point == pytest.approx(other.point, abs=1e-10)


def test_a_branch_that_begins_above_the_largest_amplitude_is_an_error_with_its_reason():
    found = followed(0.85, 10.0, top=0.2)
    assert isinstance(found, NoOrbitError)
    assert "no 1-T orbit up to Λ = 0.2" in str(found)
    assert "the branch begins at Λ = 0.239988" in str(found)
