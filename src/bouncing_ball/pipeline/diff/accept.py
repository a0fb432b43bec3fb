"""Copying results over the accepted record: ``figures/`` and the texts, which are in git.

The history of the record is ``git log figures/``.
"""

import re
import shutil
import subprocess
import sys
from collections.abc import Collection, Iterable, Mapping
from pathlib import Path
from typing import Any

from bouncing_ball.datasets.files import replacing
from bouncing_ball.errors import ModelError
from bouncing_ball.pipeline import provenance
from bouncing_ball.pipeline.artifacts import CARRIERS, files_of_figures
from bouncing_ball.pipeline.diff.folders import compare_folders
from bouncing_ball.pipeline.diff.outcome import Whole
from bouncing_ball.pipeline.diff.page import to_terminal
from bouncing_ball.pipeline.yaml_files import read_yaml


def jobs_left(repository: Path, files: Collection[str]) -> int:
    """Number of jobs that Snakemake would still run for these files, according to its triggers.

    Raises
    ------
    ModelError
        If the dry run fails.
    """
    command = [sys.executable, "-m", "snakemake", "--snakefile", str(repository / "Snakefile")]
    options = ["--dry-run", "--nolock", "--cores", "1"]
    done = subprocess.run([*command, *options, *files], capture_output=True, text=True)
    if done.returncode:
        raise ModelError(f"a dry run fails: {done.stderr.strip().splitlines()[-1]}")
    total = re.search(r"^total +(\d+)$", done.stdout + done.stderr, re.MULTILINE)
    return int(total[1]) if total else 0


def _copied(artifact: Whole, record: Path, results: Path) -> list[str]:
    """Copy the files of an artifact to the record, and remove those that it no longer has.

    The result has one line for each file copied or removed.
    """
    done = []
    for file in artifact.parts:
        accepted = record / file.name
        made = results / file.name
        if not made.exists():
            accepted.unlink()
            done.append(f"removed {file.name}")
        elif not accepted.is_file() or accepted.read_bytes() != made.read_bytes():
            with replacing(accepted) as temporary:
                shutil.copyfile(made, temporary)
            done.append(f"copied {file.name}")
    return done


def _require_reproducible(
    record: Path, results: Path, files: Collection[str], config: Mapping[str, Any]
) -> None:
    """Refuse results that a run of the committed code and configuration would not give.

    Raises
    ------
    ModelError
        With the reason, see :func:`accept`.
    """
    now = provenance.revision(record)
    if now == provenance.UNKNOWN:
        raise ModelError(
            "this folder is no repository of git, in which the record could be committed: accept "
            "results in a clone"
        )
    if now.dirty != "no":
        raise ModelError("some changes are not committed: commit them, run again, then accept")
    committed = read_yaml(record / provenance.CONFIGURATION)
    if changed := provenance.changes(config, committed):
        raise ModelError(
            f"the values of this run differ from {provenance.CONFIGURATION}: {changed}"
        )
    if left := jobs_left(record, files):
        jobs = "1 job" if left == 1 else f"{left} jobs"
        raise ModelError(f"Snakemake would still run {jobs}: run make all diff first")
    if foreign := sorted({*map(str, files_of_figures(results))} - {*files}):
        raise ModelError(f"{foreign[0]} is not made by this workflow: remove it")


def _require_committed(artifacts: Iterable[Whole], results: Path) -> None:
    """Refuse files that were made with uncommitted changes.

    A commit alone makes Snakemake run nothing again.
    """
    files = [results / file.name for artifact in artifacts for file in artifact.parts]
    carriers = [file for file in files if file.suffix in CARRIERS and file.exists()]
    early = [str(file) for file in carriers if provenance.read_provenance(file)["dirty"] != "no"]
    if early:
        raise ModelError(f"made with uncommitted changes, remove and run again: {' '.join(early)}")


def accept(
    record: Path,
    results: Path,
    files: Collection[str],
    config: Mapping[str, Any],
    only: Collection[str],
) -> list[str]:
    """Copy the named artifacts over the record, or else all that have moved beyond their budgets.

    Parameters
    ----------
    record, results : Path
        The checkout, and the folder that the run wrote.
    files : collection of str
        The files that a complete run makes.
    config : mapping
        The configuration of this run.
    only : collection of str
        Names of the artifacts to copy; if empty, all that have moved beyond their budgets.

    Returns
    -------
    list of str
        The files copied and removed, and what to commit.

    Raises
    ------
    ModelError
        If there are uncommitted changes, if the configuration differs from the committed one, if
        Snakemake would still run a job, if no rule makes one of the results, if there is no
        artifact with one of the names, or if one to copy was made with uncommitted changes. The
        record is then unchanged.
    """
    _require_reproducible(record, results, files, config)
    comparison = compare_folders(record, results, only)
    print(to_terminal(comparison), end="", flush=True)
    taken = [each for each in comparison.parts if only or not each.outcome.agrees]
    _require_committed(taken, results)
    done = [line for artifact in taken for line in _copied(artifact, record, results)]
    if not done:
        return ["Nothing to accept: the results agree with the record."]
    return [*done, "Commit the record with the reason: git add figures config *.md && git commit"]
