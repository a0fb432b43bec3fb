"""Copies of the workflow, in which a script only writes its outputs: a whole run takes seconds."""

import ast
import contextlib
import gc
import io
import os
import re
import shutil
import sys
import warnings
from dataclasses import dataclass
from pathlib import Path
from unittest import mock

import pytest
from snakemake import cli
from tests import repository
from tests.project import FILES, Project

from bouncing_ball import datasets

ROOT = Path(__file__).resolve().parents[1]
STUB = """from pathlib import Path
for file in snakemake.output:
    Path(file).write_text("made by a stub")
if False:
    {imports}
"""


def stub(script: Path) -> str:
    """A script that only writes its outputs. It names the modules that the true one imports."""
    nodes = ast.walk(ast.parse(script.read_text("utf-8")))
    imports = [ast.unparse(node) for node in nodes if isinstance(node, ast.Import | ast.ImportFrom)]
    # Lines may go on after a backslash.
    return STUB.format(imports="\n    ".join(imports).replace(", ", ", \\\n"))


# The collector of garbage looks at a few large heaps instead of many small ones.
gc.set_threshold(100_000)


def pytest_collection_finish():
    """What is imported by now stays: the collector of garbage need not look at it again and again,
    which takes about a tenth of the time.
    """
    gc.freeze()


@pytest.fixture(scope="session", autouse=True)
def hostile_git(tmp_path_factory):
    """The environment of a hook in another repository, and settings that change what git answers:
    all tests run in it, and nothing happens in that repository.
    """
    other = tmp_path_factory.mktemp("other")
    repository.git(other, "init", "-q")
    before = repository.commit(other, "first")
    variables = {
        "GIT_DIR": str(other / ".git"),
        "GIT_WORK_TREE": str(other),
        "GIT_INDEX_FILE": str(other / ".git/index"),
        "GIT_PREFIX": "src/",
        "GIT_EXTERNAL_DIFF": "false",
        "GIT_GLOB_PATHSPECS": "1",
    }
    settings = {
        "commit.gpgSign": "true",
        "gpg.program": "false",
        "diff.relative": "true",
        "diff.external": "false",
        "diff.noprefix": "true",
        "status.relativePaths": "true",
        "status.showUntrackedFiles": "no",
        "core.quotePath": "on",
    }
    variables["GIT_CONFIG_COUNT"] = str(len(settings))
    for number, (key, value) in enumerate(settings.items()):
        variables |= {f"GIT_CONFIG_KEY_{number}": key, f"GIT_CONFIG_VALUE_{number}": value}
    with pytest.MonkeyPatch.context() as patch:
        for name, value in variables.items():
            patch.setenv(name, value)
        yield other
    assert repository.git(other, "rev-parse", "HEAD") == before
    assert repository.git(other, "status", "--porcelain", "--untracked-files=all") == ""


@dataclass(frozen=True)
class Checkout:
    """A copy of the workflow, with shortcuts to run and to change it."""

    path: Path

    def run(self, *arguments: str, folder: Path | None = None) -> tuple[int | str, str]:
        """Snakemake's command in the copy or another folder: its exit status and what it prints.

        It runs in this process, which has imported Snakemake; scripts have their own as always. The
        status of a refused configuration is the line with which it is refused.
        """
        printed = io.StringIO()
        variables = dict(os.environ)
        with (
            # Those of Snakemake's code: files left open, deprecated arguments.
            warnings.catch_warnings(action="ignore"),
            contextlib.chdir(folder or self.path),
            contextlib.redirect_stdout(printed),
            contextlib.redirect_stderr(printed),
            # The profile reads the command line.
            mock.patch.object(sys, "argv", ["snakemake", *arguments]),
            pytest.raises(SystemExit) as ended,
        ):
            cli.main([*arguments])
        os.environ.clear()
        os.environ.update(variables)
        return ended.value.code, printed.getvalue()

    def plan(self, *arguments: str) -> str:
        """What a dry run prints."""
        command = ["--dry-run", "--cores", "1", "--quiet", "host", "--", *arguments]
        status, printed = self.run(*command)
        assert status == 0, printed
        return printed

    def planned(self, *arguments: str) -> set[str]:
        """The rules whose jobs a run would execute."""
        jobs = re.findall(r"^(\w+) +\d+$", self.plan(*arguments), re.MULTILINE)
        return {*jobs} - {"total"}

    def append(self, file: str, line: str) -> None:
        """Add a line to a file."""
        with (self.path / file).open("a", encoding="utf-8") as opened:
            opened.write(f"{line}\n")


@pytest.fixture(scope="session")
def stubs(tmp_path_factory) -> Checkout:
    """The workflow with scripts that only write their outputs, not run yet."""
    folder = tmp_path_factory.mktemp("stubs") / "checkout"
    without = shutil.ignore_patterns("__pycache__")
    for name in ("config", "docs", "profiles", "src", "workflow"):
        shutil.copytree(ROOT / name, folder / name, ignore=without)
    shutil.copyfile(ROOT / "Snakefile", folder / "Snakefile")
    for script in (folder / "workflow/scripts").glob("*.py"):
        script.write_text(stub(script), encoding="utf-8")
    return Checkout(folder)


@pytest.fixture(scope="session")
def complete(stubs, tmp_path_factory) -> Checkout:
    """The same after a whole run. Tests may plan further runs here, and change nothing."""
    folder = tmp_path_factory.mktemp("complete") / "checkout"
    shutil.copytree(stubs.path, folder)
    status, printed = Checkout(folder).run("--cores", "2")
    assert status == 0, printed
    return Checkout(folder)


@pytest.fixture
def fresh(stubs, tmp_path) -> Checkout:
    """A copy for one test, not run yet."""
    shutil.copytree(stubs.path, tmp_path / "checkout")
    return Checkout(tmp_path / "checkout")


@pytest.fixture
def used(complete, tmp_path) -> Checkout:
    """A copy for one test, after a whole run."""
    shutil.copytree(complete.path, tmp_path / "checkout")
    return Checkout(tmp_path / "checkout")


@pytest.fixture(scope="session")
def original_project(tmp_path_factory):
    """A project whose reference was accepted, committed and pushed."""
    made = Project(tmp_path_factory.mktemp("project") / "checkout")
    for file, words in FILES.items():
        path = made.top / file
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(words, "utf-8")
    (made.top / "figures").mkdir()
    repository.git(made.top, "init", "-q")
    repository.commit(made.top, "code")
    made.run()
    assert len(made.accept()) == 5
    repository.commit(made.top, "reference")
    repository.git(made.top, "update-ref", "refs/remotes/origin/main", "HEAD")
    # Each test copies all files: a pack has fewer than loose objects.
    repository.git(made.top, "gc", "--quiet")
    assert made.lines() == ["All 5 files agree with the reference."]
    return made


@pytest.fixture
def project(original_project, monkeypatch):
    """The same at the same place, for a test that changes it."""
    # What a dataset records of this repository is not compared, and asking git for it takes time.
    monkeypatch.setattr(datasets, "commit", lambda files: "unknown")
    saved = original_project.top.parent.with_name("saved")
    if not saved.exists():
        shutil.copytree(original_project.top.parent, saved)
    shutil.rmtree(original_project.top.parent)
    shutil.copytree(saved, original_project.top.parent)
    return original_project
