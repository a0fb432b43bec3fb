"""Our statements about the whole motion on the accepted datasets, and on false ones."""

import numpy as np
import pytest
from declared_artifacts import ARTIFACTS

from bouncing_ball.beyond.exhibits import statements as whole_motion
from bouncing_ball.beyond.exhibits.statements import decided, statements
from bouncing_ball.paper.claims.claim import defined_in

# A false value of the variable that decides a statement; of an interval it is the bound itself.
FALSE = {
    "short periods agree": ("ext_locking", "agreement", 0.9),
    "long periods differ": ("ext_locking", "agreement", 0.25),
    "prediction ranks": ("ext_locked", "correlation_gain", 0.0),
    "dense discontinuities": ("ext_locked", "uncertainty_exponent", 0.1),
    "power needs more": ("ext_means", "right", 0.5),
    "compliant contacts throw": ("ext_basins", "basin_share", 0.02),
    "fractal boundaries": ("ext_basins", "uncertainty_exponent", 1.0),
    "smooth when stiffer": ("ext_basins", "uncertainty_exponent", 0.8),
    "stiff contacts lock": ("ext_lives", "chaotic_share", 0.01),
    "seeming chaos locks": ("ext_chaos", "locked_share", 0.9),
    "chaos beside locking": ("ext_lives", "chaotic_share", 0.01),
    "cascade moves as a whole": ("ext_cascades", "cascade_coefficient", [1, 2] * 3),
    "end of the first order": ("ext_cascades", "cascade_error", 0.1),
    "corrected cascades": ("ext_cascades", "cascade_second_order", 1.0),
    "feigenbaum": ("ext_cascades", "contact_cascade_ratio", 4.5),
    "transients alike": ("ext_lives", "mean_life", 50.0),
}
CLAIMS = {one.id: one for one in defined_in(whole_motion)}


def test_the_statements_read_the_datasets_whose_parameters_they_know():
    assert {*ARTIFACTS["statements"].reads} >= {*whole_motion.PARAMETERS}


@pytest.fixture(scope="module")
def data(recorded):
    return {name: recorded[name] for name in ARTIFACTS["statements"].reads}


def test_the_statements_on_the_accepted_datasets(data, described):
    found = described(statements(data))
    assert set(found.verdict.values) == {"confirmed"}
    assert np.all(found.low <= found.found) and np.all(found.found <= found.high)


@pytest.mark.parametrize("name", CLAIMS)
def test_a_false_dataset_turns_the_statement(data, name):
    dataset, variable, value = FALSE[name]
    whole = data[dataset].copy(deep=True)
    shape = np.broadcast_to(value, whole[variable].shape)
    ends = [x for x in ("", "_low", "_high") if f"{variable}{x}" in whole]
    whole = whole.assign({f"{variable}{x}": (whole[variable].dims, shape) for x in ends})
    assert CLAIMS[name].decide({**data, dataset: whole}).verdict == "contradicted"


def test_a_missing_limit_decides_nothing():
    assert decided([5, np.nan, 6], above=3).verdict == "not decided"
    assert decided([5, 4, np.inf], above=3).verdict == "confirmed"


def test_the_share_that_locks_later_is_of_the_balls_that_had_not_locked(data):
    """In each range of r, (locked at the end - locked at first)/(1 - locked at first)."""
    chaos = data["ext_chaos"]
    first, last = (chaos.locked_share.isel(followed=k).values for k in (0, -1))
    share, low, high = whole_motion.locked_later(chaos).T
    assert np.allclose(share, (last - first) / (1 - first), rtol=1e-12, atol=1e-12)
    assert np.all(low <= share) and np.all(share <= high)
    assert np.all(share[1:] <= last[1:])
