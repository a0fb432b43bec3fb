"""The n-T orbits of the root, with one impact, and those of beyond, with k impacts, are the same.

This is the one thing that both houses have. Both have the closed form of the branch, each with its
own orbit; they agree to rounding.
"""

import numpy as np
import pytest

from bouncing_ball_beyond.inherited.models.damping import Release
from bouncing_ball_beyond.inherited.models.restitution import RestitutionModel
from bouncing_ball_beyond.inherited.models.spring_damper import SpringDamper
from bouncing_ball_beyond.inherited.periodic.explicit import explicit_branch
from bouncing_ball_beyond.inherited.periodic.orbit import (
    OBSERVABLES,
    Bifurcation,
    Side,
    trace_and_determinant,
)
from bouncing_ball_beyond.models.given_ball import a_ball
from bouncing_ball_beyond.periodic.one_impact import n_t

EPS = np.finfo(float).eps
COUNT = 40
LIMITS = {
    Bifurcation.SADDLE_NODE: n_t.saddle_node,
    Bifurcation.PERIOD_DOUBLING: n_t.period_doubling,
}


def random_balls(name):
    """Random n and balls with random r, and also ϖ for contacts."""
    rng = np.random.default_rng(65)
    n = rng.integers(1, 5, COUNT)
    r = rng.uniform(0.4, 0.98, COUNT)
    ratio = np.exp(rng.uniform(np.log(5), np.log(500), COUNT))
    if name == "rigid":
        return n, RestitutionModel(r)
    return n, SpringDamper.from_restitution(r, ratio, name)


BALLS = pytest.mark.parametrize("name", ["rigid", *Release])


def agree(of_root, of_beyond, n, factor=1.0):
    """Whether numbers differ by no more than the rounding of the equations of an orbit.

    The height at the landing, which is of the size of Λ, is the difference of terms as large as the
    square of the flight's time; there are two of them in each house.
    """
    rounding = 4 * factor * EPS * (2 * np.pi * n) ** 2
    difference = np.abs(np.asarray(of_beyond) - np.asarray(of_root))
    known = np.isfinite(of_root)
    np.testing.assert_array_equal(np.isfinite(of_beyond), known)
    assert np.any(known) and np.all(difference[known] <= np.broadcast_to(rounding, n.shape)[known])


@BALLS
@pytest.mark.parametrize("kind", Bifurcation)
def test_the_bifurcations_agree(name, kind):
    n, ball = random_balls(name)
    of_root = explicit_branch(ball).bifurcation(kind, n)
    of_beyond = LIMITS[kind](a_ball(ball), n)
    agree(of_root.amplitude, of_beyond.amplitude, n)


@BALLS
@pytest.mark.parametrize("side", Side)
def test_the_orbits_their_traces_and_determinants_agree(name, side):
    n, ball = random_balls(name)
    fold, doubling = (explicit_branch(ball).bifurcation(kind, n).amplitude for kind in Bifurcation)
    share = np.random.default_rng(8).uniform(0.05, 1.5, COUNT)
    lam = fold + share * (doubling - fold)
    of_root = explicit_branch(ball).orbit(n, lam, side)
    of_beyond = n_t.orbit(a_ball(ball), n, lam, side)
    for observable in OBSERVABLES:
        # A phase is the angle of a vector of length Λ.
        factor = 1 / lam if observable == "phase" else 1.0
        agree(getattr(of_root, observable), getattr(of_beyond, observable), n, factor)
    trace, determinant = of_beyond.trace_and_determinant()
    # The trace has (1 + r)² Λ sin φ.
    expected, contraction = trace_and_determinant(of_root)
    agree(expected, trace, n, 4.0)
    agree(contraction, determinant, n)
    for kind in Bifurcation:
        agree(kind.test(expected, contraction), kind.test(trace, determinant), n, 4.0)
