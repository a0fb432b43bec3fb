"""The atlas as its users run it: killed and resumed, on a Slurm."""

import os
import shutil
import signal
import subprocess
import sys
from dataclasses import replace
from importlib.util import find_spec
from pathlib import Path

import numpy as np
import pytest
import yaml

from bouncing_ball.beyond.atlas.plan import Plan
from bouncing_ball.beyond.atlas.shards import shard
from bouncing_ball.datasets.files import read_dataset
from bouncing_ball.pipeline.yaml_files import read_yaml

SMALL = {
    "n": [1, 2],
    "restitution": {"min": 0.05, "max": 1.0, "tiles": 2, "samples": 8},
    "position": {"tiles": 2, "samples": 25},
    "frequency_ratio": {"min": 3.0, "max": 1.0e5, "samples": 41},
    "shards": 2,
}
ATLAS = ("--configfile", "small.yaml", "--", "results/atlas/atlas.nc")
SHARDS = [f"results/atlas/shards/000{k}-of-0002.nc" for k in range(2)]


def prepared(tree):
    text = yaml.safe_dump({"atlas": SMALL})
    (tree.path / "small.yaml").write_text(text, encoding="utf-8")
    return tree


@pytest.fixture(scope="module")
def made(cloned, tmp_path_factory):
    """A tree with the whole of a small atlas."""
    folder = tmp_path_factory.mktemp("atlas") / "tree"
    shutil.copytree(cloned.path, folder, copy_function=shutil.copy2)
    tree = prepared(replace(cloned, path=folder))
    tree.run("--cores", "1", *ATLAS)
    return tree


def files_of_atlas(tree):
    """The files of the atlas: the bytes of their variables, and their attributes."""
    folder = tree.path / "results" / "atlas"
    found = {}
    for path in sorted(folder.rglob("*.nc")):
        data = read_dataset(path)
        attributes = {name: np.asarray(value).tolist() for name, value in data.attrs.items()}
        values = {name: data[name].values.tobytes() for name in data.variables}
        found[str(path.relative_to(folder))] = (attributes, values)
    return found


def test_the_first_run_in_a_fresh_clone_may_be_the_atlas(fresh):
    assert "Atlas" in fresh.planned("atlas")


@pytest.mark.long
def test_a_killed_atlas_is_resumed_without_loss(made, fresh):
    prepared(fresh)
    fresh.interrupt(signal.SIGKILL, "--cores", "1", *ATLAS, after=2, of="atlas/shards/[0-9l]*.nc")
    shards = fresh.path / "results/atlas/shards"
    early = fresh.checksums("results/atlas/shards")
    first = min(early, key=lambda name: (shards / name).stat().st_mtime_ns)
    said = fresh.run("--cores", "1", *ATLAS).stdout
    after = fresh.checksums("results/atlas")
    assert files_of_atlas(fresh) == files_of_atlas(made)
    assert 2 == len(early) < len(after)
    assert {name: after[f"shards/{name}"] for name in early} == early
    # The job of the last one was killed before it could say that it was done.
    assert f"made results/atlas/shards/{first}" not in said


@pytest.mark.long
def test_a_shard_of_the_workflow_has_the_bits_of_the_package(made):
    section = read_yaml(made.path / "config" / "config.yaml")["atlas"] | SMALL
    plan = Plan(**section)
    expected = shard(plan, 1)
    found = read_dataset(made.path / SHARDS[1])
    for name in expected.variables:
        assert found[name].values.tobytes() == expected[name].values.tobytes(), name


MISSING = [name for name in ("slurmctld", "slurmd", "sbatch") if not shutil.which(name)]
MISSING = [name for name in MISSING if not Path("/usr/sbin", name).exists()]
if not find_spec("snakemake_executor_plugin_slurm"):
    MISSING.append("snakemake-executor-plugin-slurm")
LOOPBACK = Path(__file__).with_name("slurm_on_loopback.sh")
# Without accounting the state of a job is asked of squeue; the rest makes the test short.
# When nothing has ended, the executor asks again after ten seconds more: so it first asks
# when something has.
OPTIONS = (
    *("--profile", "profiles/slurm", "--slurm-no-account"),
    *("--slurm-status-command", "squeue", "--slurm-init-seconds-before-status-checks", "6"),
    *("--latency-wait", "5"),
)


@pytest.fixture
def slurm(tmp_path):
    """The environment in which srun and its like speak to a Slurm of this test."""
    folder = tmp_path / "slurm"
    subprocess.run([LOOPBACK, "start", folder], check=True)
    try:
        yield {"PATH": f"{folder / 'bin'}{os.pathsep}{os.environ['PATH']}"}
    finally:
        subprocess.run([LOOPBACK, "stop", folder], check=True)


@pytest.mark.cluster
@pytest.mark.skipif(bool(MISSING), reason=f"not installed: {', '.join(MISSING)}")
def test_on_a_cluster_the_bits_are_the_same(made, fresh, slurm):
    prepared(fresh)
    command = [Path(sys.executable).with_name("snakemake"), *OPTIONS, *ATLAS]
    subprocess.run(command, cwd=fresh.path, env=fresh.environment() | slurm, check=True)
    assert files_of_atlas(fresh) == files_of_atlas(made)
