"""Newton, MuJoCo Warp and Genesis as their recipes are pasted: r, drops and given time steps."""

import math
from dataclasses import replace

import numpy as np
import pytest
from asked_contacts import answered
from engine_runs import Trial
from installed_engines import only_if_installed
from newer_runs import NEWER, RECIPES

from bouncing_ball_beyond.inherited.errors import ModelError
from bouncing_ball_contacts.engines.choice import ENGINES

G = 9.80665
MASS = 0.5
STIFFNESS = 1e5
# The error of r that the time step of a recipe may cause, and rounding of single precision.
ERROR = 0.0015
ROUNDING = 0.0005
pytestmark = [pytest.mark.engines, pytest.mark.filterwarnings("default")]


def recipe(name, **given):
    options = {"mass": MASS, "stiffness": STIFFNESS, "restitution_error": ERROR}
    return answered(engine=RECIPES.get(name, name), **options | given)


@pytest.mark.parametrize("restitution", [0.9, 0.75, 0.5])
@pytest.mark.parametrize("name", NEWER)
def test_the_bounce_is_within_two_thousandths_of_the_one_asked_for(name, restitution):
    only_if_installed(name)
    found = recipe(name, restitution=restitution).engine
    for fraction in (0.02, 0.98):
        start = fraction * found.time_step
        steps = int(1.3 * found.steps)
        _, speeds = NEWER[name](Trial(found, MASS, start, -1.0, steps))
        assert speeds[-1] == pytest.approx(restitution, abs=0.002)


@pytest.mark.parametrize("name", NEWER)
def test_a_dropped_ball_rises_as_the_recipe_says(name):
    only_if_installed(name)
    # A compliant contact, in which gravity lowers the bounce.
    found = recipe(name, stiffness=2e3, restitution=0.75, speed=0.5)
    drop = found.dropped.drop_height
    step = found.engine.time_step
    fall = 0.5 / G
    steps = int((2 * fall + 0.06) / step)
    heights, _ = NEWER[name](Trial(found.engine, MASS, drop, 0.0, steps, gravity=G))
    lowest = int(np.argmin(heights[: int((fall + 0.03) / step)]))
    got = math.sqrt(heights[lowest:].max() / drop)
    assert found.dropped.restitution < 0.745
    # Euler's flights are wrong by half a step of their speed.
    assert got == pytest.approx(found.dropped.restitution, abs=0.002 + G * step / 0.5)


@pytest.mark.parametrize("name", NEWER)
def test_a_step_that_is_given_has_the_range_of_r_that_is_said(name):
    only_if_installed(name)
    found = recipe(name, restitution=0.75, time_step="0.4 ms").engine
    at = found.at_step
    assert not at.is_within
    for fraction in (0.1, 0.5, 0.9):
        steps = 12 + int(3 * found.steps)
        _, speeds = NEWER[name](Trial(found, MASS, fraction * 4e-4, -1.0, steps))
        assert at.least - ROUNDING <= speeds[-1] <= at.most + ROUNDING


def test_newtons_mujoco_solver_needs_condim_1_without_friction():
    only_if_installed("newton-mujoco")
    found = recipe("newton-mujoco", restitution=0.75).engine
    slippery = found.snippet.replace("kd=", "mu=0.0, kd=")
    pyramids = slippery.replace('"mujoco:condim": 1, ', "").replace("(1e-4, 1e-4,", "(0.9, 0.95,")
    assert found.snippet != slippery != pyramids
    speeds = []
    for text in (slippery, pyramids):
        steps = int(1.3 * found.steps)
        trial = Trial(replace(found, snippet=text), MASS, 0.5 * found.time_step, -1.0, steps)
        speeds.append(NEWER["newton-mujoco"](trial)[1][-1])
    assert speeds[0] == pytest.approx(0.75, abs=0.002)
    # If this fails, the note of the recipe is out of date.
    assert np.isnan(speeds[1])


@pytest.mark.parametrize("name", ["newton-mujoco", "genesis"])
def test_a_contact_without_damping_is_refused(name, refusal):
    with refusal(ModelError, f"{name} has no contact without damping"):
        ENGINES[name].settings(ENGINES["generic"].read({"stiffness": 1.0, "damping": 0.0}, 1.0))


@pytest.mark.parametrize("name", NEWER)
def test_a_drop_at_a_given_step_has_the_depth_and_the_force_of_the_recipe(name):
    only_if_installed(name)
    height = 0.3
    step = 2e-3
    given = {"mass": MASS, "restitution": 0.75, "time_step": step}
    engine = RECIPES.get(name, name)
    found = answered(**given, engine=engine, speed=math.sqrt(2 * G * height)).engine
    drop = found.drop
    count = int(2.3 * math.sqrt(2 * height / G) / step + 4 * found.steps) + 20
    for part in (-0.4, 0.1):
        start = height + part * step * math.sqrt(2 * G * height)
        heights, speeds = NEWER[name](Trial(found, MASS, start, 0.0, count, gravity=G))
        inside = int(np.argmax(np.asarray(heights) < 0))
        left = inside + int(np.argmax(np.asarray(heights)[inside:] >= 0))
        forces = MASS * (np.diff(speeds) / step + G)
        # Samples of an instant in 256, and single precision.
        rise = max(heights[left:]) * height / start
        assert drop.rise.least * 0.99 <= rise <= drop.rise.most * 1.01
        for value, ends in (
            (-min(heights[inside:left]), drop.compression),
            (max(forces[:left]), drop.peak_force),
        ):
            assert ends.least * 0.99 <= value <= ends.most * 1.01
    long = int(60 * found.steps) + 300
    heights, _ = NEWER[name](Trial(found, MASS, 0.0, 0.0, long, gravity=G))
    assert -heights[-1] == pytest.approx(drop.depth_at_rest, rel=0.01)
