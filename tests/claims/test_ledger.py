"""The claims of the paper on the accepted datasets: complete, decided, explained."""

from pathlib import Path

import numpy as np
import pytest
import yaml

from bouncing_ball.claims.ledger import CLAIMS, READS, ledger
from bouncing_ball.claims.parameters import PARAMETERS
from bouncing_ball.claims.tally import tally
from bouncing_ball.datasets.netcdf import parameter_attributes

ROOT = Path(__file__).resolve().parents[2]
CONFIG = yaml.safe_load((ROOT / "config" / "config.yaml").read_text(encoding="utf-8"))


@pytest.fixture(scope="module")
def data(recorded):
    return {name: recorded[name] for name in READS}


@pytest.fixture(scope="module")
def verdicts(data, described):
    return described(ledger(data))


def test_names_are_unique_and_references_are_there():
    assert len({one.id for one in CLAIMS}) == len(CLAIMS)
    alone = [claim for claim in CLAIMS if not claim.restates]
    assert all(claim.restates in alone for claim in CLAIMS if claim.restates)


def test_every_formula_is_claimed_or_explains(data):
    named = " ".join(path.read_text("utf-8") for path in (ROOT / "src").glob("*/claims/paper/*.py"))
    assert all(f'"{row}"' in named for row in data["formulas"].formula.values)


def test_the_tally(verdicts):
    assert tally(verdicts, 16) == (
        "16 figures, Table 1, 67 claims; 20 restored formulas: 19 reproduced, 1 contradicted; "
        "17 numbers: 5 reproduced, 5 close, 7 contradicted; "
        "30 statements: 22 reproduced, 2 contradicted, 6 undecidable; "
        "6 restatements: 3 reproduced, 3 contradicted"
    )


def test_nothing_that_differs_is_without_explanation(verdicts):
    assert verdicts.explained.values.astype(bool).all()
    assert verdicts.explanation_holds.values.astype(bool).all()


FOUND = {
    "stiff limit": ("reproduced", 0.0001322),
    "soft divergence": ("reproduced", 0.1592),
    "kinds of motion": ("reproduced", 3),
    "contact shortens": ("reproduced", -7.387e-05),
    "period doubling": ("contradicted", 0.0884),
    "stable between": ("reproduced", 0),
    "frequency ratio": ("undecidable", None),
    "critical damping": ("reproduced", 9.834e-06),
    "static table": ("undecidable", None),
    "moving table": ("reproduced", 3.363),
    "damping of 0.85": ("reproduced", 0.05166),
    "damping of 0.65": ("reproduced", 0.1359),
    "closer with stiffness": ("undecidable", None),
    "depends on amplitude": ("reproduced", 0.02506),
    "dip at 1.2": ("contradicted", -7.922e-08),
    "soft end of 1.2": ("reproduced", 0.809),
    "negligible above 100": ("reproduced", 0.001083),
    "no analytical solution": ("undecidable", None),
    "one impact per period": ("reproduced", 0),
    "superimposed when stiff": ("reproduced", 0.0003146),
    "apart when soft": ("reproduced", 1.513),
    "saddle-node falls": ("reproduced", -0.01343),
    "period doubling rises": ("contradicted", -0.006062),
    "range widens": ("reproduced", 0.007365),
    "stiff row": ("reproduced", 1.517e-05),
    "departure from nπ": ("reproduced", 0.002706),
    "amplitude does not matter": ("undecidable", None),
    "stiff threshold": ("reproduced", 9.631e-09),
    "velocity rises": ("reproduced", 3.961e-05),
    "height rises": ("reproduced", 0.0001087),
    "phases converge": ("reproduced", 0.002446),
    "height threshold": ("reproduced", 82.18),
    "representative": ("reproduced", 0.02788),
    "permanent contact threshold": ("contradicted", 9.812),
    "safe above 100": ("undecidable", None),
}


def test_an_explanation_fails_with_its_checks(data):
    turned = data["fig06"].assign(apparent_restitution=2 - data["fig06"].apparent_restitution)
    result = ledger({**data, "fig06": turned})
    assert not result.explanation_holds.sel(explanation="swapped labels").item()
    assert "without explanation" in tally(result, 16)


@pytest.mark.parametrize("name", [name for name, needed in PARAMETERS.items() if needed])
def test_the_committed_parameters_are_the_papers(name):
    parts = [CONFIG[part] for part in ("figures", "tables", "extensions", "studies")]
    section = dict(next(part[name] for part in parts if name in part))
    needed = parameter_attributes(PARAMETERS[name])
    given = parameter_attributes(section)
    assert {key: np.ravel(given[key]).tolist() for key in needed} == {
        key: np.ravel(value).tolist() for key, value in needed.items()
    }


@pytest.mark.parametrize("claim", FOUND)
def test_verdicts_and_numbers(verdicts, claim):
    verdict, found = FOUND[claim]
    row = verdicts.sel(claim=claim)
    assert row.verdict.item() == verdict
    if found is None:
        assert row.reason.item().startswith("depends on the reading: ")
    else:
        assert row.found.item() == pytest.approx(found, rel=1e-3, abs=1e-7)


def test_the_numbers_that_the_article_prints(verdicts):
    assert np.isfinite(verdicts.range_error).all()
    assert verdicts.attrs["tolerance"] == 0.01
