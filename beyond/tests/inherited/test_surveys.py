"""Calls that return labelled datasets: balls over time, drops, branches."""

import numpy as np
import pytest
from surveys_of_balls import Surveys, drawn, has_the_orbits_and_limits

import bouncing_ball_beyond.inherited as bb
from bouncing_ball_beyond.inherited.periodic.explicit import explicit_branch
from bouncing_ball_beyond.inherited.periodic.orbit import path

CONTACT = bb.spring_damper(restitution=0.85, frequency_ratio=10.0)
RIGID = bb.rigid(restitution=0.85)


class TestSurveys(Surveys):
    """The calls of the root."""

    bb = bb

    def path(self, orbit, time):
        return path(orbit, time)[0]


@pytest.mark.parametrize("ball", [CONTACT, RIGID])
def test_a_branch_holds_the_orbits_and_limits_of_the_model(ball):
    def exact(amplitude):
        orbit = explicit_branch(ball).orbit(2, amplitude)
        return orbit.phase, orbit.stable

    has_the_orbits_and_limits(bb, ball, exact)


def test_the_plot_of_error_thresholds_has_a_mark_for_each_quantity(tmp_path):
    found = bb.error_thresholds(bb.rigid(restitution=0.65), amplitude=1.0)
    lines, _ = drawn(found, tmp_path / "shown.png")
    shown = [line.get_xdata() for line in lines.values()]
    assert any(np.array_equal(x, found.error_threshold, equal_nan=True) for x in shown)
