"""The contact against the integration of its equation, and the steady motion in contact."""

import numpy as np
import pytest
from scipy.optimize import minimize_scalar
from tests import independent

from bouncing_ball import spring_damper
from bouncing_ball.spring_damper import Contact

# The tolerance of what takes some hundred roundings: a few hundred units of 1e-16.
ROUNDING = 1e-12

# ϖ, ζ, weight and duration: at the resonance of an undamped contact and beside it, also where
# series take over; stiff, compliant and strongly damped contacts; long ones.
CONTACTS = [
    (1.0, 0.0, 1.0, 4.0),
    (1.0 + 3e-5, 0.0, 1.0, 4.0),
    (1.0, 1e-7, 0.0, 3.0),
    (1.0 - 1e-3, 1e-3, 1.0, 20.0),
    (0.4, 0.2, 1.0, 6.0),
    (3.0, 0.95, 0.3, 5.0),
    (12.0, 0.05, 1.0, 2.0),
    (1000.0, 0.6, 1.0, 0.01),
]


@pytest.mark.parametrize(("ratio", "zeta", "weight", "duration"), CONTACTS)
def test_the_motion_in_contact_is_that_of_an_integration(ratio, zeta, weight, duration):
    amplitude = 1.3
    phase = 0.7
    u = -2.4
    expected = independent.integrate_contact(
        ratio,
        zeta,
        release="displacement",
        amplitude=amplitude,
        phase=phase,
        u=u,
        weight=weight,
        duration=duration,
    )
    contact = Contact(ratio, zeta, weight=weight)
    x = amplitude * np.cos(phase)
    impact_height = amplitude * np.sin(phase)
    # The error of the integration is its relative tolerance, 1e-12, for each of up to 100 steps.
    end = contact.motion(expected.duration, u, x, impact_height)
    assert ratio * end.displacement == pytest.approx(ratio * expected.gap, abs=1e-10)
    assert end.velocity == pytest.approx(expected.rate, abs=1e-10)
    # Its interpolant is of the seventh order in steps of at most 0.5.
    along = contact.motion(expected.times, u, x, impact_height)
    np.testing.assert_allclose(ratio * along.displacement, expected.gaps, atol=1e-8)
    np.testing.assert_allclose(along.velocity, expected.rates, atol=1e-8)
    force = amplitude * np.sin(expected.times + phase) - weight
    acceleration = force - 2 * zeta * ratio * expected.rates - ratio * expected.gaps
    np.testing.assert_allclose(along.acceleration / ratio, acceleration / ratio, atol=3e-8)


def test_the_motion_of_an_array_of_contacts_is_that_of_each_and_exact_to_rounding():
    ratio, zeta = np.array([[1.0, 0.0], [1.0, 0.3], [7.0, 0.05], [300.0, 0.9], [1e6, 0.05]]).T
    angle = np.array([2.0, 3.0, 3.1, 2.5, 3.14])
    motion = Contact(ratio, zeta).motion(angle / ratio, -3.0, 0.5, 0.8)
    for k, (one, damping) in enumerate(zip(ratio, zeta, strict=True)):
        end = independent.transfer(one, damping, angle[k] / one) @ [0, -3.0, 0.8, 0.5, 1]
        assert one * motion.displacement[k] == pytest.approx(end[0], abs=ROUNDING)
        assert motion.velocity[k] == pytest.approx(end[1], abs=ROUNDING)


@pytest.mark.parametrize(("ratio", "zeta"), [(1.0, 0.0), (5.0, 0.2)])
def test_the_ball_gains_the_work_of_the_table_and_loses_that_of_the_damper(ratio, zeta):
    x = 0.5
    impact_height = 0.8
    u = -3.0
    duration = 2.5 / ratio
    contact = Contact(ratio, zeta)
    # Sixty nodes of Gauss integrate less than a turn of sines and exponentials to rounding.
    nodes, weights = np.polynomial.legendre.leggauss(60)
    s = duration * (nodes + 1) / 2
    motion = contact.motion(s, u, x, impact_height)
    force = -(2 * zeta * ratio * motion.velocity + ratio**2 * motion.displacement)
    damper = 2 * zeta * ratio * motion.velocity**2
    table_velocity = x * np.cos(s) - impact_height * np.sin(s)
    work = duration / 2 * np.sum(weights * (force * table_velocity - damper))
    end = contact.motion(duration, u, x, impact_height)
    height = end.displacement + x * np.sin(duration) + impact_height * np.cos(duration)
    velocity = end.velocity + x * np.cos(duration) - impact_height * np.sin(duration)
    energy = velocity**2 / 2 + height + ratio**2 * end.displacement**2 / 2
    assert energy - (u + x) ** 2 / 2 - impact_height == pytest.approx(work, rel=ROUNDING)


