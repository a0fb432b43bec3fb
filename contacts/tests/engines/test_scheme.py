"""Free impacts in time steps, against the engines themselves and a plain loop."""

import math

import hypothesis
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.linalg import expm

from bouncing_ball_beyond.inherited.errors import ModelError
from bouncing_ball_beyond.models.damping import LINEAR, Release, restitution_coefficient
from bouncing_ball_contacts.engines.choice import ENGINES
from bouncing_ball_contacts.engines.given_step import spread_in_steps
from bouncing_ball_contacts.engines.impacts import (
    error_in_steps,
    restitution_in_steps,
    steps_for,
)
from bouncing_ball_contacts.engines.scheme import Scheme, compensated, represented

# Measured on the engines with the text to paste (MuJoCo 4.0.0, LAMMPS 2025.7.22, PyBullet 3.2.7,
# Drake 1.51.1): ζ = 0.0958, 50 steps in a contact, the first of which begins so many steps before
# the surface.
BEFORE = np.array([0.02, 0.25, 0.5, 0.75, 0.98])
MEASURED = {
    ("mujoco", "force"): [0.75657, 0.75432, 0.75228, 0.75024, 0.74836],
    ("lammps", "force"): [0.75657, 0.75432, 0.75228, 0.75024, 0.74836],
    ("lammps", "displacement"): [0.74617, 0.73685, 0.73696, 0.73708, 0.73719],
    ("drake", "force"): [0.75696, 0.75500, 0.75286, 0.75072, 0.74876],
    ("pybullet", "force"): [0.75696, 0.75500, 0.75286, 0.75072, 0.74876],
}


@pytest.mark.parametrize(("engine", "release"), MEASURED)
def test_the_scheme_is_that_of_the_engine(engine, release):
    scheme = ENGINES[engine].scheme
    found = restitution_in_steps(scheme, 0.0958, Release(release), 50, 1 - BEFORE)
    assert found == pytest.approx(MEASURED[engine, release], abs=6e-6)


@pytest.mark.parametrize("zeta", [0.02, 0.3, 0.95])
def test_the_bias_of_compensated_steps_is_of_second_order_and_the_scatter_is_the_dampers(zeta):
    exact = float(restitution_coefficient(zeta, Release.FORCE))
    instants = (np.arange(1000) + 0.5) / 1000
    bias = []
    for steps in (160, 320):
        h = float(Release.FORCE.free_angle(zeta)) / np.sqrt(1 - zeta**2) / steps
        found = restitution_in_steps(
            Scheme.COMPENSATED, zeta, Release.FORCE, steps, [*instants, 1e-9, 1]
        )
        relative = np.log(found / exact)
        bias.append(relative[:-2].mean())
        # The damper acts for up to half a step more or less, to second order in h.
        assert relative[-2:] == pytest.approx([-zeta * h, zeta * h], abs=h**2)
    # The mean over a grid of instants differs from the integral where the number of steps changes.
    assert bias[0] / bias[1] == pytest.approx(4, rel=0.02)


@given(st.floats(1e-3, 1e9), st.floats(1e-3, 5.0), st.floats(1e-3, 0.5))
def test_compensated_steps_pass_through_the_exact_motion(stiffness, zeta, step):
    omega = np.sqrt(stiffness)
    loss = 2 * zeta * omega
    h = step / omega
    spring, damper = compensated(stiffness, loss, h)
    hypothesis.assume(damper > 0)
    # Implicit Euler and the exact flow have the same eigenvalues, and so the same characteristic
    # polynomial: of trace and determinant.
    exact = expm(h * np.array([[0.0, 1.0], [-stiffness, -loss]]))
    implicit = np.linalg.inv(np.eye(2) - h * np.array([[0.0, 1.0], [-spring, -damper]]))
    assert np.trace(implicit) == pytest.approx(np.trace(exact), rel=1e-12)
    assert np.linalg.det(implicit) == pytest.approx(np.exp(-h * loss), rel=1e-12)
    again = represented(spring, damper, h)
    assert again == pytest.approx((stiffness, loss), rel=1e-12 * max(1.0, 1 / (zeta * step)))


def by_a_loop(scheme, zeta, release, steps, fraction):
    h = float(release.free_angle(zeta)) / np.sqrt(1 - zeta**2) / steps
    ahead = "ahead" in scheme
    x = (ahead - fraction) * h
    v = -1.0
    k, c = compensated(1.0, 2 * zeta, h) if "compensated" in scheme else (1.0, 2 * zeta)
    for _ in range(2 * steps):
        if scheme is not Scheme.SEMI_IMPLICIT:
            new = (v - h * k * x) / (1 + h * (c + h * k))
        else:
            new = v - h * (x + 2 * zeta * v)
        if min(x, x + ahead * h * v) >= 0 or (release is Release.FORCE and new < v):
            return v
        x = x + h * new
        v = new
    raise AssertionError("no end")


# r of PhysX 5.6.1, measured in its package for JavaScript: compliant contact of 10⁴ N/m without
# damping, 0.5 kg, 1 m/s, no gravity. It does not tell where in a step the ball met the wall.
IN_PHYSX = {240: 0.4156, 1000: 0.8014, 4000: 0.9460, 20000: 0.9890}


