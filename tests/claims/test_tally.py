"""The last line of a run."""

import xarray as xr

from bouncing_ball.claims.assessment import assess
from bouncing_ball.claims.tally import tally


def verdicts(*rows):
    """Group, verdict and whether it is explained, claim by claim."""
    names = ("group", "verdict", "explained")
    columns = zip(*rows, strict=True)
    return xr.Dataset(
        {name: ("claim", list(column)) for name, column in zip(names, columns, strict=True)}
    )


def test_counts_from_the_best_to_the_worst_group_by_group():
    line = tally(
        verdicts(
            ("restatement", "contradicted", True),
            ("number", "contradicted", True),
            ("number", "close", True),
            ("statement", "reproduced", True),
            ("statement", "undecidable", True),
            ("number", "reproduced", True),
            ("restored formula", "reproduced", True),
        ),
        16,
    )
    # The restatement does not count among the six.
    assert line == (
        "16 figures, Table 1, 6 claims; 1 restored formula: 1 reproduced; "
        "3 numbers: 1 reproduced, 1 close, 1 contradicted; "
        "2 statements: 1 reproduced, 1 undecidable; 1 restatement: 1 contradicted"
    )


def test_what_is_not_asked_is_counted_where_there_is_any():
    line = tally(verdicts(("number", "not asked", True), ("number", "reproduced", True)), 2)
    assert line == "2 figures, Table 1, 2 claims; 2 numbers: 1 reproduced, 1 not asked"


def test_what_is_not_explained_is_counted():
    line = tally(
        verdicts(
            ("number", "contradicted", False),
            ("number", "close", True),
            ("restatement", "undecidable", False),
        ),
        2,
    )
    assert line.endswith("; 1 restatement: 1 undecidable; 2 without explanation")
    assert tally(verdicts(("number", "contradicted", True)), 2).endswith("1 contradicted")


def test_an_explanation_that_fails_shows_in_the_line(ledger, number, statement, turns, data):
    book = ledger(number, statement, explanations=[turns])
    assert "without explanation" not in tally(assess(book, data), 16)
    turns["checks"][0]["condition"] = {"above": "0"}
    book = ledger(number, statement, explanations=[turns])
    assert tally(assess(book, data), 16) == (
        "16 figures, Table 1, 2 claims; 1 number: 1 reproduced; 1 statement: 1 contradicted; "
        "1 without explanation"
    )
