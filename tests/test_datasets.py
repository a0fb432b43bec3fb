"""Datasets are saved with their meaning and provenance, and read back as they were."""

import json
import os
import platform

import numpy as np
import pytest
import xarray as xr

from bouncing_ball import datasets

# What `git hash-object` says of "pass" and a line end.
PASS = "2ae28399f5fda2dfb1b04405f4a3b4895f5fac1e"


@pytest.fixture
def small():
    return xr.Dataset(
        {"phase": ("n", [0.5, np.nan]), "stable": ("n", [True, False])}, coords={"n": [1, 2]}
    )


def test_a_saved_dataset_is_described_and_read_as_it_was(small, tmp_path):
    path = tmp_path / "new" / "fig02.nc"
    code = tmp_path / "code.py"
    code.write_bytes(b"pass\r\n")
    datasets.save(small, path, "Figure 2", {"n": np.int64(1), "range": {"max": 2.0}}, [code])
    saved = datasets.read(path)
    xr.testing.assert_equal(saved, small)
    assert saved.phase.attrs == {
        "long_name": "phase of the table when the contact starts",
        "symbol": "φ",
        "equation": "Eqs. 6, 21",
        "units": "rad",
        "tolerance": 1e-9,
        "floor": 1e-3,
    }
    assert "tolerance" not in saved.stable.attrs
    assert json.loads(saved.attrs["parameters"]) == {"n": 1, "range": {"max": 2.0}}
    assert json.loads(saved.attrs["code"]) == {str(code): PASS}
    assert json.loads(saved.attrs["versions"])["numpy"] == np.__version__
    assert saved.attrs["computed_on"].startswith(platform.system())
    assert os.listdir(path.parent) == ["fig02.nc"]
    assert small.phase.attrs == {}


def test_a_path_may_be_a_text_as_snakemake_gives_it(small, tmp_path):
    path = tmp_path / "fig02.nc"
    datasets.save(small, str(path), "Figure 2", {}, [])
    xr.testing.assert_equal(datasets.read(path), small)


def test_a_variable_without_description_is_refused(small, tmp_path):
    with pytest.raises(ValueError, match=r"^fig02.nc: .* has no description of height, speed$"):
        datasets.save(small.assign(height=1.0, speed=2.0), tmp_path / "fig02.nc", "", {}, [])


def test_a_failed_save_leaves_the_old_file(small, tmp_path, monkeypatch):
    path = tmp_path / "fig02.nc"
    path.write_text("old")

    def fail(*arguments, **options):
        raise OSError("disk full")

    monkeypatch.setattr(xr.Dataset, "to_netcdf", fail)
    with pytest.raises(OSError, match="disk full"):
        datasets.save(small, path, "", {}, [])
    assert path.read_text() == "old"
