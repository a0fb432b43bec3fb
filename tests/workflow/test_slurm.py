"""Two stages of the replication on a Slurm, by Snakemake's own executor."""

import os
import shutil
import subprocess
import sys
from importlib.util import find_spec
from pathlib import Path

import pytest

STAGES = ("permanent_contact", "restitution_model")
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
def test_on_a_cluster_the_results_have_the_same_bytes(fresh, slurm):
    fresh.run("--cores", "1", *STAGES)
    expected = fresh.contents("results")
    for folder in ("results", ".snakemake"):
        shutil.rmtree(fresh.path / folder)
    command = [Path(sys.executable).with_name("snakemake"), *OPTIONS, "--", *STAGES]
    subprocess.run(command, cwd=fresh.path, env=fresh.environment() | slurm, check=True)
    assert fresh.contents("results") == expected
