"""Verdicts at their boundaries, and what leaves a claim open."""

import json

import numpy as np
import pytest
import xarray as xr

from bouncing_ball.claims.ledger import Condition, Relation
from bouncing_ball.claims.verdict import (
    Verdict,
    decide,
    foreign_parameter,
    judge_condition,
    judge_number,
)
from bouncing_ball.errors import ModelError

REPRODUCED, CLOSE, CONTRADICTED, UNDECIDABLE, NOT_ASKED = Verdict


@pytest.mark.parametrize(
    ("value", "verdict"),
    [
        (82.0, REPRODUCED),
        # Exactly half a unit, to both sides, rounds to the printed number.
        (82.5, REPRODUCED),
        (81.5, REPRODUCED),
        (np.nextafter(82.5, 83) + 1e-6, CLOSE),
        # Exactly two units.
        (84.0, CLOSE),
        (80.0, CLOSE),
        (84.0 + 1e-6, CONTRADICTED),
        (80.0 - 1e-6, CONTRADICTED),
        (-82.0, CONTRADICTED),
        (np.inf, CONTRADICTED),
        (-np.inf, CONTRADICTED),
    ],
)
def test_a_number_against_82(value, verdict):
    assert judge_number(value, "82", None, 2).verdict is verdict


@pytest.mark.parametrize(("value", "verdict"), [(0.2555, REPRODUCED), (0.2545, REPRODUCED)])
def test_half_a_unit_in_decimals_that_binary_numbers_miss(value, verdict):
    assert judge_number(value, "0.255", None, 2).verdict is verdict
    # Two units are not 0.002 in binary; they still are on the bound.
    assert judge_number(0.502, "0.500", None, 2).verdict is CLOSE


def test_the_deviations_of_a_number():
    finding = judge_number(0.2400, "0.238", None, 2)
    assert finding.units == pytest.approx(2.0, abs=1e-10)
    assert finding.relative == pytest.approx(0.002 / 0.238, rel=1e-12)
    assert (finding.value, finding.required) == (0.24, "0.238")
    below = judge_number(-1.5, "-1", None, 2)
    assert (below.units, below.relative) == (-0.5, -0.5)


def test_a_given_unit_and_a_printed_zero():
    assert judge_number(54.2, "100", 100, 2).verdict is REPRODUCED
    assert judge_number(49.9, "100", 100, 2).verdict is CLOSE
    assert judge_number(-101.0, "100", 100, 2).verdict is CONTRADICTED
    zero = judge_number(2.7, "0", None, 2)
    assert zero.verdict is CONTRADICTED and np.isnan(zero.relative)
    assert judge_number(0.5, "0", None, 2).verdict is REPRODUCED


@pytest.mark.parametrize(
    ("relation", "below", "on", "above"),
    [
        (Relation.AT_MOST, REPRODUCED, REPRODUCED, CONTRADICTED),
        (Relation.AT_LEAST, CONTRADICTED, REPRODUCED, REPRODUCED),
        (Relation.BELOW, REPRODUCED, CONTRADICTED, CONTRADICTED),
        (Relation.ABOVE, CONTRADICTED, CONTRADICTED, REPRODUCED),
    ],
)
def test_strict_and_other_bounds(relation, below, on, above):
    condition = Condition(relation, "5")
    verdicts = [judge_condition(x, condition, 5.0).verdict for x in (4.0, 5.0, 6.0)]
    assert verdicts == [below, on, above]


@pytest.mark.parametrize(
    ("relation", "value", "verdict"),
    [
        # A condition holds or does not; nothing is close to it.
        (Relation.AT_MOST, 0.010001, CONTRADICTED),
        (Relation.AT_LEAST, 0.009999, CONTRADICTED),
        (Relation.BELOW, 0.011, CONTRADICTED),
        (Relation.ABOVE, 0.009, CONTRADICTED),
        (Relation.AT_MOST, np.inf, CONTRADICTED),
        (Relation.AT_LEAST, np.inf, REPRODUCED),
        (Relation.AT_LEAST, -np.inf, CONTRADICTED),
        # Rounding does not decide what lies on the bound.
        (Relation.AT_MOST, 0.01 * (1 + 1e-12), REPRODUCED),
        (Relation.AT_LEAST, 0.01 * (1 - 1e-12), REPRODUCED),
    ],
)
def test_a_condition_holds_or_does_not(relation, value, verdict):
    finding = judge_condition(value, Condition(relation, "0.01"), 0.01)
    assert finding.verdict is verdict
    assert np.isnan(finding.units) and np.isnan(finding.relative)


