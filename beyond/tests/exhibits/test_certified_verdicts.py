"""Verdicts on intervals against printed digits."""

import numpy as np
import pytest
from bouncing_ball_beyond.exhibits.certified_verdicts import interval_against_print
from hypothesis import assume, given
from hypothesis import strategies as st

from bouncing_ball.errors import ModelError
from bouncing_ball.paper.claims.verdict import CLOSE_UNITS, Verdict, against_print


@pytest.mark.parametrize(
    ("low", "high", "verdict"),
    [
        (0.2546, 0.2554, Verdict.REPRODUCED),
        (0.25449999, 0.2546, Verdict.NOT_DECIDED),  # a part of it rounds to 0.254
        (0.2556, 0.2569, Verdict.CLOSE),
        (0.2531, 0.2544, Verdict.CLOSE),
        (0.2556, 0.2571, Verdict.NOT_DECIDED),
        (0.2571, 0.26, Verdict.CONTRADICTED),
        (0.1, 0.2529, Verdict.CONTRADICTED),
        (0.25, 0.26, Verdict.NOT_DECIDED),
    ],
)
def test_an_interval_has_the_verdict_that_all_its_numbers_have(low, high, verdict):
    found = interval_against_print([(low + high) / 2, low, high], "0.255")
    assert found.verdict is verdict
    assert (found.low, found.high) == (low, high)


@given(st.floats(-9, 9), st.floats(0, 4))
def test_no_number_of_an_interval_has_another_verdict(off, width):
    """The verdict on an interval is that on each of its numbers, or there is none."""
    low = 82 + off
    high = low + width
    # A single number is also reproduced or close if rounding may have moved it from a bound.
    bounds = (0.5, CLOSE_UNITS)
    assume(all(abs(abs(x - 82) - bound) > 1e-8 for x in (low, high) for bound in bounds))
    numbers = np.linspace(low, high, 41)
    parts = {against_print(number, "82").verdict for number in numbers}
    whole = interval_against_print([(low + high) / 2, low, high], "82").verdict
    if whole is not Verdict.NOT_DECIDED:
        assert parts == {whole}
    if len(parts) > 1:
        assert whole is Verdict.NOT_DECIDED


def test_no_rounding_decides_in_favour_of_an_interval():
    # A single number next to the tie is reproduced, an interval beyond it is not.
    beyond = 82.5 + 1e-10
    assert against_print(beyond, "82").verdict is Verdict.REPRODUCED
    assert interval_against_print([82.4, 82.3, beyond], "82").verdict is Verdict.NOT_DECIDED
    assert interval_against_print([82.4, 82.3, 82.5], "82").verdict is Verdict.REPRODUCED


@pytest.mark.parametrize("limits", [(82.3, 82.1), (81.0, 81.5), (-np.inf, 83.0), (80.0, np.inf)])
def test_limits_that_do_not_contain_the_number_are_refused(limits):
    with pytest.raises(ModelError, match="is no interval around"):
        interval_against_print([82.2, *limits], "82")
