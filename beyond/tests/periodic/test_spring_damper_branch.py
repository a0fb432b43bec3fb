"""The n-T branch as an explicit curve."""

import mpmath
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from sixty_digits import Exact

from bouncing_ball_beyond.inherited.errors import ModelError
from bouncing_ball_beyond.models.damping import LINEAR, Release
from bouncing_ball_beyond.models.oscillator import responses
from bouncing_ball_beyond.models.permanent_contact import permanent_contact_threshold
from bouncing_ball_beyond.models.spring_damper import SpringDamper
from bouncing_ball_beyond.periodic.one_impact.paper_unknowns import PaperUnknowns
from bouncing_ball_beyond.periodic.one_impact.spring_damper_branch import (
    branch_point,
    orbits_of_points,
)

EPS = np.finfo(float).eps

releases = st.sampled_from(LINEAR)
# log ϖ, ζ, n, and the excess angle in units of the fold's scale, 1/ϖ.
log_ratios = st.floats(np.log(0.5), np.log(1e6))
dampings = st.one_of(st.just(0.0), st.floats(0, 0.9))
families = st.integers(1, 5)


def scaled_residual(orbit, point, contact):
    omega = float(contact.frequency_ratio)
    y = np.array([point.phase, point.u + point.x, omega * point.contact_duration, point.amplitude])
    # Velocities, and lengths over one flight; the phase ϖD is rounded too.
    speed = 1 + abs(float(point.u)) + float(point.amplitude) + 2 * np.pi * orbit.n
    size = np.array([speed, speed, speed * 2 * np.pi * orbit.n])
    size = size * (1 + omega * float(point.contact_duration))
    return PaperUnknowns.of(orbit).residual(y) / size


@given(log_ratios, dampings, families, releases, st.floats(-0.9, 1.0))
def test_every_point_satisfies_the_papers_equations(log_omega, zeta, n, release, share):
    contact = SpringDamper(float(np.exp(log_omega)), zeta, release)
    omega_d = contact.frequency_ratio * np.sqrt((1 - zeta) * (1 + zeta))
    start = float(contact.free_angle)
    # Contacts from a tenth of the free one up to ε = 1, or up to the cycle's
    # end (where the three equations become dependent).
    excess = share * start if share < 0 else min(share, 0.95 * (omega_d * 2 * np.pi * n - start))
    point = branch_point(excess, contact, n)
    orbit = orbits_of_points(point, contact, n)
    # A 3 × 3 solve: its condition costs about two digits.
    assert np.all(np.abs(scaled_residual(orbit, point, contact)) < 1e-13)


@pytest.mark.parametrize("detuning", [1e-6, 3e-5, 7e-5, 1e-4, 1e-3])
def test_next_to_the_undamped_resonance_a_point_has_all_its_digits(detuning):
    """Against 60 digits, where the closed form of the motion in contact loses some."""
    contact = SpringDamper(1 + detuning, 0.0)
    for excess in (-0.5, 0.0, 0.2, 0.7):
        point = branch_point(excess, contact, 1)
        with mpmath.workdps(60):
            expected = [float(x) for x in Exact(contact, 1).orbit(excess)]
        found = [float(x) for x in (point.contact_duration, point.u, point.x, point.y)]
        # Some twenty roundings of the largest of them.
        np.testing.assert_allclose(found, expected, rtol=0, atol=5e-15 * np.max(np.abs(expected)))


@pytest.mark.parametrize("release", LINEAR)
@pytest.mark.parametrize("zeta", [0.0, 0.0517, 0.4, 0.9])
@pytest.mark.parametrize("omega", [0.7, 1.0, 2.0, 10.0, 1e4, 1e6])
def test_the_derivatives_are_the_slopes_of_the_branch(release, zeta, omega):
    contact = SpringDamper(omega, zeta, release)
    # The branch turns within 1/ϖ of ε; in those units all is of order one. D
    # is kept away from zero, where Λ is infinite.
    unit = min(1.0, 1 / omega, float(contact.free_angle) / 2)
    h = 2e-3 * unit
    excess = np.array([-1.0, -0.3, 0.0, 0.2, 0.7]) * unit
    steps = [branch_point(excess + k * h, contact, 2) for k in (-2, -1, 1, 2)]
    point = branch_point(excess, contact, 2)
    weights = np.array([1, -8, 8, -1]) / (12 * h)
    for name in ("x", "y"):
        difference = weights @ np.array([getattr(step, name) for step in steps])
        computed = getattr(point, f"d_{name}")
        # h⁴ times a fifth derivative of up to 1e3: 1e-8; roundings eps/2e-3.
        scale = np.hypot(point.d_x, point.d_y).max()
        assert computed == pytest.approx(difference, abs=1e-8 * scale)
    slope = weights @ np.array([step.amplitude**2 / 2 for step in steps])
    assert point.fold == pytest.approx(slope, abs=1e-8 * np.abs(slope).max())


