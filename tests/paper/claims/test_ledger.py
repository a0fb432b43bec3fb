"""The claims of the paper on the accepted datasets: complete, decided, explained."""

from pathlib import Path

import numpy as np
import pytest
import xarray as xr
import yaml

from bouncing_ball.beyond.exhibits import statements
from bouncing_ball.datasets.files import parameter_attributes, rows_beside
from bouncing_ball.paper.claims import claim
from bouncing_ball.paper.claims.ledger import CLAIMS, ledger, tally
from bouncing_ball.paper.claims.parameters import PARAMETERS
from bouncing_ball.pipeline.diff.datasets import compare_datasets

ROOT = Path(__file__).resolve().parents[3]
CONFIG = yaml.safe_load((ROOT / "config" / "config.yaml").read_text(encoding="utf-8"))


@pytest.fixture(scope="module")
def data(recorded, table):
    of_paper = table["claims"]["reads"]
    assert {*of_paper} == {*PARAMETERS}
    assert {*table["statements"]["reads"]} == {*statements.PARAMETERS}
    return {name: recorded[name] for name in of_paper}


@pytest.fixture(scope="module")
def verdicts(data, described):
    return described(ledger(data))


def test_names_are_unique_and_references_are_there():
    assert len({one.id for one in CLAIMS}) == len(CLAIMS)
    alone = [claim for claim in CLAIMS if not claim.restates]
    assert all(claim.restates in alone for claim in CLAIMS if claim.restates)


def test_every_formula_is_claimed_or_explains(data):
    named = " ".join(path.read_text("utf-8") for path in (ROOT / "src").glob("*/paper/claims/*.py"))
    listed = {row["row"] or row["item"] for row in rows_beside(claim.__file__)}
    rows = data["formulas"].formula.values
    assert all(row in listed or f'"{row}"' in named for row in rows)


def test_the_tally(verdicts):
    readme = (ROOT / "README.md").read_text(encoding="utf-8")
    assert f"\n{tally(verdicts)}\n" in readme


def test_a_motion_without_a_kind_is_not_chaos():
    kinds = next(claim for claim in CLAIMS if claim.id == "kinds of motion")
    for last, verdict in (("undecided", "contradicted"), ("chaotic", "reproduced")):
        found = xr.Dataset({"kind": (("model", "case"), [["orbit", "subharmonic", last]])})
        found = found.assign_coords(model=["restitution"])
        assert kinds.decide({"ext_locking": found}).verdict == verdict


def test_an_explanation_fails_with_its_checks(data):
    turned = data["fig06"].assign(apparent_restitution=2 - data["fig06"].apparent_restitution)
    result = ledger({**data, "fig06": turned})
    assert not result.explanation_holds.sel(explanation="swapped labels").item()
    assert "without explanation" in tally(result)


@pytest.mark.parametrize("name", [name for name, needed in PARAMETERS.items() if needed])
def test_the_committed_parameters_are_the_papers(name):
    parts = [CONFIG[part] for part in ("figures", "tables", "extensions", "studies")]
    section = dict(next(part[name] for part in parts if name in part))
    needed = parameter_attributes(PARAMETERS[name])
    given = parameter_attributes(section)
    assert {key: np.ravel(given[key]).tolist() for key in needed} == {
        key: np.ravel(value).tolist() for key, value in needed.items()
    }


def test_the_accepted_datasets_give_the_accepted_verdicts(verdicts, recorded):
    # Every claim's number, condition and reason, as somebody looked at and accepted them.
    found = compare_datasets("claims", recorded["claims"], verdicts)
    moved = [row for row in found if row.name != "header" and not row.outcome.agrees]
    assert {row.name for row in found} >= {*verdicts.variables} and moved == []
