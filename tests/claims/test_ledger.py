"""Claims from their mapping: conditions, readings, tables, names."""

import copy

import pytest

from bouncing_ball.claims.ledger import Condition, Measure, Relation
from bouncing_ball.claims.ledger_file import parse_ledger
from bouncing_ball.errors import ModelError

TABLE = {
    "id": "ranges",
    "kind": "table",
    "section": "Results",
    "item": "Table 1",
    "statement": "{bound} for n = {n} at {frequency_ratio:g}",
    "over": {"frequency_ratio": [1e4, 2.0], "n": [1, 2], "bound": ["low", "high"]},
    "printed": [[["0.10", "0.20"], ["0.30", "0.40"]], [["0.50", "0.60"], ["0.70", "0.80"]]],
    "legibility": "clear",
    "remark": "read so",
    "decided_by": {"dataset": "table1", "variable": "computed", "at": {"rule": "a"}},
    "explanation": [
        {"where": {"frequency_ratio": 1e4, "bound": "high"}, "name": "first"},
        {"where": {"frequency_ratio": 1e4}, "name": "second"},
        {"where": {"n": 2}, "name": "first"},
    ],
    "uses": ["sweep"],
}


def explanation(name):
    check = {"decided_by": {"dataset": "x", "variable": "y"}, "condition": {"above": "0"}}
    return {"id": name, "text": "Why.", "checks": [check]}


@pytest.fixture
def table():
    return copy.deepcopy(TABLE)


def parsed(ledger, *claims):
    return ledger(*claims, explanations=[explanation("first"), explanation("second")])


def test_a_table_becomes_one_claim_for_each_number(ledger, table):
    claims = parsed(ledger, table).claims
    assert [claim.id for claim in claims] == [
        "ranges: 10000, 1, low",
        "ranges: 10000, 1, high",
        "ranges: 10000, 2, low",
        "ranges: 10000, 2, high",
        "ranges: 2, 1, low",
        "ranges: 2, 1, high",
        "ranges: 2, 2, low",
        "ranges: 2, 2, high",
    ]
    assert [claim.printed for claim in claims] == [f"0.{k}0" for k in range(1, 9)]
    last = claims[-1]
    place = (("rule", "a"), ("frequency_ratio", 2.0), ("n", 2), ("bound", "high"))
    assert last.criteria[0].measure == Measure("table1", "computed", place)
    assert last.criteria[0].condition is None
    assert last.statement == "high for n = 2 at 2"
    assert (last.kind, last.remark, last.uses) == ("number", "read so", ("table1", "sweep"))


def test_the_first_explanation_that_fits_is_taken(ledger, table):
    names = [claim.explanation for claim in parsed(ledger, table).claims]
    assert names == ["second", "first", "second", "first", "", "", "first", "first"]


def test_entries_of_a_table_restate_a_claim_where_they_say(ledger, table, number):
    table["restates"] = [{"where": {"n": 2, "bound": "high"}, "name": "height"}]
    claims = parsed(ledger, number, table).claims[1:]
    assert [claim.restates for claim in claims] == ["", "", "", "height"] * 2
    assert [claim.group for claim in claims] == [*["number"] * 3, "restatement"] * 2


@pytest.mark.parametrize("other", ["depth", "height", "again"])
def test_only_a_claim_that_stands_alone_can_be_restated(ledger, number, other, one_line):
    again = number | {"id": "again", "restates": "height"}
    third = number | {"id": "third", "restates": other}
    if other == "height":
        assert parsed(ledger, number, again, third).claims[2].restates == "height"
        return
    with pytest.raises(ModelError) as error:
        parsed(ledger, number, again, third)
    one_line(error, f"claim 'third' restates {other!r}, which is not an independent claim")


@pytest.mark.parametrize(
    ("kind", "legibility", "group"),
    [
        ("number", "damaged", "number"),
        ("statement", "clear", "statement"),
        ("formula", "clear", "statement"),
        ("formula", "damaged", "restored formula"),
        ("formula", "unreadable", "restored formula"),
    ],
)
def test_what_a_claim_is_counted_as(ledger, number, kind, legibility, group):
    change = {"kind": kind, "legibility": legibility}
    assert parsed(ledger, number | change).claims[0].group == group


def test_a_printed_table_as_numbers_with_the_parameters_behind_it(table, one_line):
    book = parse_ledger(
        {
            "close_units": 2,
            "parameters": {
                "every": {"release": "displacement"},
                "table1": {"restitution": 0.85, "n": [1, 2, 3], "points": {"at_least": 5}},
            },
            "claims": [table],
            "explanations": [explanation("first"), explanation("second")],
        }
    )
    assert book.datasets == ["sweep", "table1", "x"]
    assert book.table("ranges") == {
        "release": "displacement",
        "restitution": 0.85,
        "frequency_ratio": [1e4, 2.0],
        "n": [1, 2],
        "bound": ["low", "high"],
        "values": [[[0.1, 0.2], [0.3, 0.4]], [[0.5, 0.6], [0.7, 0.8]]],
    }
    with pytest.raises(ModelError) as error:
        book.table("Table 2")
    one_line(error, "unknown table 'Table 2'; known: ranges")


