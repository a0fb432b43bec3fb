"""The names that users import from the package."""

import inspect
import pickle
import pydoc

import numpy as np
import pytest
from public_face import PublicFace

import bouncing_ball_beyond.inherited
from bouncing_ball_beyond.inherited import (
    RestitutionModel,
    SpringDamper,
    orbit,
    orbits,
    rigid,
    simulate,
    spring_damper,
)
from bouncing_ball_beyond.inherited.models.damping import damping_ratio

CONTACT = spring_damper(restitution=0.85, frequency_ratio=10.0)
RIGID = rigid(restitution=0.85)


class TestPublicFace(PublicFace):
    """The names and calls of the root."""

    bb = bouncing_ball_beyond.inherited


def test_help_shows_the_way_in():
    text = pydoc.render_doc(bouncing_ball_beyond.inherited, renderer=pydoc.plaintext)
    for call in (
        "bouncing_ball_beyond.inherited.orbit(",
        "bouncing_ball_beyond.inherited.limits(",
        "bouncing_ball_beyond.inherited.simulate(",
    ):
        assert call in text


def test_a_public_name_is_no_package():
    """Also after the packages of the library are imported."""
    for name in bouncing_ball_beyond.inherited.__all__:
        assert not inspect.ismodule(getattr(bouncing_ball_beyond.inherited, name)), name


def test_a_single_number_in_is_a_number_out():
    one = orbit(CONTACT, 1, amplitude=np.float64(0.9))
    ends = bouncing_ball_beyond.inherited.limits(RIGID)
    numbers = (one.phase, one.max_height, one.model.damping_ratio, ends.saddle_node.amplitude)
    assert all(isinstance(x, float) for x in numbers)
    assert type(bouncing_ball_beyond.inherited.permanent_contact(CONTACT)) is float
    again = pickle.loads(pickle.dumps(one))
    assert repr(again) == repr(one) and again.phase == one.phase


SPRING = SpringDamper(10.0, damping_ratio(0.85))


@pytest.mark.parametrize(("model", "ball"), [(RestitutionModel(0.85), RIGID), (SPRING, CONTACT)])
def test_the_models_of_the_library_are_the_balls_of_all_calls(model, ball):
    assert type(model) is type(ball) and repr(model) == repr(ball)
    assert repr(orbit(model, amplitude=0.9)) == repr(orbit(ball, amplitude=0.9))
    assert repr(orbits(model, amplitude=0.9)) == repr(orbits(ball, amplitude=0.9))
    assert repr(bouncing_ball_beyond.inherited.limits(model)) == repr(
        bouncing_ball_beyond.inherited.limits(ball)
    )
    assert bouncing_ball_beyond.inherited.permanent_contact(
        model
    ) == bouncing_ball_beyond.inherited.permanent_contact(ball)
    for call in (
        lambda one: simulate(one, amplitude=[0.9, 1.0], impacts=3),
        lambda one: bouncing_ball_beyond.inherited.history(one, amplitude=0.9, periods=1.0),
    ):
        assert call(model).equals(call(ball))


def test_models_in_an_array_have_an_axis():
    found = orbit(RestitutionModel(np.array([0.5, 0.85])), amplitude=[0.9, 1.4])
    same = orbit(rigid(restitution=[0.5, 0.85]), amplitude=[0.9, 1.4])
    assert found.identical(same)
    # One value of each parameter for each model, and not a grid of them.
    pairs = SpringDamper(np.array([5.0, 10.0]), np.array([0.05, 0.1]))
    found = simulate(pairs, amplitude=[0.9, 1.0, 1.1], impacts=3)
    assert dict(found.time.sizes) == {"amplitude": 3, "model": 2, "impact": 3}
    assert found.frequency_ratio.values.tolist() == [5.0, 10.0]
    one = spring_damper(frequency_ratio=10.0, damping_ratio=0.1)
    one = simulate(one, amplitude=1.1, impacts=3)
    np.testing.assert_array_equal(found.time.isel(amplitude=2, model=1), one.time)


def test_error_thresholds_are_those_of_the_errors_of_the_models():
    ball = rigid(restitution=[0.65, 0.85])
    found = bouncing_ball_beyond.inherited.error_thresholds(
        ball, amplitude=1.0, tolerance=[0.01, 0.05], quantities=["max_height", "phase"]
    )
    at = found.isel(tolerance=1).sel(restitution=0.85)
    ratio = float(at.error_threshold.sel(quantity="max_height"))
    exact = orbit(spring_damper(restitution=0.85, frequency_ratio=ratio), amplitude=1.0)
    simple = orbit(RIGID, amplitude=1.0)
    assert abs(exact.max_height / simple.max_height - 1) == pytest.approx(0.05, rel=1e-9)
