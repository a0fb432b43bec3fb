"""Mistakes drawn at random from what a house declares, and how each is refused: by one line.

``draw`` is the function that draws from a strategy, as hypothesis gives it to a test.
"""

import argparse
import functools
import inspect
import math
import shlex
from collections.abc import Callable, Iterable, Mapping
from types import ModuleType
from typing import Any

import numpy as np
import pytest
from declared_arguments import Arguments, Declared
from hypothesis import given
from hypothesis import strategies as st

from bouncing_ball_beyond.inherited.cli.answers import parser
from bouncing_ball_beyond.inherited.errors import ModelError, Range
from bouncing_ball_beyond.inherited.models.spring_damper import LOSSES

NUMBERS = st.floats() | st.integers() | st.sampled_from([10**400, -1, 0, 1.5, 5e-324, 1e300])
# Words that begin no number, no name and no choice.
WORDS = st.text("qxyz#_ ", min_size=1, max_size=30).filter(str.strip)
UNKNOWN = st.text("qxyz", min_size=1, max_size=12)
"""Words that are no option."""


def is_float(value: object) -> bool:
    return isinstance(value, float)


def outside(allowed: Range) -> st.SearchStrategy:
    """Numbers outside a range, often just beyond its ends."""
    low = allowed.low
    high = allowed.high
    ends = [math.nextafter(low, -math.inf), math.nextafter(high, math.inf)]
    if allowed.ends[0] == "(":
        ends.append(low)
    if allowed.ends[1] == ")":
        ends.append(high)
    if allowed.whole:
        ends.append(low + 0.5)
    return st.sampled_from(ends) | NUMBERS.filter(lambda value: value not in allowed)


# The command line.

TypedOption = tuple[str, str, argparse.Action]


def options(command: str) -> dict[str, argparse.Action]:
    """The options of a command that take a number in a range, or one of several names."""
    (commands,) = parser([command])._subparsers._group_actions
    found = commands.choices[command]._option_string_actions
    return {k: each for k, each in found.items() if each.choices or range_of(each)}


def range_of(action: argparse.Action) -> Range | None:
    """The range that the parser of a number holds."""
    if not inspect.isfunction(action.type):
        return None
    return inspect.getclosurevars(action.type).nonlocals.get("allowed")


def typed_options(commands: Mapping[str, Any]) -> list[TypedOption]:
    """An example of each command with each of these options."""
    return [
        (about.examples[0], name, action)
        for command, about in commands.items()
        for name, action in options(command).items()
    ]


def refuses_a_wrong_option(refused: Callable, draw: Callable, case: TypedOption) -> None:
    example, name, action = case
    allowed = range_of(action)
    wrong = WORDS if allowed is None else WORDS | outside(allowed).map(repr)
    if action.nargs == 2:
        more = [name, "1", draw(wrong.filter(lambda text: not text.startswith("-")))]
    else:
        # After a sign of equality any text is a value, even if it begins with a dash.
        more = [f"{name}={draw(wrong)}"]
    words = shlex.split(example) + more
    status, line = refused(*words)
    assert status == 2 and line.startswith(f"bouncing-ball: argument {name}: ")
    assert all(choice in line for choice in action.choices or [str(allowed)]), line


def refuses_an_unknown_option(refused: Callable, example: str, word: str) -> None:
    status, line = refused(*shlex.split(example), f"--{word}=1")
    assert status == 2 and f"unrecognized arguments: --{word}=1" in line


def options_are_refused(commands: Mapping[str, Any]) -> type:
    """A class of tests of the options of these commands.

    Each call makes functions of its own, because Hypothesis refuses a test that several classes
    inherit: it would keep the examples of one for another.
    """

    @functools.cache
    def cases() -> list[TypedOption]:
        return typed_options(commands)

    class OptionsAreRefused:
        @given(st.data())
        def test_a_wrong_option_is_refused(self, refused, data):
            case = data.draw(st.sampled_from(cases()))
            refuses_a_wrong_option(refused, data.draw, case)

        @given(st.data(), UNKNOWN)
        def test_an_unknown_option_is_refused(self, refused, data, word):
            command = data.draw(st.sampled_from(sorted(commands)))
            refuses_an_unknown_option(refused, commands[command].examples[0], word)

    return OptionsAreRefused


# Arguments of public functions.

DeclaredArgument = tuple[str, str, Declared]


def given_arguments(arguments: Arguments, calls: Iterable[str]) -> list[DeclaredArgument]:
    """The declared arguments of these calls."""
    return [(call, name, allowed) for call in calls for name, allowed in arguments(call).items()]


def right_arguments(package: ModuleType) -> dict[str, dict[str, Any]]:
    """Arguments that are right, by the names of the calls that both houses of balls have."""
    ball = package.rigid(restitution=0.85)
    return {
        "rigid": {}, "spring_damper": {"restitution": 0.85, "frequency_ratio": 10.0},
        "simulate": {"ball": ball, "amplitude": 1.0}, "history": {"ball": ball, "amplitude": 1.0},
        "drop": {"ball": ball, "height": 1.0}, "orbit": {"ball": ball, "amplitude": 1.0},
        "orbits": {"ball": ball, "amplitude": 1.0}, "limits": {"ball": ball},
        "branch": {"ball": ball}, "error_thresholds": {"ball": ball, "amplitude": 1.0},
    }  # fmt: skip


def refuses_a_wrong_argument(
    draw: Callable, package: ModuleType, calls: Mapping[str, dict], case: DeclaredArgument
) -> None:
    """``calls`` has the arguments of calls that are right."""
    call, name, allowed = case
    right = {k: v for k, v in calls[call].items() if not {k, name} <= set(LOSSES)}
    if isinstance(allowed, Range):
        number = outside(allowed)
        odd = st.sampled_from([True, "1", b"1", 1j, {}, object()])
        several = st.lists(number, min_size=1, max_size=3)
        array = st.lists(outside(allowed).filter(is_float), min_size=1, max_size=3).map(np.array)
        wrong = draw(number | WORDS | odd | several | array)
        said = "must be a single number", f"is not {allowed}"
    else:
        wrong = draw(WORDS | NUMBERS | st.just(True))
        said = (f"is not one of {', '.join(allowed)}",)
    with pytest.raises(ModelError) as error:
        getattr(package, call)(**right | {name: wrong})
    line = str(error.value)
    assert "\n" not in line and line.startswith(name) and any(x in line for x in said), line
