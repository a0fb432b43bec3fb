"""Continuous integration, as far as it can be checked without a runner."""

import os
import re
import subprocess
from pathlib import Path

import pytest
import yaml

ROOT = Path(__file__).resolve().parents[2]
WORKFLOW = ROOT / ".github" / "workflows" / "ci.yml"
JOBS = yaml.safe_load(WORKFLOW.read_text(encoding="utf-8"))["jobs"]


def without_make() -> dict[str, str]:
    """The environment, whatever make has started these tests."""
    ours = ("MAKE", "MFLAGS", "CI")
    return {name: value for name, value in os.environ.items() if not name.startswith(ours)}


def dry(*arguments: str) -> str:
    """What make would do."""
    return subprocess.run(
        ["make", "--dry-run", "--always-make", *arguments],
        cwd=ROOT,
        env=without_make(),
        capture_output=True,
        text=True,
        check=True,
    ).stdout


def run_script(tmp_path, failing: str) -> tuple[int, list[str], str]:
    """Exit status, make's targets in order, and the last line, if some of the targets fail."""
    program = tmp_path / "make"
    program.write_text(
        f'#!/bin/sh\necho "$@" >> "{tmp_path}/called"\n'
        f'case " {failing} " in *" $1 "*) exit 2;; esac\n',
        encoding="utf-8",
    )
    program.chmod(0o755)
    environment = without_make()
    environment["PATH"] = f"{tmp_path}{os.pathsep}{environment['PATH']}"
    done = subprocess.run(
        [ROOT / ".ci" / "run"], env=environment, capture_output=True, text=True, check=False
    )
    called = (tmp_path / "called").read_text(encoding="utf-8").split()
    return done.returncode, called, done.stdout.splitlines()[-1] if done.stdout else ""


STEPS = ["lint", "clean", "all", "diff", "test", "test-cluster"]


@pytest.mark.parametrize("failing", ["", *STEPS, "lint test"])
def test_every_step_runs_and_the_diff_before_the_tests(tmp_path, failing):
    status, called, last = run_script(tmp_path, failing)
    assert called[0] == "setup" and sorted(called[1:]) == sorted(STEPS)
    assert called.index("clean") < called.index("all") < called.index("diff") < called.index("test")
    assert (status, last.startswith("Failed: ")) == ((1, True) if failing else (0, False))
    assert set(failing.split()) <= set(last.split())


def test_without_the_set_up_nothing_runs(tmp_path):
    status, called, _ = run_script(tmp_path, "setup")
    assert status != 0 and called == ["setup"]


def test_the_newest_versions_run_what_the_locked_ones_do():
    lines = [line for line in dry("newest").splitlines() if not line.startswith("make[")]
    assert not any("requirements" in line for line in lines)
    order = ["--editable", "rm -rf results", "snakemake --cores 2", "--cores 2 diff", "pytest"]
    found = [next(k for k, line in enumerate(lines) if part in line) for part in order]
    assert found == sorted(found)
    assert all(".venv-newest/bin/" in lines[k] for k in found if k != found[1])


@pytest.mark.parametrize("job", JOBS)
def test_a_job_runs_what_exists_and_keeps_it_even_on_failure(job):
    steps = JOBS[job]["steps"]
    commands = [step.get("run", "") for step in steps]
    targets = [name for text in commands for name in re.findall(r"^make (\S+)$", text, re.M)]
    for target in targets:
        assert dry(target)
    assert targets or ".ci/run" in commands
    last = max(k for k, text in enumerate(commands) if text.startswith(("make ", ".ci/run")))
    kept = [step for step in steps[last + 1 :] if "upload-artifact" in step.get("uses", "")]
    # The long tests leave nothing to look at.
    assert bool(kept) == (job != "long") and all(step["if"] == "${{ always() }}" for step in kept)


def test_a_folder_hides_no_target():
    make = (ROOT / "Makefile").read_text(encoding="utf-8")
    phony = re.search(r"^\.PHONY: (.*)$", make, re.MULTILINE)[1].split()
    targets = set(re.findall(r"^([a-z-]+):", make, re.MULTILINE))
    assert set(phony) == targets


def test_the_workflow_reads_only_and_holds_no_secret():
    text = WORKFLOW.read_text(encoding="utf-8")
    assert re.findall(r"permissions:\n((?:  .*\n)+)", text) == ["  contents: read\n"]
    assert "secrets" not in text
    used = re.findall(r"uses: (\S+)", text)
    assert used and all(re.fullmatch(r"actions/[a-z-]+@v\d+", name) for name in used)
