"""The last line of a run."""

import xarray as xr

from bouncing_ball.audit.claims.assessment import assess
from bouncing_ball.audit.claims.tally import tally


def verdicts(*pairs):
    names, explained = zip(*pairs, strict=True)
    return xr.Dataset({"verdict": ("claim", list(names)), "explained": ("claim", list(explained))})


def test_counts_from_the_best_to_the_worst():
    line = tally(
        verdicts(
            ("contradicted", True),
            ("close", True),
            ("reproduced", True),
            ("undecidable", True),
            ("reproduced", True),
        ),
        16,
    )
    assert line == (
        "16 figures, Table 1, 5 claims: 2 reproduced, 1 close, 1 contradicted, 1 undecidable"
    )


def test_what_is_not_asked_is_counted_where_there_is_any():
    line = tally(verdicts(("not asked", True), ("reproduced", True)), 2)
    assert line.endswith(
        "2 claims: 1 reproduced, 0 close, 0 contradicted, 0 undecidable, 1 not asked"
    )


def test_what_is_not_explained_is_counted():
    line = tally(verdicts(("contradicted", False), ("close", True), ("undecidable", False)), 2)
    assert line.endswith("1 undecidable; 2 without explanation")
    assert tally(verdicts(("contradicted", True)), 2).endswith("0 undecidable")


def test_an_explanation_that_fails_shows_in_the_line(ledger, number, statement, turns, data):
    book = ledger(number, statement, explanations=[turns])
    assert "without explanation" not in tally(assess(book, data), 16)
    turns["checks"][0]["condition"] = {"above": "0"}
    book = ledger(number, statement, explanations=[turns])
    assert tally(assess(book, data), 16) == (
        "16 figures, Table 1, 2 claims: 1 reproduced, 0 close, 1 contradicted, 0 undecidable; "
        "1 without explanation"
    )
