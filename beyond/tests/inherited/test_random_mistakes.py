"""Mistakes drawn at random from what the package declares.

These are the ranges and choices of options and arguments, and the types of the configuration.

Each is refused with one line, which names what is wrong and says what is allowed. How each way of
refusing words it is tested where this way is defined.
"""

import copy
import math
import string
import typing
from pathlib import Path

import pytest
from declared_arguments import arguments_of
from hypothesis import given, settings
from hypothesis import strategies as st
from random_mistakes import (
    WORDS,
    given_arguments,
    options_are_refused,
    refuses_a_wrong_argument,
    right_arguments,
    typed_options,
)

import bouncing_ball_beyond.inherited as bb
from bouncing_ball_beyond.exhibits.configuration import Configuration
from bouncing_ball_beyond.inherited.cli.commands import COMMANDS
from bouncing_ball_beyond.inherited.models.model import Model
from bouncing_ball_beyond.inherited.pipeline.configuration_check import check_parameters, place
from bouncing_ball_beyond.inherited.pipeline.yaml_files import ConfigurationError, read_yaml

ROOT = Path(__file__).parents[2]

# The command line.


# The commands of the root.
TestOptions = options_are_refused(COMMANDS)


# Arguments of public functions.

CALLS = right_arguments(bb)
"""Arguments of calls that are right."""


GIVEN = given_arguments(arguments_of(bb, Model), CALLS)


@given(st.data(), st.sampled_from(GIVEN))
def test_a_wrong_argument_is_refused(data, case):
    refuses_a_wrong_argument(data.draw, bb, CALLS, case)


def test_the_declarations_are_found():
    assert len(typed_options(COMMANDS)) > 30 and len(GIVEN) > 25
    assert {call for call, *_ in GIVEN} == CALLS.keys()


# The configuration.

CONFIG = read_yaml(ROOT / "config" / "config.yaml")
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
def test_a_wrong_value_in_the_configuration_is_refused(refusal, path, wrong):
    config = copy.deepcopy(CONFIG)
    section = config
    for key in path[:-1]:
        section = section[key]
    section[path[-1]] = wrong
    with refusal(ConfigurationError, place(path), " must "):
        check_parameters(Configuration, config)


@given(
    st.sampled_from([p for p in leaves(CONFIG) if isinstance(p[-1], str)]),
    st.text(string.ascii_lowercase, min_size=12),
)
@FEW
def test_an_unknown_key_in_the_configuration_is_refused(refusal, path, word):
    config = copy.deepcopy(CONFIG)
    section = config
    for key in path[:-1]:
        section = section[key]
    known = list(section)
    section[word] = section.pop(path[-1])
    with pytest.raises(ConfigurationError) as error:
        check_parameters(Configuration, config)
    # The key that has another name now is missing.
    unknown, *missing = str(error.value).splitlines()
    assert unknown.startswith(f"unknown key {place((*path[:-1], word))} = ")
    assert all(key in unknown for key in known)
    assert all(line.startswith(f"missing key {place(path)}") for line in missing)
