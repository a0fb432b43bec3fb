"""The certified numbers of the paper: they agree with double precision and with the verdicts."""

import numpy as np
import pytest
import xarray as xr

from bouncing_ball.beyond.exhibits.proofs import Proofs, proofs
from bouncing_ball.paper.exhibits.printed_table1 import printed_text

GIVEN = {
    "n": (1, 2, 3),
    "restitution": 0.85,
    "frequency_ratio": (1e4, 10.0, 2.0),
    "thresholds": {"n": 1, "restitution": 0.65, "amplitude": 1.0, "tolerance": 0.01},
    "digits": 30,
}


@pytest.fixture(scope="module")
def data() -> xr.Dataset:
    return proofs(Proofs(**GIVEN))


def test_every_number_is_certified_to_its_digits(data, described):
    described(data)
    assert (data.certified_what != "").all() and (data.certified != "").all()
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
    for quantity in found["quantity"].values:
        words = str(quantity).replace("_", " ")
        name = "ϖ of permanent contact" if words == "permanent contact" else f"ϖ for 1% of {words}"
        exact = float(data.certified.sel(certificate=name))
        assert abs(float(found.sel(quantity=quantity)) / exact - 1) < 1e-9


def test_the_verdicts_on_printed_numbers_are_certain(data, recorded):
    """No verdict of the ledger would change if double precision were exact."""
    claims = recorded["claims"]
    certain = dict(zip(data.certificate.values, data.certified_print.values, strict=True))
    verdicts = {"reproduced": {"reproduced"}, "contradicted": {"close", "contradicted"}}
    checked = 0
    for ratio in GIVEN["frequency_ratio"]:
        for n in GIVEN["n"]:
            for bound in ("saddle-node", "period doubling"):
                printed = printed_text(ratio, n, bound)
                exact = float(
                    data.certified.sel(certificate=f"Λ of the {bound}, ϖ = {ratio:g}, n = {n}")
                )
                verdict = certain[f"Λ of the {bound}, ϖ = {ratio:g}, n = {n}"]
                same = (claims.printed_text == printed) & (abs(claims.found - exact) < 1e-9)
                assert same.sum() >= 1
                assert {*claims.verdict.values[same.values]} <= verdicts[verdict]
                checked += 1
    assert checked == 18
    for name, printed in (("ϖ for 1% of max height", "82"), ("ϖ of permanent contact", "6")):
        exact = float(data.certified.sel(certificate=name))
        same = (claims.printed_text == printed) & (abs(claims.found - exact) < 1e-6)
        assert {*claims.verdict.values[same.values]} <= verdicts[certain[name]]
        assert same.sum() >= 1


def test_other_parameters_have_nothing_printed():
    other = proofs(Proofs(**(GIVEN | {"restitution": 0.7, "n": (1,), "frequency_ratio": (10.0,)})))
    assert (other.certified_printed_text[:2] == "").all()
    assert np.isfinite(other.certified_approximation).all()
