"""The certified numbers of the paper, and the verdicts on printed numbers that they decide."""

from pathlib import Path

import numpy as np
import pytest
import xarray as xr

from bouncing_ball.beyond.exhibits.certified_verdicts import (
    certified_interval,
    certified_verdicts,
)
from bouncing_ball.beyond.exhibits.certified_verdicts_figures import ext_verdicts
from bouncing_ball.beyond.exhibits.proofs import (
    Proofs,
    ToleratedError,
    certified_thresholds,
    proofs,
)
from bouncing_ball.datasets.files import parameter_attributes
from bouncing_ball.errors import ModelError
from bouncing_ball.paper.claims.claims import CLAIMS
from bouncing_ball.pipeline.yaml_files import read_yaml

CONFIG = Path(__file__).resolve().parents[3] / "config" / "config.yaml"
GIVEN = read_yaml(CONFIG)["beyond"]["ext_proofs"]
PRINTED = [claim for claim in CLAIMS if claim.printed]


def certified(given) -> xr.Dataset:
    """The dataset with its parameters as attributes, as a run makes it."""
    return proofs(Proofs(**given)).assign_attrs(parameter_attributes(given))


@pytest.fixture(scope="module")
def data() -> xr.Dataset:
    return certified(GIVEN)


def test_every_number_is_certified_to_its_digits(data, described):
    described(data)
    assert (data.certified_what != "").all() and (data.certified != "").all()
    assert (data.certified_bits > 300).all()
    radius = data.certified_radius.astype(float) / data.certified_approximation
    assert radius.max() < 1e-28


def test_the_ends_of_table_1_are_those_of_double_precision(data, recorded):
    table = recorded["table1"].computed
    for ratio in table.frequency_ratio.values:
        for n in table.n.values:
            for bound in table.bound.values:
                name = f"Λ of the {bound}, ϖ = {ratio:g}, n = {n}"
                exact = float(data.certified.sel(certificate=name))
                # The record has Newton's method in double precision on the equations of the orbit.
                assert (
                    abs(float(table.sel(frequency_ratio=ratio, n=n, bound=bound)) - exact) < 1e-11
                )


def test_the_thresholds_are_those_of_double_precision(data, recorded):
    found = recorded["thresholds"].error_threshold.sel({"tolerance": 0.01})
    names = {"max_height": "ϖ for 1% of max height", "permanent_contact": "ϖ of permanent contact"}
    for quantity, name in names.items():
        exact = float(data.certified.sel(certificate=name))
        assert abs(float(found.sel(quantity=quantity)) / exact - 1) < 1e-9


def test_only_numbers_that_the_paper_prints_are_certified(data):
    assert {*data.certified_claim.values} == {claim.id for claim in PRINTED}
    assert data.sizes["certificate"] == len(PRINTED)


def test_an_error_without_a_threshold_says_that_none_was_found():
    """At Λ = 1000 the restitution model is not right within 15 % on any contact."""
    orbit = ToleratedError(n=16, restitution=0.65, amplitude=1000.0, tolerance=0.1545)
    rows = list(certified_thresholds(orbit, 20))
    missing = [row for row in rows if row.ball is None]
    assert any("no threshold was found to start from" in row.what for row in missing)


def test_every_printed_number_has_one_certificate_around_the_number_of_its_claim(data, recorded):
    found = recorded["claims"].found
    for claim in PRINTED:
        value, low, high = certified_interval({"ext_proofs": data}, claim.id)
        assert low < value < high and high - low < 5e-16 * abs(value)
        # The least accurate number of double precision is a threshold, to 1e-9.
        assert abs(float(found.sel(claim=claim.id)) / value - 1) < 1e-9


def test_the_certified_verdicts_are_those_of_the_ledger(data, recorded):
    found = certified_verdicts({"ext_proofs": data, "claims": recorded["claims"]})
    assert [*found.claim.values] == [claim.id for claim in PRINTED]
    assert (found.verdict == recorded["claims"].verdict.sel(claim=found.claim)).all()
    assert {*found.verdict.values} == {"reproduced", "differs in the last digits", "contradicted"}
    header, body = ext_verdicts(found)
    assert len(body) == len(PRINTED) and len(header) == 6


def test_a_verdict_that_differs_from_the_ledger_stops_the_run(data, recorded):
    verdict = recorded["claims"].verdict.copy()
    verdict.loc["height threshold"] = "contradicted"
    ledger = recorded["claims"].assign(verdict=verdict)
    said = (
        "'height threshold': reproduced by its certified interval, but contradicted in the ledger"
    )
    with pytest.raises(ModelError, match=said):
        certified_verdicts({"ext_proofs": data, "claims": ledger})


def test_a_wide_interval_decides_nothing_and_stops_the_run(data, recorded):
    radius = data.certified_radius.astype(object)
    radius[(data.certified_claim == "height threshold").values] = "1.0"
    wide = data.assign(certified_radius=radius)
    with pytest.raises(ModelError, match="not decided by its certified interval"):
        certified_verdicts({"ext_proofs": wide, "claims": recorded["claims"]})


def test_a_printed_number_without_a_certificate_stops_the_run(data, recorded):
    some = data.isel(certificate=data.certified_claim.values != "height threshold")
    with pytest.raises(ModelError, match="0 certificates instead of one"):
        certified_verdicts({"ext_proofs": some, "claims": recorded["claims"]})
    text = data.certified.astype(object)
    text[(data.certified_claim == "height threshold").values] = ""
    refused = data.assign(certified=text)
    with pytest.raises(ModelError, match="not certified"):
        certified_verdicts({"ext_proofs": refused, "claims": recorded["claims"]})


def test_with_other_parameters_no_verdict_is_certified(recorded):
    other = certified(GIVEN | {"restitution": 0.7, "n": [1], "frequency_ratio": [10.0]})
    assert np.isfinite(other.certified_approximation).all()
    found = certified_verdicts({"ext_proofs": other, "claims": recorded["claims"]})
    assert (found.verdict == "not asked").all()
