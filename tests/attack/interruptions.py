"""Runs of two figures killed at random moments: the rerun gives the same bytes."""

import os
import shutil
import signal
import subprocess
import sys
import time
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np

ROOT = Path(__file__).resolve().parents[2]
SNAKEMAKE = Path(sys.executable).with_name("snakemake")
TARGETS = ("fig11", "fig12")


def start(tree: Path, *arguments: str) -> subprocess.Popen:
    """Snakemake in a copy of the tree, in a session of its own."""
    return subprocess.Popen(
        [SNAKEMAKE, "--cores", "2", *arguments],
        cwd=tree,
        env=os.environ | {"PYTHONPATH": str(tree / "src")},
        stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL,
        start_new_session=True,
    )


def results(tree: Path) -> dict[str, bytes]:
    """What is there under its own name."""
    paths = (tree / "results" / "figures").glob("*")
    return {path.name: path.read_bytes() for path in paths if ".part" not in path.name}


def killed(tree: Path, delay: float) -> None:
    """A run from clean, killed with all its jobs after so many seconds."""
    for folder in ("results", ".snakemake"):
        shutil.rmtree(tree / folder, ignore_errors=True)
    running = start(tree, *TARGETS)
    try:
        running.wait(timeout=delay)
    except subprocess.TimeoutExpired:
        os.killpg(running.pid, signal.SIGKILL)
        running.wait()


def attack(seed: int, seconds: float) -> tuple[int, int, list[str]]:
    """Kills after a random share of the time that a run takes."""
    rng = np.random.default_rng(seed)
    end = time.monotonic() + seconds
    tried, fallen = 0, []
    with TemporaryDirectory() as name:
        tree = Path(name, "tree")
        for folder in ("config", "profiles", "src", "workflow"):
            shutil.copytree(ROOT / folder, tree / folder)
        for file in ("Snakefile", "requirements.lock"):
            shutil.copyfile(ROOT / file, tree / file)
        before = time.monotonic()
        if start(tree, *TARGETS).wait() != 0:
            return 1, 0, ["a run that nothing interrupts fails"]
        length = time.monotonic() - before
        expected = results(tree)
        while not tried or time.monotonic() < end:
            delay = float(rng.uniform(0.0, length))
            killed(tree, delay)
            early = results(tree)
            start(tree, "--unlock").wait()
            status = start(tree, *TARGETS).wait()
            tried += 1
            torn = sorted(name for name, data in early.items() if data != expected[name])
            if torn or status != 0 or results(tree) != expected:
                fallen.append(f"killed after {delay:.3f} of {length:.3f} s; torn files: {torn}")
    return tried, tried - len(fallen), fallen
