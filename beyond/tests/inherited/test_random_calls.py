"""Random calls end with an answer or with one line: no traceback, no warning, nothing printed.

Arguments are drawn from the ranges and names that the functions declare. A call that takes long is
ended.
"""

import inspect
from typing import Any

import numpy as np
import pytest
from declared_arguments import arguments_of
from hypothesis import given, settings
from hypothesis import strategies as st
from random_arguments import Calls, RandomCall, check, undeclared, with_ball

import bouncing_ball_beyond.inherited as bb
from bouncing_ball_beyond.inherited.accuracy.errors import Quantity
from bouncing_ball_beyond.inherited.models.model import Model
from bouncing_ball_beyond.inherited.periodic.orbit import Orbit, defect, multipliers, path

arguments = arguments_of(bb, Model)
# Random calls of each function, of all functions in the long test.
SOME = 4
MANY = 90


def orbit(calls: Calls) -> Any:
    found = calls.random("orbit", calls.ball(), needed=("amplitude",))
    if isinstance(found, Orbit):
        for use in (multipliers, defect, repr):
            use(found)
        path(found, np.linspace(0.0, 7.0, 5))
    return found


def error_thresholds(calls: Calls) -> Any:
    names = st.lists(st.sampled_from(list(map(str, Quantity))), min_size=1, max_size=2)
    more = {"quantities": calls.draw(names)} if calls.draw(st.booleans()) else {}
    return calls.random("error_thresholds", calls.rigid(), needed=("amplitude",), **more)


CALLS: dict[str, RandomCall] = {
    "orbit": orbit,
    "error_thresholds": error_thresholds,
} | {
    name: with_ball(name, *needed)
    for name, *needed in (
        ("simulate", "amplitude"),
        ("history", "amplitude"),
        ("drop", "height"),
        ("limits",),
        ("orbits", "amplitude"),
        ("branch",),
        ("permanent_contact",),
    )
}
"""A function for each public function, which draws its arguments and calls it."""


def test_every_public_function_is_called():
    functions = {name for name in bb.__all__ if inspect.isfunction(getattr(bb, name))}
    # It takes the path of a file and no numbers: tests/drawing/test_figures_of_files.py.
    assert functions - {"rigid", "spring_damper", "open"} == CALLS.keys()


def test_the_ranges_of_numbers_are_declared():
    assert undeclared(bb, arguments, CALLS) == set()


@pytest.mark.parametrize("name", CALLS)
@settings(max_examples=SOME)
@given(st.data())
def test_random_calls_are_answered_or_refused(name, data):
    check(CALLS[name], Calls(data.draw, bb, arguments))


@pytest.mark.long
@pytest.mark.parametrize("name", CALLS)
@settings(max_examples=MANY)
@given(st.data())
def test_many_random_calls_are_answered_or_refused(name, data):
    check(CALLS[name], Calls(data.draw, bb, arguments))
