"""The adapter around a job: its arguments, its files, and its message when it fails."""

from types import SimpleNamespace

import pytest
import xarray as xr

from bouncing_ball_beyond.inherited.datasets.files import write_dataset
from bouncing_ball_beyond.inherited.errors import ModelError
from bouncing_ball_beyond.inherited.pipeline.job import logged, make_dataset, read_input, using


@pytest.fixture
def interruptible(monkeypatch):
    """The tests must survive the signal handler with which an interrupted job ends at once."""
    monkeypatch.setattr("signal.signal", lambda *_: None)


@pytest.mark.parametrize(
    ("error", "said"),
    [
        (ValueError("one\ntwo\n  three"), "compute_fig08: one two three (details in "),
        (KeyError("ϖ"), "compute_fig08: KeyError: 'ϖ' (details in "),
    ],
)
def test_a_failure_is_one_line(tmp_path, interruptible, one_line, error, said):
    def study():
        raise error

    log = tmp_path / "logs" / "job.log"
    job = SimpleNamespace(rule="compute_fig08", log=[str(log)], input={}, params={})
    with pytest.raises(SystemExit) as exit_, logged(job):
        make_dataset(job, study)
    one_line(exit_, f"{said}{log})")
    assert "Traceback" in log.read_text(encoding="utf-8")


def test_a_variable_without_a_unit_is_refused(refusal):
    with refusal(ModelError, "phase has no unit: the study ends with described(...)"):
        make_dataset(SimpleNamespace(input={}, params={}), lambda: xr.Dataset({"phase": 0.0}))


def test_an_input_is_whole_or_its_command_is_named(tmp_path, refusal):
    path = tmp_path / "fig08.nc"

    def refused(said):
        with refusal(ModelError, f"{said}: make it again, snakemake --cores 2 --force {path}"):
            read_input(str(path))

    refused(f"no dataset {path}")
    write_dataset(xr.Dataset(attrs={"n": 1}), path)
    assert read_input(str(path)).attrs["n"] == 1
    path.write_bytes(path.read_bytes()[:-100])
    refused(f"{path} is damaged")


def test_a_readable_file_with_other_content_is_named(refusal):
    with refusal(ModelError, "results/figures/fig08.nc has not the content that is needed ("):
        with using("results/figures/fig08.nc"):
            _ = xr.Dataset().needed
