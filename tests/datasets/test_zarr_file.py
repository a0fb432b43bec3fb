"""Zarr: the values and attributes of the netCDF file, the same bytes, whole or not there."""

import sys

import numpy as np
import pytest
import xarray as xr
from zarr.storage import ZipStore

from bouncing_ball.datasets import zarr_file
from bouncing_ball.datasets.netcdf import DatasetError, read_dataset, write_dataset
from bouncing_ball.datasets.zarr_file import write_zarr


@pytest.fixture
def data():
    """All that an atlas has: counts that are 0, gaps, infinities, texts, single precision."""
    shape = 2, 3, 2
    values = np.arange(12.0).reshape(shape)
    dims = ("release", "restitution", "quantity")
    return xr.Dataset(
        {
            "exceeding": (dims, values.astype("i4"), {"long_name": "nodes"}),
            "needed": (dims, np.where(values == 1, np.nan, values / 3).astype("f4")),
            "largest_threshold": (dims, np.where(values == 3, np.inf, values)),
            "reached": (("restitution",), [True, False, True]),
            "orbits": ((), 10**8),
        },
        {
            "release": ["displacement", "force"],
            "restitution": [0.0625, 0.0875, 1 / 3],
            "quantity": ["phase", "max_height"],
        },
        {"title": "ϖ and Λ", "n": [1, 2], "range__min": 0.5},
    )


def opened(path):
    with ZipStore(path, mode="r") as store:
        return xr.open_zarr(store).load()


def test_values_and_attributes_are_those_of_the_netcdf_file(data, tmp_path):
    write_dataset(data, tmp_path / "data.nc", compressed=True)
    expected = read_dataset(tmp_path / "data.nc")
    write_zarr(expected, tmp_path / "data.zarr.zip", ("release", "quantity"))
    found = opened(tmp_path / "data.zarr.zip")
    assert set(found.variables) == set(expected.variables)
    for name in expected.variables:
        assert found[name].dims == expected[name].dims
        assert found[name].dtype == expected[name].dtype
        assert found[name].values.tobytes() == expected[name].values.tobytes(), name
        assert found[name].attrs == expected[name].attrs
    assert list(found.attrs) == list(expected.attrs)
    for name, value in expected.attrs.items():
        assert np.array_equal(found.attrs[name], value)
    assert found.needed.encoding["chunks"] == (1, 3, 1)
    assert found.reached.encoding["chunks"] == (3,)


def test_the_same_bytes_every_time(data, tmp_path, monkeypatch):
    paths = [tmp_path / name for name in ("one.zarr.zip", "two.zarr.zip")]
    write_zarr(data, paths[0], ("release",))
    monkeypatch.setattr("time.time", lambda: 2e9)
    write_zarr(data, paths[1], ("release",))
    assert paths[0].read_bytes() == paths[1].read_bytes()


def test_a_failing_write_leaves_what_was_there(data, tmp_path, monkeypatch):
    path = tmp_path / "data.zarr.zip"
    write_zarr(data, path, ())
    before = path.read_bytes()

    def fail(self, *arguments):
        raise OSError("disk full")

    monkeypatch.setattr(zarr_file.zipfile.ZipFile, "writestr", fail)
    with pytest.raises(OSError, match="disk full"):
        write_zarr(data, path, ())
    assert [p.name for p in tmp_path.iterdir()] == [path.name]
    assert path.read_bytes() == before


def test_without_zarr_it_says_what_to_install(data, tmp_path, monkeypatch, one_line):
    monkeypatch.setitem(sys.modules, "zarr.storage", None)
    with pytest.raises(DatasetError) as error:
        write_zarr(data, tmp_path / "data.zarr.zip", ())
    one_line(error, "bouncing-ball[zarr]")
