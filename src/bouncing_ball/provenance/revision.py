"""The state of the repository: which commit, and whether anything was changed."""

import os
import subprocess
from pathlib import Path
from typing import NamedTuple

RECORD = ("figures", "paper.md")
"""What git holds of the results; a change there changes no result."""


class Revision(NamedTuple):
    """A commit (full hash) and whether the tree was dirty (yes or no), or unknown."""

    commit: str
    dirty: str


UNKNOWN = Revision("unknown", "unknown")


def _git(folder: Path, *arguments: str) -> str | None:
    """The output of git, or None if it fails or is not there."""
    # A hook tells git by GIT_… which repository it works in, and that need not be this one.
    # Jobs that run side by side need not wait for each other's lock of the index.
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

    Untracked files count, unless git ignores them; the accepted record does not.
    Unknown without git, or in a folder that is not the top of its own repository.
    """
    head = _git(folder, "rev-parse", "--show-cdup", "HEAD")
    excluded = [f":(exclude){name}" for name in RECORD]
    status = _git(folder, "status", "--porcelain", "--untracked-files=normal", "--", ".", *excluded)
    # The way up to the top comes first, and there it is empty.
    if head is None or status is None or not head.startswith("\n"):
        return UNKNOWN
    return Revision(head.strip(), "yes" if status else "no")


def checkout(*starts: Path) -> Path | None:
    """The first folder, at or above the starts in turn, that holds this workflow."""
    for start in starts:
        for folder in (start, *start.parents):
            if (folder / "Snakefile").is_file() and (folder / "src" / "bouncing_ball").is_dir():
                return folder
    return None
