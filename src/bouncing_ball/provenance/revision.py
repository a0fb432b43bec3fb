"""The state of the repository: its commit, and whether it has uncommitted changes."""

import os
import subprocess
from pathlib import Path
from typing import NamedTuple

RECORD = ("figures", "paper.md", "supplement.md")
"""The accepted results in git, which affect no new result."""


class Revision(NamedTuple):
    """The full hash of a commit, and whether the tree was dirty (yes or no), or unknown."""

    commit: str
    dirty: str


UNKNOWN = Revision("unknown", "unknown")


def _git(folder: Path, *arguments: str) -> str | None:
    """The output of git; None if git fails or is not installed."""
    # In a hook the variables GIT_… name a repository that may not be this one. Without optional
    # locks, parallel jobs do not wait for each other's lock of the index.
    environment = {key: value for key, value in os.environ.items() if key[:4] != "GIT_"}
    try:
        done = subprocess.run(
            ["git", "-C", str(folder), *arguments],
            env=environment | {"GIT_OPTIONAL_LOCKS": "0"},
            capture_output=True,
            encoding="utf-8",
            check=True,
        )
    except (OSError, subprocess.CalledProcessError):
        return None
    return done.stdout


def revision(folder: Path) -> Revision:
    """The commit checked out in a folder, and whether its tree is dirty.

    Untracked files count, unless git ignores them; the accepted record does not count.
    The result is :data:`UNKNOWN` without git, or if the folder is not the top of a repository.
    """
    head = _git(folder, "rev-parse", "--show-cdup", "HEAD")
    excluded = [f":(exclude){name}" for name in RECORD]
    status = _git(folder, "status", "--porcelain", "--untracked-files=normal", "--", ".", *excluded)
    # The first line is the path of the folder below the top of the repository: empty at the top.
    if head is None or status is None or not head.startswith("\n"):
        return UNKNOWN
    return Revision(head.strip(), "yes" if status else "no")


def checkout(*starts: Path) -> Path | None:
    """The first folder, at or above each start in turn, that holds this workflow, or None."""
    for start in starts:
        for folder in (start, *start.parents):
            if (folder / "Snakefile").is_file() and (folder / "src" / "bouncing_ball").is_dir():
                return folder
    return None
