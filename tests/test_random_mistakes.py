"""Mistakes drawn at random from what the package declares.

These are the ranges and choices of options and arguments, and the types of the configuration.

Each is refused with one line, which names what is wrong and says what is allowed. How each way of
refusing words it is tested where this way is defined.
"""

import argparse
import copy
import inspect
import math
import shlex
import string
import typing
from pathlib import Path

import numpy as np
import pytest
from declared_arguments import arguments
from declared_artifacts import ARTIFACTS
from hypothesis import given, settings
from hypothesis import strategies as st
from whole_configuration import configuration_type

import bouncing_ball as bb
from bouncing_ball.cli.answers import parser
from bouncing_ball.cli.commands import COMMANDS
from bouncing_ball.errors import ModelError, Range
from bouncing_ball.models.spring_damper import LOSSES
from bouncing_ball.pipeline.configuration import check_parameters, place
from bouncing_ball.pipeline.yaml_files import ConfigurationError, read_yaml

ROOT = Path(__file__).parents[1]
NUMBERS = st.floats() | st.integers() | st.sampled_from([10**400, -1, 0, 1.5, 5e-324, 1e300])
# Words that begin no number, no name and no choice.
WORDS = st.text("qxyz#_ ", min_size=1, max_size=30).filter(str.strip)


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


TYPED = [
    (about.examples[0], name, action)
    for command, about in COMMANDS.items()
    for name, action in options(command).items()
]


@given(st.data(), st.sampled_from(TYPED))
def test_a_wrong_option_is_refused(refused, data, case):
    example, name, action = case
    allowed = range_of(action)
    wrong = WORDS if allowed is None else WORDS | outside(allowed).map(repr)
    # After a sign of equality any text is a value, even if it begins with a dash.
    words = [*shlex.split(example), f"{name}={data.draw(wrong)}"]
    status, line = refused(*words)
    assert status == 2 and line.startswith(f"bouncing-ball: argument {name}: ")
    assert all(choice in line for choice in action.choices or [str(allowed)]), line


@given(st.sampled_from(sorted(COMMANDS)), st.text("qxyz", min_size=1, max_size=12))
def test_an_unknown_option_is_refused(refused, command, word):
    status, line = refused(*shlex.split(COMMANDS[command].examples[0]), f"--{word}=1")
    assert status == 2 and f"unrecognized arguments: --{word}=1" in line


# Arguments of public functions.

BALL = bb.rigid(restitution=0.85)
CALLS = {
    "rigid": {}, "spring_damper": {"restitution": 0.85, "frequency_ratio": 10.0},
    "simulate": {"ball": BALL, "amplitude": 1.0}, "history": {"ball": BALL, "amplitude": 1.0},
    "drop": {"ball": BALL, "height": 1.0}, "orbit": {"ball": BALL, "amplitude": 1.0},
    "orbits": {"ball": BALL, "amplitude": 1.0}, "limits": {"ball": BALL},
    "branch": {"ball": BALL}, "error_thresholds": {"ball": BALL, "amplitude": 1.0},
}  # fmt: skip
"""Arguments of calls that are right."""


GIVEN = [(call, name, allowed) for call in CALLS for name, allowed in arguments(call).items()]


@given(st.data(), st.sampled_from(GIVEN))
def test_a_wrong_argument_is_refused(refusal, data, case):
    call, name, allowed = case
    right = {k: v for k, v in CALLS[call].items() if not {k, name} <= set(LOSSES)}
    if isinstance(allowed, Range):
        number = outside(allowed)
        odd = st.sampled_from([True, "1", b"1", 1j, {}, object()])
        several = st.lists(number, min_size=1, max_size=3)
        array = st.lists(outside(allowed).filter(is_float), min_size=1, max_size=3).map(np.array)
        wrong = data.draw(number | WORDS | odd | several | array)
        said = "must be a single number", f"is not {allowed}"
    else:
        wrong = data.draw(WORDS | NUMBERS | st.just(True))
        said = (f"is not one of {', '.join(allowed)}",)
    with pytest.raises(ModelError) as error:
        getattr(bb, call)(**right | {name: wrong})
    line = str(error.value)
    assert "\n" not in line and line.startswith(name) and any(x in line for x in said), line


def test_the_declarations_are_found():
    assert len(TYPED) > 30 and len(GIVEN) > 25
    assert {call for call, *_ in GIVEN} == CALLS.keys()


# The configuration.

CONFIG = read_yaml(ROOT / "config" / "config.yaml")
STUDIES = configuration_type(ARTIFACTS.values())
# The whole configuration is checked each time, with a search for the orbits that are new.
FEW = settings(max_examples=15)


def leaves(value: typing.Any, path: tuple = ()) -> typing.Iterator[tuple]:
    """The places of the numbers and texts of the configuration."""
    if not isinstance(value, dict | list):
        yield path
        return
    for key, each in value.items() if isinstance(value, dict) else enumerate(value):
        yield from leaves(each, (*path, key))


@given(
    st.sampled_from(list(leaves(CONFIG))),
    st.sampled_from([{}, [], None, math.nan, math.inf, -1e300, ""]) | WORDS,
)
@FEW
@pytest.mark.usefixtures("searched_once")
def test_a_wrong_value_in_the_configuration_is_refused(refusal, path, wrong):
    config = copy.deepcopy(CONFIG)
    section = config
    for key in path[:-1]:
        section = section[key]
    section[path[-1]] = wrong
    with refusal(ConfigurationError, place(path), " must "):
        check_parameters(STUDIES, config)


@given(
    st.sampled_from([p for p in leaves(CONFIG) if isinstance(p[-1], str)]),
    st.text(string.ascii_lowercase, min_size=12),
)
@FEW
@pytest.mark.usefixtures("searched_once")
def test_an_unknown_key_in_the_configuration_is_refused(refusal, path, word):
    config = copy.deepcopy(CONFIG)
    section = config
    for key in path[:-1]:
        section = section[key]
    known = list(section)
    section[word] = section.pop(path[-1])
    with pytest.raises(ConfigurationError) as error:
        check_parameters(STUDIES, config)
    # The key that has another name now is missing.
    unknown, *missing = str(error.value).splitlines()
    assert unknown.startswith(f"unknown key {place((*path[:-1], word))} = ")
    assert all(key in unknown for key in known)
    assert all(line.startswith(f"missing key {place(path)}") for line in missing)
