"""The delay of a contact and the diameter of Barker and Henderson (J. Chem. Phys. 47, 4714, 1967).

An elastic collision of two spheres without friction is to first order that of hard spheres whose
diameter is smaller by v t_c(v). In equilibrium at the temperature T the mean of v t_c over all
approaching pairs is ∫ exp(-U/kT) dξ, with the potential U of the overlap ξ: exchange the integrals
over v and ξ, with x² = v² - 2U/μ.

Lengths are in diameters of the grains; their reduced mass and the constant K of the force are 1.
"""

import math
from itertools import pairwise

import numpy as np
import pytest
from scipy.integrate import quad, solve_ivp

from bouncing_ball_beyond import ForceLaw, SpringDamper


def hertz(p, v, stiffness):
    return stiffness * p * p**0.5


# The contact, its potential U, and kT.
LINEAR = (SpringDamper(1.0, restitution=1.0), lambda x: x**2 / 2, 1e-4)
HERTZ = (ForceLaw(hertz, {"stiffness": 1.0}, root=2), lambda x: 2 / 5 * x**2.5, 1e-6)


def integral(function, end):
    """An integral from 0 to `end`, to ten digits."""
    return quad(function, 0.0, end, epsabs=0, epsrel=1e-10, limit=200)[0]


def mean_depth(ball, thermal, power):
    """The mean of v t_c(v), where the density of v is vᵖ exp(-v²/2kT) but for a factor."""

    def weight(y):
        return y**power * math.exp(-(y**2) / 2)

    def depth(y):
        v = y * math.sqrt(thermal)
        return v * float(ball.signature(v).centroid)

    # The rest beyond y = 10 is of the order of exp(-50).
    return integral(lambda y: weight(y) * depth(y), 10.0) / integral(weight, 10.0)


@pytest.mark.parametrize(("ball", "potential", "thermal"), [LINEAR, HERTZ])
def test_the_mean_depth_is_the_decrease_of_the_diameter(ball, potential, thermal):
    mean = mean_depth(ball, thermal, 0)
    # The diameter is smaller by d - ∫(1 - exp(-U/kT)) = ∫ exp(-U/kT), which beyond twelve times the
    # mean, on the scale of which it falls, is below exp(-70).
    decrease = integral(lambda x: math.exp(-potential(x) / thermal), 12 * mean)
    assert mean == pytest.approx(decrease, rel=1e-8)


def test_colliding_pairs_are_faster():
    ball, _, thermal = LINEAR
    ratio = mean_depth(ball, thermal, 1) / mean_depth(ball, thermal, 0)
    assert ratio == pytest.approx(math.pi / 2, rel=1e-8)


def off_by(stiffness):
    """How far an oblique collision is from that of hard spheres of the smaller diameter d.

    The relative velocity is 0.8 along the line of centres and 0.6 across it at the touch.
    """
    start, velocity = np.array([1.0, 0.0]), np.array([-0.8, 0.6])

    def motion(_, state):
        distance = np.hypot(*state[:2])
        push = stiffness * max(1.0 - distance, 0.0)
        return [*state[2:], *(push * state[:2] / distance)]

    exact = {"max_step": 1e-3, "rtol": 1e-11, "atol": 1e-13}
    solution = solve_ivp(motion, (0.0, 1.0), [*start, *velocity], **exact)
    d = 1.0 - 0.8 * math.pi / 2 / math.sqrt(stiffness)
    # The continued flight has the distance d at t.
    t = 0.8 - math.sqrt(0.8**2 - (1.0 - d**2))
    place = start + t * velocity
    reflected = velocity - 2 * (velocity @ place) / d**2 * place
    hard = [*(place + (1.0 - t) * reflected), *reflected]
    return np.linalg.norm(solution.y[:, -1] - hard)


def test_an_oblique_collision_is_that_of_smaller_hard_spheres():
    errors = [off_by(stiffness) for stiffness in (1e4, 4e4, 1.6e5)]
    # Of second order in the duration, which is halved each time; the next order is smaller by it.
    for longer, shorter in pairwise(errors):
        assert longer / shorter == pytest.approx(4, rel=math.pi / 100)
