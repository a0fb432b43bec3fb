"""Verdicts on numbers against printed digits, and on conditions."""

import numpy as np
import pytest
import xarray as xr
from hypothesis import given
from hypothesis import strategies as st

from bouncing_ball.errors import ModelError
from bouncing_ball.paper.claims.verdict import (
    LAST_DIGITS,
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
    last_digits = LAST_DIGITS * abs(digits)
    if min(abs(abs(off) - 0.5), abs(abs(off) - last_digits)) < 1e-6:
        return
    found = against_print(float(text) + off * unit, text)
    expected = (
        Verdict.REPRODUCED
        if abs(off) < 0.5
        else Verdict.DIFFERS
        if abs(off) < last_digits
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
        (0.2576, "0.255", Verdict.CONTRADICTED),
        (0.25755, "0.255", Verdict.DIFFERS),  # a hundredth
        (6.4, "6", Verdict.REPRODUCED),  # half a unit is more than a hundredth
        (6.6, "6", Verdict.CONTRADICTED),
        (-1.26, "-1.3", Verdict.REPRODUCED),
    ],
)
def test_ties_are_decided_in_favour_of_the_paper(value, printed, verdict):
    assert against_print(value, printed).verdict is verdict


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
