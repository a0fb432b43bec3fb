"""``accept`` as it is called; what it refuses is tested in tests/record/test_accept.py."""

import csv
import os
import shutil
import subprocess
from pathlib import Path

import pytest

from bouncing_ball.compare.folders import compare_folders
from bouncing_ball.compare.tolerance_file import read_tolerances
from bouncing_ball.datasets.netcdf import read_dataset, write_dataset

MAKEFILE = Path(__file__).resolve().parents[2] / "Makefile"
REASON = """costs $5: "new" form of Eq. 8; it's `date` \\ 100 % #1"""


@pytest.fixture
def tree(complete, monkeypatch):
    """A complete run, and no reason or request left over from whoever runs the tests."""
    for name in ("REASON", "ONLY"):
        monkeypatch.delenv(name, raising=False)
    return complete


def record(tree):
    return {
        name: content
        for name, content in tree.contents().items()
        if name.split("/")[0] in ("figures", "paper.md", "accepted.csv")
    }


def refused(tree):
    """The one line of ours; nothing of the record is touched."""
    before = record(tree)
    done = tree.run("--cores", "1", "accept", check=False)
    assert done.returncode == 1 and "Traceback" not in done.stdout + done.stderr
    assert record(tree) == before
    [said] = [line for line in done.stderr.splitlines() if line.startswith("accept: ")]
    return said


def move(path, by):
    """Change a value of a dataset of the record relatively, on purpose."""
    data = read_dataset(path)
    data.threshold_amplitude.values.flat[7] *= 1 + by
    write_dataset(data, path)


def test_what_has_moved_becomes_the_record(tree, monkeypatch):
    figures = tree.path / "figures"
    # As if the code had moved one, another processor nudged one, and one were no more.
    move(figures / "fig11.nc", 1e-3)
    nudged = figures / "fig02.nc"
    data = read_dataset(nudged)
    data.ball.values.flat[-1] *= 1 + 1e-15
    write_dataset(data, nudged)
    (figures / "old.png").write_bytes(b"from an older version")
    before = nudged.read_bytes()
    # What is missing is made first.
    (tree.path / "results" / "figures" / "fig11.png").unlink()
    monkeypatch.setenv("REASON", REASON)
    monkeypatch.setenv("ONLY", "moved")
    done = tree.run("--cores", "1", "accept")
    commit = tree.git("rev-parse", "HEAD")
    assert f"files made at commit {commit}\n" in done.stdout and REASON in done.stdout
    with open(tree.path / "accepted.csv", encoding="utf-8", newline="") as file:
        entry = list(csv.DictReader(file))[-1]
    assert (entry["commit"], entry["reason"]) == (commit, REASON)
    assert {"fig11 drifted", "old removed"} <= set(entry["changes"].split("; "))
    for name in ("fig11.nc", "fig11.png", "fig11.svg"):
        assert (figures / name).read_bytes() == (tree.path / "results/figures" / name).read_bytes()
    assert not (figures / "old.png").exists()
    # Within its budget: neither copied nor named.
    assert nudged.read_bytes() == before and "fig02" not in entry["changes"]

    rules = read_tolerances(tree.path / "config" / "tolerances.yaml")
    only = ("fig02", "fig11")
    assert compare_folders(tree.path, tree.path / "results", rules, only).outcome.agrees


def test_a_reason_is_asked_for_before_anything_runs(tree):
    missing = tree.path / "results" / "figures" / "fig11.png"
    missing.unlink()
    assert refused(tree) == "accept: say why the record changes: make accept REASON='…'"
    assert not missing.exists()


def test_stale_results_are_refused_whatever_their_times(tree, monkeypatch):
    monkeypatch.setenv("REASON", REASON)
    tree.configure("figures", "fig11", "restitution", value=0.7)
    with open(tree.path / "workflow" / "scripts" / "table.py", "a", encoding="utf-8") as file:
        file.write("# edited\n")
    tree.edit("figures/fig12.py")
    tree.commit("Other results")
    tree.run("--cores", "1", "--touch")
    # Snakemake now makes nothing, so that this is what `accept` finds:
    # fig11's dataset, the pictures of fig12, and all tables.
    said = refused(tree)
    assert "made from other than this commit makes it from: other " in said
    assert "--forceall" in said


@pytest.mark.skipif(shutil.which("make") is None, reason="no make on this machine")
@pytest.mark.parametrize("origin", ["command line", "environment"])
@pytest.mark.parametrize(
    "reason", [REASON, "$(shell touch made) ${HOME} $$ $(date)", "`touch made`; touch made"]
)
def test_make_hands_the_reason_over_as_it_is_typed(tmp_path, reason, origin):
    # In place of Snakemake, what says with which arguments and reason it was called.
    program = tmp_path / "bin" / "snakemake"
    program.parent.mkdir()
    program.write_text('#!/bin/sh\nprintf "%s\\n" "$@" "$REASON"\n', encoding="utf-8")
    program.chmod(0o755)
    typed = [f"REASON={reason}"] if origin == "command line" else []
    done = subprocess.run(
        ["make", "--silent", "-f", MAKEFILE, "accept", "SETUP=", "VENV=.", *typed],
        cwd=tmp_path,
        env=os.environ | ({} if typed else {"REASON": reason}),
        capture_output=True,
        text=True,
        check=True,
    )
    assert done.stdout.splitlines() == ["--cores", "1", "accept", reason]
    assert not (tmp_path / "made").exists()
