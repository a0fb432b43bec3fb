"""The tables of claims and formulas as texts."""

import numpy as np
import pytest
import xarray as xr

from bouncing_ball.claims.assessment import assess
from bouncing_ball.figures.tables import claims, formulas


def table(result):
    header, body = claims.rows(result)
    assert all(len(line) == len(header) for line in body)
    return {line[0]: dict(zip(header, line, strict=True)) for line in body}


def test_one_row_for_each_claim(ledger, number, statement, data):
    rows = table(assess(ledger(number, statement), data))
    assert rows["height"] == {
        "claim": "height",
        "where": "Fig. 14",
        "what the paper says": "the threshold",
        "printed or required": "82",
        "found": "82.18",
        "deviation": "+0.18 (+0.22 %)",
        "verdict": "reproduced",
    }
    assert rows["rises"]["found"] == "-0.25" and rows["rises"]["deviation"] == ""


@pytest.mark.parametrize(
    ("printed", "value", "text"),
    [("82", 82.17736, "82.18"), ("0.750", 0.7507349, "0.75073"), ("0.1359", 0.13585, "0.135850")],
)
def test_two_digits_more_than_printed(ledger, number, data, printed, value, text):
    data["fig"]["threshold"] = value
    assert table(assess(ledger(number | {"printed": printed}), data))["height"]["found"] == text


def test_nothing_found_is_a_dash(ledger, number, data):
    rows = table(assess(ledger(number, parameters={"fig": {"n": 2}}), data))
    assert (rows["height"]["found"], rows["height"]["deviation"]) == ("–", "")
    assert rows["height"]["printed or required"] == "82"


def test_a_number_of_the_size_of_rounding_is_its_bound(ledger, statement, data):
    statement["condition"] = {"at_most": {"variable": "budget"}}
    for found, text in ((1e-16, "≤ 1e-12"), (9e-13, "≤ 1e-12"), (2e-12, "2e-12")):
        data["fig"] = data["fig"].assign(rise=("n", [found] * 3), budget=1e-12)
        assert table(assess(ledger(statement), data))["rises"]["found"] == text


def test_an_infinite_error_is_shown(ledger, statement, data):
    data["fig"]["rise"] = ("n", [np.inf, np.inf, np.inf])
    assert table(assess(ledger(statement), data))["rises"]["found"] == "inf"


def test_formulas():
    data = xr.Dataset(
        {
            "disagreement": ("formula", [1.64e-14, 0.0884]),
            "budget": ("formula", [1e-12, 1e-8]),
            "compared_with": ("formula", ["simulation", "a multiplier"]),
        },
        coords={"formula": ["Eq. 5", "Eq. 8"]},
    )
    header, body = formulas.rows(data)
    assert header == ["formula", "compared with", "largest disagreement", "allowed"]
    assert body == [
        ["Eq. 5", "simulation", "≤ 1e-12", "1e-12"],
        ["Eq. 8", "a multiplier", "8.8e-02", "1e-08"],
    ]
