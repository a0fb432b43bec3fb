"""The claims of the paper on the accepted datasets: complete, decided, explained."""

from pathlib import Path

import numpy as np
import pytest
import xarray as xr
import yaml
from declared_artifacts import ARTIFACTS

from bouncing_ball.datasets.files import parameter_attributes
from bouncing_ball.paper.claims.claims import CLAIMS, claims, tally
from bouncing_ball.paper.claims.parameters import PARAMETERS
from bouncing_ball.pipeline.diff.datasets import compare_datasets

ROOT = Path(__file__).resolve().parents[3]
CONFIG = yaml.safe_load((ROOT / "config" / "config.yaml").read_text(encoding="utf-8"))


@pytest.fixture(scope="module")
def data(recorded):
    of_paper = ARTIFACTS["claims"].reads
    assert {*of_paper} == {*PARAMETERS}
    return {name: recorded[name] for name in of_paper}


@pytest.fixture(scope="module")
def verdicts(data, described):
    return described(claims(data))


def test_names_are_unique_and_references_are_there():
    assert len({one.id for one in CLAIMS}) == len(CLAIMS)
    alone = [claim for claim in CLAIMS if not claim.restates]
    assert all(claim.restates in alone for claim in CLAIMS if claim.restates)


def test_every_formula_is_claimed_or_explains(data):
    named = " ".join(path.read_text("utf-8") for path in (ROOT / "src").glob("*/paper/claims/*.py"))
    assert all(f'"{row}"' in named for row in data["formulas"].formula.values)


def test_the_readme_has_the_tally_of_the_accepted_verdicts(verdicts):
    readme = (ROOT / "README.md").read_text(encoding="utf-8")
    assert f"\n{tally(verdicts)}\n" in readme


@pytest.mark.parametrize(
    ("change", "verdict"),
    [
        ({}, "reproduced"),
        ({"lyapunov_error": 0.1}, "contradicted"),
        ({"lyapunov_exponent": -0.4}, "contradicted"),
        ({"stickings": 1}, "contradicted"),
        ({"impacts": 8, "periods": 8}, "contradicted"),
    ],
)
def test_a_ball_is_chaotic_only_if_its_neighbours_separate_and_it_never_sticks(change, verdict):
    assert verdict_on_kinds([1, 2], change) == verdict


def test_two_subharmonic_balls_and_a_chaotic_one_are_not_all_kinds_of_motion():
    assert verdict_on_kinds([2, 2], {}) == "contradicted"
    assert verdict_on_kinds([1, 1], {}) == "contradicted"


def verdict_on_kinds(repetitions, change):
    """The verdict for two balls that repeat after so many impacts, and a chaotic one, changed."""
    kinds = next(claim for claim in CLAIMS if claim.id == "kinds of motion")
    known = {"impacts": repetitions, "periods": repetitions, "stickings": [0, 0]}
    known |= {"lyapunov_exponent": [np.nan] * 2, "lyapunov_error": [np.nan] * 2}
    last = {"impacts": 0, "periods": 0, "stickings": 0}
    last |= {"lyapunov_exponent": 0.4, "lyapunov_error": 0.01} | change
    balls = xr.Dataset({name: ("amplitude", [*two, last[name]]) for name, two in known.items()})
    return kinds.decide({"three_balls": balls}).verdict


def test_an_explanation_fails_with_its_checks(data):
    turned = data["fig06"].assign(apparent_restitution=2 - data["fig06"].apparent_restitution)
    result = claims({**data, "fig06": turned})
    assert not result.explanation_holds.sel(explanation="swapped labels").item()
    assert "without explanation" in tally(result)


@pytest.mark.parametrize("name", [name for name, needed in PARAMETERS.items() if needed])
def test_the_committed_parameters_are_the_papers(name):
    needed = parameter_attributes(PARAMETERS[name])
    given = parameter_attributes(CONFIG["paper"][name])
    assert {key: np.ravel(given[key]).tolist() for key in needed} == {
        key: np.ravel(value).tolist() for key, value in needed.items()
    }


def test_the_accepted_datasets_give_the_accepted_verdicts(verdicts, recorded):
    # Every claim's number, condition and reason, as somebody looked at and accepted them.
    found = compare_datasets("claims", recorded["claims"], verdicts)
    moved = [row for row in found if row.name != "header" and not row.outcome.agrees]
    assert {row.name for row in found} >= {*verdicts.variables} and moved == []
