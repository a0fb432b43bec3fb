"""The adapter around a job: what it takes, and what is said when it fails."""

import shutil
from pathlib import Path
from types import SimpleNamespace

import pytest
import xarray as xr

from bouncing_ball.datasets.netcdf import DatasetError, write_dataset
from bouncing_ball.pipeline.job import logged, make_dataset, read_input, withdraw

FIG08, FIG09 = "results/figures/fig08.nc", "results/figures/fig09.nc"


@pytest.fixture
def interruptible(monkeypatch):
    """An interrupted job ends at once, but the tests are not to."""
    monkeypatch.setattr("signal.signal", lambda *_: None)


@pytest.mark.parametrize(
    ("error", "said"),
    [
        (ValueError("one\ntwo\n  three"), "stage/fig08: one two three (details in "),
        (KeyError("ϖ"), "stage/fig08: KeyError: 'ϖ' (details in "),
    ],
)
def test_a_failure_is_one_line(tmp_path, interruptible, one_line, error, said):
    log = tmp_path / "logs" / "job.log"
    job = SimpleNamespace(rule="stage", wildcards=["fig08"], log=[str(log)])
    with pytest.raises(SystemExit) as exit_, logged(job):
        raise error
    one_line(exit_, f"{said}{log})")
    assert "Traceback" in log.read_text(encoding="utf-8")


@pytest.fixture
def made(tmp_path, interruptible, monkeypatch):
    """A folder with two datasets as their jobs write them."""
    monkeypatch.chdir(tmp_path)
    for path in (FIG08, FIG09):
        job = SimpleNamespace(
            rule="stage",
            wildcards=[Path(path).stem],
            output=[path],
            log=[f"results/logs/stages/{Path(path).stem}.log"],
        )
        with logged(job):
            write_dataset(xr.Dataset(attrs={"provenance_target": path, "n": 1}), path)
    return tmp_path


def test_an_input_is_what_its_job_wrote(made):
    assert read_input(FIG08).attrs["n"] == 1


def _put_other(made):
    shutil.copyfile(FIG09, FIG08)


def _truncate(made):
    Path(FIG08).write_bytes(Path(FIG08).read_bytes()[:-100])


def _lose(made):
    Path(FIG08).unlink()


@pytest.mark.parametrize(
    ("change", "said"),
    [
        (_put_other, f"{FIG08} is the dataset of {FIG09}"),
        (_truncate, f"{FIG08} is damaged"),
        (_lose, f"no dataset {FIG08}"),
    ],
)
def test_an_input_that_is_not(made, one_line, change, said):
    change(made)
    with pytest.raises(DatasetError) as error:
        read_input(FIG08)
    one_line(error, f"{said}: make it again, snakemake --cores 2 --force {FIG08}")


def test_a_stage_that_fails_leaves_no_article(made, one_line):
    for path in ("results/paper.md", "results/tally.txt"):
        Path(path).write_text("old", encoding="utf-8")
    job = SimpleNamespace(
        rule="stage",
        wildcards=["fig08"],
        log=["results/logs/stages/fig08.log"],
        output=SimpleNamespace(data=FIG08),
        input=SimpleNamespace(data=[]),
        params=SimpleNamespace(
            study="studies.nothing.here", arguments={"parameters": {}}, title=""
        ),
    )
    with pytest.raises(SystemExit) as exit_:
        make_dataset(job)
    one_line(exit_, "stage/fig08: studies.nothing.here: No module named")
    assert not Path("results/paper.md").exists() and not Path("results/tally.txt").exists()
    # Nothing to remove is no mistake.
    withdraw()
