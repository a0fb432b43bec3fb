"""Runs of two figures killed at random moments: the rerun gives the same bytes."""

import os
import shutil
import signal
import subprocess
import sys
import time
from collections.abc import Iterator
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


def attack(seed: int) -> Iterator[list[str]]:
    """Kills after a random share of the time that a run takes."""
    rng = np.random.default_rng(seed)
    with TemporaryDirectory() as name:
        tree = Path(name, "tree")
        for folder in ("config", "profiles", "src", "workflow"):
            shutil.copytree(ROOT / folder, tree / folder)
        for file in ("Snakefile", "requirements.lock"):
            shutil.copyfile(ROOT / file, tree / file)
        before = time.monotonic()
        if start(tree, *TARGETS).wait() != 0:
            yield ["a run that nothing interrupts fails"]
            return
        length = time.monotonic() - before
        expected = results(tree)
        while True:
            delay = float(rng.uniform(0.0, length))
            killed(tree, delay)
            early = results(tree)
            start(tree, "--unlock").wait()
            status = start(tree, *TARGETS).wait()
            torn = sorted(name for name, data in early.items() if data != expected[name])
            fell = torn or status != 0 or results(tree) != expected
            yield [
                f"killed after {delay:.3f} of {length:.3f} s; torn files: {torn}" if fell else ""
            ]
