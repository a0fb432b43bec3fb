"""Calls that return labelled datasets: balls over time, drops, branches."""

import numpy as np
import pytest
from surveys_of_balls import (
    Surveys,
    drawn,
    has_the_orbits_and_limits,
    parts_draw_the_figure_of_the_whole,
)

import bouncing_ball_beyond as bb
from bouncing_ball_beyond.periodic.one_impact import n_t

CONTACT = bb.spring_damper(restitution=0.85, frequency_ratio=10.0)
RIGID = bb.rigid(restitution=0.85)


class TestSurveys(Surveys):
    """The calls that the root has as well, here on this house's own code."""

    bb = bb

    def path(self, orbit, time):
        return orbit.path(time)[0]


@pytest.mark.parametrize("ball", [CONTACT, RIGID, bb.corrected(CONTACT)])
def test_a_branch_holds_the_orbits_and_limits_of_the_model(ball):
    def exact(amplitude):
        orbit = n_t.orbit(ball, 2, amplitude)
        return orbit.phase, orbit.is_stable()

    has_the_orbits_and_limits(bb, ball, exact)


def test_the_plot_of_error_thresholds_has_a_mark_for_each_quantity(tmp_path):
    found = bb.error_thresholds(bb.rigid(restitution=0.65), amplitude=1.0)
    lines, _ = drawn(found, tmp_path / "shown.png")
    shown = lines["restitution model"].get_xdata()
    np.testing.assert_array_equal(shown, found.error_threshold.sel(simple="restitution"))


@pytest.mark.parametrize("call", [bb.motion_of, bb.lyapunov_exponent])
def test_a_part_of_a_motion_draws_the_figure_of_the_whole(call):
    found = call(RIGID, amplitude=[0.9, 1.0], phase=[1.0, 1.1])
    parts_draw_the_figure_of_the_whole(found)


def test_the_free_impact_of_a_law_is_of_single_numbers(refusal):
    with refusal(ValueError, "restitution must be a single numb"):
        bb.contact_law("tsuji", restitution=[0.5, 0.6], duration=0.1)


def test_balls_on_a_law_are_followed_at_the_speeds_of_their_first_impacts():
    durations = [0.1, 0.2]
    balls = bb.contact_law("tsuji", restitution=0.8, duration=durations)
    found = bb.simulate(balls, amplitude=0.5, velocity=[-2.0, -3.0], impacts=2)
    assert found.time.dims == ("velocity", "duration", "impact")
    for k, duration in enumerate(durations):
        ball = bb.contact_law("tsuji", restitution=0.8, duration=duration, speed=0.5 + 3.0)
        one = bb.simulate(ball, amplitude=0.5, velocity=-3.0, impacts=2)
        np.testing.assert_allclose(found.time[1, k], one.time, rtol=1e-12)
