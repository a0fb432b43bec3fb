"""Texts and tables against the record: words decide, digits move with their data."""

import re

import numpy as np
import pytest

from bouncing_ball.compare.drift import span
from bouncing_ball.compare.outcome import Outcome, status
from bouncing_ball.compare.report_html import to_html
from bouncing_ball.compare.report_json import to_json
from bouncing_ball.compare.report_terminal import to_terminal
from bouncing_ball.compare.texts import compare_texts

# Most compare whole folders.
pytestmark = pytest.mark.slow

TEXTS = ["figures/table1.csv", "figures/table1.md", "figures/table1.tex", "paper.md"]


def replace(path, old, new):
    text = path.read_text(encoding="utf-8")
    assert old in text, old
    path.write_text(text.replace(old, new, 1), encoding="utf-8")


def nudge(pair, budgets, name="table1", variable="computed"):
    """Move one value of a dataset by so many of its budgets."""
    data = pair.dataset(name)
    rule = pair.rules.of(name, variable)
    index = tuple(int(k) for k in np.argwhere(np.isfinite(data[variable].values))[0])
    step = rule.budget * (span(data[variable]) if rule.scale is None else 1e-9)
    data[variable].values[index] += budgets * step
    pair.write(name, data)


def move_everything(pair):
    """Every dataset within its budget, and a last digit in paper.md and a table."""
    for name, variable in (("fig05", "phase"), ("fig08", "phase"), ("table1", "computed")):
        nudge(pair, 0.5, name, variable)
    for file in ("figures/table1.csv", "paper.md"):
        replace(pair.new / file, "0.23999", "0.24000")


def page_text(comparison):
    """The words of the page, without the marks within them."""
    return re.sub(r"<[^>]+>", "", to_html(comparison))


@pytest.mark.parametrize("moved", [False, True])
def test_a_falsified_paper_differs_whatever_else_has_moved(pair, moved):
    if moved:
        move_everything(pair)
        assert pair.compare().outcome is Outcome.WITHIN
    paper = pair.new / "paper.md"
    replace(paper, "are right, with one exception", "are wrong, all of them")
    comparison = pair.compare()
    assert status(comparison.outcome) == 1
    assert pair.artifact("paper").outcome is Outcome.DRIFTED
    drifted = [line for line in pair.part("paper.md").lines if line.outcome is Outcome.DRIFTED]
    assert len(drifted) == 1 and "are wrong, all of them" in drifted[0].new
    for report in (to_terminal, to_json, page_text):
        assert "are wrong, all of them" in report(comparison)


def test_every_changed_line_is_listed(pair):
    text = (pair.new / "paper.md").read_text(encoding="utf-8")
    lines = text.split("\n")
    changed = [k for k, line in enumerate(lines) if line.strip()][5::7]
    for k in changed:
        lines[k] += " indeed"
    (pair.new / "paper.md").write_text("\n".join(lines), encoding="utf-8")
    found = pair.part("paper.md").lines
    assert [line.place for line in found] == [f"line {k + 1}" for k in changed]
    comparison = pair.compare()
    assert to_json(comparison).count(" indeed") == len(changed)
    assert page_text(comparison).count(" indeed") == len(changed)
    assert f"{len(changed) - 5} more" in to_terminal(comparison)


@pytest.mark.parametrize("file", TEXTS)
def test_a_digit_moves_with_its_data_only(pair, file):
    replace(pair.new / file, "0.23999", "0.24000")
    # The data are the same: then the printed digit has another reason.
    assert pair.part(file).outcome is Outcome.DRIFTED
    nudge(pair, 0.5)
    assert pair.part(file).outcome is Outcome.WITHIN
    assert pair.compare().outcome is Outcome.WITHIN
    nudge(pair, 2.0)
    assert pair.part(file).outcome is Outcome.DRIFTED
    # A digit of the table that is not its data's.
    nudge(pair, 0.5)
    replace(pair.new / file, "0.24000", "0.24001")
    assert pair.part(file).outcome is Outcome.DRIFTED


@pytest.mark.parametrize("file", TEXTS)
def test_a_text_without_data_may_not_move(pair, file):
    for folder in (pair.record, pair.new):
        for path in (folder / "figures").glob("*.nc"):
            path.unlink()
    assert pair.part(file).outcome is Outcome.IDENTICAL
    replace(pair.new / file, "0.23999", "0.24000")
    assert pair.part(file).outcome is Outcome.DRIFTED


@pytest.mark.parametrize(
    ("old", "new", "place"),
    [
        ("computed", "calculated", "line 1"),
        ("ϖ,n", "ϖ,n,m", "line 1"),
        ("\n2,1,", "\n2,1,saddle-node,,,\n2,1,", "line 14"),
    ],
)
def test_the_shape_and_the_words_of_a_table(pair, old, new, place):
    nudge(pair, 0.5)
    replace(pair.new / "figures" / "table1.csv", old, new)
    (line,) = pair.part("figures/table1.csv").lines
    assert (line.place, line.outcome) == (place, Outcome.DRIFTED)


def changes(record, new, data=Outcome.WITHIN):
    lines = compare_texts("\n".join(record), "\n".join(new), data)
    return [(line.place, str(line.outcome), line.record, line.new) for line in lines]


def test_lines_put_in_and_left_out():
    # After one that is put in, the lines are still held against their own.
    assert changes(["a", "0.5", "c", "d"], ["x", "a", "0.6", "y", "d"]) == [
        ("line 1", "drifted", None, "x"),
        ("line 2", "within budget", "0.5", "0.6"),
        ("line 3", "drifted", "c", "y"),
    ]
    assert changes("abc", "ab") == [("line 3", "drifted", "c", None)]
    assert changes("", "a") == [("line 1", "drifted", "", "a")]
    # A line at the top of a long text, and two that have changed places.
    many = [f"line {'x' * k}" for k in range(1000)]
    assert changes(many, ["new", *many]) == [("line 1", "drifted", None, "new")]
    assert len(changes(many, [*many[:500], many[501], many[500], *many[502:]])) == 2


@pytest.mark.parametrize(
    ("old", "new", "same"),
    [
        ("| 4.5e-13 |", "| 4.6e-13 |", True),
        ("| 4.5e-13 |", "| 4.7e-13 |", False),
        ("9.99", "10.0", True),
        ("1e99999999999999999999", "1e99999999999999999999", True),
        ("1e99999999999999999999", "1e99999999999999999998", False),
        ("1e9999", "2e9999", True),
        ("9" * 5000 + ".5", "9" * 5000 + ".6", True),
        ("12 orbits", "13 orbits", False),
        ("0.25", "−0.25", False),
        ("0.25\r", "0.25", False),
    ],
)
def test_numbers_as_they_are_printed(old, new, same):
    found = changes([old], [new])
    assert {outcome for _, outcome, *_ in found} <= ({"within budget"} if same else {"drifted"})
    assert same or found
