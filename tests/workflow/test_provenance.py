"""The provenance of the artifacts of a run: commit, configuration, and a command that works."""

import os
import subprocess
from pathlib import Path

import pytest

from bouncing_ball.pipeline.artifact_files import CARRIERS
from bouncing_ball.pipeline.provenance import explain, read_provenance
from bouncing_ball.pipeline.sources import LIBRARIES


def test_every_artifact_carries_its_provenance(pristine):
    commit = pristine.git("rev-parse", "HEAD")
    paths = (pristine.path / "results/figures").rglob("*")
    carriers = [path for path in paths if path.suffix in CARRIERS]
    assert len(carriers) > 50
    for path in carriers:
        made = read_provenance(path)
        assert (made["commit"], made["dirty"], made["configuration"]) == (commit, "no", {}), path
        assert (pristine.path / made["target"]).with_suffix(path.suffix) == path
        assert all((pristine.path / name).is_file() for name in made["inputs"]), path
        assert list(made["versions"]) == ["python", *LIBRARIES]


@pytest.mark.long
def test_another_configuration_is_named_and_its_command_gives_the_file(complete, monkeypatch):
    path = Path("results/figures/fig11.nc")
    monkeypatch.chdir(complete.path)
    before = path.read_bytes()
    commit = read_provenance(path)["commit"]
    config = Path("results/mine.yaml")
    config.write_text("paper:\n  fig11:\n    restitution: 0.7\n", encoding="utf-8")
    complete.run("--cores", "1", str(path), "--configfile", str(config))
    answer = explain(path)
    # The tree is clean: a commit and this configuration decide.
    assert (answer["commit"], answer["dirty"]) == (commit, "no")
    assert answer["configuration"] == {"paper": {"fig11": {"restitution": 0.7}}}
    other = path.read_bytes()
    assert other != before
    path.unlink()
    # The program of the environment, as quick to start as in other tests.
    program = complete.path / "results" / "snakemake"
    program.write_text(f'#!/bin/sh\nexec {complete.python} -m snakemake "$@"\n', encoding="utf-8")
    program.chmod(0o755)
    found = complete.environment() | {"PATH": f"{program.parent}:{os.environ['PATH']}"}
    for command in answer["make_again"]:
        subprocess.run(command, shell=True, check=True, capture_output=True, env=found)
    assert path.read_bytes() == other
