"""Files are written completely or not at all, with the same bytes every time."""

import os
import shutil

import numpy as np
import pytest
import xarray as xr
from netCDF4 import Dataset

from bouncing_ball_beyond.inherited.datasets.files import (
    parameter_attributes,
    read_dataset,
    write_dataset,
)
from bouncing_ball_beyond.inherited.datasets.variables import describe
from bouncing_ball_beyond.inherited.errors import ModelError


@pytest.fixture
def data():
    return describe(
        xr.Dataset(
            {
                "phase": (("n", "point"), [[0.1, 0.2, np.nan], [0.3, 0.4, 1e-300]]),
                "stable": (("n", "point"), [[True, False, True], [False, True, True]]),
                "reason": ("sample", ["saddle-node", "", "period doubling"]),
                "saddle_node_amplitude": ((), 1 / 3),
            },
            coords={"n": [1, 2], "bound": ["unstable side", "stable side"]},
        )
    ).assign_attrs({"title": "ϖ and Λ", "n": 1, "range__min": 0.5, "tolerances": [0.1, 0.01]})


def test_a_dataset_that_is_written_and_read_is_the_same(data, tmp_path):
    path = tmp_path / "data.nc"
    write_dataset(data, path)
    again = read_dataset(path)
    xr.testing.assert_identical(again.drop_attrs(), data.drop_attrs())
    for name in data.variables:
        assert again[name].attrs == data[name].attrs, name
        assert again[name].dtype.kind == data[name].dtype.kind or name in ("reason", "bound")
    assert again.stable.dtype == bool
    assert again.attrs["title"] == "ϖ and Λ" and again.attrs["range__min"] == 0.5
    assert again.attrs["tolerances"].tolist() == [0.1, 0.01]
    # The file is closed: it can be replaced and removed.
    path.unlink()


def test_the_same_bytes_every_time(data, tmp_path):
    paths = [tmp_path / name for name in ("one.nc", "two.nc")]
    for path in paths:
        write_dataset(data, path)
    assert paths[0].read_bytes() == paths[1].read_bytes()


def test_a_failing_write_leaves_what_was_there(data, tmp_path, monkeypatch):
    def fail(self, path, **options):
        path.write_bytes(b"half a file")
        raise OSError("disk full")

    path = tmp_path / "deep" / "data.nc"
    write_dataset(data, path)
    before = path.read_bytes()
    monkeypatch.setattr(xr.Dataset, "to_netcdf", fail)
    for target in (path, path.with_name("other.nc")):
        with pytest.raises(OSError, match="disk full"):
            write_dataset(data, target)
    assert {each: each.read_bytes() for each in path.parent.iterdir()} == {path: before}


def test_nested_parameters_become_flat_attributes_that_netcdf_holds(tmp_path):
    parameters = {
        "release": "displacement",
        "flag": True,
        "amplitude": [1.1, 1, 0.6],
        "frequency_ratio": {"min": 1.0, "samples": 7},
        "quantities": ["max_height", "phase"],
        "printed": [[[0.255, 1.032]]],
    }
    flat = parameter_attributes(parameters)
    assert flat == {
        "release": "displacement",
        "flag": 1,
        "amplitude": [1.1, 1, 0.6],
        "frequency_ratio__min": 1.0,
        "frequency_ratio__samples": 7,
        "quantities": '["max_height", "phase"]',
        "printed": "[[[0.255, 1.032]]]",
    }
    # All of them are attributes that netCDF can hold.
    write_dataset(xr.Dataset(attrs=flat), tmp_path / "parameters.nc")
    again = read_dataset(tmp_path / "parameters.nc").attrs
    assert again.pop("amplitude").tolist() == flat.pop("amplitude") and again == flat


def test_a_damaged_file_is_one_line(tmp_path, refusal):
    path = tmp_path / "fig08.nc"
    with refusal(ModelError, "no dataset", "fig08.nc"):
        read_dataset(path)
    write_dataset(xr.Dataset({"phase": ("point", [0.0] * 1000)}), path)
    path.write_bytes(path.read_bytes()[:2000])
    with refusal(ModelError, "fig08.nc is damaged"):
        read_dataset(path)
    # A name that cannot be encoded is shown with its escapes.
    with refusal(ModelError, "no dataset \\ud800"):
        read_dataset("\ud800")


def test_what_would_be_read_for_ever_is_one_line(tmp_path, refusal):
    path = tmp_path / "fig08.nc"
    os.mkfifo(path)
    with refusal(ModelError, "fig08.nc cannot be read: it is no regular file"):
        read_dataset(path)
    path.unlink()
    # A file of some kilobytes.
    with Dataset(path, "w") as data:
        data.createDimension("t", 10**11)
        data.createVariable("x", "f8", ("t",), chunksizes=(1 << 20,))
    with refusal(ModelError, "fig08.nc is damaged: its arrays have 1.0e+11 numbers"):
        read_dataset(path)


@pytest.mark.parametrize("error", [RuntimeError("NetCDF: HDF error"), PermissionError(13, "no")])
def test_a_full_disk_is_called_full(tmp_path, monkeypatch, error):
    """The libraries report it as one of these errors; with space left they are what they say."""

    def to_netcdf(*_, **__):
        raise error

    data = xr.Dataset({"phase": ("point", [0.0] * 1000)})
    monkeypatch.setattr(xr.Dataset, "to_netcdf", to_netcdf)
    for free, expected, said in (
        (data.nbytes, OSError, "No space left on device"),
        (10**9, type(error), str(error)),
    ):
        usage = shutil.disk_usage(tmp_path)._replace(free=free)
        monkeypatch.setattr(shutil, "disk_usage", lambda _, usage=usage: usage)
        with pytest.raises(expected) as raised:
            write_dataset(data, tmp_path / "fig08.nc")
        assert said in str(raised.value)
        monkeypatch.undo()
        monkeypatch.setattr(xr.Dataset, "to_netcdf", to_netcdf)
    assert list(tmp_path.iterdir()) == []
