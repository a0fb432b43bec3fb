"""Verdicts on numbers against printed digits, and on conditions."""

import numpy as np
import pytest
import xarray as xr
from hypothesis import assume, given
from hypothesis import strategies as st

from bouncing_ball.errors import ModelError
from bouncing_ball.paper.claims.verdict import (
    CLOSE_UNITS,
    Verdict,
    above,
    against_print,
    at_least,
    at_most,
    below,
    largest_number,
    smallest,
)


@given(st.integers(-(10**6), 10**6).filter(bool), st.integers(0, 6), st.floats(-9, 9))
def test_a_number_is_judged_by_units_of_its_last_digit(digits, decimals, off):
    text = f"{digits / 10**decimals:.{decimals}f}"
    unit = 10.0**-decimals
    if min(abs(abs(off) - 0.5), abs(abs(off) - CLOSE_UNITS)) < 1e-6:
        return
    found = against_print(float(text) + off * unit, text)
    expected = (
        Verdict.REPRODUCED
        if abs(off) < 0.5
        else Verdict.CLOSE
        if abs(off) < CLOSE_UNITS
        else Verdict.CONTRADICTED
    )
    assert found.verdict is expected
    assert found.deviation_units == pytest.approx(off, abs=1e-8)
    assert found.deviation == pytest.approx(off * unit / abs(float(text)), abs=1e-8)
    assert (found.required, np.isnan(found.limit)) == (text, True)


@pytest.mark.parametrize(
    ("value", "printed", "verdict"),
    [
        (0.2545, "0.255", Verdict.REPRODUCED),  # half a unit
        (0.2575, "0.255", Verdict.CONTRADICTED),
        (0.253, "0.255", Verdict.CLOSE),  # two units
        (-1.26, "-1.3", Verdict.REPRODUCED),
    ],
)
def test_ties_are_decided_in_favour_of_the_paper(value, printed, verdict):
    assert against_print(value, printed).verdict is verdict


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
    found = against_print([(low + high) / 2, low, high], "0.255")
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
    whole = against_print([(low + high) / 2, low, high], "82").verdict
    if whole is not Verdict.NOT_DECIDED:
        assert parts == {whole}
    if len(parts) > 1:
        assert whole is Verdict.NOT_DECIDED


def test_no_rounding_decides_in_favour_of_an_interval():
    # A single number next to the tie is reproduced, an interval beyond it is not.
    beyond = 82.5 + 1e-10
    assert against_print(beyond, "82").verdict is Verdict.REPRODUCED
    assert against_print([82.4, 82.3, beyond], "82").verdict is Verdict.NOT_DECIDED
    assert against_print([82.4, 82.3, 82.5], "82").verdict is Verdict.REPRODUCED


@pytest.mark.parametrize("limits", [(82.3, 82.1), (81.0, 81.5), (-np.inf, 83.0), (80.0, np.inf)])
def test_limits_that_do_not_contain_the_number_are_refused(limits):
    with pytest.raises(ModelError, match="is no interval around"):
        against_print([82.2, *limits], "82")


@pytest.mark.parametrize(
    ("condition", "sign", "holding", "failing", "decides"),
    [
        (at_most, "≤", [1, 2], [1, 2.001], max),
        (at_least, "≥", [3, 2], [3, 1.999], min),
        (below, "<", [1, 1.999], [1, 2], max),
        (above, ">", [3, 2.001], [3, 2], min),
    ],
)
def test_conditions_hold_for_all_values(condition, sign, holding, failing, decides):
    for values, verdict in ((holding, Verdict.REPRODUCED), (failing, Verdict.CONTRADICTED)):
        found = condition(values, 2)
        assert found.verdict is verdict
        assert (found.found, found.limit, found.required) == (decides(values), 2, f"{sign} 2")
        assert np.isnan(found.deviation_units) and np.isnan(found.deviation)


def test_rounding_decides_nothing_on_a_bound():
    assert at_most(0.1 + 0.2, 0.3).verdict is Verdict.REPRODUCED
    assert at_least(-0.1 - 0.2, -0.3).verdict is Verdict.REPRODUCED
    assert at_most(1e-12, 0).verdict is Verdict.CONTRADICTED


@pytest.mark.parametrize("decide", [largest_number, smallest, lambda x: at_most(x, 1)])
@pytest.mark.parametrize("values", [[], [1.0, np.nan], xr.DataArray([np.nan], name="height")])
def test_what_is_missing_is_not_passed_over(decide, values, refusal):
    with refusal(ModelError, "numbers missing"):
        decide(values)


def test_a_missing_bound_decides_nothing():
    with pytest.raises(ModelError):
        at_most(1.0, np.nan)
