"""Verdicts on intervals against printed digits."""

from fractions import Fraction

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from bouncing_ball.errors import ModelError
from bouncing_ball_beyond.exhibits.certified_verdicts import Verdict, interval_against_print

# The largest relative distance from a printed number at which only last digits differ.
LAST_DIGITS = 0.01


def of_a_number(number, printed):
    """The verdict on an exact number by its distance in units of the last printed digit."""
    unit = Fraction(1, 10 ** len(printed.partition(".")[2]))
    distance = abs(Fraction(number) - Fraction(printed)) / unit
    if distance <= Fraction(1, 2):
        return Verdict.REPRODUCED
    within = abs(Fraction(number) / Fraction(printed) - 1) <= Fraction(1, 100)
    return Verdict.DIFFERS if within else Verdict.CONTRADICTED


@pytest.mark.parametrize(
    ("low", "high", "verdict"),
    [
        (0.2546, 0.2554, Verdict.REPRODUCED),
        (0.25449999, 0.2546, Verdict.NOT_DECIDED),  # a part of it rounds to 0.254
        (0.2556, 0.2575, Verdict.DIFFERS),
        (0.2525, 0.2544, Verdict.DIFFERS),
        (0.2556, 0.2576, Verdict.NOT_DECIDED),
        (0.2576, 0.26, Verdict.CONTRADICTED),
        (0.1, 0.2524, Verdict.CONTRADICTED),
        (0.25, 0.26, Verdict.NOT_DECIDED),
    ],
)
def test_an_interval_has_the_verdict_that_all_its_numbers_have(low, high, verdict):
    found = interval_against_print([(low + high) / 2, low, high], "0.255", LAST_DIGITS)
    assert found is verdict


@given(st.floats(-9, 9), st.floats(0, 4))
def test_no_number_of_an_interval_has_another_verdict(off, width):
    """The verdict on an interval is that on each of its numbers, or there is none."""
    low = 82 + off
    high = low + width
    assume(low <= (low + high) / 2 <= high)
    parts = {of_a_number(number, "82") for number in np.linspace(low, high, 41)}
    whole = interval_against_print([(low + high) / 2, low, high], "82", LAST_DIGITS)
    if whole is not Verdict.NOT_DECIDED:
        assert parts == {whole}
    if len(parts) > 1:
        assert whole is Verdict.NOT_DECIDED


def test_no_rounding_decides_in_favour_of_an_interval():
    # An interval up to the tie is reproduced, and one that ends beyond it is not.
    beyond = 82.5 + 1e-10
    for end, verdict in ((82.5, Verdict.REPRODUCED), (beyond, Verdict.NOT_DECIDED)):
        assert interval_against_print([82.4, 82.3, end], "82", LAST_DIGITS) is verdict


@pytest.mark.parametrize("limits", [(82.3, 82.1), (81.0, 81.5), (-np.inf, 83.0), (80.0, np.inf)])
def test_limits_that_do_not_contain_the_number_are_refused(limits):
    with pytest.raises(ModelError, match="is no interval around"):
        interval_against_print([82.2, *limits], "82", LAST_DIGITS)
