"""The adapter around a job: its arguments, its files, and its message when it fails."""

from types import SimpleNamespace

import pytest
import xarray as xr

from bouncing_ball.datasets.files import write_dataset
from bouncing_ball.datasets.variables import Budget
from bouncing_ball.errors import ModelError
from bouncing_ball.pipeline import jobs
from bouncing_ball.pipeline.jobs import logged, make_dataset, read_input, using
from bouncing_ball.pipeline.samples import COMPUTATION, CONTENT


@pytest.fixture
def interruptible(monkeypatch):
    """The tests must survive the signal handler with which an interrupted job ends at once."""
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


def test_a_variable_without_a_unit_is_refused(refusal):
    output = SimpleNamespace(data="results/one.nc")
    job = SimpleNamespace(params=SimpleNamespace(arguments={}), input={}, output=output)
    with refusal(ModelError, "phase has no unit: the study ends with described(...)"):
        make_dataset(job, lambda: xr.Dataset({"phase": 0.0}))


class Params(dict):
    """Named values, as those of a job of Snakemake."""

    __getattr__ = dict.__getitem__


@pytest.mark.parametrize("sample", [True, False])
def test_only_a_sample_has_a_processor_time_which_is_that_of_its_shards_and_its_own(
    tmp_path, monkeypatch, sample
):
    code = {f"{jobs.PREFIX}code": "1f0e models/rigid.py"}
    monkeypatch.setattr(jobs, "provenance", lambda snakemake: code)
    monkeypatch.setattr("time.process_time", lambda: 2.0)
    shards = [str(tmp_path / f"{k}.nc") for k in range(2)]
    for path in shards:
        write_dataset(xr.Dataset({"a": ("a_0", [1.0])}, attrs={jobs.SECONDS: "20"}), path)
    job = SimpleNamespace(
        params=Params(
            arguments={"parameters": {}},
            title="A sample",
            compressed=sample,
            budgets={"a": Budget(1e-6)},
        ),
        input={"shards": shards},
        output=SimpleNamespace(data=str(tmp_path / "sample.nc")),
    )

    def study(parameters: dict, found: dict) -> xr.Dataset:
        return xr.Dataset({"a": ("place", found["a"], {"units": "1"})})

    make_dataset(job, study)
    made = read_input(job.output.data)
    assert made.a.values.tolist() == [1.0, 1.0] and made.a.attrs["budget"] == 1e-6
    assert made.attrs.get(jobs.SECONDS) == ("42" if sample else None)
    # Only a sample records what computed it, by what the code is now.
    assert (COMPUTATION in made.attrs) == (CONTENT in made.attrs) == sample


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


def test_a_file_that_is_accepted_by_hand_is_restored_from_git(tmp_path, refusal):
    path = tmp_path / "config" / "atlas.nc"
    path.parent.mkdir()
    path.write_bytes(b"no dataset")
    with refusal(ModelError, f"{path} is damaged: restore it, git checkout -- {path}"):
        read_input(str(path))


def test_a_readable_file_with_other_content_is_named(refusal):
    with refusal(ModelError, "config/atlas.nc has not the content that is needed ("):
        with using("config/atlas.nc"):
            _ = xr.Dataset().needed
