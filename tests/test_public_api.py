"""The names that users import from the package."""

import ast
import inspect
import pickle
import pydoc
from operator import attrgetter

import numpy as np
import pytest

import bouncing_ball
from bouncing_ball import (
    RestitutionModel,
    SpringDamper,
    orbit,
    orbits,
    rigid,
    simulate,
    spring_damper,
)
from bouncing_ball.models.damping import damping_ratio

CONTACT = spring_damper(restitution=0.85, frequency_ratio=10.0)
RIGID = rigid(restitution=0.85)


def test_every_public_name_is_there_and_documented():
    for name in bouncing_ball.__all__:
        assert getattr(bouncing_ball, name).__doc__, name
    assert set(bouncing_ball.__all__) <= set(dir(bouncing_ball))


def test_every_public_name_that_editors_see_is_one_that_is_imported():
    statements = ast.walk(ast.parse(inspect.getsource(bouncing_ball)))
    shown = [each for each in statements if isinstance(each, ast.ImportFrom)]
    seen = {name.asname: each.module for each in shown for name in each.names if name.asname}
    assert seen == {name: f"bouncing_ball.{x}" for name, x in bouncing_ball._MODULES.items()}
    with pytest.raises(AttributeError, match="no attribute 'model'"):
        attrgetter("model")(bouncing_ball)


def test_help_shows_the_way_in():
    text = pydoc.render_doc(bouncing_ball, renderer=pydoc.plaintext)
    for call in ("bouncing_ball.orbit(", "bouncing_ball.limits(", "bouncing_ball.simulate("):
        assert call in text


def test_an_argument_that_is_none_is_missing(refusal):
    with refusal(bouncing_ball.ModelError, "impacts is missing"):
        simulate(RIGID, amplitude=1.0, impacts=None)


def test_a_public_name_is_no_package():
    """Also after the packages of the library are imported."""
    for name in bouncing_ball.__all__:
        assert not inspect.ismodule(getattr(bouncing_ball, name)), name


def test_a_single_number_in_is_a_number_out():
    one = orbit(CONTACT, 1, amplitude=np.float64(0.9))
    ends = bouncing_ball.limits(RIGID)
    numbers = (one.phase, one.max_height, one.model.damping_ratio, ends.saddle_node.amplitude)
    assert all(isinstance(x, float) for x in numbers)
    assert type(bouncing_ball.permanent_contact(CONTACT)) is float
    again = pickle.loads(pickle.dumps(one))
    assert repr(again) == repr(one) and again.phase == one.phase


SPRING = SpringDamper(10.0, damping_ratio(0.85))


