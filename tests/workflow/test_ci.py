"""Continuous integration, as far as it can be checked without a runner."""

import os
import re
import shutil
import stat
import subprocess
from pathlib import Path

import pytest
import yaml

ROOT = Path(__file__).resolve().parents[2]
WORKFLOW = ROOT / ".github" / "workflows" / "ci.yml"
STEPS = ["setup", "lint", "test", "clean", "all", "diff"]


@pytest.fixture(scope="module")
def workflow():
    return yaml.safe_load(WORKFLOW.read_text(encoding="utf-8"))


def dry(*arguments: str) -> subprocess.CompletedProcess:
    """What make would do, whatever make has started these tests."""
    environment = {
        key: value for key, value in os.environ.items() if not key.startswith(("MAKE", "MFLAGS"))
    }
    return subprocess.run(
        ["make", "--dry-run", *arguments],
        cwd=ROOT,
        env=environment,
        capture_output=True,
        text=True,
        check=False,
    )


def made(job) -> list[str]:
    """The make targets of a job, in order."""
    commands = [step.get("run", "") for step in job["steps"]]
    return [command.removeprefix("make ") for command in commands if command.startswith("make ")]


def test_both_ways_take_the_same_steps(workflow):
    script = (ROOT / ".ci" / "run").read_text(encoding="utf-8")
    assert re.findall(r"^make (\S+)$", script, re.MULTILINE) == STEPS
    assert made(workflow["jobs"]["locked"]) == STEPS
    assert made(workflow["jobs"]["newest"]) == ["newest"]


@pytest.mark.parametrize("target", [*STEPS, "newest", "setup-newest", "ci", "accept", "lock"])
def test_every_target_exists(target):
    # A folder or file of that name would hide a target that is not declared.
    make = (ROOT / "Makefile").read_text(encoding="utf-8")
    phony = re.search(r"^\.PHONY: (.*)$", make, re.MULTILINE)
    assert phony and target in phony[1].split()
    done = dry("--always-make", target)
    assert done.returncode == 0, done.stderr
    assert "Nothing to be done" not in done.stdout


def test_the_newest_versions_run_what_the_locked_ones_do():
    done = dry("newest")
    commands = [line for line in done.stdout.splitlines() if not line.startswith("make[")]
    assert "requirements" not in done.stdout
    order = ["--editable", "rm -rf results", "pytest", "snakemake --cores 2", "--cores 2 diff"]
    found = [next(k for k, line in enumerate(commands) if part in line) for part in order]
    assert found == sorted(found)
    assert all(".venv-newest/bin/" in commands[k] for k in found if k != found[1])


def test_the_script_is_a_program():
    assert (ROOT / ".ci" / "run").stat().st_mode & stat.S_IXUSR
    subprocess.run([shutil.which("bash"), "-n", ROOT / ".ci" / "run"], check=True)


def test_the_workflow_reads_only_and_holds_no_secret(workflow):
    assert workflow["permissions"] == {"contents": "read"}
    assert "secrets" not in WORKFLOW.read_text(encoding="utf-8")
    assert all("permissions" not in job for job in workflow["jobs"].values())


def test_when_it_runs(workflow):
    # YAML 1.1 takes the key `on` for true.
    when = workflow[True]
    assert {"push", "pull_request", "schedule"} <= set(when)
    minute, hour, day, month, weekday = when["schedule"][0]["cron"].split()
    assert (day, month) == ("*", "*") and 0 <= int(weekday) <= 6
    assert 0 <= int(minute) < 60 and 0 <= int(hour) < 24
    matrix = workflow["jobs"]["locked"]["strategy"]["matrix"]
    assert matrix["python"] == ["3.11", "3.13"]
    assert "continue-on-error" not in workflow["jobs"]["locked"]
    # Red on schedule only.
    blocking = workflow["jobs"]["newest"]["continue-on-error"]
    assert blocking == "${{ github.event_name != 'schedule' }}"


def test_actions_are_pinned_by_major_version(workflow):
    steps = [step for job in workflow["jobs"].values() for step in job["steps"]]
    used = [step["uses"] for step in steps if "uses" in step]
    assert used and all(re.fullmatch(r"actions/[a-z-]+@v\d+", name) for name in used)


@pytest.mark.parametrize("name", ["locked", "newest"])
def test_page_and_results_are_kept_even_on_failure(workflow, name):
    steps = workflow["jobs"][name]["steps"]
    kept = [step for step in steps if step.get("uses", "").startswith("actions/upload-artifact@")]
    assert [step["with"]["path"] for step in kept] == ["results/diff/index.html", "results/"]
    summary = next(step for step in steps if step.get("name") == "Summary")
    assert "results/diff/diff.md" in summary["run"]
    for step in [*kept, summary]:
        assert step["if"] == "${{ !cancelled() }}"
        # After everything that may fail.
        assert steps.index(step) > max(
            index for index, one in enumerate(steps) if one.get("run", "").startswith("make ")
        )
