"""The calls of beyond take the balls of the root."""

import numpy as np
import pytest
import xarray as xr

import bouncing_ball_beyond as bb
import bouncing_ball_beyond.inherited
from bouncing_ball_beyond.inherited.errors import ModelError
from bouncing_ball_beyond.models.contact_model import ContactModel
from bouncing_ball_beyond.models.given_ball import a_ball, a_single_ball
from bouncing_ball_beyond.models.rigid import RestitutionModel
from bouncing_ball_beyond.models.spring_damper import SpringDamper

CONTACT = {"frequency_ratio": 10.0, "damping_ratio": 0.1}
CASES = {
    "rigid": ("rigid", {"restitution": 0.85}),
    "contact": ("spring_damper", CONTACT),
    "force release": ("spring_damper", CONTACT | {"release": "force"}),
    "rigid balls": ("rigid", {"restitution": [0.6, 0.85]}),
    "contacts": ("spring_damper", CONTACT | {"frequency_ratio": [8.0, 10.0], "release": "force"}),
    "grid": ("spring_damper", {"frequency_ratio": [8.0, 10.0], "damping_ratio": [0.05, 0.1, 0.2]}),
}
CALLS = {
    "orbit": lambda ball: bb.orbit(ball, amplitude=1.0),
    "limits": lambda ball: bb.limits(ball, n=[1, 2]),
    "permanent_contact": bb.permanent_contact,
    "branch": lambda ball: bb.branch(ball, points=20),
    "simulate": lambda ball: bb.simulate(ball, amplitude=1.0, impacts=5),
    "history": lambda ball: bb.history(ball, amplitude=1.0, periods=1.0, samples=10),
    "drop": lambda ball: bb.drop(ball, height=2.0, periods=1.0, samples=10),
    "motion_of": lambda ball: bb.motion_of(ball, amplitude=0.9, impacts=50),
    "lyapunov_exponent": lambda ball: bb.lyapunov_exponent(ball, amplitude=0.9, impacts=50),
}
OF_ONE_BALL = {
    "orbits": lambda ball: bb.orbits(ball, amplitude=1.0),
    "orbit_of_motion": lambda ball: bb.orbit_of_motion(ball, amplitude=0.9),
    "orbit_diagram": lambda ball: bb.orbit_diagram(ball, amplitude=[0.9, 1.0], impacts=50),
    "basins": lambda ball: bb.basins(ball, amplitude=0.9, starts=4),
}


def both(case):
    maker, parameters = CASES[case]
    return getattr(bouncing_ball_beyond.inherited, maker)(**parameters), getattr(bb, maker)(
        **parameters
    )


def require_same(found, expected):
    if isinstance(expected, xr.Dataset):
        xr.testing.assert_identical(found, expected)
    else:
        assert repr(found) == repr(expected)


def require_equal(found, expected):
    assert repr(found) == repr(expected)
    for name, values in expected.numbers().items():
        np.testing.assert_array_equal(found.numbers()[name], values)


@pytest.mark.parametrize("case", CASES)
def test_a_ball_of_the_root_becomes_one_of_beyond(case):
    of_root, of_beyond = both(case)
    found = a_ball(of_root)
    require_equal(found, of_beyond)
    assert list(found.parameters) == list(of_beyond.parameters)
    assert a_ball(of_beyond) is of_beyond


@pytest.mark.parametrize("call", CALLS)
@pytest.mark.parametrize("case", CASES)
def test_each_call_gives_the_same_for_both(case, call):
    of_root, of_beyond = both(case)
    require_same(CALLS[call](of_root), CALLS[call](of_beyond))


@pytest.mark.parametrize("call", OF_ONE_BALL)
@pytest.mark.parametrize("case", ["rigid", "contact", "force release"])
def test_each_call_of_one_ball_gives_the_same_for_both(case, call):
    of_root, of_beyond = both(case)
    require_same(OF_ONE_BALL[call](of_root), OF_ONE_BALL[call](of_beyond))


def test_a_ball_of_the_root_is_corrected_and_compared():
    of_root, of_beyond = both("contact")
    assert bb.corrected(of_root) == bb.corrected(of_beyond)
    rigid, same = both("rigid")
    require_same(
        bb.error_thresholds(rigid, amplitude=1.0, quantities=["max_height"]),
        bb.error_thresholds(same, amplitude=1.0, quantities=["max_height"]),
    )


def test_a_model_of_the_root_keeps_its_fields():
    contact = bouncing_ball_beyond.inherited.SpringDamper(np.array([5.0, 10.0]), 0.1, "force")
    expected = ContactModel(SpringDamper(np.array([5.0, 10.0]), 0.1, "force"))
    require_equal(a_ball(contact), expected)
    assert a_ball(bouncing_ball_beyond.inherited.RestitutionModel(0.5)) == RestitutionModel(0.5)


def test_several_balls_of_the_root_are_refused_where_one_is_needed(refusal):
    with refusal(ModelError, "restitution", "single number"):
        a_single_ball(bouncing_ball_beyond.inherited.rigid(restitution=[0.5, 0.6]))
