"""Claims as functions, on small datasets: parameters, readings, explanations, the dataset."""

from dataclasses import replace

import numpy as np
import pytest
import xarray as xr

from bouncing_ball.errors import ModelError
from bouncing_ball.paper.claims.claim import Claim, claim, formula
from bouncing_ball.paper.claims.claims import judged_claims, tally
from bouncing_ball.paper.claims.paper_parameters import NotAsked, PaperData, digest, of_dataset
from bouncing_ball.paper.claims.verdict import above, at_most

BOUNDS = {"first": 83, "second": 82}


def it_turns(data):
    """It sinks
    first.
    """
    return {"rise at the second": at_most(data["fig"].rise.sel(n=2), 0)}


@claim("Fig. 14", printed="82")
def height_threshold(data):
    """the threshold

    Remark: read off
    a curve
    """
    return data["fig"].threshold


@claim("Fig. 14", id="rises", explanation=it_turns)
def rising(data):
    """the height rises

    Condition: it rises everywhere
    """
    return above(data["fig"].rise, 0)


@claim("Fig. 14", explanation=it_turns, restates=height_threshold)
def two_readings(data):
    """the threshold again"""
    return {name: at_most(data["fig"].threshold, bound) for name, bound in BOUNDS.items()}


right = formula("a law", "Eq. 1", "the law")
limit = formula("a limit", "Eq. 2", "the limit", "Eq. 1")


PARAMETERS = {
    "n": np.int64(1),
    "cases": '[{"r": 0.5}]',
    "span__max": 10.0,
    "span__min": 0.5,
    "tolerances": np.array([0.01, 0.02]),
    "release": "displacement",
}
NAMES = ("n", "cases", "span", "tolerances")


# The digest of the parameters of the small dataset.
DIGESTS = {"fig": (digest(of_dataset(PARAMETERS, NAMES)), *NAMES)}


@pytest.fixture
def data():
    fig = xr.Dataset(
        {"threshold": ((), 82.18), "rise": ("n", [0.5, -0.25, 1.0])},
        coords={"n": [1, 2, 3]},
        attrs=PARAMETERS,
    )
    both = dict.fromkeys(("disagreement", "disagreement_in_use"), ("formula", [1e-13]))
    rows = xr.Dataset({**both, "budget": ("formula", [1e-12])})
    return {"fig": fig, "formulas": rows.assign_coords(formula=["Eq. 1"])}


def judged(claims, data):
    """The verdicts on claims that require the parameters of the small dataset."""
    return judged_claims(claims, data, DIGESTS)


def row(claim: Claim, data):
    result = judged([claim], data).isel(claim=0)
    return {name: values.item() for name, values in result.data_vars.items() if not values.dims}


def test_a_printed_number_is_judged_by_its_last_digit(data):
    found = row(height_threshold, data)
    assert found["deviation_units"] == pytest.approx(0.18)
    assert found["deviation"] == pytest.approx(0.18 / 82)
    del found["deviation_units"], found["deviation"]
    # A number that is not compared with a bound has none, and no interval.
    assert {name: value for name, value in found.items() if value == value != ""} == {
        "item": "Fig. 14",
        "group": "number",
        "statement": "the threshold",
        "printed_text": "82",
        "remark": "read off a curve",
        "decided_by": "fig",
        "parameters": "n = 1",
        "required": "82",
        "found": 82.18,
        "verdict": "reproduced",
        "explained": True,
    }
    assert height_threshold.id == "height threshold"


def test_a_statement_that_fails_is_explained_by_checks_that_hold(data):
    result = judged([rising], data)
    found = row(rising, data)
    assert (found["verdict"], found["found"], found["required"]) == ("contradicted", -0.25, "> 0")
    assert found["condition"] == "it rises everywhere"
    assert (found["explained_by"], found["explained"], found["limit"]) == ("it turns", True, 0)
    assert result.explanation_text.item() == "It sinks first."
    assert result.explanation_holds.item()
    assert result.explanation_checks.item() == "rise at the second: -0.25 (required ≤ 0)"
    data["fig"]["rise"] = ("n", [0.5, 0.25, -1.0])
    found = row(rising, data)
    assert (found["verdict"], found["explained"]) == ("contradicted", False)


