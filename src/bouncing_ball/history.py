"""What git knows of this checkout: the one place where it is asked, by the code and by the tests.

The answers are about one folder, whatever the caller's environment says: in a hook, git itself sets
variables that name another repository or another index. What the user's configuration would change
in an answer is overridden, and what protects the user, such as `safe.directory`, is kept. A folder
that is not the top of its repository, for example an archive that was unpacked inside another one,
has no history.
"""

import hashlib
import os
import re
import subprocess
from collections.abc import Collection, Iterable
from functools import cached_property
from pathlib import Path, PurePath

CHECKOUT = Path(__file__).resolve().parents[2]
"""The checkout that this file is in."""

HASH = re.compile("[0-9a-f]{40}")
"""A commit. Nothing else that a file records becomes an argument of git."""

KEPT = ("GIT_CONFIG", "GIT_EXEC_PATH", "GIT_CEILING", "GIT_TEST_")
"""Beginnings of variables that do not say where a repository is."""

SETTINGS = ("core.quotePath=off", "core.fsmonitor=false", "diff.relative=false")


def git(folder: Path, *arguments: str) -> subprocess.CompletedProcess[str] | None:
    """What git answers about a folder; none if there is no git."""
    environment = {
        name: value
        for name, value in os.environ.items()
        if not name.startswith("GIT_") or name.startswith(KEPT)
    }
    environment |= {"LC_ALL": "C", "GIT_OPTIONAL_LOCKS": "0", "GIT_LITERAL_PATHSPECS": "1"}
    options = [option for setting in SETTINGS for option in ("-c", setting)]
    command = ["git", "-C", str(folder), *options, *arguments]
    try:
        return subprocess.run(
            command, capture_output=True, check=False, encoding="utf-8", env=environment
        )
    except OSError:
        return None


class History:
    """The history of a checkout. Without git, `head` is empty and nothing is known.

    Files are named by their path from the top of the checkout.
    """

    def __init__(self, top: str | Path = CHECKOUT):
        self.top = Path(top).resolve()
        answer = git(self.top, "rev-parse", "--show-toplevel", "--is-shallow-repository", "HEAD")
        self.refused = answer is not None and "dubious ownership" in answer.stderr
        known = answer.stdout.splitlines() if answer and answer.returncode == 0 else []
        lines = known or ["", "", ""]
        self.shallow = lines[1] == "true"
        self.head = lines[2] if lines[0] == str(self.top) else ""

    def ask(self, *arguments: str) -> list[str] | None:
        """The lines that git answers; none if it refuses, or there is no history."""
        answer = git(self.top, *arguments) if self.head else None
        return answer.stdout.splitlines() if answer and answer.returncode == 0 else None

    def names(self, files: Iterable[str | Path]) -> list[str]:
        """Those of some files that are inside the checkout."""
        return [name for name in contained(files, self.top) if not os.path.isabs(name)]

    @cached_property
    def edited(self) -> set[str]:
        """Files that are not as in the last commit, or not in git."""
        lines = self.ask("status", "--porcelain", "--untracked-files=all", "--no-renames")
        return {line[3:].strip('"') for line in lines or ()}

    def uncommitted(self, files: Iterable[str | Path]) -> set[str]:
        """Those of some files, or of the files in some folders, that are `edited`."""
        names = self.names(files)
        return {
            each for each in self.edited if any(PurePath(each).is_relative_to(one) for one in names)
        }

    def since(self, commit: str, files: Iterable[str | Path]) -> list[str] | None:
        """Files that the last commit has otherwise than another one; none if that is unknown."""
        if not HASH.fullmatch(commit):
            return None
        changes = ["diff", "--name-only", "--no-renames", commit, "HEAD", "--"]
        changes += self.names(files)
        return self.ask(*changes)

    def newest(self, commits: Iterable[str], files: Collection[str | Path]) -> str:
        """The newest of those commits that git knows, else that which last changed some files."""
        whole = {commit for commit in commits if HASH.fullmatch(commit)}
        known = [each for each in whole if self.ask("cat-file", "-e", each) is not None]
        names = self.names(files)
        # In a shallow clone every file seems to be as old as the clone.
        if not known and (self.shallow or not names):
            return ""
        found = self.ask("rev-list", "-1", *(known or ["HEAD", "--", *names]))
        return found[0] if found else ""

    @cached_property
    def branch(self) -> set[str]:
        """Files that this branch changed against the main one."""
        main = "origin/main" if self.ask("rev-parse", "--verify", "origin/main") else "main"
        fork = self.ask("merge-base", "HEAD", main)
        return set(self.since(fork[0], [self.top]) or ()) if fork else set()

    def told(self, names: Collection[str]) -> list[str]:
        """Files with when they changed, the latest first."""
        paths = [self.top / name for name in names]
        edited = self.uncommitted(paths)
        times = {}
        for name in contained(paths, self.top):
            dated = ["rev-list", "-1", "--timestamp", "--abbrev-commit", "HEAD", "--", name]
            found = None if self.shallow or name in edited else self.ask(*dated)
            time, commit = found[0].split() if found else ("0", "")
            words = ["not committed"] if name in edited else []
            words += ["on this branch"] if name in self.branch and name not in edited else []
            words += [commit] if commit else []
            line = f"{name} ({', '.join(words)})" if words else name
            times[line] = float("inf") if name in edited else int(time)
        return sorted(times, key=lambda line: (-times[line], line))


def contained(files: Iterable[str | Path], top: Path = CHECKOUT) -> list[str]:
    """The names of files from the top of a checkout; the whole path of a file outside it."""
    paths = [Path(file).resolve() for file in files]
    return [
        path.relative_to(top).as_posix() if path.is_relative_to(top) else str(path)
        for path in paths
    ]


def contents(files: Iterable[str | Path]) -> dict[str, str]:
    """Text files by their names in the checkout, each with the id that git gives to its content.

    `git show ID` prints the content, if it was committed. Line ends do not count.
    """
    paths = list(files)
    ids = {}
    for name, path in zip(contained(paths), paths, strict=True):
        text = Path(path).read_bytes().replace(b"\r\n", b"\n")
        blob = b"blob %d\0" % len(text) + text
        ids[name] = hashlib.sha1(blob, usedforsecurity=False).hexdigest()
    return ids


def commit(files: Iterable[str | Path], top: str | Path = CHECKOUT) -> str:
    """The commit of a checkout, with "+dirty" if one of the files is not as in that commit.

    In an archive that git made, the commit that the archive names; "unknown" without either.
    """
    archival = Path(top) / ".git_archival.txt"
    if archival.is_file():
        named = re.search(f"node: ({HASH.pattern})", archival.read_text(encoding="utf-8"))
        if named:
            return f"{named[1]} (archive)"
    history = History(top)
    if not history.head:
        return "unknown (git: dubious ownership)" if history.refused else "unknown"
    return history.head + ("+dirty" if history.uncommitted(files) else "")
