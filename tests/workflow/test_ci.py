"""Continuous integration, as far as it can be checked without a runner."""

import os
import re
import subprocess
from pathlib import Path

import pytest
import yaml

ROOT = Path(__file__).resolve().parents[2]
WORKFLOW = ROOT / ".github" / "workflows" / "ci.yml"


def without_make() -> dict[str, str]:
    """The environment without the variables of the make that has started these tests."""
    ours = ("MAKE", "MFLAGS", "CI")
    return {name: value for name, value in os.environ.items() if not name.startswith(ours)}


def dry(*arguments: str) -> str:
    """The commands that make would run."""
    command = ["make", "--dry-run", "--always-make", *arguments]
    return subprocess.check_output(command, cwd=ROOT, env=without_make(), text=True)


def run_script(tmp_path, failing: str, hanging: str = "none") -> tuple[int, list[str], str]:
    """Exit status, make's targets in order, and the last line, if some targets fail or hang."""
    program = tmp_path / "make"
    program.write_text(
        f'#!/bin/sh\necho "$*" >> "{tmp_path}/called"\n'
        f'case ",{failing}," in *",$*,"*) exit 2;; esac\n'
        f'case ",{hanging}," in *",$*,"*) exec sleep 600;; esac\n',
        encoding="utf-8",
    )
    program.chmod(0o755)
    environment = without_make()
    environment["PATH"] = f"{tmp_path}{os.pathsep}{environment['PATH']}"
    if hanging != "none":
        environment["LIMIT"] = "1"
    done = subprocess.run(
        [ROOT / ".ci" / "run"], env=environment, capture_output=True, text=True, check=False
    )
    called = (tmp_path / "called").read_text(encoding="utf-8").splitlines()
    return done.returncode, called, done.stdout.splitlines()[-1] if done.stdout else ""


STEPS = [
    *("lint", "clean", "all", "diff", "test", "test-cluster"),
    *(f"-C beyond {target}" for target in ("setup", "lint", "all", "diff", "test")),
    *("-C beyond lint-contacts", "-C beyond test-contacts"),
]


@pytest.mark.parametrize("failing", ["", *STEPS, "lint,test"])
def test_every_step_runs_whatever_fails_and_the_diff_runs_before_the_tests(tmp_path, failing):
    status, called, last = run_script(tmp_path, failing)
    assert called[0] == "setup" and sorted(called[1:]) == sorted(STEPS)
    order = ["clean", "all", "diff", "test", *STEPS[6:]]
    assert sorted(order, key=called.index) == order
    assert (status, last.startswith("Failed: ")) == ((1, True) if failing else (0, False))
    assert all(step in last for step in failing.split(","))


def test_a_step_that_hangs_is_ended_and_named(tmp_path):
    status, called, last = run_script(tmp_path, "", "test")
    assert status == 1 and called[-1] == STEPS[-1] and last == "Failed: test"


def test_the_linter_of_snakemake_has_to_end(tmp_path):
    """It ends with the status 0 if the workflow stops it early, and then says nothing good."""
    for program in ("ruff", "snakefmt", "mypy", "lint-imports", "snakemake"):
        path = tmp_path / "bin" / program
        path.parent.mkdir(exist_ok=True)
        path.write_text("#!/bin/sh\necho $SAID\n", encoding="utf-8")
        path.chmod(0o755)
    for said, status in (("Your workflow is in a good condition!", 0), ("Using a profile.", 2)):
        done = subprocess.run(
            ["make", "lint", "SETUP=", f"VENV={tmp_path}"],
            cwd=ROOT,
            env=without_make() | {"SAID": said},
            capture_output=True,
            text=True,
            check=False,
        )
        assert done.returncode == status


def test_without_the_set_up_nothing_runs(tmp_path):
    status, called, _ = run_script(tmp_path, "setup")
    assert status != 0 and called == ["setup"]


def number_of_line(part, lines):
    """The first line with this part."""
    found = [k for k, line in enumerate(lines) if part in line]
    assert found, f"make newest runs no command with {part!r}: {lines}"
    return found[0]


def test_the_newest_versions_run_what_the_locked_ones_do():
    lines = [line for line in dry("newest").splitlines() if not line.startswith("make[")]
    assert not any("requirements" in line for line in lines)
    order = ["--editable", "rm -rf results", "snakemake --cores 2", "--cores 2 diff", "pytest"]
    found = [number_of_line(part, lines) for part in order]
    assert found == sorted(found)
    assert all(".venv-newest/bin/" in lines[k] for k in found if k != found[1])


def jobs_of_ci():
    return yaml.safe_load(WORKFLOW.read_text(encoding="utf-8"))["jobs"]


def test_the_replication_is_a_job_of_its_own_and_each_comparison_is_in_the_summary():
    jobs = jobs_of_ci()
    assert "make replication" in [step.get("run") for step in jobs["replication"]["steps"]]
    # It is not hidden by another job, nor does it hide one.
    assert not any("needs" in job for job in jobs.values())
    assert "continue-on-error" not in jobs["replication"]
    for name in ("replication", "locked", "newest"):
        (summary,) = [step for step in jobs[name]["steps"] if step.get("name") == "Summary"]
        assert "GITHUB_STEP_SUMMARY" in summary["run"] and "always()" in summary["if"]


def test_the_summary_has_the_verdict_or_says_that_there_is_none(tmp_path):
    (command,) = {
        step["run"]
        for job in jobs_of_ci().values()
        for step in job["steps"]
        if step.get("name") == "Summary"
    }
    summary = tmp_path / "summary"
    environment = without_make() | {"GITHUB_STEP_SUMMARY": str(summary)}
    subprocess.run(["bash", "-e", "-c", command], cwd=tmp_path, env=environment, check=True)
    assert summary.read_text(encoding="utf-8").strip() == "No results were compared."
    report = tmp_path / "results" / "diff" / "replication.txt"
    report.parent.mkdir(parents=True)
    report.write_text("11 identical. The new artifacts agree with the record.\n", encoding="utf-8")
    subprocess.run(["bash", "-e", "-c", command], cwd=tmp_path, env=environment, check=True)
    said = summary.read_text(encoding="utf-8")
    assert "replication" in said and "11 identical. The new artifacts agree" in said


def test_the_jobs_of_ci_run_targets_of_make_that_exist():
    commands = [step.get("run", "") for job in jobs_of_ci().values() for step in job["steps"]]
    targets = [name for text in commands for name in re.findall(r"^make ([\w -]+)$", text, re.M)]
    assert targets and ".ci/run" in commands and all(dry(*target.split()) for target in targets)
