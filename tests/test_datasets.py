"""Datasets are saved with their meaning and provenance, and read back as they were."""

import json
import os
import platform
import py_compile
import re
import sys
from dataclasses import replace
from importlib import import_module
from types import SimpleNamespace

import netCDF4
import numpy as np
import pytest
import xarray as xr

from carbonelli2011.variables import described
from paper_replication import datasets, provenance
from paper_replication.datasets import Project, Variable

# What `git hash-object` says of "pass" and a line end.
PASS = "2ae28399f5fda2dfb1b04405f4a3b4895f5fac1e"
NOTHING = provenance.sources(SimpleNamespace(code=[]))


@pytest.fixture
def small():
    return xr.Dataset(
        {"phase": ("n", [0.5, np.nan]), "stable": ("n", [True, False])}, coords={"n": [1, 2]}
    )


@pytest.fixture
def project(tmp_path):
    """A replication in this folder, without a reference."""
    return Project(
        tmp_path, tmp_path, (), (), "", "", "", described, ("variables.py",), print, print
    )


def test_a_saved_dataset_is_described_and_read_as_it_was(small, project, tmp_path):
    path = tmp_path / "new" / "fig02.nc"
    code = tmp_path / "code.py"
    code.write_bytes(b"pass\r\n")
    given = {"n": np.int64(1), "range": {"max": 2.0}}
    sources = provenance.sources(SimpleNamespace(code=[str(code)]))
    datasets.save(small, path, "Figure 2", given, sources, project)
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
    assert json.loads(saved.attrs["code"]) == {"code.py": PASS}
    assert json.loads(saved.attrs["versions"])["numpy"] == np.__version__
    assert saved.attrs["computed_on"].startswith(platform.system())
    assert os.listdir(path.parent) == ["fig02.nc"]
    assert small.phase.attrs == {}


def test_a_file_is_as_the_conventions_demand_that_it_names(project, tmp_path):
    """CF-1.11, Sections 2.3, 2.5.1, 2.6 and 3.1, of which a checker of CF names no fault either."""
    about = replace(project, references="A paper", source="code 1.0", license="BSD-3-Clause")
    data = xr.Dataset({"phase": ("amplitude", [0.5, np.nan])}, {"amplitude": [1.0, 2.0]})
    datasets.save(data, tmp_path / "fig99.nc", "Title", {}, NOTHING, about)
    with netCDF4.Dataset(tmp_path / "fig99.nc") as file:
        assert file.Conventions == "CF-1.11"
        assert all(getattr(file, name) for name in ("title", "references", "source", "license"))
        for name, variable in file.variables.items():
            assert re.fullmatch("[A-Za-z][A-Za-z0-9_]*", name)
            assert variable.long_name and variable.units in ("1", "rad")
            is_coordinate = name in file.dimensions
            assert not (is_coordinate and "_FillValue" in variable.ncattrs())


def test_a_variable_without_description_is_refused(small, project, tmp_path):
    with pytest.raises(ValueError, match=r"^fig02.nc: describe height, speed in variables.py$"):
        unknown = small.assign(height=1.0, speed=2.0)
        datasets.save(unknown, tmp_path / "fig02.nc", "", {}, NOTHING, project)


def test_large_numbers_are_compressed(project, tmp_path):
    path = tmp_path / "fig02.nc"
    numbers = xr.Dataset({"phase": ("n", np.zeros(10_000))}, {"n": np.arange(10_000)})
    datasets.save(numbers, path, "", {}, NOTHING, project)
    assert path.stat().st_size < numbers.nbytes / 2


def test_a_failed_save_leaves_the_old_file(small, project, tmp_path, monkeypatch):
    path = tmp_path / "fig02.nc"
    path.write_text("old")

    def fail(*arguments, **options):
        raise OSError("disk full")

    monkeypatch.setattr(xr.Dataset, "to_netcdf", fail)
    with pytest.raises(OSError, match="disk full"):
        datasets.save(small, path, "", {}, NOTHING, project)
    assert path.read_text() == "old"


def test_a_description_belongs_to_its_dataset(small, project, tmp_path):
    """A variable of one dataset has none in another; another package gives its own."""
    named = small.assign(impacts=3)
    datasets.save(named, tmp_path / "three_balls.nc", "", {}, NOTHING, project)
    with pytest.raises(ValueError, match="describe impacts in"):
        datasets.save(named, tmp_path / "fig02.nc", "", {}, NOTHING, project)
    own = {"n": Variable("order"), "phase": Variable("angle"), "stable": Variable("whether")}
    mine = replace(project, describe=lambda name: own if name == "mine" else {})
    datasets.save(small, tmp_path / "mine.nc", "", {}, NOTHING, mine)
    assert datasets.read(tmp_path / "mine.nc").phase.long_name == "angle"


def test_two_processes_that_write_the_same_file_do_not_meet(tmp_path, monkeypatch):
    path = tmp_path / "paper.md"
    with datasets.whole(path) as one:
        monkeypatch.setattr(datasets.os, "getpid", lambda: 0)
        with datasets.whole(path) as other:
            assert one != other
            other.write_text("other", "utf-8")
        one.write_text("one", "utf-8")
    assert path.read_text("utf-8") == "one"


def test_a_job_runs_the_source_that_it_records_whatever_byte_code_there_is(tmp_path, monkeypatch):
    """An edit that leaves size and time, as a copy that keeps times does."""
    file = tmp_path / "a_stage.py"
    file.write_text("NUMBER = 1\n")
    before = file.stat()
    py_compile.compile(file, invalidation_mode=py_compile.PycInvalidationMode.TIMESTAMP)
    file.write_text("NUMBER = 2\n")
    os.utime(file, ns=(before.st_atime_ns, before.st_mtime_ns))
    monkeypatch.syspath_prepend(tmp_path)
    hooks = [*sys.path_hooks]
    with provenance.reading(SimpleNamespace(code=[str(file)])):
        assert import_module("a_stage").NUMBER == 2
    assert sys.path_hooks == hooks
    del sys.modules["a_stage"]
    assert import_module("a_stage").NUMBER == 1  # That is what Python does.
    del sys.modules["a_stage"]
