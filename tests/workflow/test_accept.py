"""``accept``: what may become the record, and what is refused."""

import csv
import os
import shutil
import subprocess
from importlib.metadata import version
from pathlib import Path

import pytest

from bouncing_ball.record.diff.folders import compare_folders
from bouncing_ball.record.diff.outcome import Outcome
from bouncing_ball.record.diff.tolerance_file import read_tolerances

REASON = "The reason, in a few words"


def log(tree):
    with open(tree.path / "accepted.csv", encoding="utf-8", newline="") as file:
        return list(csv.DictReader(file))


def record(tree):
    return {
        name: content
        for name, content in tree.contents().items()
        if name.split("/")[0] in ("figures", "paper.md", "accepted.csv")
    }


def says_the_same(tree):
    """Whether the record has every file of the results, and says the same."""
    files = [set(tree.contents(folder)) for folder in ("figures", "results/figures")]
    rules = read_tolerances(tree.path / "config" / "tolerances.yaml")
    outcome = compare_folders(tree.path, tree.path / "results", rules).outcome
    return files[0] == files[1] and outcome is Outcome.IDENTICAL


def refused(tree, *arguments):
    """The one line of ours; nothing of the record is touched."""
    before = record(tree)
    done = tree.run("--cores", "1", "accept", *arguments, check=False)
    assert done.returncode == 1 and "Traceback" not in done.stdout + done.stderr
    assert record(tree) == before
    said = [line for line in done.stderr.splitlines() if line.startswith("accept: ")]
    assert len(said) == 1
    return said[0]


def test_the_results_become_the_record(complete):
    tree = complete
    (tree.path / "figures" / "stale.png").write_bytes(b"from an older version")
    done = tree.run("--cores", "1", "accept", "--config", f"reason={REASON}")
    # First what there is to accept, and where it was made.
    commit = tree.git("rev-parse", "HEAD")
    assert f"56 files made at commit {commit}\n" in done.stdout
    assert "stale" in done.stdout and f"Accepted, reason: {REASON}" in done.stdout
    assert says_the_same(tree)
    entry = log(tree)[-1]
    assert (entry["commit"], entry["reason"]) == (commit, REASON)
    assert "stale removed" in entry["changes"].split("; ")
    # The record is no dirt, and the same results are nothing new.
    before = record(tree)
    again = tree.run("--cores", "1", "accept", "--config", "reason=Again")
    assert "Nothing to accept" in again.stdout
    assert record(tree) == before
    # A second acceptance is a second entry.
    (tree.path / "figures" / "fig08.png").unlink()
    tree.run("--cores", "1", "accept", "--config", "reason=Lost")
    last = log(tree)[-1]
    assert int(last["number"]) == int(entry["number"]) + 1
    assert (last["reason"], last["changes"]) == ("Lost", "fig08 new")
    assert says_the_same(tree)
    # Copied is what has moved, and nothing else.
    after = record(tree)
    moved = {name for name in after if after[name] != before.get(name)}
    assert moved == {"accepted.csv", *(f"figures/fig08.{kind}" for kind in ("nc", "png", "svg"))}


def test_a_reason_runs_nothing_again(complete):
    assert complete.planned("--config", "reason=Something") == set()


def test_refused_without_a_reason(complete):
    assert 'say why the record changes: --config reason="…"' in refused(complete)


def test_refused_with_a_dirty_tree(complete):
    (complete.path / "README.md").write_text("Not committed.\n", encoding="utf-8")
    said = refused(complete, "--config", f"reason={REASON}")
    assert "the tree is dirty: commit first" in said


def test_refused_without_git(complete):
    shutil.rmtree(complete.path / ".git")
    assert "no git repository" in refused(complete, "--config", f"reason={REASON}")


def test_refused_with_results_of_a_dirty_tree(complete):
    readme = complete.path / "README.md"
    before = readme.read_bytes()
    readme.write_text("Not committed.\n", encoding="utf-8")
    complete.run("--cores", "1", "--force", "fig01")
    readme.write_bytes(before)
    said = refused(complete, "--config", f"reason={REASON}")
    assert "figures/fig01.png and 1 more made from a dirty or unknown tree" in said


def test_refused_with_another_configuration(complete, tmp_path):
    mine = tmp_path / "mine.yaml"
    mine.write_text("figures:\n  fig11:\n    restitution: 0.7\n", encoding="utf-8")
    assert refused(complete, "--configfile", str(mine), "--config", f"reason={REASON}") == (
        "accept: the configuration is not config/config.yaml: accept what the commit alone makes "
        "(details in results/logs/accept.log)"
    )