@pytest.mark.parametrize(
    ("change", "said"),
    [
        (lambda t: t["printed"].pop(), "printed is not a list of 2, one for each frequency_ratio"),
        (lambda t: t["printed"].append([]), "printed is not a list of 2"),
        (
            lambda t: t["printed"][1].pop(),
            "printed at frequency_ratio = 2.0 is not a list of 2, one for each n",
        ),
        (
            lambda t: t["printed"][1][0].append("0.9"),
            "printed at frequency_ratio = 2.0, n = 1 is not a list of 2, one for each bound",
        ),
        (
            lambda t: t["printed"][1][0].__setitem__(1, 0.6),
            "n = 1, bound = high is 0.6, not a number as a text",
        ),
        (lambda t: t.update(statement="{m} there"), "may name only frequency_ratio, n, bound"),
        (lambda t: t.update(statement="{} there"), "may name only frequency_ratio, n, bound"),
        (lambda t: t.update(statement="{n there"), "has a brace that does not match"),
        (lambda t: t.update(statement="n} there"), "has a brace that does not match"),
        # Otherwise a format of a gigabyte, and the attributes of an object.
        (lambda t: t.update(statement="{n:99999999999}"), "may write n as {n} or {n:g}"),
        (lambda t: t.update(statement="{n:{n}}"), "may write n as {n} or {n:g}"),
        (lambda t: t.update(statement="{n!r}"), "may write n as {n} or {n:g}"),
        (lambda t: t.update(statement="{bound:g}"), "may write bound as {bound}"),
        (lambda t: t.update(statement="{n.zzz}"), "it names 'n.zzz'"),
        (lambda t: t.update(statement="{n[0]}"), "it names 'n[0]'"),
        (
            lambda t: t["explanation"][0].update(where={"r": 1}),
            "'first' is for r, which is not one of frequency_ratio, n, bound",
        ),
        (
            lambda t: t.update(restates=[{"where": {"r": 1}, "name": "height"}]),
            "the restates 'height' is for r, which is not one of frequency_ratio, n, bound",
        ),
    ],
)
def test_a_wrong_table_is_one_line(ledger, table, change, said, one_line):
    change(table)
    with pytest.raises(ModelError) as error:
        parsed(ledger, table)
    one_line(error, "table 'ranges': ", said)


@pytest.mark.parametrize("relation", list(Relation))
def test_conditions(ledger, statement, relation):
    statement["condition"] = {"text": "so", relation: "0.5"}
    claim = ledger(statement).claims[0]
    assert claim.criteria[0].condition == Condition(relation, "0.5", bound_is_variable=False)
    assert claim.condition_text == "so"
    statement["condition"] = {relation: {"variable": "budget"}}
    claim = ledger(statement).claims[0]
    assert claim.criteria[0].condition == Condition(relation, "budget", bound_is_variable=True)
    assert claim.condition_text == ""


def test_readings_each_with_a_condition_of_its_own(ledger, statement):
    source = statement.pop("decided_by")
    statement["condition"] = {"text": "small"}
    statement["readings"] = [
        {"reading": "1 %", "condition": {"at_most": "0.01"}, "decided_by": source},
        {
            "reading": "10 %",
            "condition": {"at_most": "0.1"},
            "decided_by": {"dataset": "other", "variable": "x"},
        },
    ]
    claim = ledger(statement).claims[0]
    assert [criterion.reading for criterion in claim.criteria] == ["1 %", "10 %"]
    assert [criterion.condition.bound for criterion in claim.criteria] == ["0.01", "0.1"]
    assert claim.uses == ("fig", "other")


def test_what_is_used_is_listed_once_and_the_deciding_dataset_first(ledger, number):
    claim = ledger(number | {"uses": ["sweep", "fig", "sweep"]}).claims[0]
    assert claim.uses == ("fig", "sweep")


def test_what_a_claim_may_leave_out(ledger, number):
    claim = ledger(number).claims[0]
    assert (claim.unit, claim.remark, claim.condition_text, claim.explanation) == (None, "", "", "")
    assert ledger(number | {"unit": 100}).claims[0].unit == 100


def test_names_are_defined_once(ledger, number, statement, table, one_line):
    with pytest.raises(ModelError) as error:
        ledger(number, statement | {"id": "height"})
    one_line(error, "claim 'height' is defined twice in the ledger")
    with pytest.raises(ModelError) as error:
        parsed(ledger, table, number | {"id": "ranges: 2, 1, low"})
    one_line(error, "claim 'ranges: 2, 1, low' is defined twice")
    # The rest of two tables of one name may differ; the name may not.
    other = copy.deepcopy(table) | {"over": {"n": [5]}, "printed": ["1"], "statement": "{n}"}
    other["explanation"] = []
    with pytest.raises(ModelError) as error:
        parsed(ledger, table, other)
    one_line(error, "claim 'ranges' is defined twice")
    with pytest.raises(ModelError) as error:
        ledger(number, explanations=[explanation("why"), explanation("why")])
    one_line(error, "explanation 'why' is defined twice in the ledger")


def test_an_unknown_explanation(ledger, number, one_line):
    with pytest.raises(ModelError) as error:
        ledger(number | {"explanation": "because"})
    one_line(error, "claim 'height': unknown explanation 'because'; known: it turns")


def test_measures_in_words():
    assert str(Measure("fig", "x")) == "fig: x"
    assert str(Measure("fig", "x", (("n", 1), ("bound", "low")), "max")) == (
        "max of fig: x at n = 1, bound = low"
    )


def test_the_mapping_is_not_changed(number, turns):
    mapping = {
        "close_units": 3,
        "parameters": {"fig": {"n": 1}},
        "claims": [number, copy.deepcopy(TABLE) | {"explanation": []}],
        "explanations": [turns],
    }
    before = copy.deepcopy(mapping)
    book = parse_ledger(mapping)
    assert mapping == before
    assert book.close_units == 3 and book.parameters == {"fig": {"n": 1}}
