"""Mistakes drawn at random from what the package declares.

These are the ranges and choices of options and of arguments.

Each is refused with one line, which names what is wrong and says what is allowed. How each way of
refusing words it is tested where this way is defined.
"""

from hypothesis import given
from hypothesis import strategies as st
from random_laws import arguments
from random_mistakes import (
    given_arguments,
    options_are_refused,
    refuses_a_wrong_argument,
    right_arguments,
    typed_options,
)

import bouncing_ball_beyond as bb
from bouncing_ball_beyond.cli.commands import COMMANDS

# The command line.


# The commands of beyond.
TestOptions = options_are_refused(COMMANDS)


# Arguments of public functions.

BALL = bb.rigid(restitution=0.85)
CALLS = right_arguments(bb) | {
    "contact_law": {"law": "tsuji", "restitution": 0.85, "duration": 0.1},
    "motion_of": {"ball": BALL, "amplitude": 1.0},
    "lyapunov_exponent": {"ball": BALL, "amplitude": 1.0},
    "orbit_diagram": {"ball": BALL, "amplitude": [0.9, 1.0]},
    "basins": {"ball": BALL, "amplitude": 1.0},
    "orbit_of_motion": {"ball": BALL, "amplitude": 1.0},
}
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
    assert len(typed_options(COMMANDS)) > 60 and len(GIVEN) > 40
    assert {call for call, *_ in GIVEN} == CALLS.keys()