def test_a_claim_that_holds_in_some_readings_is_right_in_one_or_undecidable(data):
    found = row(two_readings, data)
    assert (found["verdict"], found["restates"]) == ("in one reading", "height threshold")
    assert found["reason"] == ("first: reproduced (82.18); second: contradicted (82.18)")
    assert (found["found"], found["explained"]) == (82.18, True)
    # The same if the reading in which it holds is not the first.
    turned = replace(
        two_readings, decide=lambda data: dict([*two_readings.decide(data).items()][::-1])
    )
    assert (row(turned, data)["verdict"], row(turned, data)["found"]) == ("in one reading", 82.18)
    # If the readings are values of something that the text does not have, nothing is decided,
    lacking = replace(two_readings, missing="the limit")
    found = row(lacking, data)
    assert (found["verdict"], found["missing"]) == ("undecidable", "the limit")
    assert np.isnan(found["found"]) and found["explained"]
    # but for values that all give the same verdict.
    data["fig"]["threshold"] += 100
    for one in (two_readings, turned, lacking):
        assert row(one, data)["verdict"] == "contradicted"


def test_a_definition_is_checked_and_not_counted_as_reproduced(data):
    sure = replace(rising, definition=True)
    # It is contradicted if its check fails.
    assert row(sure, data)["verdict"] == "contradicted"
    data["fig"]["rise"] = ("n", [0.5, 0.25, 1.0])
    assert row(rising, data)["verdict"] == "reproduced"
    found = row(sure, data)
    assert (found["verdict"], found["found"], found["explained"]) == ("definition", 0.25, True)
    assert tally(judged([sure], data)) == "1 statements: 1 definition"


def test_each_claim_is_counted_in_its_group(data):
    assert row(right, data)["verdict"] == "reproduced"
    assert [
        row(claim, data)["group"] for claim in (right, height_threshold, rising, two_readings)
    ] == [*("restored formula", "number", "statement", "statement")]


@pytest.mark.parametrize("name", ["disagreement", "disagreement_in_use"])
def test_a_formula_is_right_if_it_is_right_as_printed_and_as_it_is_used(name, data):
    assert row(limit, data)["verdict"] == "reproduced"
    data["formulas"][name] = data["formulas"][name] * 100
    assert row(limit, data)["verdict"] == "contradicted"
    assert row(limit, data)["required"] == "≤ 1e-12"
    data["formulas"][name] *= np.nan
    assert row(limit, data)["verdict"] == "contradicted"


@pytest.mark.parametrize(
    "change",
    [
        {"n": 2},
        {"cases": '[{"r": 0.6}]'},
        {"span__max": 9.9},
        {"span__max": "far"},
        {"tolerances": 0.01},
        {"release": "force"},
    ],
)
def test_with_other_parameters_a_claim_is_not_asked(data, change):
    data["fig"] = data["fig"].assign_attrs(change)
    found = row(rising, data)
    assert found["reason"].startswith("fig has other parameters than the claim requires: ")
    (said,) = (f"{name} = {value}" for name, value in change.items())
    assert said in found["reason"]
    assert (found["verdict"], found["explained"]) == ("not asked", True)
    assert np.isnan([found["found"], found["limit"]]).all()
    result = judged([rising], data)
    assert not result.explanation_holds.item()
    assert result.explanation_checks.item() == found["reason"]
    with pytest.raises(NotAsked):
        PaperData(data, DIGESTS)["fig"]


def test_a_parameter_that_is_missing_is_another_one(data):
    del data["fig"].attrs["n"]
    assert row(rising, data)["verdict"] == "not asked"


def test_the_paper_parameters_are_no_more_than_required(data):
    data["fig"] = data["fig"].assign_attrs(other=3, n=[1.0])
    del data["fig"].attrs["release"]  # only where a dataset has it
    assert row(rising, data)["verdict"] == "contradicted"


@pytest.mark.parametrize(
    ("change", "said"),
    [
        (lambda data: data.pop("fig"), "fig"),
        (lambda data: data.update(fig=data["fig"].drop_vars("rise")), "rise"),
        (lambda data: data.update(fig=data["fig"].sel(n=[1, 3])), "not all values found in index"),
        (lambda data: data["fig"].rise.values.fill(np.nan), "rise: 1 of 1 numbers missing"),
    ],
)
def test_what_is_missing_is_an_error_in_one_line(data, change, said, one_line):
    change(data)
    with pytest.raises(ModelError) as error:
        judged([rising], data)
    one_line(error, said)
    assert str(error.value).startswith(("'rises': ", "'it turns': "))


def test_the_tally_counts_verdicts_by_group(data):
    some = [rising, two_readings, height_threshold, right]
    formulas = "1 formulas: 1 reproduced"
    statements = "2 statements: 1 in one reading, 1 contradicted"
    lines = [formulas, "1 printed numbers: 1 reproduced", statements]
    assert tally(judged(some, data)).splitlines() == lines
    data["fig"]["rise"] = ("n", [0.5, 0.25, -1.0])
    assert tally(judged(some, data)).endswith(", 1 without explanation")
    data["fig"].attrs["n"] = 2
    of_figure = ["1 printed numbers: 1 not asked", "2 statements: 2 not asked"]
    assert tally(judged(some, data)).splitlines() == [formulas, *of_figure]
