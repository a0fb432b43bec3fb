"""A page that computes: its texts to the letter, its reference orbits by their budgets."""

from pathlib import Path

import pytest

from bouncing_ball.compare.outcome import Outcome
from bouncing_ball.compare.pages import read_page
from bouncing_ball.compare.parts import judge
from bouncing_ball.compare.tolerance_file import read_tolerances
from bouncing_ball.configuration.study import typed
from bouncing_ball.figures.explorer.document import to_html
from bouncing_ball.record.reading import UnreadableError
from bouncing_ball.studies.reference_orbits import reference_orbits

FILE = "explorer.html"
RULES = read_tolerances(Path(__file__).parents[2] / "config" / "tolerances.yaml")
GIVEN = {"frequency_ratio": {"min": 1.0, "max": 1e4, "samples": 11}, "seed": 31}


@pytest.fixture(scope="module")
def data():
    return typed(reference_orbits)(GIVEN)


def judged(folder, before, after):
    for name, text in (("record", before), ("new", after)):
        (folder / name).mkdir()
        (folder / name / FILE).write_text(text, encoding="utf-8")
    return judge(FILE, "explorer", (folder / "record", folder / "new"), RULES)


def test_another_commit_is_no_difference(tmp_path, data):
    before, after = (to_html(data.assign_attrs(provenance_commit=40 * digit)) for digit in "12")
    assert before != after
    assert judged(tmp_path, before, after).outcome is Outcome.IDENTICAL


@pytest.mark.parametrize(
    ("drift", "outcome"), [(1e-14, Outcome.WITHIN), (1e-9, Outcome.DRIFTED)], ids=str
)
def test_reference_orbits_have_budgets(tmp_path, data, drift, outcome):
    moved = data.copy(deep=True)
    moved.phase.values[0, 3] += drift
    part = judged(tmp_path, to_html(data), to_html(moved))
    assert part.outcome is outcome
    assert part.variables[0].name == "phase"


def test_no_letter_of_the_page_may_change(tmp_path, data):
    page = to_html(data)
    part = judged(tmp_path, page, page.replace("const GRAVITY = 9.80665", "const GRAVITY = 9.8066"))
    assert part.outcome is Outcome.DRIFTED
    assert [line.record for line in part.lines] == ["const GRAVITY = 9.80665;"]


@pytest.mark.parametrize(
    "change",
    [
        lambda page: page.replace('id="references"', 'id="other"'),
        lambda page: page.replace('"orbits": [', '"orbits": [1, '),
        lambda page: page.replace('"names": [', '"names": ["one more", '),
        lambda page: page.replace('"orbits": [', "[" * 100_000),
        lambda page: page.replace('{"state": [', '{"state": [{}, ', 1),
        # As an array of texts, 300 MB.
        lambda page: page.replace('["displacement"', f'["{5_000_000 * "d"}"', 1),
        # What is in the block is not compared by its letters.
        lambda page: page.replace('"commit": "', '"commit": "</script><h1>Anything</h1>', 1),
        lambda page: page.replace('{"commit": ', '{"more": 1, "commit": ', 1),
        lambda page: page.replace('{"state": [', '{"more": 1, "state": [', 1),
        lambda page: page.replace('"phase"', '"contact_duration"', 1),
        lambda page: page.replace("\n</script>", "</script>"),
    ],
)
def test_a_page_that_holds_no_such_data_is_refused(data, change):
    page = to_html(data)
    assert change(page) != page
    with pytest.raises(UnreadableError):
        read_page(change(page))


def test_many_blocks_that_never_end(data):
    # Looked for from each beginning to the end of two megabytes, they took hours.
    with pytest.raises(UnreadableError, match="40000 blocks"):
        read_page(40_000 * '<script type="application/json" id="references">\n')
