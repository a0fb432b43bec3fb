"""The claims of the paper on the accepted datasets: complete, decided, explained."""

from pathlib import Path

import numpy as np
import pytest
import yaml

from bouncing_ball.claims.ledger import CLAIMS, EXPLANATIONS, READS, ledger
from bouncing_ball.claims.parameters import PARAMETERS
from bouncing_ball.claims.tally import tally
from bouncing_ball.datasets.netcdf import attribute_name, parameter_attributes

ROOT = Path(__file__).resolve().parents[2]
CONFIG = yaml.safe_load((ROOT / "config" / "config.yaml").read_text(encoding="utf-8"))


@pytest.fixture(scope="module")
def data(recorded):
    return {name: recorded[name] for name in READS}


@pytest.fixture(scope="module")
def verdicts(data, described):
    return described(ledger(data))


def test_names_are_unique_and_references_are_there():
    for part in (CLAIMS, EXPLANATIONS):
        names = [one.id for one in part]
        assert len(set(names)) == len(names)
    alone = [claim for claim in CLAIMS if not claim.restates]
    assert all(claim.restates in alone for claim in CLAIMS if claim.restates)
    assert {claim.explanation for claim in CLAIMS} - {None} == set(EXPLANATIONS)


def test_every_formula_is_claimed_or_explains(data):
    named = " ".join(path.read_text("utf-8") for path in (ROOT / "src").glob("*/claims/paper/*.py"))
    assert all(f'"{row}"' in named for row in data["formulas"].formula.values)


def test_the_tally(verdicts):
    assert tally(verdicts, 16) == (
        "16 figures, Table 1, 76 claims; 21 restored formulas: 20 reproduced, 1 contradicted; "
        "18 numbers: 5 reproduced, 5 close, 7 contradicted, 1 undecidable; "
        "37 statements: 24 reproduced, 7 contradicted, 6 undecidable; "
        "8 restatements: 4 reproduced, 4 contradicted"
    )


def test_nothing_that_differs_is_without_explanation(verdicts):
    assert verdicts.explained.values.astype(bool).all()
    assert verdicts.explanation_holds.values.astype(bool).all()


FOUND = {
    "stiff limit": ("reproduced", 0.0001322),
    "soft divergence": ("reproduced", 0.1592),
    "kinds of motion": ("reproduced", 3),
    "contact shortens": ("reproduced", -7.387e-05),
    "no assumptions": ("contradicted", 674.3),
    "needs continuation": ("contradicted", 7.69e-14),
    "existence changes": ("reproduced", 0.04228),
    "period doubling": ("contradicted", 0.0884),
    "stable between": ("reproduced", 0),
    "frequency ratio": ("undecidable", None),
    "critical damping": ("reproduced", 9.834e-06),
    "static table": ("undecidable", None),
    "moving table": ("reproduced", 3.363),
    "damping of 0.85": ("reproduced", 0.05166),
    "damping of 0.65": ("reproduced", 0.1359),
    "damping of 0.65, four digits": ("reproduced", 0.1359),
    "closer with stiffness": ("undecidable", None),
    "depends on amplitude": ("reproduced", 0.02506),
    "dip at 1.2": ("contradicted", -7.922e-08),
    "soft end of 1.2": ("reproduced", 0.809),
    "negligible above 100": ("reproduced", 0.001083),
    "equations cited": ("contradicted", 13.44),
    "no analytical solution": ("undecidable", None),
    "one impact per period": ("reproduced", 0),
    "figures of existence domains": ("contradicted", 2),
    "superimposed when stiff": ("reproduced", 0.0003146),
    "apart when soft": ("reproduced", 1.665),
    "saddle-node falls": ("reproduced", -0.01343),
    "period doubling rises": ("contradicted", -0.006062),
    "range widens": ("reproduced", 0.007365),
    "stiff row": ("reproduced", 1.517e-05),
    "velocity is not nπ": ("reproduced", 0.2738),
    "departure from nπ": ("undecidable", None),
    "amplitude does not matter": ("undecidable", None),
    "stiff threshold": ("reproduced", 9.631e-09),
    "velocity rises": ("reproduced", 3.961e-05),
    "height rises": ("reproduced", 0.0001087),
    "impact phase converges": ("reproduced", 0.001322),
    "release phase converges": ("reproduced", 0.002446),
    "height threshold": ("reproduced", 82.18),
    "representative": ("reproduced", 0.02788),
    "amplitude of Fig. 15": ("contradicted", 1.296),
    "permanent contact threshold": ("contradicted", 9.812),
    "permanent contact above 6": ("contradicted", 0.02673),
    "safe above 100": ("undecidable", None),
}


def test_an_explanation_fails_with_its_checks(data):
    turned = data["fig06"].assign(apparent_restitution=2 - data["fig06"].apparent_restitution)
    result = ledger({**data, "fig06": turned})
    assert not result.explanation_holds.sel(explanation="swapped labels").item()
    assert "without explanation" in tally(result, 16)


# Parameters that no verdict depends on: how finely a branch is drawn or how far, and what
# else a study computes.
HARMLESS = {
    **{name: {"amplitude_max", "points"} for name in ("fig03", "fig08", "fig09")},
    "fig11": {"frequency_ratio.min", "frequency_ratio.max", "frequency_ratio.samples"},
    **{key: {"frequency_ratio.min", "frequency_ratio.samples"} for key in ("fig13", "fig14")},
    "fig15": {"points"},
    "table1": {"amplitude_max"},
    "ext_release": "thresholds",
    "motions": "ensemble",
}


@pytest.mark.parametrize("name", [name for name, needed in PARAMETERS.items() if needed])
def test_every_parameter_is_the_papers_or_harmless(name):
    parts = [CONFIG[part] for part in ("figures", "tables", "extensions", "studies")]
    section = dict(next(part[name] for part in parts if name in part))
    harmless = HARMLESS.get(name, set())
    if isinstance(harmless, str):
        del section[harmless]
        harmless = set()
    needed = set(PARAMETERS[name])
    assert not needed & harmless
    assert set(parameter_attributes(section)) == {attribute_name(x) for x in needed | harmless}


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
