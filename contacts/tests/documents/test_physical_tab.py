"""The physical tab of beyond's explorer in a real browser: what it says is what ``design`` says."""

import math
import runpy
from pathlib import Path

import pytest

from bouncing_ball_contacts.contact.texts import shown

PAGE = Path(__file__).parents[3] / "beyond" / "tests" / "explorer" / "test_page_in_browser.py"
TESTS = runpy.run_path(str(PAGE))
# Fixtures: what the browser made of the page, and the answer of a command.
seen = TESTS["seen"]
answered = TESTS["answered"]
RELEASES = TESTS["RELEASES"]

pytestmark = pytest.mark.slow

MODELS = "spring-damper", "restitution", "corrected"
SAMPLED = {"greatest_compression", "peak_force", "peak_force_over_weight", "permanent_contact"}


def agree(page, expected, **bounds):
    """What the page shows is what is expected, and no number where that is None."""
    numbers = {name: float(page[name]) for name in expected}
    found = {name: x if math.isfinite(x) else None for name, x in numbers.items()}
    assert found == pytest.approx(expected, **bounds)


@pytest.mark.parametrize("case", range(len(RELEASES)))
def test_the_physical_tab_says_what_the_command_prints(case, seen, answered, short_runs):
    state = seen["physical"][case]
    said = answered(state["command"])
    page = state["rows"] | state["values"]
    orbit, *_ = said["orbits"]
    assert (state["refused"], state["chosen"], said["law"]) == ("", str(RELEASES[case]), None)
    numbers = said | orbit | said["corrected"] | said["time_step"]
    numbers = {name: numbers[name] for name in page if name in numbers}
    assert len(numbers) >= 18
    for name, found in zip(MODELS, orbit["standing"].values(), strict=True):
        numbers |= {f"{name} {x}": found[x] for x in ("saddle_node", "period_doubling")}
    agree(page, {name: numbers[name] for name in numbers if name not in SAMPLED}, rel=1e-9)
    agree(page, {name: numbers[name] for name in SAMPLED}, rel=1e-5)
    for kind in ("errors", "corrected_errors"):
        found = {f"{kind} {x}": y for x, y in orbit[kind].items()}
        agree(page, found, rel=0, abs=3e-8)
    if orbit["is_stable"] and orbit["is_admissible"]:
        # The page judges orbits only, and no ball that is laid on the table.
        verdict = said["verdict"].partition("; a ball laid")[0].rstrip(".")
        assert state["verdict"].startswith(verdict)
    else:
        assert "unstable" in state["verdict"] or not orbit["exists"]
    assert state["notes"] == [f"{note}." for note in said["notes"]]


def test_each_verdict_has_the_shares_of_starts_beside_it(seen, answered, short_motions):
    few, some, wide, tie = seen["counted"]
    for state in (few, some, wide, tie):
        said = answered(state["command"])
        share = said["starts"].get(f"orbit {said['n']}/1", 0.0)
        assert state["share"] == share
        assert state["starts"].startswith("Of 144 balls with other starts, ")
        assert share == 0 or f"{shown(share, '%')} " in state["starts"]
    assert tie["share"] == 9 / 144 and "only 6.2 % of the starts end on it" in tie["verdict"]
    assert "94 % end at rest on the table" in tie["starts"]
    # A verdict on an orbit that few balls reach is not the headline.
    assert few["share"] == 0 and few["good"] == "false"
    headline = "Most balls end otherwise than on the stable 5-T orbit: no start ends on it."
    assert few["verdict"] == headline
    assert "Of the orbit alone: The restitution model is good enough: " in few["starts"]
    assert some["good"] == "false" and "on the 1-T orbit" in some["starts"]
    assert wide["good"] == "true" and "+1.2 %, within 5 %." in wide["verdict"]
    assert '--tolerance "5 %"' in wide["command"]


def test_a_contact_that_is_too_long_is_refused_in_the_words_of_the_command(seen, refused):
    call = "design --mass 20g --frequency 50Hz --acceleration 0.8g --n 1"
    _, line = refused(*call.split(), "--stiffness", "1e-9", "--restitution", "0.85")
    state = seen["tooLong"]
    assert f"bouncing-ball: {state['refused']}" == line
    assert state["verdict"] == state["command"] == ""