def test_refused_with_results_of_another_configuration(complete):
    # No parameter of this figure, so that it is up to date without the option.
    complete.run("--cores", "1", "--force", "fig01", "--config", "release=force")
    said = refused(complete, "--config", f"reason={REASON}")
    assert "figures/fig01.png and 1 more made from a dirty or unknown tree, or with anoth" in said


def test_refused_with_another_package(complete, tmp_path, monkeypatch):
    shutil.copytree(complete.path / "src", tmp_path / "src")
    monkeypatch.setattr(
        type(complete), "environment", lambda _: os.environ | {"PYTHONPATH": str(tmp_path / "src")}
    )
    said = refused(complete, "--config", f"reason={REASON}")
    assert "the package is not imported from src/ of the repository: accept" in said


def test_refused_with_versions_that_are_not_locked(complete):
    path = complete.path / "requirements.lock"
    text = path.read_text(encoding="utf-8")
    pin = f"scipy=={version('scipy')}"
    path.write_text(text.replace(pin, "scipy==0.1"), encoding="utf-8")
    complete.commit("Another lock")
    said = refused(complete, "--config", f"reason={REASON}")
    assert f"made with scipy {version('scipy')}, requirements.lock has 0.1: make setup" in said


def test_refused_with_a_file_that_nothing_makes(complete):
    (complete.path / "results" / "figures" / "mine.png").write_bytes(b"")
    said = refused(complete, "--config", f"reason={REASON}")
    assert "results/figures/mine.png is not made by this workflow" in said


def test_an_incomplete_result_is_made_first(complete):
    for folder in ("figures", "results/figures"):
        (complete.path / folder / "fig11.nc").unlink()
    complete.run("--cores", "1", "accept", "--config", f"reason={REASON}")
    assert says_the_same(complete)


def test_results_of_several_commits_are_reported(complete):
    first = complete.git("rev-parse", "HEAD")
    (complete.path / "README.md").write_text("Other words.\n", encoding="utf-8")
    second = complete.commit("Other words")
    (complete.path / "figures" / "fig05.png").unlink()
    complete.run("--cores", "1", "--force", "fig01")
    done = complete.run("--cores", "1", "accept", "--config", f"reason={REASON}")
    assert f"54 files made at commit {first}, up to date but not the one checked out" in done.stdout
    assert f"2 files made at commit {second}\n" in done.stdout
    assert log(complete)[-1]["commit"] == second


@pytest.mark.skipif(shutil.which("make") is None, reason="no make on this machine")
@pytest.mark.parametrize("reason", ['the "new" form; it\'s', "`false` \\ $$(false)", ""])
def test_make_hands_the_reason_over_as_it_is(tmp_path, reason):
    # In place of Snakemake, what says with which arguments it was called.
    program = tmp_path / "bin" / "snakemake"
    program.parent.mkdir()
    program.write_text('#!/bin/sh\nprintf "%s\\n" "$@"\n', encoding="utf-8")
    program.chmod(0o755)
    makefile = Path(__file__).resolve().parents[2] / "Makefile"
    done = subprocess.run(
        ["make", "--silent", "-f", makefile, "accept", "SETUP=", "VENV=.", f"REASON={reason}"],
        cwd=tmp_path,
        capture_output=True,
        text=True,
        check=True,
    )
    expected = f"reason={reason.replace('$$', '$')}"
    assert done.stdout.splitlines() == ["--cores", "1", "accept", "--config", expected]


@pytest.mark.parametrize("reason", ["", "Eq. 8: sign"])
def test_a_reason_that_is_no_line_is_a_mistake_of_the_configuration(complete, reason):
    before = record(complete)
    done = complete.run("--cores", "1", "accept", "--config", f"reason={reason}", check=False)
    assert done.returncode == 1 and "configuration: reason = " in done.stderr
    assert record(complete) == before


@pytest.mark.parametrize("file", ["figures/fig12.nc", "figures/table1.md", "paper.md"])
def test_refused_with_a_file_changed_by_hand(complete, file):
    (complete.path / "figures" / "fig05.png").unlink()
    path = complete.path / "results" / file
    path.write_bytes(path.read_bytes() + b" ")
    # Nothing looks newer than it is, so that nothing is made again.
    times = (complete.path / "results" / "figures" / "fig12.png").stat()
    os.utime(path, ns=(times.st_atime_ns, times.st_mtime_ns - 10**9))
    said = refused(complete, "--config", f"reason={REASON}")
    assert f"results/{file} is not what its job wrote: remove it" in said
