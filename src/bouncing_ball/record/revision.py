"""The state of the repository: which commit, and whether anything was changed.

Asked of git, when a file is written or accepted. Without git, or in a folder
that is not the top of its own repository, the answer is "unknown".
"""

import os
import subprocess
from datetime import UTC, datetime
from pathlib import Path
from typing import NamedTuple

from bouncing_ball.errors import ModelError

RECORD = ("figures", "paper.md", "accepted.csv")
"""What git holds of the results; a change there changes no result."""


class Revision(NamedTuple):
    """A commit (full hash) and whether the tree was dirty (yes or no), or unknown."""

    commit: str
    dirty: str


UNKNOWN = Revision("unknown", "unknown")


def parse_status(text: str) -> Revision:
    """The revision from ``git status --porcelain=v2 --branch``.

    Examples
    --------
    >>> parse_status("# branch.oid 1f0e\\n# branch.head main\\n")
    Revision(commit='1f0e', dirty='no')
    >>> parse_status("# branch.oid 1f0e\\n? src/new.py\\n").dirty
    'yes'
    >>> parse_status("# branch.oid (initial)\\n? Snakefile\\n")
    Revision(commit='unknown', dirty='unknown')
    """
    changed = False
    commit = ""
    for line in text.splitlines():
        if line.startswith("# branch.oid "):
            commit = line.split()[-1]
        changed = changed or not line.startswith("#")
    if not commit or commit == "(initial)":
        return UNKNOWN
    return Revision(commit, "yes" if changed else "no")


def _git(folder: Path, *arguments: str) -> str | None:
    """What git says, or None if it fails or is not there."""
    # Called by a hook, git would pass on which repository it is at work in; and
    # jobs that run side by side need not wait for each other's index.
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

    Untracked files count, unless git ignores them; the record does not.
    """
    if (_git(folder, "rev-parse", "--show-cdup") or "inside").strip():
        return UNKNOWN
    status = _git(
        folder,
        *("status", "--porcelain=v2", "--branch", "--untracked-files=normal", "--", "."),
        *(f":(exclude){name}" for name in RECORD),
    )
    return UNKNOWN if status is None else parse_status(status)


def commit_date(folder: Path) -> str:
    """The day of the commit checked out in a folder, in UTC.

    Raises
    ------
    ModelError
        If git knows none.
    """
    seconds = _git(folder, "show", "--no-patch", "--format=%ct", "HEAD")
    if not seconds:
        raise ModelError(f"no commit in {folder} to take the date from")
    return datetime.fromtimestamp(int(seconds), UTC).date().isoformat()


def checkout(*starts: Path) -> Path | None:
    """The first folder, at or above the starts in turn, that holds this workflow."""
    for start in starts:
        for folder in (start, *start.parents):
            if (folder / "Snakefile").is_file() and (folder / "src" / "bouncing_ball").is_dir():
                return folder
    return None
