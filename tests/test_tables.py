"""Table 1, the thresholds and the hypotheses on the printed numbers as texts."""

import json

import numpy as np
import pytest
import xarray as xr

from carbonelli2011 import tables

BOUNDS = ["saddle-node", "period doubling"]
ROWS = [1e4, 10.0, 2.0]
PARAMETERS = {
    "n": [1, 2, 3],
    "restitution": 0.85,
    "frequency_ratio": ROWS,
    "release": "displacement",
}


@pytest.fixture
def ends():
    """Table 1, whose first row is an end that rounds to the printed one, and one that does not."""
    shape = ("frequency_ratio", "n", "bound")
    unprinted = [[np.nan] * 2] * 3
    return xr.Dataset(
        {
            "computed": (shape, [[[0.25471, 1.0383]] * 3] * 3),
            "printed": (shape, [[[0.255, 1.032], *unprinted[1:]], unprinted, unprinted]),
            "admissible": (shape, [[[True, True]] * 3] * 3),
        },
        {"frequency_ratio": ROWS, "n": PARAMETERS["n"], "bound": BOUNDS},
        {"parameters": json.dumps(PARAMETERS)},
    )


def test_each_printed_end_has_its_verdict(ends):
    header, *rows = tables.table1(ends)
    assert header == ["ϖ", "n", "end", "computed", "printed", "distance", "verdict"]
    assert rows[0][3:] == ["0.25471", "0.255", "rounds to 0.255", "reproduced"]
    assert rows[1][3:] == ["1.03830", "1.032", "+6.3 units, +0.61 %", "not reproduced"]
    assert len(rows) == ends["computed"].size


def test_an_end_within_a_unit_is_named_as_such(ends):
    ends["computed"][0, 0, 1] = 1.0328
    assert tables.table1(ends)[2][-2:] == [
        "+0.8 units, +0.08 %, within one unit of the last digit",
        "not reproduced",
    ]


def test_an_end_that_does_not_exist_has_no_number(ends):
    ends["computed"][0, 0, 1] = np.nan
    assert tables.table1(ends)[2][3:] == ["no such bifurcation", "1.032", "", "not asked"]


def test_an_end_that_no_ball_follows_is_marked(ends):
    ends["admissible"][0, 0, 1] = False
    assert tables.table1(ends)[2][3] == "1.03830, which no ball follows"


def test_an_end_that_is_not_printed_has_no_verdict(ends):
    ends["printed"][0, 0, 1] = np.nan
    assert tables.table1(ends)[2][3:] == ["1.03830", "", "", ""]


def test_table_1_under_other_parameters_is_not_judged(ends):
    ends.attrs["parameters"] = json.dumps(PARAMETERS | {"restitution": 0.7})
    assert [row[-1] for row in tables.table1(ends)[1:3]] == ["not asked", "not asked"]


def test_a_threshold_outside_of_the_scan_is_a_bound():
    data = xr.Dataset(
        {
            "error_threshold": (("quantity", "tolerance"), [[np.nan, 82.1774, np.nan]]),
            "threshold_status": (("quantity", "tolerance"), [["within", "found", "exceeded"]]),
            "admissible": (("quantity", "frequency_ratio"), [[True, True, True]]),
        },
        {
            "quantity": ["max_height"],
            "tolerance": [0.1, 0.01, 0.005],
            "frequency_ratio": [20.0, 50.0, 100.0],
        },
        {"parameters": json.dumps({"n": 1, "restitution": 0.65, "amplitude": 1.0})},
    )
    assert tables.thresholds(data) == [
        [
            "error of an orbit with n = 1, r = 0.65, Λ = 1, relative; of the phase in periods",
            "10 %",
            "1 %",
            "0.5 %",
        ],
        ["maximum height", "< 20", "82.177", "> 100"],
    ]
    data["threshold_status"] = data.threshold_status.copy(
        data=[["first orbit", "found", "no orbit"]]
    )
    data["admissible"][0, 1] = False
    assert tables.thresholds(data)[1][1:] == [
        "from where the orbit begins",
        "82.177, which no ball follows",
        "no orbit at 100",
    ]


def test_hypotheses_have_their_distances_and_counts():
    """Names of numbers are not parsed: the variable `row` says which are ends of Table 1."""
    over = ("hypothesis", "number")
    data = xr.Dataset(
        {
            "found": (over, [[0.2547, 1.0383, 0.5, 82.177], [0.2552, np.nan, 0.5, np.nan]]),
            "deviation_units": (over, [[-0.3, 6.3, 0.0, 0.177], [0.2, np.nan, 0.0, np.nan]]),
            "agrees": (over, [[True, False, True, True], [True, False, True, False]]),
            "rms_difference": ("hypothesis", [2.884, np.nan]),
            "printed_text": ("number", ["0.255", "1.032", "0.500", "82"]),
            "row": ("number", [2.0, 2.0, 1e4, np.nan]),
        },
        {
            "hypothesis": ["equations as they stand", "other"],
            "number": ["a saddle-node", "a period doubling", "another", "height"],
        },
    )
    heads = ["Table 1, ϖ = 2", "Table 1, ϖ = 10000", "root mean square distance, compliant rows"]
    heads += ["height, printed 82", "reproduced"]
    assert tables.hypotheses(data) == [
        ["hypothesis", *heads],
        ["equations as they stand", "1 of 2", "1 of 1", "2.88", "82.18 (+0.18)", "3 of 4"],
        ["other", "1 of 2", "1 of 1", "–", "–", "2 of 4"],
    ]
