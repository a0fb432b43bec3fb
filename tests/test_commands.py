"""Every command that is published: Snakemake's own parser reads it, and it runs where it can."""

import itertools
import os
import re
import shlex
import shutil
import subprocess
import sys
from dataclasses import replace
from functools import cache
from pathlib import Path

import pytest
import yaml
from snakemake import cli

ROOT = Path(__file__).resolve().parents[1]
BEYOND = ROOT / "extras/beyond"
CONTACTS = ROOT / "extras/contacts"
# Where commands are published, below the root and below extras/beyond.
PATTERNS = [
    *("*.md", "docs/*.md", "figures/*.md", ".test/*.md", "workflow/templates/*.j2"),
    *("Snakefile", "Makefile", "environment.yml", "pyproject.toml"),
    *("config/*.yaml", "profiles/*/*.yaml", "workflow/envs/*.yaml", ".ci/run"),
    ".github/workflows/*.yml",
]
PROGRAM = r"(?:[A-Z0-9_]+=\S+ )*(?:\.venv/bin/)?snakemake"
# In backticks, or a line of its own with a description after two spaces or a #.
SPAN = re.compile(rf"`{PROGRAM} ([^`]+)`")
LINE = re.compile(rf"^(?:# )?[ \t]*{PROGRAM} (-.*?)(?:  .*| +#.*)?$", re.MULTILINE)
ANY = re.compile(r"snakemake -(?:-[a-z]|[a-z] )")


def pages(folder: Path) -> list[Path]:
    """The files of a folder in which commands are published."""
    return sorted(path for pattern in PATTERNS for path in folder.glob(pattern))


def published(page: Path) -> list[str]:
    """What follows the word snakemake in each command of a page."""
    text = page.read_text("utf-8")
    found = [*SPAN.findall(text), *LINE.findall(text)]
    if page.name == "Makefile":
        # Of the targets that there are.
        targets = re.findall("^(all|diff|accept|lint|report):", text, re.MULTILINE)
        found += [line for target in targets for line in made(page, target)]
    return found


def made(makefile: Path, target: str) -> list[str]:
    """The same of what make would run for a target."""
    command = ["make", "--dry-run", "--always-make", "-C", str(makefile.parent), target]
    planned = subprocess.run(command, capture_output=True, text=True, check=True).stdout
    # What is printed goes through a filter.
    return re.findall(r"-m snakemake (.*?)(?: *2>&1.*)?$", planned, re.MULTILINE)


def commands(folder: Path) -> list[str]:
    """All commands that the pages of a folder publish, each once."""
    return [*dict.fromkeys(each for page in pages(folder) for each in published(page))]


@cache
def parser():
    """Snakemake's own."""
    return cli.get_argument_parser()


def parsed(command: str):
    """The arguments as Snakemake reads them, without those of a profile."""
    return parser().parse_args(shlex.split(command))


@pytest.mark.parametrize("folder", [ROOT, BEYOND], ids=["root", "beyond"])
def test_no_command_is_overlooked(folder):
    """Whatever looks like a command with an option is found by the patterns."""
    for page in pages(folder):
        if page.name != "Makefile":
            lines = published(page)
            found = ANY.findall(" ".join(f"snakemake {line}" for line in lines))
            assert len(ANY.findall(page.read_text("utf-8"))) == len(found), page


@pytest.fixture(params=[ROOT, BEYOND], ids=["root", "beyond"])
def workflow(request, stubs, tmp_path, monkeypatch):
    """A folder with a Snakefile, which is the working directory, and its targets."""
    arguments = ["--snakefile", str(request.param / "Snakefile"), "--list"]
    status, listed = replace(stubs, path=tmp_path).run(*arguments)
    assert status == 0, listed
    monkeypatch.chdir(request.param)
    return request.param, {line.split()[0] for line in listed.splitlines()}


def test_snakemake_reads_every_command(workflow):
    folder, targets = workflow
    found = commands(folder)
    assert len(found) >= 8
    for command in found:
        given = parsed(command)
        # The figures of CONTRIBUTING's recipe and of the page on other parameters.
        assert set(given.targets) <= targets | {"fig17"}, command
        named = {given.cores, given.lint, given.list_rules, given.dryrun, given.report}
        assert named - {None, False} or given.profile, f"{command}: nothing is run"


def test_the_parser_refuses_a_wrong_order(capsys, monkeypatch):
    """A guard for the test above: --sdm takes several values, of which diff is none."""
    monkeypatch.chdir(ROOT)
    with pytest.raises(SystemExit):
        parsed("--cores 2 --sdm conda diff")
    assert "invalid choice: 'diff'" in capsys.readouterr().err
    assert parsed("--cores 2 diff --sdm conda").targets == ["diff"]


# Commands of make


@pytest.mark.parametrize("page", [*pages(ROOT), *pages(BEYOND), *CONTACTS.glob("*.md")], ids=str)
def test_targets_of_make_exist(page):
    text = page.read_text("utf-8")
    called = re.findall(
        r"(?:`|^[ \t]*(?:step |- run: )?|&& )make ([^`\n#$&|]+)", text, re.MULTILINE
    )
    home = next(each for each in (BEYOND, CONTACTS, ROOT) if page.is_relative_to(each))
    for words in map(shlex.split, called):
        # Commands of the extras are typed at the root or in their own folder.
        folder = ROOT / words.pop(words.index("-C") + 1) if "-C" in words else home
        targets = [word for word in words if re.fullmatch("[a-z][a-z-]*", word)]
        rules = re.findall(r"^([\w -]+):", (folder / "Makefile").read_text("utf-8"), re.MULTILINE)
        assert {*targets} <= {*" ".join(rules).split()}, words