def test_a_bound_of_zero_is_exact_and_gives_no_deviation():
    finding = judge_condition(0.1, Condition(Relation.AT_MOST, "0"), 0.0)
    assert finding.verdict is CONTRADICTED
    assert np.isnan(finding.units) and np.isnan(finding.relative)


def test_a_bound_from_a_dataset_is_exact(ledger, statement):
    statement["condition"] = {"at_most": {"variable": "budget"}}
    statement["decided_by"] = {"dataset": "checks", "variable": "found", "at": {"formula": "b"}}
    book = ledger(statement)
    checks = xr.Dataset(
        {"found": ("formula", [9.0, 2.0]), "budget": ("formula", [0.0, 2.0])},
        coords={"formula": ["a", "b"]},
    )
    decision = decide(book.claims[0], book, {"checks": checks})
    assert decision.verdict is REPRODUCED and decision.finding.required == "≤ 2"
    checks["budget"][1] = 1.9
    decision = decide(book.claims[0], book, {"checks": checks})
    assert decision.verdict is CONTRADICTED and np.isnan(decision.finding.units)
    with pytest.raises(ModelError, match="checks has no variable budget"):
        decide(book.claims[0], book, {"checks": checks.drop_vars("budget")})


def test_a_missing_number_is_an_error_and_no_verdict(ledger, number, data):
    book = ledger(number)
    with pytest.raises(ModelError, match=r"^fig: threshold: 1 of 1 not a number$"):
        decide(book.claims[0], book, {"fig": data["fig"].assign(threshold=np.nan)})


def test_readings_that_disagree_leave_a_claim_open(ledger, number, data):
    source = number.pop("decided_by")
    readings = [
        {"reading": "first", "decided_by": source},
        {"reading": "second", "decided_by": {"dataset": "fig", "variable": "rise", "at": {"n": 1}}},
    ]
    book = ledger(number | {"readings": readings})
    decision = decide(book.claims[0], book, data)
    assert decision.verdict is UNDECIDABLE and decision.finding is None
    assert decision.reason == (
        "depends on the reading: first: reproduced (82.18); second: contradicted (0.5)"
    )
    # They agree: the first one's finding.
    readings[1]["decided_by"]["variable"] = "other"
    data["fig"]["other"] = ("n", [82.4, 0.0, 0.0])
    book = ledger(number | {"readings": readings})
    decision = decide(book.claims[0], book, data)
    assert decision.verdict is REPRODUCED and decision.finding.value == 82.18


def foreign(book, data):
    return foreign_parameter(book.claims[0], book, data)


