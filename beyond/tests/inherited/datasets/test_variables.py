"""The vocabulary of the datasets: its rows are complete, and unknown names are refused."""

import numpy as np
import pytest
import xarray as xr
from declared_artifacts import BUDGETS

from bouncing_ball_beyond.inherited.datasets.variables import SHARED, Variable, describe
from bouncing_ball_beyond.inherited.errors import ModelError
from bouncing_ball_beyond.inherited.pipeline.diff.datasets import budget_of

# Measured impacts have units; everything else is dimensionless.
IN_SI = dict.fromkeys(("measured_speed", "curve_speed", "shaker_speed"), "m s-1") | {
    "shaker_frequency": "Hz",
    "time_step": "s",
    "driver_step": "s",
    "driver_height": "m",
    "driver_certified": "m",
    "drop_height": "m",
}


def test_every_declaration_is_complete(declared):
    for name, entry in declared.items():
        assert name.isidentifier()
        assert entry.units == IN_SI.get(name, "rad" if name.endswith("phase") else "1")
        assert entry.long_name and entry.long_name == entry.long_name.strip()
        assert not entry.equation or entry.equation.startswith(("Eq", "Table"))


def test_no_two_names_mean_the_same(declared):
    pairs = [(entry.long_name, entry.symbol) for entry in declared.values()]
    assert len(set(pairs)) == len(pairs)


def test_the_budgets_name_what_there_is(declared):
    whole = {name: budget_of(one.attributes()) for name, one in declared.items()}
    for budgets in (whole, *BUDGETS.values()):
        for name, budget in budgets.items():
            assert budget.size > 0 and (name in declared or name == "*")
            assert budget.over in ("", *declared) and budget.scale in ("", "1", *declared)


def test_each_variable_and_each_dimension_is_described():
    data = xr.Dataset({"phase": ("point", [0.5, 1.0]), "release": ("case", ["force"])})
    result = describe(data.assign_coords(frequency_ratio=2.0))
    assert result.phase.attrs == {
        "long_name": SHARED["phase"].long_name,
        "units": "rad",
        "symbol": "φ",
        "equation": "Eqs. 6, 21",
    }
    # Coordinates and what is no number are described too.
    for name in ("release", "case", "frequency_ratio"):
        assert result[name].attrs["long_name"] == SHARED[name].long_name
        assert result[name].attrs["units"] == "1"
    # The data stay, and so does the argument.
    assert np.array_equal(result.phase, data.phase) and data.phase.attrs == {}


def test_a_study_describes_the_variables_that_only_it_writes():
    own = {"depth": Variable("depth of the contact", symbol="d", budget=1e-9, scale="1")}
    result = describe(xr.Dataset({"depth": ("point", [0.0])}), own)
    assert result.depth.attrs["symbol"] == "d" and result.depth.attrs["budget"] == 1e-9


def test_unknown_names_are_refused():
    with pytest.raises(ModelError, match="velocity_of_light"):
        describe(xr.Dataset({"velocity_of_light": 1.0}))
    with pytest.raises(ModelError, match="elsewhere"):
        describe(xr.Dataset({"phase": 1.0}, coords={"elsewhere": 2.0}))
