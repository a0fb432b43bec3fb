"""Arrays with labels as arguments of calls: what their labels may say, and what is refused."""

import numpy as np
import pytest
from labels_of_arguments import (
    LONG,
    LabelsOfArguments,
    every_wrong_object,
    refuses_an_array_along_one_value,
    refuses_in_one_short_line,
)

import bouncing_ball_beyond as bb
from bouncing_ball_beyond.inherited.errors import ModelError

BALL = bb.rigid(restitution=0.85)
LAW = bb.contact_law("hunt-crossley", restitution=0.7, duration=0.3)


class TestLabelsOfArguments(LabelsOfArguments):
    """The calls that the root has as well, here on this house's own code."""

    bb = bb


def test_an_array_along_an_argument_with_one_value_is_refused(refusal):
    refuses_an_array_along_one_value(bb, refusal, bb.motion_of)


@every_wrong_object
@pytest.mark.parametrize(
    "call",
    [
        lambda bb, wrong: bb.follow(bb.orbit(BALL, amplitude=1.0), along=wrong, to=1.1),
        lambda bb, wrong: bb.contact_law(wrong, restitution=0.5, duration=0.1),
    ],
    ids=["along", "law"],
)
def test_any_object_is_refused_in_one_short_line(call, wrong):
    refuses_in_one_short_line(bb, call, wrong)


@pytest.mark.parametrize(
    ("call", "text"),
    [
        (lambda: bb.orbit(LAW, amplitude=LONG), "100001 results exceed the limit of 100000"),
        (lambda: bb.motion_of(BALL, amplitude=np.full(20_000_001, 1.0)), "20000001 places of a"),
        (lambda: bb.basins(BALL, amplitude=1.0, starts=5000), "balls exceed the limit of 20000000"),
    ],
)
def test_results_that_would_fill_the_memory_are_refused_before_they_are_computed(
    call, text, refusal
):
    with refusal(ModelError, text, "use fewer"):
        call()