@pytest.mark.parametrize(("model", "ball"), [(RestitutionModel(0.85), RIGID), (SPRING, CONTACT)])
def test_the_models_of_the_library_are_the_balls_of_all_calls(model, ball):
    assert type(model) is type(ball) and repr(model) == repr(ball)
    assert repr(orbit(model, amplitude=0.9)) == repr(orbit(ball, amplitude=0.9))
    assert repr(orbits(model, amplitude=0.9)) == repr(orbits(ball, amplitude=0.9))
    assert repr(bouncing_ball.limits(model)) == repr(bouncing_ball.limits(ball))
    assert bouncing_ball.permanent_contact(model) == bouncing_ball.permanent_contact(ball)
    for call in (
        lambda one: simulate(one, amplitude=[0.9, 1.0], impacts=3),
        lambda one: bouncing_ball.history(one, amplitude=0.9, periods=1.0),
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


def test_a_threshold_of_permanent_contact_is_a_number_or_has_named_axes():
    found = bouncing_ball.permanent_contact(
        spring_damper(damping_ratio=[0.0, 0.1], frequency_ratio=[2.0, 4.0, 8.0])
    )
    assert dict(found.threshold_amplitude.sizes) == {"damping_ratio": 2, "frequency_ratio": 3}
    assert float(found.threshold_amplitude[0, 1]) == 1 - 1 / 16
    assert bouncing_ball.permanent_contact(RIGID) == 1.0


def test_error_thresholds_are_those_of_the_errors_of_the_models():
    ball = rigid(restitution=[0.65, 0.85])
    found = bouncing_ball.error_thresholds(
        ball, amplitude=1.0, tolerance=[0.01, 0.05], quantities=["max_height", "phase"]
    )
    at = found.isel(tolerance=1).sel(restitution=0.85)
    ratio = float(at.error_threshold.sel(quantity="max_height"))
    exact = orbit(spring_damper(restitution=0.85, frequency_ratio=ratio), amplitude=1.0)
    simple = orbit(RIGID, amplitude=1.0)
    assert abs(exact.max_height / simple.max_height - 1) == pytest.approx(0.05, rel=1e-9)


def test_a_misspelt_parameter_is_named_with_its_function():
    with pytest.raises(TypeError, match=r"^orbit\(\) got an unexpected keyword .*'amplitud'"):
        orbit(RIGID, amplitud=1.0)
    with pytest.raises(TypeError, match=r"^spring_damper\(\) missing .*'frequency_ratio'"):
        spring_damper(restitution=0.5)


@pytest.mark.parametrize(
    ("call", "says"),
    [
        (lambda: orbits(CONTACT, amplitude=[0.5, 1.0]), "amplitude must be a single number"),
        (lambda: orbit(RIGID, n=2.5, amplitude=1.0), "n = 2.5 is not a whole number"),
        (lambda: orbit(RIGID, n=np.array([True]), amplitude=1.0), "n = True is not a whole"),
        (
            lambda: orbit(0.85, amplitude=1.0),
            "the ball = 0.85 is not a ball: it is not made by rigid or spring_damper",
        ),
        (lambda: rigid(restitution=[[0.5]]), "restitution has several axes without names"),
        (lambda: rigid(restitution=np.array([0.5, np.nan])), "restitution = nan is not a number"),
        (
            lambda: spring_damper(restitution=0.85, frequency_ratio=10.0, release="glue"),
            "release = 'glue' is not one of displacement, force",
        ),
        (
            lambda: spring_damper(frequency_ratio=10.0),
            "one of the arguments restitution damping_ratio measured_restitution is required",
        ),
        (
            lambda: spring_damper(frequency_ratio=1.0, restitution=0.5, damping_ratio=0.1),
            "argument damping_ratio: not allowed with argument restitution",
        ),
        (
            lambda: spring_damper(frequency_ratio=None, damping_ratio=0),
            "frequency_ratio is missing",
        ),
        # A text of the user is shown as it is, and is no placeholder of a message.
        (lambda: orbit(RIGID, amplitude="{law} {}"), "amplitude = '{law} {}' is not a num"),
        (
            lambda: bouncing_ball.error_thresholds(CONTACT, amplitude=1.0),
            "error_thresholds needs a ball made by rigid",
        ),
        (
            lambda: bouncing_ball.error_thresholds(RIGID, amplitude=1.0, quantities=["mass"]),
            "quantities = 'mass' is not one of max_height",
        ),
    ],
)
def test_wrong_values_are_refused_with_the_allowed_ones(call, says, refusal):
    with refusal(bouncing_ball.ModelError, says):
        call()


@pytest.mark.parametrize(
    "ask",
    [
        lambda: bouncing_ball.history(RIGID, amplitude=1e-300),
        lambda: bouncing_ball.simulate(RIGID, amplitude=1.0, velocity=-1e300),
        lambda: bouncing_ball.drop(RIGID, height=1e12),
    ],
)
def test_numbers_whose_squares_have_no_digits_are_refused(ask):
    with pytest.raises(bouncing_ball.ModelError, match=r"is not (0 or )?a number in \["):
        ask()


def test_a_table_at_rest_is_allowed():
    assert bouncing_ball.simulate(RIGID, amplitude=[0.0, 1e-12], impacts=3).time.shape == (2, 3)


@pytest.mark.parametrize("amplitude_max", [pytest.param(400.0, marks=pytest.mark.long), 1e4])
def test_a_branch_is_followed_to_large_amplitudes(amplitude_max):
    ball = bouncing_ball.spring_damper(restitution=0.85, frequency_ratio=10.0)
    found = bouncing_ball.branch(ball, amplitude_max=amplitude_max, points=20)
    assert float(found.amplitude[-1]) == pytest.approx(amplitude_max, rel=1e-12)
    # Beyond them the unstable side has more.
    for kind, limit in zip(
        ("saddle-node", "period doubling"), bouncing_ball.limits(ball), strict=True
    ):
        located = found.special_amplitude.values[found.special_kind.values == kind]
        assert np.abs(located - limit.amplitude).min() < 1e-11
