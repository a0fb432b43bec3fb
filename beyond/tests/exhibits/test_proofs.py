"""The certified numbers of the paper, and the verdicts on printed numbers that they decide."""

import csv
from pathlib import Path

import numpy as np
import pytest
import xarray as xr

from bouncing_ball.errors import ModelError
from bouncing_ball.pipeline.yaml_files import read_yaml
from bouncing_ball_beyond.exhibits.certified_verdicts import (
    certified_interval,
    certified_verdicts,
)
from bouncing_ball_beyond.exhibits.certified_verdicts_figures import ext_verdicts
from bouncing_ball_beyond.exhibits.proofs import (
    Proofs,
    ToleratedError,
    certified_thresholds,
    proofs,
)

CONFIG = Path(__file__).resolve().parents[2] / "config" / "config.yaml"
GIVEN = read_yaml(CONFIG)["beyond"]["ext_proofs"]
FIGURES = Path(__file__).resolve().parents[2] / "figures"


@pytest.fixture(scope="module")
def data() -> xr.Dataset:
    return proofs(Proofs(**GIVEN))


@pytest.fixture(scope="module")
def printed(recorded) -> list[str]:
    """The claims of printed numbers in the accepted ledger."""
    ledger = recorded["claims"]
    return ledger.claim.values[ledger.printed_text.values != ""].tolist()


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


def test_only_numbers_that_the_paper_prints_are_certified(data, printed):
    assert {*data.certified_claim.values} == {*printed}
    assert data.sizes["certificate"] == len(printed)


def test_an_error_without_a_threshold_says_that_none_was_found():
    """At Λ = 1000 the restitution model is not right within 15 % on any contact."""
    orbit = ToleratedError(n=16, restitution=0.65, amplitude=1000.0, tolerance=0.1545)
    rows = list(certified_thresholds(orbit, 20))
    missing = [row for row in rows if row.ball is None]
    assert any("no threshold was found to start from" in row.what for row in missing)


def test_every_printed_number_has_one_certificate_around_the_number_of_its_claim(
    data, recorded, printed
):
    found = recorded["claims"].found
    for claim in printed:
        value, low, high = certified_interval(data, claim)
        assert low < value < high and high - low < 5e-16 * abs(value)
        # The least accurate number of double precision is a threshold, to 1e-9.
        assert abs(float(found.sel(claim=claim)) / value - 1) < 1e-9


def test_the_certified_verdicts_are_those_of_the_ledger(data, recorded, printed, described):
    found = described(certified_verdicts({"ext_proofs": data, "claims": recorded["claims"]}))
    assert found.claim.values.tolist() == printed
    assert (found.verdict == recorded["claims"].verdict.sel(claim=found.claim)).all()
    assert {*found.verdict.values} == {"reproduced", "differs in the last digits", "contradicted"}
    header, body = ext_verdicts(found)
    assert len(body) == len(printed) and len(header) == 6


def test_the_verdicts_are_those_of_the_record(recorded):
    """Also their deviations, which the table has with three digits."""
    found = certified_verdicts(recorded)
    names = ["verdict", "printed_text", "low", "high", "found", "deviation", "deviation_units"]
    xr.testing.assert_allclose(found[names], recorded["ext_verdicts"][names], rtol=1e-12)
    with FIGURES.joinpath("ext_verdicts.csv").open(encoding="utf-8", newline="") as file:
        header, *body = csv.reader(file)
    assert (header, body) == ext_verdicts(found)


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


def test_a_printed_number_without_a_certificate_is_listed(data, recorded):
    some = data.isel(certificate=data.certified_claim.values != "height threshold")
    text = data.certified.astype(object)
    text[(data.certified_claim == "height threshold").values] = ""
    for missing in (some, data.assign(certified=text)):
        found = certified_verdicts({"ext_proofs": missing, "claims": recorded["claims"]})
        one = found.sel(claim="height threshold")
        assert one.verdict == "not certified" and np.isnan(one.low) and np.isnan(one.deviation)
        assert (found.verdict == "not certified").sum() == 1
        assert any(row[2:] == ["not certified", "", "–", "–"] for row in ext_verdicts(found)[1])


def test_two_certificates_of_a_number_stop_the_run(data, recorded):
    twice = xr.concat([data, data.isel(certificate=[0])], "certificate")
    with pytest.raises(ModelError, match="has 2 certificates"):
        certified_verdicts({"ext_proofs": twice, "claims": recorded["claims"]})


def test_numbers_of_other_parameters_are_those_of_no_claim(recorded):
    other = GIVEN | {"restitution": 0.7, "n": [1], "frequency_ratio": [10.0]}
    for name in ("thresholds", "apparent"):
        other[name] = other[name] | {"restitution": 0.7}
    found = proofs(Proofs(**other))
    assert np.isfinite(found.certified_approximation).all()
    assert (found.certified_claim == "").all()
    verdicts = certified_verdicts({"ext_proofs": found, "claims": recorded["claims"]})
    assert (verdicts.verdict == "not certified").all()
