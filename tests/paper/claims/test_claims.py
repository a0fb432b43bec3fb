"""The claims of the paper on the accepted datasets: complete, decided, explained."""

from pathlib import Path

import numpy as np
import pytest
import xarray as xr
from declared_artifacts import read_by

from bouncing_ball.datasets.files import parameter_attributes
from bouncing_ball.errors import ModelError
from bouncing_ball.paper.claims import claims as claims_module
from bouncing_ball.paper.claims.claims import CLAIMS, claims, tally
from bouncing_ball.paper.claims.paper_parameters import PAPER, digest, of_dataset
from bouncing_ball.pipeline.diff.datasets import compare_datasets
from bouncing_ball.pipeline.yaml_files import read_yaml

ROOT = Path(__file__).resolve().parents[3]
# Rows about which the paper claims nothing: the definitions of r_a and of the error of a model,
# with which the package computes, and ϖ inverted, which results if its letters mean the opposite.
DEFINITIONS = ("Eq. 17", "Eqs. 37-38", "ϖ = Ω/ω, Ω of the table")


@pytest.fixture(scope="module")
def data(recorded):
    of_paper = read_by("claims")
    assert {*of_paper} == {*PAPER, "formulas", "forensics", "witness"}
    return {name: recorded[name] for name in of_paper}


@pytest.fixture(scope="module")
def verdicts(data, described):
    return described(claims(data))


def test_two_claims_of_one_name_are_refused(monkeypatch, recorded, refusal):
    monkeypatch.setattr(claims_module, "CLAIMS", (*CLAIMS, CLAIMS[0]))
    with refusal(ModelError, f"'{CLAIMS[0].id}' is the name of two claims"):
        claims(recorded)


def test_names_are_unique_and_references_are_there():
    assert len({one.id for one in CLAIMS}) == len(CLAIMS)
    alone = [claim for claim in CLAIMS if not claim.restates]
    assert all(claim.restates in alone for claim in CLAIMS if claim.restates)


@pytest.mark.parametrize(
    ("dip", "thousandth", "hundredth"),
    [(0.0099, True, False), (0.0101, True, True), (0.00099, False, False)],
)
def test_a_dip_is_visible_from_the_share_on_that_is_named(monkeypatch, dip, thousandth, hundredth):
    monkeypatch.setattr("bouncing_ball.paper.claims.evidence.dip", lambda data, amplitude: dip)
    (one,) = (claim for claim in CLAIMS if claim.id == "dip at 1.2")
    findings = one.decide({})
    seen = {reading: found.verdict == "reproduced" for reading, found in findings.items()}
    assert seen == {"a thousandth is visible": thousandth, "a hundredth is visible": hundredth}


def test_every_row_says_what_is_compared_and_at_which_parameters(verdicts):
    assert (verdicts.compared != "").all() and (verdicts.parameters != "").all()
    of_table = verdicts.parameters.sel(claim="Table 1: 10, 3, saddle-node").item()
    assert of_table == "r = 0.85, n = 3, ϖ = 10, ζ = 0.0517"
    of_pairs = verdicts.parameters.sel(claim="negligible above 100").item()
    pairs = "(r, Λ) = (1, 0.8), (0.85, 1), (0.65, 1), (0.1, 2.6)"
    assert of_pairs.startswith(f"Fig. 5: {pairs}, n = 1, ϖ = 1 to 1000, ")
    # What the text does not have is named where the verdict hangs on it, and nowhere else.
    undecided = verdicts.verdict == "undecidable"
    assert (verdicts.missing[undecided] != "").all() and undecided.any()
    assert (verdicts.missing[verdicts.verdict == "in one reading"] == "").all()


def test_every_formula_is_claimed_or_explains(data):
    named = " ".join(path.read_text("utf-8") for path in (ROOT / "src").glob("*/paper/claims/*.py"))
    rows = {*data["formulas"].formula.values} - {*DEFINITIONS}
    assert all(f'"{row}"' in named for row in rows)


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


def test_claims_are_decided_for_the_parameters_of_the_configuration():
    config = read_yaml(ROOT / "config" / "config.yaml")
    for name, (expected, *names) in PAPER.items():
        given = parameter_attributes(config["paper"][name] | {"release": config["release"]})
        assert digest(of_dataset(given, tuple(names))) == expected, name


def test_the_accepted_datasets_give_the_accepted_verdicts(verdicts, recorded):
    # Every claim's number, condition and reason, as somebody looked at and accepted them.
    record = recorded["claims"]
    found = compare_datasets(record, verdicts.assign_attrs(record.attrs))
    moved = [row for row in found if row.name != "header" and not row.outcome.agrees]
    assert {row.name for row in found} >= {*verdicts.variables} and moved == []


@pytest.mark.parametrize(
    ("away", "broken"),
    # At a bifurcation itself, and within the rounding of a grid, rounding decides.
    [(0.0, False), (1e-10, False), (-1e-10, False), (1e-8, True), (-1e-8, True)],
)
@pytest.mark.parametrize("bifurcation", [0.5, 1.1])
def test_one_orbit_of_the_wrong_stability_breaks_the_rule_of_figure_3(bifurcation, away, broken):
    stable_between = next(claim for claim in CLAIMS if claim.id == "stable between")
    amplitude = np.array([0.6, bifurcation * (1 + away), 2.0])
    is_between = (amplitude > 0.5) & (amplitude < 1.1)
    stable = np.where([False, True, False], ~is_between, is_between)
    orbits = xr.Dataset(
        {
            "amplitude": ("point", amplitude),
            "phase": ("point", [0.1, 0.2, 0.3]),
            "stable": ("point", stable),
            "saddle_node_amplitude": 0.5,
            "period_doubling_amplitude": ("impact_map", [1.1]),
        },
        coords={"impact_map": ["exact"]},
    )
    verdict = stable_between.decide({"fig03": orbits}).verdict
    assert verdict == ("contradicted" if broken else "reproduced")
