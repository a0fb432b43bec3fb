"""Random calls end with an answer or with one line: no traceback, no warning, nothing printed.

Arguments are drawn from the ranges and names that the functions declare. A call that takes
long is ended.
"""

import inspect
from functools import partial
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from random_arguments import Calls, RandomCall, check, numbers, sometimes, undeclared, with_ball
from random_laws import CallsOfBeyond, arguments

import bouncing_ball_beyond as bb
from bouncing_ball_beyond.accuracy.errors import OF_IMPACTS
from bouncing_ball_beyond.inherited.datasets.arguments import POSITIVE, START
from bouncing_ball_beyond.inherited.errors import ModelError, Range
from bouncing_ball_beyond.periodic.orbits.special import Special

# Random calls of each function, of all functions in the long test.
SOME = 8
MANY = 90


def orbit(calls: Calls) -> Any:
    found = calls.random("orbit", calls.ball(), needed=("amplitude",))
    if hasattr(found, "multipliers"):
        for use in (found.multipliers, found.is_admissible, found.defect, found.__repr__):
            use()
        found.path(np.linspace(0.0, 7.0, 5))
    return found


def error_thresholds(calls: Calls) -> Any:
    names = st.lists(st.sampled_from(OF_IMPACTS).map(str), min_size=1, max_size=2)
    more = {"quantities": calls.draw(names)} if calls.draw(st.booleans()) else {}
    return calls.random("error_thresholds", calls.rigid(), needed=("amplitude",), **more)


# Branches and curves.


SPECIAL = list(map(str, Special))


def branch_of_an_orbit(calls: Calls) -> Any:
    ends = calls.draw(st.sampled_from([orbit, partial(CALLS["orbit_of_motion"])]))
    start = ends(calls)
    model = getattr(start, "model", None)
    names = ["amplitude", "frequency", *(() if model is None else model.numbers())]
    more: dict[str, Any] = {}
    if calls.draw(st.booleans()):
        more["along"] = calls.draw(st.sampled_from(names))
    if calls.draw(st.booleans()):
        more["to"] = calls.value(Range())
    return calls.random("follow", start, **more)


def special(calls: Calls, kind: str) -> Any:
    """A special orbit of a branch; without one the call is refused."""
    found = branch_of_an_orbit(calls)
    if calls.with_mistakes and calls.draw(sometimes(6)):
        return next(iter(found.states()))
    try:
        return found.first(kind)
    except (ValueError, TypeError, LookupError) as error:
        raise ModelError(str(error)) from None


def limits_of(calls: Calls) -> tuple[Any, Any]:
    """The range of a parameter on a curve."""
    pair = st.tuples(numbers(POSITIVE), numbers(POSITIVE)).map(sorted)
    low, high = calls.draw(pair)
    return low, high


def across(calls: Calls, start: Any) -> str:
    return calls.draw(st.sampled_from(["amplitude", *start.model.numbers()]))


def follow(calls: Calls) -> Any:
    """The branch of an orbit, or a branch or a curve from a special orbit."""
    way = calls.draw(st.sampled_from([0, 0, 0, 1, 2]))
    if way == 0:
        return branch_of_an_orbit(calls)
    start = special(calls, calls.draw(st.sampled_from(list(map(str, Special)))))
    if way == 1:
        return calls.random("follow", start, to=calls.value(Range()))
    ranges = {"amplitude": limits_of(calls)} if calls.draw(st.booleans()) else {}
    along = "amplitude", across(calls, start)
    return calls.random("follow", start, along=along, ranges=ranges)


def orbit_near(calls: Calls) -> Any:
    count = calls.draw(st.integers(1, 3))
    guess = {name: [calls.value(START) for _ in range(count)] for name in ("phases", "velocities")}
    return calls.random("orbit_near", calls.ball(), needed=("amplitude",), **guess)


def normal_form(calls: Calls) -> Any:
    return calls.call("normal_form", special(calls, calls.draw(st.sampled_from(SPECIAL))))


def grazing_form(calls: Calls) -> Any:
    return calls.call("grazing_form", special(calls, calls.draw(st.sampled_from(SPECIAL))))


CALLS: dict[str, RandomCall] = {
    each.__name__: each
    for each in (
        orbit, orbit_near, error_thresholds, follow, normal_form, grazing_form,
    )
} | {
    name: with_ball(name, *needed)
    for name, *needed in (
        ("simulate", "amplitude"), ("history", "amplitude"), ("drop", "height"), ("limits",),
        ("orbits", "amplitude"), ("branch",), ("permanent_contact",), ("motion_of", "amplitude"),
        ("lyapunov_exponent", "amplitude"), ("orbit_diagram", "amplitude"),
        ("basins", "amplitude"), ("orbit_of_motion", "amplitude"),
    )
}  # fmt: skip
"""A function for each public function, which draws its arguments and calls it."""
QUICK = ("orbit", "limits", "permanent_contact", "error_thresholds")


def test_every_public_function_is_called():
    functions = {name for name in bb.__all__ if inspect.isfunction(getattr(bb, name))}
    makers = {"rigid", "spring_damper", "contact_law", "corrected"}
    # They take the path of a file and no numbers: tests/drawing/test_figures_of_files.py and
    # tests/periodic/test_saved.py.
    assert functions - makers - {"open", "read_orbits"} == CALLS.keys()


def test_the_ranges_of_numbers_are_declared():
    assert undeclared(bb, arguments, CALLS) == set()


@pytest.mark.parametrize("name", QUICK)
@settings(max_examples=SOME)
@given(st.data())
def test_random_calls_of_quick_functions_are_answered_or_refused(name, data):
    check(CALLS[name], CallsOfBeyond(data.draw))


@pytest.mark.long
@pytest.mark.parametrize("name", CALLS)
@settings(max_examples=MANY)
@given(st.data())
def test_random_calls_are_answered_or_refused(name, data):
    check(CALLS[name], CallsOfBeyond(data.draw))
