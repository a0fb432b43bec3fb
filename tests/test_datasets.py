"""Datasets are saved with their meaning and provenance, and read back as they were."""

import json
import os
import subprocess

import numpy as np
import pytest
import xarray as xr

from bouncing_ball import datasets


@pytest.fixture
def small():
    return xr.Dataset(
        {"phase": ("n", [0.5, np.nan]), "stable": ("n", [True, False])}, coords={"n": [1, 2]}
    )


@pytest.fixture
def checkout(tmp_path):
    """A git checkout with one committed file."""
    folder = tmp_path / "ünï 你好"
    folder.mkdir()
    (folder / "code.py").write_text("one\n")
    for command in (["init", "-q"], ["add", "."], ["commit", "-q", "-m", "first"]):
        git(folder, *command)
    return folder


def git(folder, *arguments):
    identity = ["-c", "user.name=A", "-c", "user.email=a@b.c"]
    command = ["git", "-C", str(folder), *identity, *arguments]
    return subprocess.run(command, check=True, capture_output=True, text=True).stdout.strip()


def test_a_saved_dataset_is_described_and_read_as_it_was(small, tmp_path):
    path = tmp_path / "new" / "fig02.nc"
    code = tmp_path / "code.py"
    code.write_text("pass\n")
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
    assert saved.attrs["code"] == datasets.digest([code])
    assert json.loads(saved.attrs["versions"])["numpy"] == np.__version__
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


def test_the_digest_ignores_order_and_line_ends_only(tmp_path):
    first = tmp_path / "a.py"
    second = tmp_path / "b.py"
    first.write_bytes(b"x = 1\n")
    second.write_bytes(b"y = 2\n")
    digest = datasets.digest([first, second])
    first.write_bytes(b"x = 1\r\n")
    assert datasets.digest([second, first]) == digest
    first.write_bytes(b"x = 2\n")
    assert datasets.digest([first, second]) != digest


def test_the_commit_says_whether_a_tracked_file_has_changed(checkout):
    commit = git(checkout, "rev-parse", "HEAD")
    (checkout / "untracked").write_text("")
    assert datasets.commit(checkout) == commit
    (checkout / "code.py").write_text("two\n")
    assert datasets.commit(checkout) == commit + "+dirty"


def test_an_archive_names_its_commit(tmp_path):
    (tmp_path / ".git_archival.txt").write_text(f"node: {'a1' * 20}\n")
    assert datasets.commit(tmp_path) == "a1" * 20 + " (archive)"


def test_no_commit_is_known_without_git_or_in_a_checkout_of_another_owner(
    checkout, tmp_path, monkeypatch
):
    assert datasets.commit(tmp_path) == "unknown"
    monkeypatch.setenv("GIT_TEST_ASSUME_DIFFERENT_OWNER", "1")
    assert datasets.commit(checkout) == "unknown (git: dubious ownership)"
    monkeypatch.setenv("PATH", "")
    assert datasets.commit(checkout) == "unknown"
