"""The dataset of verdicts."""

import numpy as np
import pytest

from bouncing_ball.claims.assessment import assess
from bouncing_ball.errors import ModelError


def row(result, claim):
    """All that the dataset says of one claim."""
    keys = [key for key, values in result.data_vars.items() if values.dims == ("claim",)]
    return {key: result[key].sel(claim=claim).item() for key in keys}


def test_what_is_said_of_each_claim(ledger, number, statement, data, described):
    result = described(assess(ledger(number, statement), data))
    assert result.claim.values.tolist() == ["height", "rises"]
    height, rises = row(result, "height"), row(result, "rises")
    assert height["deviation_units"] == pytest.approx(0.18, abs=1e-12)
    assert height["deviation"] == pytest.approx(0.18 / 82, rel=1e-9)
    assert np.isnan(height["limit"]) and rises["limit"] == 0
    del height["deviation_units"], height["deviation"], height["limit"]
    assert height == {
        "section": "Results",
        "item": "Fig. 14",
        "kind": "number",
        "group": "number",
        "restates": "",
        "statement": "the threshold",
        "printed_text": "82",
        "legibility": "clear",
        "remark": "",
        "condition": "",
        "decided_by": "fig: threshold is 82",
        "required": "82",
        "found": 82.18,
        "verdict": "reproduced",
        "reason": "",
        "printed_table": "",
        "explained_by": "",
        "explained": True,
    }
    assert (rises["verdict"], rises["found"], rises["required"]) == ("contradicted", -0.25, "> 0")
    assert rises["decided_by"] == "min of fig: rise > 0"
    assert rises["condition"] == "it rises everywhere"
    assert (rises["explained_by"], rises["explained"]) == ("it turns", True)
    assert result.explanation.values.tolist() == ["it turns"]
    assert result.explanation_text.item() == "It sinks first."
    assert result.explanation_holds.item() is True


def test_an_explanation_that_does_not_hold_explains_nothing(ledger, statement, turns, data):
    # The number at n = 2 is -0.25.
    turns["checks"].append(
        {
            "decided_by": {"dataset": "fig", "variable": "rise", "at": {"n": 2}},
            "condition": {"at_most": "-0.3"},
        }
    )
    result = assess(ledger(statement, explanations=[turns]), data)
    assert not result.explanation_holds.item()
    assert row(result, "rises")["verdict"] == "contradicted"
    assert row(result, "rises")["explained"] is False


def test_a_check_that_is_only_close_does_not_hold(ledger, statement, turns, data):
    turns["checks"][0]["condition"] = {"at_most": "-0.3"}  # missed by half a unit
    assert not assess(ledger(statement, explanations=[turns]), data).explanation_holds.item()


def test_a_claim_without_explanation(ledger, statement, data):
    del statement["explanation"]
    assert row(assess(ledger(statement), data), "rises")["explained"] is False


def test_an_explanation_computed_with_other_parameters_explains_nothing(ledger, statement, data):
    data["other"] = data["fig"].assign_attrs(n=2)
    turns = {
        "id": "it turns",
        "text": "It sinks first.",
        "checks": [
            {
                "decided_by": {"dataset": "other", "variable": "rise", "at": {"n": 2}},
                "condition": {"below": "0"},
            }
        ],
    }
    book = ledger(statement, explanations=[turns], parameters={"other": {"n": 1}})
    result = assess(book, data)
    assert not result.explanation_holds.item() and not row(result, "rises")["explained"]
    book = ledger(statement, explanations=[turns], parameters={"other": {"n": 2}})
    assert assess(book, data).explanation_holds.item()


def test_with_other_parameters_a_claim_is_not_asked(ledger, number, data):
    result = row(assess(ledger(number, parameters={"fig": {"n": 2}}), data), "height")
    assert (result["verdict"], result["explained"]) == ("not asked", True)
    assert result["reason"] == "fig was computed with n = 1; the claim requires 2"
    # What was printed is still there; nothing was found.
    assert result["required"] == "82"
    assert np.isnan([result["found"], result["deviation_units"], result["deviation"]]).all()


def test_a_claim_open_between_readings_needs_an_explanation(ledger, number, data):
    source = number.pop("decided_by")
    other = {"dataset": "fig", "variable": "rise", "at": {"n": 1}}
    number["readings"] = [
        {"reading": "first", "decided_by": source},
        {"reading": "second", "decided_by": other},
    ]
    result = row(assess(ledger(number), data), "height")
    assert (result["verdict"], result["explained"]) == ("undecidable", False)
    assert result["decided_by"] == "fig: threshold is 82; fig: rise at n = 1 is 82"
    result = row(assess(ledger(number | {"explanation": "it turns"}), data), "height")
    assert (result["verdict"], result["explained"]) == ("undecidable", True)


def test_a_bound_from_the_dataset_in_words(ledger, statement, data):
    statement["condition"] = {"at_most": {"variable": "budget"}}
    data["fig"]["budget"] = ("n", [2.0, 2.0, 2.0])
    result = row(assess(ledger(statement), data), "rises")
    assert result["decided_by"] == "min of fig: rise ≤ its budget"
    assert result["required"] == "≤ 2"


def test_a_missing_input_of_an_explanation_is_an_error(ledger, number, turns, data, one_line):
    turns["checks"][0]["decided_by"]["at"] = {"n": 7}
    with pytest.raises(ModelError) as error:
        assess(ledger(number, explanations=[turns]), data)
    one_line(error, "fig: rise at n = 7: n = 7 is not among 1, 2, 3")