@pytest.mark.parametrize(
    ("given", "paper", "same"),
    [
        (1, 1, True),
        (np.int64(1), 1.0, True),
        (2, 1, False),
        (0.65, 0.6500000001, False),
        # A list of one number is that number among the attributes.
        (np.float64(10.0), [10.0], True),
        (np.array([1.0, 2.0]), [1.0, 2.0], True),
        (np.array([2.0, 1.0]), [1.0, 2.0], False),
        (np.array([1.0, 2.0]), [1.0], False),
        ("displacement", "displacement", True),
        ("force", "displacement", False),
        (json.dumps([{"r": 1.0, "a": 0.8}]), [{"r": 1.0, "a": 0.8}], True),
        (json.dumps([{"r": 1.0, "a": 0.9}]), [{"r": 1.0, "a": 0.8}], False),
        (json.dumps([{"r": 1.0}]), [{"r": 1.0, "a": 0.8}], False),
        (1000.0, {"at_least": 1000.0}, True),
        (999.0, {"at_least": 1000.0}, False),
        (6.0, {"at_most": 6.0}, True),
        (6.1, {"at_most": 6.0}, False),
        (5.0, {"at_least": 5, "at_most": 5}, True),
        (np.array([0.1, 0.01]), {"includes": [0.01]}, True),
        (np.float64(0.01), {"includes": [0.01]}, True),
        (np.array([0.1, 0.02]), {"includes": [0.01]}, False),
        (json.dumps(["phase", "max"]), {"includes": ["max", "phase"]}, True),
        (json.dumps(["phase"]), {"includes": ["max", "phase"]}, False),
        # Of another kind, or torn.
        ("zzz", {"at_most": 6.0}, False),
        (json.dumps([{"r": 1.0}]), {"includes": [1.0]}, False),
        ("[1, 2", {"includes": [1]}, False),
    ],
)
def test_parameters_as_attributes_hold_them(ledger, number, data, given, paper, same):
    data["fig"].attrs["x"] = given
    book = ledger(number, parameters={"fig": {"x": paper}})
    decision = decide(book.claims[0], book, data)
    if same:
        assert decision.verdict is REPRODUCED and foreign(book, data) == ""
    else:
        assert decision.verdict is NOT_ASKED and decision.finding is None
        assert decision.reason.startswith("fig was computed with x = ")
        assert "\n" not in decision.reason


def test_the_reason_names_both_values(ledger, number, data):
    data["fig"].attrs["x"] = np.array([1.0, 2.0])
    book = ledger(number, parameters={"fig": {"x": [1.0]}})
    assert foreign(book, data) == "fig was computed with x = [1.0, 2.0]; the claim requires [1.0]"
    book = ledger(number, parameters={"fig": {"n": {"at_least": 2}}})
    assert foreign(book, data) == "fig was computed with n = 1; the claim requires at least 2"


def test_every_asks_only_the_datasets_that_have_the_parameter(ledger, number, data):
    book = ledger(number, parameters={"every": {"release": "displacement"}})
    assert foreign(book, data) == ""
    data["fig"].attrs["release"] = "displacement"
    assert foreign(book, data) == ""
    data["fig"].attrs["release"] = "force"
    assert (
        foreign(book, data)
        == "fig was computed with release = force; the claim requires displacement"
    )


def test_parameters_of_one_variable_ask_only_what_it_decides(ledger, number, statement, data):
    book = ledger(number, statement, parameters={"fig.rise": {"restitution": 0.85}})
    first, second = (decide(claim, book, data) for claim in book.claims)
    assert first.verdict is REPRODUCED
    assert second.verdict is NOT_ASKED


def test_datasets_behind_the_deciding_one_are_asked_too(ledger, number, data):
    data["sweep"] = xr.Dataset(attrs={"n": 2})
    book = ledger(number, parameters={"sweep": {"n": 1}})
    assert foreign(book, data) == ""
    book = ledger(number | {"uses": ["sweep"]}, parameters={"sweep": {"n": 1}})
    assert foreign(book, data) == "sweep was computed with n = 2; the claim requires 1"


def test_a_dataset_or_a_parameter_that_is_missing_is_no_agreement(ledger, number, data, one_line):
    book = ledger(number | {"uses": ["sweep"]})
    with pytest.raises(ModelError) as error:
        decide(book.claims[0], book, data)
    one_line(error, "'height' uses the unknown dataset sweep")
    book = ledger(number, parameters={"fig": {"restituton": 0.65}})
    with pytest.raises(ModelError) as error:
        decide(book.claims[0], book, data)
    one_line(error, "'height' needs restituton = 0.65", "fig has no parameter restituton")


def test_foreign_parameters_come_before_what_they_make_missing(ledger, number, data):
    # The place is gone because of the parameter: open, not an error.
    number["decided_by"] = {"dataset": "fig", "variable": "rise", "at": {"n": 4}}
    book = ledger(number, parameters={"fig": {"restitution": 0.85}})
    assert decide(book.claims[0], book, data).verdict is NOT_ASKED
    with pytest.raises(ModelError, match="n = 4 is not among 1, 2, 3"):
        decide(book.claims[0], ledger(number), data)
