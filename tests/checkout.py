"""Copies of a workflow, of the replication or of extras/beyond, whose scripts only write their
outputs, so that a whole run takes seconds; and git without the settings of its user.
"""

import contextlib
import io
import os
import re
import shutil
import subprocess
import warnings
from dataclasses import dataclass
from pathlib import Path
from unittest import mock

import pytest
from snakemake import cli

ROOT = Path(__file__).resolve().parents[1]

STUB = """from pathlib import Path
for file in snakemake.output:
    about = [getattr(snakemake.params, name, "") for name in ("stage", "settings")]
    Path(file).write_text(f"{about[0]} {sorted(about[1])}")
raise SystemExit
"""


@dataclass(frozen=True)
class Checkout:
    """A copy of a workflow, with shortcuts to run and to change it."""

    path: Path

    def run(self, *arguments: str) -> tuple[int | str, str]:
        """Snakemake's command in this process: its exit status, or the line with which it ends, and
        what it prints.
        """
        printed = io.StringIO()
        with (
            mock.patch.dict(os.environ),
            warnings.catch_warnings(action="ignore"),
            contextlib.chdir(self.path),
            contextlib.redirect_stdout(printed),
            contextlib.redirect_stderr(printed),
            pytest.raises(SystemExit) as ended,
        ):
            cli.main([*arguments])
        return ended.value.code, printed.getvalue()

    def planned(self, *arguments: str) -> set[str]:
        """The rules whose jobs a run would execute."""
        status, printed = self.run("--dry-run", "--cores", "1", "--quiet", "host", "--", *arguments)
        assert status == 0, printed
        return {*re.findall(r"^(\w+) +\d+$", printed, re.MULTILINE)} - {"total", "all"}

    def made(self, folder: str = "results") -> set[str]:
        """The results of a run."""
        base = self.path / folder
        files = {str(path.relative_to(base)) for path in base.rglob("*") if path.is_file()}
        return {name for name in files if not name.startswith(("logs/", "records/"))}

    def edit(self, file: str, old: str, new: str) -> None:
        """Replace a text in a file."""
        text = (self.path / file).read_text("utf-8")
        assert old in text
        (self.path / file).write_text(text.replace(old, new, 1), "utf-8")


def stubbed(top: Path, folder: Path) -> Checkout:
    """Copy a workflow into another folder, with scripts that only write their outputs."""
    without = shutil.ignore_patterns("__pycache__")
    for name in ("config", "profiles", "src", "workflow"):
        shutil.copytree(top / name, folder / name, ignore=without)
    shutil.copyfile(top / "Snakefile", folder / "Snakefile")
    for script in (folder / "workflow/scripts").glob("*.py"):
        script.write_text(STUB + script.read_text("utf-8"), "utf-8")
    return Checkout(folder)


@contextlib.contextmanager
def without_variables_of_git():
    """Git without the variables of a hook, and without the configuration of a user or a machine.

    A hook exports the index and the repository of its commit. Tests that used them would commit
    their own project into the user's repository.
    """
    names = subprocess.check_output(["git", "rev-parse", "--local-env-vars"], text=True).split()
    with pytest.MonkeyPatch.context() as patch:
        for name in [*names, "GIT_DEFAULT_HASH", "GIT_TEMPLATE_DIR"]:
            patch.delenv(name, raising=False)
        patch.setenv("GIT_CONFIG_GLOBAL", os.devnull)
        patch.setenv("GIT_CONFIG_NOSYSTEM", "1")
        yield