@pytest.mark.parametrize("r", [1.0, 0.85, 0.3, 0.14])
@pytest.mark.parametrize("release", spring_damper.RELEASES)
def test_the_restitution_of_a_free_impact(r, release):
    """A contact that is found from the duration of an impact has this duration, and this r."""
    contact = spring_damper.contact_of_duration([0.01, 0.4], r, release)
    zeta = float(contact.damping_ratio)
    for ratio, duration in zip(contact.frequency_ratio, [0.01, 0.4], strict=True):
        impact = independent.integrate_contact(ratio, zeta, release, 0.0, 0.0, -1.0, weight=0.0)
        # Some ten steps of the integration, each with 1e-12.
        assert impact.rate == pytest.approx(r, abs=1e-11)
        assert impact.duration == pytest.approx(duration, rel=1e-11)
    assert contact.restitution == pytest.approx(r, abs=1e-14)


@pytest.mark.parametrize("r", [0.05, np.exp(-2)])
def test_no_contact_with_the_force_release_has_a_small_r(r):
    contact = spring_damper.contact_of_duration(0.1, [r, 0.5], "force")
    np.testing.assert_array_equal(np.isnan(contact.frequency_ratio), [True, False])
    # Close to critical damping it is e⁻².
    impact = independent.integrate_contact(1.0, 0.9999, "force", 0.0, 0.0, -1.0, weight=0.0)
    assert impact.rate == pytest.approx(np.exp(-2), abs=1e-4)


def test_the_formulas_of_the_readme_for_a_measured_duration():
    r = np.linspace(0.14, 1, 200)
    exact = spring_damper.contact_of_duration(1.0, r, "force").frequency_ratio
    by_hand = np.pi + 2 / np.pi * np.log(r) + 0.033 * np.log(r) ** 2
    assert np.abs(by_hand / exact - 1).max() < 1e-3
    exact = spring_damper.contact_of_duration(1.0, r, "displacement").frequency_ratio
    np.testing.assert_allclose(exact, np.hypot(np.pi, np.log(r)), rtol=ROUNDING)


def steady_motion(ratio, zeta):
    """Amplitudes of q = ϖδ and of the force q + 2ζδ′ in the steady motion for Λ = 1."""
    turn = independent.transfer(ratio, zeta, 2 * np.pi)
    # Without weight: the column of the constant is left out.
    table = np.array([0.0, 1.0])
    repeated = np.linalg.solve(np.eye(2) - turn[:2, :2], turn[:2, 2:4] @ table)
    quarter = independent.transfer(ratio, zeta, np.pi / 2)
    later = quarter[:2, :2] @ repeated + quarter[:2, 2:4] @ table
    return [np.hypot(repeated @ row, later @ row) for row in ([1, 0], [1, 2 * zeta])]


@pytest.mark.parametrize(("ratio", "zeta"), [(0.3, 0.1), (1.0, 0.136), (2.0, 0.8), (30.0, 0.05)])
def test_permanent_contact_lasts_until_the_steady_motion_reaches_its_release(ratio, zeta):
    displacement, force = steady_motion(ratio, zeta)
    # The weight alone presses the contact by q = -1/ϖ.
    amplitude = spring_damper.permanent_contact(ratio, zeta)
    assert amplitude * displacement == pytest.approx(1 / ratio, rel=1e-10)
    amplitude = spring_damper.permanent_contact(ratio, zeta, "force")
    assert amplitude * force == pytest.approx(1 / ratio, rel=1e-10)


@pytest.mark.parametrize("zeta", [0.0, 0.1, 0.5, 0.7, 0.75])
@pytest.mark.parametrize("release", spring_damper.RELEASES)
def test_the_lowest_threshold_of_permanent_contact(zeta, release):
    ratio, lowest = spring_damper.lowest_permanent_contact(zeta, release)
    if zeta == 0.75 and release == "displacement":
        assert (ratio, lowest) == (np.inf, 1.0)
        assert np.all(np.diff(spring_damper.permanent_contact(np.geomspace(0.1, 1e3), zeta)) < 0)
        return
    assert spring_damper.permanent_contact(ratio, zeta, release) == pytest.approx(lowest, abs=1e-15)
    around = np.array([0.99 * ratio, 1.01 * ratio])
    assert np.all(spring_damper.permanent_contact(around, zeta, release) > lowest)
    minimum = minimize_scalar(
        lambda x: spring_damper.permanent_contact(x, zeta, release) ** 2,
        bounds=(ratio / 3, 3 * ratio),
        method="bounded",
        options={"xatol": 1e-10},
    )
    # The place of a minimum has half of the digits of its value, fewer where it is flat.
    assert minimum.x == pytest.approx(ratio, rel=1e-6)


@pytest.mark.parametrize(("amplitude", "zeta"), [(0.99, 0.1359), (0.5, 0.05), (0.3, 0.0)])
def test_the_frequency_ratios_of_a_threshold(amplitude, zeta):
    ratios = spring_damper.permanent_contact_ratios(amplitude, zeta)
    assert ratios[0] < spring_damper.lowest_permanent_contact(zeta)[0] < ratios[1]
    np.testing.assert_allclose(spring_damper.permanent_contact(ratios, zeta), amplitude, rtol=1e-12)


def test_no_frequency_ratio_has_a_threshold_below_the_lowest():
    assert np.isnan(spring_damper.permanent_contact_ratios(0.15, 0.1)).all()
