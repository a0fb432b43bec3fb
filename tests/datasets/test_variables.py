"""The vocabulary of the datasets."""

import numpy as np
import pytest
import xarray as xr

from bouncing_ball.datasets.variables import VARIABLES, describe


def test_every_entry_is_complete():
    for name, variable in VARIABLES.items():
        assert name.isidentifier()
        assert variable.long_name and variable.long_name == variable.long_name.strip()
        assert variable.units in ("1", "rad")
        assert not variable.equation or variable.equation.startswith(("Eq", "Table"))
    # Two names must not mean the same.
    pairs = [(v.long_name, v.symbol) for v in VARIABLES.values()]
    assert len(set(pairs)) == len(pairs)


def test_angles_are_in_radians_and_nothing_else():
    for name, variable in VARIABLES.items():
        assert (variable.units == "rad") == name.endswith("phase"), name


def test_describe():
    data = xr.Dataset(
        {
            "phase": ("point", [0.5, 1.0]),
            "stable": ("point", [True, False]),
            "special_kind": ("special", ["fold"]),
            "n": 3,
        },
        coords={"frequency_ratio": 2.0},
    )
    result = describe(data)
    assert result.phase.attrs == {
        "long_name": VARIABLES["phase"].long_name,
        "units": "rad",
        "symbol": "φ",
        "equation": "Eqs. 6, 21",
    }
    # Coordinates and what is no number are described too.
    for name in ("stable", "special_kind", "n", "frequency_ratio"):
        assert result[name].attrs["long_name"] == VARIABLES[name].long_name
    assert result.n.attrs["units"] == result.frequency_ratio.attrs["units"] == "1"
    # The data stay, and so does the argument.
    assert np.array_equal(result.phase, data.phase)
    assert data.phase.attrs == {}


def test_old_attributes_do_not_survive():
    data = xr.Dataset({"phase": ("point", [0.5], {"long_name": "wrong", "extra": 1})})
    assert "extra" not in describe(data).phase.attrs


def test_unknown_names_are_refused():
    with pytest.raises(KeyError, match="velocity_of_light"):
        describe(xr.Dataset({"velocity_of_light": 1.0}))
    with pytest.raises(KeyError, match="elsewhere"):
        describe(xr.Dataset({"phase": 1.0}, coords={"elsewhere": 2.0}))
