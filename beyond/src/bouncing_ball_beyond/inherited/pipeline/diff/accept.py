"""Copying results over the accepted record: ``figures/`` and the texts, which are in git.

The history of the record is ``git log figures/``.
"""

import shutil
from collections.abc import Collection
from pathlib import Path

from bouncing_ball_beyond.inherited.datasets.files import replacing
from bouncing_ball_beyond.inherited.errors import ModelError
from bouncing_ball_beyond.inherited.pipeline import provenance
from bouncing_ball_beyond.inherited.pipeline.artifact_files import CARRIERS, files_in
from bouncing_ball_beyond.inherited.pipeline.diff.compare import compare_folders
from bouncing_ball_beyond.inherited.pipeline.diff.report import to_terminal


def accept(
    house: Path, results: Path, files: Collection[str], only: Collection[str] = ()
) -> list[str]:
    """Copy the named artifacts over the record, or else all that have moved beyond their budgets.

    Parameters
    ----------
    house, results : Path
        The folder of the record, and the folder that the run wrote.
    files : collection of str
        The files that a complete run makes.
    only : collection of str
        Names of the artifacts to copy; if empty, all that have moved beyond their budgets.

    Returns
    -------
    list of str
        The files copied and removed, and what to commit.

    Raises
    ------
    ModelError
        If there is no repository, if there are uncommitted changes, if no rule makes one of the
        results, if there is no artifact with one of the names, or if one to copy was made with
        uncommitted changes or another configuration. The record is then unchanged.
    """
    now = provenance.revision(house.absolute())
    if now.dirty == "unknown":
        raise ModelError(
            "this folder is no repository of git, in which the record could be committed: accept "
            "results in a clone"
        )
    if now.dirty != "no":
        raise ModelError("some changes are not committed: commit them, run again, then accept")
    if foreign := sorted({str(results / file) for file in files_in(results)} - {*files}):
        raise ModelError(f"{foreign[0]} is not made by this workflow: remove it")
    comparison = compare_folders(house, results, only)
    print(to_terminal(comparison), end="", flush=True)
    taken = [each for each in comparison.parts if only or not each.outcome.agrees]
    names = [file.name for artifact in taken for file in artifact.parts]
    for path in (results / name for name in names):
        if path.suffix in CARRIERS and path.exists():
            origin = provenance.read_provenance(path)
            if origin["dirty"] != "no":
                raise ModelError(f"made with uncommitted changes, remove and run again: {path}")
            if origin["configuration"]:
                raise ModelError(f"{path} has another configuration: {origin['configuration']}")
    done = []
    for name in names:
        accepted = house / name
        made = results / name
        if not made.exists():
            accepted.unlink()
            done.append(f"removed {name}")
        elif not accepted.is_file() or accepted.read_bytes() != made.read_bytes():
            with replacing(accepted) as temporary:
                shutil.copyfile(made, temporary)
            done.append(f"copied {name}")
    if not done:
        return ["Nothing to accept: the results agree with the record."]
    return [*done, "Commit the record with the reason: git add figures config *.md && git commit"]