# Runs


@pytest.fixture
def checkout(fresh):
    """A copy whose scripts only write their outputs, with the files that the pages name."""
    shutil.copytree(ROOT / ".test", fresh.path / ".test")
    for name in ("mine.yaml", "compliant.yaml"):
        (fresh.path / name).write_text("release: force\n", "utf-8")
    return fresh


def test_commands_with_options_run(checkout):
    """The others name targets, which exist; a cluster and conda have tests of their own."""
    ran = 0
    for command in commands(ROOT):
        options = {word for word in shlex.split(command) if word.startswith("-")}
        if options <= {"--cores", "--lint", "--report"} or options & {"--profile", "--sdm"}:
            continue
        status, printed = checkout.run("--dry-run", *shlex.split(command))
        assert status == 0, f"{command}: {status} {printed}"
        ran += 1
    assert ran >= 7


# It knows what Snakemake asks, and an environment is a folder with this Python.
CONDA = """#!/bin/sh
echo "conda $*" >> {log}
case "$*" in
--version) echo "conda 26.1.0" ;;
"info --json") echo '{{"conda_prefix": "{prefix}", "platform": "linux-64"}}' ;;
config*) echo '{{"get": {{"channel_priority": "strict"}}}}' ;;
"env create"*)
    eval "set -- $*"
    while [ "$1" != --file ]; do shift; done
    grep --quiet "^dependencies:" "$2" || exit 1
    [ "$3" != --prefix ] || mkdir -p "$4/conda-meta" ;;
activate* | clean*) ;;
*) echo "unknown: conda $*"; exit 1 ;;
esac
"""


@pytest.fixture
def conda(tmp_path, monkeypatch):
    """A stand-in for conda, which notes what it is asked."""
    prefix = tmp_path / "conda"
    (prefix / "bin").mkdir(parents=True)
    program = prefix / "bin/conda"
    program.write_text(CONDA.format(log=tmp_path / "asked", prefix=prefix), "utf-8")
    program.chmod(0o755)
    (prefix / "bin/activate").write_text(f'echo "activate $1" >> {tmp_path / "asked"}\n', "utf-8")
    path = [str(prefix / "bin"), str(Path(sys.executable).parent), os.environ["PATH"]]
    monkeypatch.setenv("PATH", os.pathsep.join(path))
    monkeypatch.setenv("CONDA", str(prefix))
    return tmp_path / "asked"


def test_the_job_with_conda_runs(checkout, conda):
    """The script of continuous integration, and the commands of the page on clusters."""
    jobs = yaml.safe_load((ROOT / ".github/workflows/ci.yml").read_text("utf-8"))["jobs"]
    (script,) = (step["run"] for step in jobs["conda"]["steps"] if "run" in step)
    shutil.copyfile(ROOT / "environment.yml", checkout.path / "environment.yml")
    # Figure 1 is in the place of the comparison: two jobs instead of twenty. The run without --sdm
    # is as any other, and its folders are in its place.
    shorter = script.replace("snakemake --cores 2 diff\n", "mkdir results .snakemake\n")
    command = ["bash", "-e", "-c", re.sub(r"\bdiff\b", "fig01", shorter)]
    run = subprocess.run(command, cwd=checkout.path, capture_output=True, text=True, check=False)
    assert run.returncode == 0, run.stdout + run.stderr
    asked = conda.read_text("utf-8")
    assert "conda env create --file environment.yml" in asked
    # Snakemake makes an environment from workflow/envs, and activates it for each job.
    assert "conda env create --quiet --no-default-packages --file" in asked
    assert re.search("^activate .*/\\.snakemake/conda/", asked, re.MULTILINE)
    page = (ROOT / "docs/on-a-cluster.md").read_text("utf-8")
    lines = [line.strip() for line in script.splitlines()[1:]]
    assert [line for line in lines if line not in page and not line.startswith("rm ")] == []


def test_a_failed_step_skips_none_of_the_others():
    """In GitHub's continuous integration: lint, replication and tests."""
    jobs = yaml.safe_load((ROOT / ".github/workflows/ci.yml").read_text("utf-8"))["jobs"]
    steps = jobs["replication"]["steps"]
    runs = [step for step in steps if "run" in step]
    commands = [step["run"] for step in runs if step["run"].startswith("make")]
    assert commands == ["make lint", "make replication", "make test"]
    later = itertools.dropwhile(lambda step: step.get("run") != "make replication", steps)
    assert all("!cancelled()" in step["if"] for step in later)


@pytest.mark.parametrize(
    "log, said", [("All files agree.", "All files agree."), (None, "There was no")]
)
def test_the_summary_of_a_run_has_the_verdict(tmp_path, log, said):
    """On GitHub, between the marks of a text that is shown as it is."""
    (tmp_path / ".ci").mkdir()
    shutil.copy(ROOT / ".ci/summary", tmp_path / ".ci")
    if log:
        (tmp_path / "results/logs").mkdir(parents=True)
        (tmp_path / "results/logs/diff.log").write_text(f"{log}\n", "utf-8")
    environment = os.environ | {"GITHUB_STEP_SUMMARY": str(tmp_path / "page")}
    subprocess.run([tmp_path / ".ci/summary"], env=environment, capture_output=True, check=True)
    first, line, last = (tmp_path / "page").read_text("utf-8").splitlines()
    assert first == last == "```" and line.startswith(said)
