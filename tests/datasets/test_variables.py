"""The vocabulary of the datasets: its rows are complete, and unknown names are refused."""

from pathlib import Path

import numpy as np
import pytest
import xarray as xr

from bouncing_ball.compare.budgets import ARTIFACTS, budget_of
from bouncing_ball.datasets import variables
from bouncing_ball.datasets.variables import VARIABLES, describe
from bouncing_ball.errors import ModelError


def test_every_entry_is_complete():
    for name, entry in VARIABLES.items():
        assert name.isidentifier()
        assert list(entry) == ["long_name", "symbol", "units", "equation"]
        assert entry["units"] == ("rad" if name.endswith("phase") else "1")
        assert entry["long_name"] and entry["long_name"] == entry["long_name"].strip()
        assert not entry["equation"] or entry["equation"].startswith(("Eq", "Table"))
    # A name stands once, and two names do not mean the same.
    rows = (Path(variables.__file__).with_suffix(".csv")).read_text(encoding="utf-8").splitlines()
    assert len(rows) == len(VARIABLES) + 1
    pairs = [(entry["long_name"], entry["symbol"]) for entry in VARIABLES.values()]
    assert len(set(pairs)) == len(pairs)


def test_the_budgets_name_what_there_is():
    whole = {name: budget_of("any", name) for name in VARIABLES}
    for budgets in (whole, *ARTIFACTS.values()):
        for name, budget in budgets.items():
            assert budget.size > 0 and (name in VARIABLES or name == "*")
            assert budget.over in ("", *VARIABLES) and budget.scale in ("", "1", *VARIABLES)


def test_describe():
    data = xr.Dataset({"phase": ("point", [0.5, 1.0]), "special_kind": ("special", ["fold"])})
    result = describe(data.assign_coords(frequency_ratio=2.0))
    assert result.phase.attrs == {
        "long_name": VARIABLES["phase"]["long_name"],
        "units": "rad",
        "symbol": "φ",
        "equation": "Eqs. 6, 21",
    }
    # Coordinates and what is no number are described too.
    for name in ("special_kind", "special", "frequency_ratio"):
        assert result[name].attrs["long_name"] == VARIABLES[name]["long_name"]
        assert result[name].attrs["units"] == "1"
    # The data stay, and so does the argument.
    assert np.array_equal(result.phase, data.phase) and data.phase.attrs == {}


def test_unknown_names_are_refused():
    with pytest.raises(ModelError, match="velocity_of_light"):
        describe(xr.Dataset({"velocity_of_light": 1.0}))
    with pytest.raises(ModelError, match="elsewhere"):
        describe(xr.Dataset({"phase": 1.0}, coords={"elsewhere": 2.0}))
