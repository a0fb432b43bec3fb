"""Random branches of all models: each end is right by a second code, or named."""

import numpy as np
import pytest
from random_branches import BALLS, orbit_of, sample

from bouncing_ball_beyond.periodic.branches.following import branch_from

LONG = [pytest.mark.long, pytest.mark.slow]


def check(verdicts):
    """No verdict is wrong, and at most one in twenty ends is only named."""
    assert not [each for each in verdicts if each.verdict == "wrong"]
    named = [each for each in verdicts if each.verdict == "named"]
    assert len(named) <= max(1, 0.05 * len(verdicts))


@pytest.mark.parametrize("count, seed", [(4, 7), pytest.param(300, 480411, marks=LONG)])
def test_the_ends_of_random_branches_are_right_or_named(count, seed):
    verdicts = sample(count, seed)
    models = {"restitution", "spring-damper", "contact-law", "corrected"}
    assert count < len(BALLS) * 4 or {each.model for each in verdicts} == models
    # Of the 300 branches 297 were right, and 3 were named.
    check(verdicts)


@pytest.mark.parametrize("name", ["rigid", "displacement", "force", "corrected"])
def test_no_branch_jumps_to_another_one(name):
    """The determinant of the Jacobian over the tangent keeps its sign along a regular branch, also
    at its folds; a tangent of another branch would change it in half of all cases.
    """
    orbit = orbit_of(name, np.random.default_rng(480412))
    for to in (0.7 * orbit.amplitude, 1.4 * orbit.amplitude):
        branch = branch_from(orbit, to=to, most=100)
        # At a period halving two branches meet.
        points = branch.branch.points[:-1]
        slopes = branch.problem.jacobian(points)
        tangents = branch.branch.tangents[:-1, np.newaxis]
        signs = np.sign(np.linalg.det(np.concatenate([slopes, tangents], axis=1)))
        assert len(points) > 3
        assert np.all(signs == signs[0])
