"""How a claim is judged: printed numbers, and statements with their readings."""

from functools import partial

import numpy as np
import pytest

from paper_replication import verdicts

# Printed numbers


@pytest.mark.parametrize(
    ("computed", "printed", "verdict"),
    [
        (0.2545, "0.255", "reproduced"),
        (0.2555, "0.255", "reproduced"),
        (0.25449, "0.255", "not reproduced"),
        (0.256, "0.255", "not reproduced"),
        (0.25399, "0.255", "not reproduced"),
        (0.7505, "0.750", "reproduced"),
        (0.751, "0.750", "not reproduced"),
        (0.751, "0.75", "reproduced"),
        (82.5, "82", "reproduced"),
        (82.6, "82", "not reproduced"),
        (83.01, "82", "not reproduced"),
        (6.49, "6", "reproduced"),
        (7.01, "6", "not reproduced"),
        (np.nan, "6", "not asked"),
    ],
)
def test_a_number_is_reproduced_if_it_rounds_to_the_printed_one(computed, printed, verdict):
    assert verdicts.against_print(computed, printed).verdict == verdict


# Statements


def test_readings_that_agree_decide_and_others_are_named():
    low = verdicts.at_most("the lower", [1.0, 2.0], 2.0)
    high = verdicts.at_most("the higher", [1.0, 2.1], 2.0)
    claim = verdicts.Claim("name", "Fig. 1", "text", {}, lambda: [])
    assert verdicts.of_readings(claim, [low])["verdict"] == "reproduced"
    assert verdicts.of_readings(claim, [high, high])["verdict"] == "not reproduced"
    mixed = verdicts.of_readings(claim, [high, low])
    assert mixed["verdict"] == "partly"
    assert mixed["own_sense"] == "does not hold"
    assert verdicts.of_readings(claim, [low, high])["own_sense"] == "holds"
    assert mixed["condition"] == [
        "literally, no: the higher (2.1, at most 2)",
        "yes: the lower (2, at most 2)",
    ]


def test_what_the_text_lacks_makes_a_statement_not_testable_only_if_readings_differ():
    claim = verdicts.Claim("name", "Fig. 1", "text", {}, lambda: [], missing="the axis")
    low = verdicts.above("the lower", 1.0)
    high = verdicts.above("the higher", 0.0)
    undecidable = verdicts.of_readings(claim, [low, high])
    assert undecidable["verdict"] == "not testable"
    assert undecidable["reason"] == "the text does not say the axis"
    assert verdicts.of_readings(claim, [low, low])["verdict"] == "reproduced"
    assert verdicts.of_readings(claim, [])["verdict"] == "not testable"


def test_what_follows_by_algebra_holds_and_gives_its_reason():
    claim = verdicts.Claim(
        "name", "Eq. 1", "text", {}, lambda: [verdicts.argued("the limit", True, "by algebra")]
    )
    judgement = verdicts.answer(claim, {})
    assert judgement["verdict"] == "reproduced"
    assert judgement["condition"] == ["yes: the limit (by algebra)"]
    assert judgement["own_sense"] == ""
    certain = verdicts.by_definition("the duration", "it is positive")
    assert verdicts.of_readings(claim, [certain])["own_sense"] == "cannot fail"
    assert verdicts.of_readings(claim, [certain, *claim.decide()])["own_sense"] == ""


def test_conditions_take_the_worst_number_and_a_missing_one_is_not_judged():
    assert verdicts.at_most("", [1.0, 3.0], 2.0)[1:3] == (False, 3.0)
    assert verdicts.at_least("", [1.0, 3.0], 2.0)[1:3] == (False, 1.0)
    assert verdicts.above("", [0.0, 3.0])[1:3] == (False, 0.0)
    assert verdicts.within("", [0.01, 0.5], 0.5)[1:5] == (True, 0.5, "at most 50 %", True)
    assert verdicts.beyond("", [0.9, 0.5], 0.5)[1:5] == (True, 0.5, "at least 50 %", True)
    for condition in (
        partial(verdicts.at_most, bound=0.0),
        partial(verdicts.at_least, bound=0.0),
        verdicts.above,
    ):
        for values in ([1.0, np.nan], []):
            lacking = verdicts.Claim("name", "Fig. 1", "text", {}, lambda: [])
            readings = [verdicts.argued("by algebra", True, "it is"), condition("", values)]
            assert verdicts.of_readings(lacking, readings)["verdict"] == "not asked"
