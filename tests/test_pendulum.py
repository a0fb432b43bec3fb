"""Another paper, in another folder: `tests/pendulum` uses `paper_replication` from there."""

import shutil
import subprocess

import pytest
from tests.conftest import Checkout
from tests.reference import ROOT

from paper_replication.datasets import parameters, read


@pytest.fixture(scope="module")
def replicated(git_of_its_own, tmp_path_factory):
    """A copy of the folder whose results are its reference."""
    there = Checkout(tmp_path_factory.mktemp("another") / "pendulum")
    shutil.copytree(ROOT / "tests/pendulum", there.path)
    author = ["-c", "user.name=A", "-c", "user.email=a@b.c"]
    for command in (["init", "-qb", "main"], ["add", "."], [*author, "commit", "-qm", "first"]):
        subprocess.run(["git", "-C", str(there.path), *command], check=True)
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("PYTHONPATH", str(ROOT / "src"))
        status, printed = there.run("--cores", "1", "accept")
        assert status == 0, printed
        yield there


def test_a_dataset_a_claim_and_a_sentence(replicated):
    fig1, claims = (read(replicated.path / f"figures/{name}.nc") for name in ("fig1", "claims"))
    assert parameters(fig1) == {"length": 1.0, "gravity": 9.81}
    assert (claims.verdict == "reproduced").all()
    assert (replicated.path / "paper.md").read_text("utf-8") == "At 60° a swing takes 2.15 s."


def test_a_run_is_compared_with_the_reference(replicated):
    assert replicated.run("--cores", "1", "diff")[0] == 0
    assert replicated.run("--cores", "1", "--config", "gravity=9.80665", "--", "diff")[0] == 1
    report = (replicated.path / "results/diff/report.txt").read_text("utf-8")
    assert "fig1: period 2" in report and "parameter: gravity 9.81 → 9.80665\n" in report
