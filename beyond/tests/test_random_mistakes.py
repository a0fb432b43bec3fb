"""Mistakes drawn at random from what the package declares.

These are the ranges and choices of options and of arguments.

Each is refused with one line, which names what is wrong and says what is allowed. How each way of
refusing words it is tested where this way is defined.
"""

from hypothesis import given
from hypothesis import strategies as st
from random_laws import arguments
from random_mistakes import (
    UNKNOWN,
    given_arguments,
    refuses_a_wrong_argument,
    refuses_a_wrong_option,
    refuses_an_unknown_option,
    typed_options,
)

import bouncing_ball_beyond as bb
from bouncing_ball_beyond.cli.commands import COMMANDS

# The command line.

TYPED = typed_options(COMMANDS)


@given(st.data(), st.sampled_from(TYPED))
def test_a_wrong_option_is_refused(refused, data, case):
    refuses_a_wrong_option(refused, data.draw, case)


@given(st.sampled_from(sorted(COMMANDS)), UNKNOWN)
def test_an_unknown_option_is_refused(refused, command, word):
    refuses_an_unknown_option(refused, COMMANDS[command].examples[0], word)


# Arguments of public functions.

BALL = bb.rigid(restitution=0.85)
CALLS = {
    "rigid": {}, "spring_damper": {"restitution": 0.85, "frequency_ratio": 10.0},
    "contact_law": {"law": "tsuji", "restitution": 0.85, "duration": 0.1},
    "simulate": {"ball": BALL, "amplitude": 1.0}, "history": {"ball": BALL, "amplitude": 1.0},
    "drop": {"ball": BALL, "height": 1.0}, "orbit": {"ball": BALL, "amplitude": 1.0},
    "orbits": {"ball": BALL, "amplitude": 1.0}, "limits": {"ball": BALL},
    "branch": {"ball": BALL}, "error_thresholds": {"ball": BALL, "amplitude": 1.0},
    "motion_of": {"ball": BALL, "amplitude": 1.0},
    "lyapunov_exponent": {"ball": BALL, "amplitude": 1.0},
    "orbit_diagram": {"ball": BALL, "amplitude": [0.9, 1.0]},
    "basins": {"ball": BALL, "amplitude": 1.0},
    "orbit_of_motion": {"ball": BALL, "amplitude": 1.0},
}  # fmt: skip
"""Arguments of calls that are right."""


GIVEN = [
    each
    for each in given_arguments(arguments, CALLS)
    # A release is for the parameters of one law only.
    if each[:2] != ("contact_law", "release")
]


@given(st.data(), st.sampled_from(GIVEN))
def test_a_wrong_argument_is_refused(data, case):
    refuses_a_wrong_argument(data.draw, bb, CALLS, case)


def test_the_declarations_are_found():
    assert len(TYPED) > 60 and len(GIVEN) > 40
    assert {call for call, *_ in GIVEN} == CALLS.keys()