def in_a_step_of_implicit_euler(x, v, h, stiffness):
    """The end of a step of p″ = -κ max(p, 0), of which the force is that at the end."""
    free = x + h * v
    if free >= 0:
        return free, v
    x = free / (1 + h * h * stiffness)
    return x, v - h * stiffness * x


@pytest.mark.parametrize("rate", IN_PHYSX)
def test_contacts_found_ahead_are_those_of_physx(rate):
    kappa = 1e4 / 0.5
    h = 1 / rate
    found = spread_in_steps(Scheme.AHEAD, 0.0, Release.FORCE, math.sqrt(kappa) * h)
    # Four digits were measured, and they were found to agree to 0.0002.
    assert found.mean == pytest.approx(IN_PHYSX[rate], abs=2.5e-4)
    assert found.least - 5e-5 <= IN_PHYSX[rate] <= found.most + 5e-5
    # If the force is that at the end of the step, contacts are found ahead.
    loop = []
    for place in (np.arange(200) + 0.5) / 200 * h:
        x, v = place, -1.0
        while v <= 0 or x < 0:
            x, v = in_a_step_of_implicit_euler(x, v, h, kappa)
        loop.append(v)
    assert found.least <= min(loop) and max(loop) <= found.most
    # Means of 200 midpoints, where r has one jump at most.
    assert np.mean(loop) == pytest.approx(found.mean, abs=(found.most - found.least) / 200)


def test_a_contact_found_ahead_is_damped_for_one_step_more():
    zeta = 0.1
    for scheme, without in (
        (Scheme.COMPENSATED_AHEAD, Scheme.COMPENSATED),
        (Scheme.AHEAD, Scheme.IMPLICIT),
    ):
        assert (scheme.is_ahead, scheme.is_implicit) == (True, True)
        assert scheme.uncompensated is Scheme.AHEAD
        second = []
        for h in (0.02, 0.01):
            one, other = (
                spread_in_steps(each, zeta, Release.FORCE, h).mean for each in (scheme, without)
            )
            second.append(math.log(one / other) + 2 * zeta * h)
        # What is left of ln(1 - 2ζh) is of second order.
        assert second[0] / second[1] == pytest.approx(4, rel=0.05)


@pytest.mark.parametrize("scheme", Scheme)
@pytest.mark.parametrize("release", LINEAR)
@pytest.mark.parametrize("zeta", [0.0, 0.05, 0.4])
def test_powers_of_a_step_are_its_steps(scheme, release, zeta):
    fractions = np.array([0.03, 0.4, 1.0])
    found = restitution_in_steps(scheme, zeta, release, 37, fractions)
    loop = [by_a_loop(scheme, zeta, release, 37, fraction) for fraction in fractions]
    assert found == pytest.approx(loop, rel=1e-12)


@pytest.mark.parametrize(
    ("scheme", "release"), sorted({(x.scheme, y) for x in ENGINES.values() for y in x.releases})
)
def test_the_error_falls_like_one_over_the_steps(scheme, release):
    coarse, fine = (error_in_steps(scheme, 0.1, release, steps) for steps in (400, 3200))
    assert coarse / fine == pytest.approx(8, rel=0.05)
    assert fine < 0.002
    # The closed form is its limit, linear in 1/N.
    one, two = (restitution_in_steps(scheme, 0.1, release, n, 0.5) for n in (2000, 4000))
    limit = float(restitution_coefficient(0.1, release))
    assert 2 * two - one == pytest.approx(limit, abs=2e-4 if release is Release.FORCE else 4e-4)


@pytest.mark.parametrize("scheme", Scheme)
@pytest.mark.parametrize("error", [0.03, 0.005, 0.002])
def test_the_steps_for_an_error_are_the_least(scheme, error):
    least = steps_for(scheme, 0.1, Release.FORCE, error)
    assert error_in_steps(scheme, 0.1, Release.FORCE, least) <= error
    assert error_in_steps(scheme, 0.1, Release.FORCE, least - 1) > error
    more = range(least, 4 * least, max(1, least // 10))
    assert all(error_in_steps(scheme, 0.1, Release.FORCE, steps) <= error for steps in more)


def test_many_steps_follow_the_law_of_few():
    # Beyond 4096: an extrapolation, tried at its end.
    least = steps_for(Scheme.IMPLICIT, 0.1, Release.FORCE, 5e-4)
    assert 5000 < least < 8000
    found = error_in_steps(Scheme.IMPLICIT, 0.1, Release.FORCE, least)
    assert found == pytest.approx(5e-4, rel=2e-3)


@pytest.mark.parametrize(
    ("arguments", "says"),
    [
        ((0.1, 7), "7 steps in a contact are too few: use at least 8"),
        ((-0.1, 50), "damping ratio ζ = -0.1 is not a finite number ≥ 0"),
    ],
)
def test_a_mistake_is_refused_in_one_line(arguments, says, refusal):
    zeta, steps = arguments
    with refusal(ModelError, says):
        restitution_in_steps(Scheme.IMPLICIT, zeta, Release.FORCE, steps)
