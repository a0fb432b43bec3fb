"""The adapter around a job: what it takes, and what is said when it fails."""

import shutil
from collections import namedtuple
from pathlib import Path
from types import SimpleNamespace

import pytest
import xarray as xr

from bouncing_ball.datasets.netcdf import DatasetError, read_dataset, write_dataset
from bouncing_ball.pipeline.job import logged, make_dataset, read_input, withdraw
from bouncing_ball.record.provenance import file_digest

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


@pytest.mark.parametrize("fails", [True, False])
def test_a_log_that_cannot_be_written(tmp_path, interruptible, monkeypatch, one_line, fails):
    def full(*_, **__):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(Path, "write_text", full)
    log = tmp_path / "logs" / "job.log"
    job = SimpleNamespace(rule="stage", wildcards=["fig08"], log=[str(log)], output=[])
    with pytest.raises(SystemExit) as exit_, logged(job):
        if fails:
            raise ValueError("no orbit")
    one_line(exit_, f"(no details: {log}: No space left on device)")
    assert ("no orbit" in str(exit_.value)) == fails
    assert list(log.parent.iterdir()) == []


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


def _edit(made):
    write_dataset(read_dataset(FIG08).assign_attrs(n=2), FIG08)


def _truncate(made):
    Path(FIG08).write_bytes(Path(FIG08).read_bytes()[:-100])


def _lose_log(made):
    Path("results/logs/stages/fig08.log").unlink()


@pytest.mark.parametrize("change", [_put_other, _edit, _truncate, _lose_log])
def test_an_input_that_is_not(made, one_line, change):
    change(made)
    with pytest.raises(DatasetError) as error:
        read_input(FIG08)
    one_line(error, FIG08, "not what its job wrote", f"snakemake --cores 2 --force {FIG08}")


def test_the_dataset_of_another_artifact_with_its_log(made, one_line):
    _put_other(made)
    log = Path("results/logs/stages/fig08.log")
    log.write_text(f"sha256 {file_digest(FIG08)} {FIG08}\n", encoding="utf-8")
    with pytest.raises(DatasetError) as error:
        read_input(FIG08)
    one_line(error, f"{FIG08} is the dataset of {FIG09}: make it again")


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
            study="studies.parameters.grid", parameters={"min": 1.0}, settings={}, title=""
        ),
    )
    with pytest.raises(SystemExit) as exit_:
        make_dataset(job)
    one_line(exit_, "stage/fig08: KeyError: 'max'")
    assert not Path("results/paper.md").exists() and not Path("results/tally.txt").exists()
    # Nothing to remove is no mistake.
    withdraw()


def test_a_stage_that_finds_nothing_says_so(made, monkeypatch):
    found = xr.Dataset({"phase": ("point", [float("nan")]), "n": 1.0})
    monkeypatch.setattr("bouncing_ball.pipeline.job.load", lambda study: lambda parameters: found)
    published = {}
    monkeypatch.setattr(
        "bouncing_ball.pipeline.job.publish",
        lambda job, data, attributes: published.update(attributes),
    )
    make_dataset(
        SimpleNamespace(
            rule="stage",
            wildcards=["fig08"],
            log=["results/logs/stages/fig08.log"],
            output=namedtuple("Output", "data")(FIG08),
            input=SimpleNamespace(data=[]),
            params=SimpleNamespace(study="", parameters={"n": 1}, settings={}),
        )
    )
    assert published == {"n": 1, "without_values": "phase"}
