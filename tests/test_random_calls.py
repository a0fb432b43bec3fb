"""Random calls end with an answer or with one line: no traceback, no warning, nothing printed.

Arguments are drawn from the ranges and names that the functions declare. A call that takes long is
ended.
"""

import inspect
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from declared_arguments import arguments
from hypothesis import given, note, settings
from hypothesis import strategies as st
from random_arguments import Calls, TimeOver

import bouncing_ball as bb
from bouncing_ball.accuracy.errors import Quantity
from bouncing_ball.errors import ModelError, NoOrbitError
from bouncing_ball.periodic.orbit import Orbit, defect, multipliers, path

# Random calls of each function, of all functions in the long test.
SOME = 8
MANY = 90


def with_ball(name: str, *needed: str) -> Callable[[Calls], Any]:
    """A random call of a function of a ball, of which the other arguments are declared."""
    return lambda calls: calls.random(name, calls.ball(), needed=needed)


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


CALLS: dict[str, Callable[[Calls], Any]] = {
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


def check(name: str, data: Any) -> None:
    """A random call is answered, or refused with one line, or takes too long."""
    calls = Calls(data.draw)
    try:
        CALLS[name](calls)
    except TimeOver:
        pass
    except (ModelError, NoOrbitError) as error:
        assert "\n" not in str(error), calls.said
    finally:
        note("; ".join(calls.said))
    assert not calls.spoken.getvalue(), calls.said


def test_every_public_function_is_called():
    functions = {name for name in bb.__all__ if inspect.isfunction(getattr(bb, name))}
    # It takes the path of a file and no numbers: tests/drawing/test_figures_of_files.py.
    assert functions - {"rigid", "spring_damper", "open"} == CALLS.keys()


def test_the_ranges_of_numbers_are_declared():
    undeclared = {
        (name, argument)
        for name in CALLS
        for argument, about in inspect.signature(getattr(bb, name)).parameters.items()
        if str(about.annotation).strip("'") in ("float", "int", "float | None", "int | None")
        and argument not in arguments(name)
    }
    assert undeclared == set()


@pytest.mark.parametrize("name", CALLS)
@settings(max_examples=SOME)
@given(st.data())
def test_random_calls_are_answered_or_refused(name, data):
    check(name, data)


@pytest.mark.long
@pytest.mark.parametrize("name", CALLS)
@settings(max_examples=MANY)
@given(st.data())
def test_many_random_calls_are_answered_or_refused(name, data):
    check(name, data)