@pytest.mark.parametrize("zeta", [0.0, 0.05, 0.5, 0.95])
def test_the_free_contact_ends_at_the_free_angle_and_not_before(zeta):
    # The free contact, thrown against the table with velocity -1: δ = -g.
    omega = 3.0
    omega_d = omega * np.sqrt(1 - zeta**2)
    for release in LINEAR:
        angle = float(SpringDamper(omega, zeta, release).free_angle)
        g = responses(angle / omega_d, omega, zeta).impulse
        defect = g.value if release is Release.DISPLACEMENT else 2 * zeta * g.rate + omega * g.value
        assert abs(float(defect)) < 20 * EPS
        # Nothing vanishes earlier: it is the first release.
        s = np.linspace(0.01, 0.99, 50) * angle / omega_d
        g = responses(s, omega, zeta).impulse
        before = (
            g.value if release is Release.DISPLACEMENT else (2 * zeta * g.rate + omega * g.value)
        )
        assert np.all(before > 0)


@pytest.mark.parametrize("restitution", [0.3, 0.65, 0.85, 0.95])
@pytest.mark.parametrize("omega", [1.05, 1.2, 2.0, 5.0, 10.0, 100.0])
def test_permanent_contact_continues_into_a_stable_orbit(restitution, omega):
    # docs/cascade-of-flights.md, (1) and (2): both remainders are of first order in the
    # flight, and fall to a half with it.
    contact = SpringDamper.from_restitution(restitution, omega)
    flight = np.array([2e-2, 1e-2]) / omega
    excess = (2 * np.pi - flight) * contact.damped_frequency - contact.free_angle
    point = branch_point(excess, contact, 1)
    zeta = contact.damping_ratio
    threshold = permanent_contact_threshold(omega, zeta)
    rise = 8 * (point.amplitude / threshold - 1) / flight**2 - 1
    assert np.all(np.abs(rise) < 0.05)
    # The rounding of Λ, below 1e-13 (section 3 there), over T²/8.
    rounding = 8e-13 / flight[1] ** 2
    assert rise[1] == pytest.approx(rise[0] / 2, rel=0.1, abs=rounding)
    decay = np.exp(-2 * np.pi * zeta * omega)
    trace = 2 * decay * np.cos(2 * np.pi * contact.damped_frequency)
    error = point.trace - trace
    # The trace divides by the velocities at impact and release, of order T/ϖ².
    rounding = 64 * EPS * omega**2 / flight[1]
    assert error[1] == pytest.approx(error[0] / 2, rel=0.1, abs=rounding)
    assert point.determinant == pytest.approx(decay**2, rel=2 * zeta * omega * flight[0] * 1.1)
    # At ϖ = 100 a flight of 1e-3 rises by 1e-11, well above the rounding of heights.
    excess = (2 * np.pi - 1e-3) * contact.damped_frequency - contact.free_angle
    orbit = orbits_of_points(branch_point(excess, contact, 1), contact, 1)
    assert bool(orbit.is_stable()) and bool(orbit.is_admissible())


@pytest.mark.parametrize(("omega", "zeta"), [(2.0, 0.05), (5.0, 0.1), (3.0, 0.4)])
def test_a_contact_of_several_periods_opens_in_each_of_them(omega, zeta):
    # As D → 2πn: one orbit of the ball for n = 1, none for n ≥ 2, whose contact
    # is over after one period, when δ becomes positive.
    contact = SpringDamper(omega, zeta)
    for n in (1, 2, 3):
        duration = 2 * np.pi * n - 0.05
        excess = float(duration * contact.damped_frequency - contact.free_angle)
        orbit = orbits_of_points(branch_point(excess, contact, n), contact, n)
        assert orbit.defect() < 1e-10
        assert bool(orbit.is_admissible()) == (n == 1)
        touches = 2 * np.pi * np.arange(1, n) - 0.05 / 2
        time = touches[:, np.newaxis] + np.linspace(-0.05, 0.05, 201)
        flow = contact.flow(time, 0.0, orbit.relative_impact_velocity, orbit.phase, orbit.amplitude)
        assert np.all(flow.displacement.max(axis=1) > 0)


def test_many_points_are_the_same_as_single_ones():
    # More than two blocks, with the short and resonant contacts among them.
    excess = np.linspace(-3.1, 3.0, 20_000)
    whole = branch_point(excess, SpringDamper(1.0, 0.0), 2)
    assert whole.amplitude.shape == (20_000,)
    for k in (0, 1, 8191, 8192, 12_001, 19_999):
        single = branch_point(excess[k], SpringDamper(1.0, 0.0), 2)
        for field, value in zip(whole, single, strict=True):
            assert float(field[k]) == pytest.approx(float(value), rel=1e-12, abs=1e-14)


@pytest.mark.parametrize("zeta", [1.0, 1.5])
def test_overdamped_contacts_are_refused(zeta, refusal):
    with refusal(ModelError, f"ζ = {zeta}", "not below 1"):
        branch_point(0.0, SpringDamper(10.0, zeta), 1)
