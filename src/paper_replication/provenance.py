"""How a result was made: the contents of the files that a job reads, and versions of libraries.

Nothing here decides a number of a result.
"""

import hashlib
import os
import platform
import subprocess
import sys
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from functools import partial
from importlib import metadata
from importlib.machinery import SOURCE_SUFFIXES, FileFinder, SourceFileLoader
from pathlib import Path
from types import CodeType
from typing import Any

PACKAGES = ("numpy", "scipy", "xarray", "netCDF4", "matplotlib")
"""The libraries on which numbers and pictures depend."""


def sources(inputs: Any) -> dict[str, dict[str, str]]:
    """What a job reads if it starts now: the contents of its files of `code` and of its `data`, by
    their paths, and `versions`. Its `inputs` have `code`, and may have `data`, a file or several.
    """
    data = getattr(inputs, "data", [])
    return {
        "code": contents_in(Path(), inputs.code),
        "data": contents_in(Path(), [data] if isinstance(data, str) else data),
        "versions": versions(),
    }


class FromSource(SourceFileLoader):
    """Compiles a module from its source, and neither reads nor writes byte code."""

    def get_code(self, fullname: str) -> CodeType:
        path = self.get_filename(fullname)
        return self.source_to_code(self.get_data(path), path)


@contextmanager
def from_source(*folders: Path) -> Iterator[None]:
    """Compile modules below these folders that are imported in this context from their sources.

    Python runs its byte code as long as the source has the same size and time. A copy that keeps
    times, or a second edit within a second, leaves both.
    """
    finder = FileFinder.path_hook((FromSource, SOURCE_SUFFIXES))

    def hook(folder: str) -> Any:
        if not any(Path(folder).resolve().is_relative_to(allowed.resolve()) for allowed in folders):
            raise ImportError(f"{folder} is not one of them")
        return finder(folder)

    sys.path_hooks.insert(0, hook)
    sys.path_importer_cache.clear()
    try:
        yield
    finally:
        sys.path_hooks.remove(hook)
        sys.path_importer_cache.clear()


@contextmanager
def reading(inputs: Any) -> Iterator[dict[str, dict[str, str]]]:
    """Yield what a job with these inputs reads; end the job if it has changed at the end.

    A script imports within this context what decides its results, because Python reads a module
    once, when it is imported. It is compiled from its source then. The job fails, and Snakemake
    removes its files.
    """
    before = sources(inputs)
    try:
        with from_source(*{Path(file).parent for file in inputs.code}):
            yield before
    finally:
        now = sources(inputs)
        changed = {key for kind in now for key, _ in before[kind].items() - now[kind].items()}
        if changed:
            sys.exit(f"run again: {', '.join(sorted(changed))} changed while this job ran")


def content(file: str | Path) -> str:
    """Identify a file by its content: the hash that git gives to it.

    `git show HASH` prints the content if it was committed. Line ends of texts do not count.
    """
    text = Path(file).read_bytes()
    if Path(file).suffix not in (".png", ".nc"):
        text = text.replace(b"\r\n", b"\n")
    return blob(text)


def blob(text: bytes) -> str:
    """The hash that git gives to a content."""
    return hashlib.sha1(b"blob %d\0" % len(text) + text, usedforsecurity=False).hexdigest()


def contents_in(top: Path, files: Iterable[str]) -> dict[str, str]:
    """The contents of those files that exist in a folder, by their paths from there."""
    return {file: content(top / file) for file in files if (top / file).is_file()}


def relative(top: Path, file: str | Path) -> str:
    """The path of a file from a folder."""
    return Path(file).resolve().relative_to(top.resolve()).as_posix()


def versions() -> dict[str, str]:
    """Return the versions of Python and of PACKAGES."""
    return {"python": platform.python_version()} | {
        name: metadata.version(name) for name in PACKAGES
    }


def git(checkout: Path, *arguments: str) -> str:
    """What git answers about a repository; empty without git.

    A hook has variables that name the repository and the index of its commit. They are dropped, as
    git advises for another repository.
    """
    run = partial(subprocess.run, capture_output=True, check=True, text=True)
    try:
        names = run(["git", "rev-parse", "--local-env-vars"]).stdout.split()
        environment = {name: value for name, value in os.environ.items() if name not in names}
        command = ["git", "-C", str(checkout), "-c", "core.quotePath=off", *arguments]
        return run(command, env=environment).stdout.strip()
    except (OSError, subprocess.CalledProcessError):
        return ""


def tree(checkout: Path, commit: str, *paths: str) -> dict[str, str]:
    """The hashes of the files of a commit; empty if git does not know it."""
    lines = git(checkout, "ls-tree", "-r", commit, *paths).splitlines()
    return {line.partition("\t")[2]: line.split()[2] for line in lines}


def uncommitted(checkout: Path, *paths: str) -> list[str]:
    """What git does not have of these files and folders as they are now.

    Files of which git was told to look away (`skip-worktree`) are read all the same. Git that does
    not answer is no proof.
    """
    asked = ("status", "--porcelain", "--branch", "--untracked-files=all", "--", *paths)
    status = git(checkout, *asked).splitlines()
    committed = tree(checkout, "HEAD", "--", *paths)
    present = [file for file in committed if (checkout / file).is_file()]
    hashes = git(checkout, "hash-object", "--", *present).split()
    if not status or len(hashes) != len(present):
        return ["`git status` does not answer"]
    now = dict(zip(present, hashes, strict=True))
    # The first line is the branch.
    listed = [line.strip() for line in status[1:]]
    return listed or [file for file, made in committed.items() if now.get(file) != made]


def main_branch(checkout: Path) -> dict[str, str]:
    """The hashes of the files on the main branch; empty if it is not known here."""
    trees = (tree(checkout, name) for name in ("origin/HEAD", "origin/main", "main"))
    return next(filter(None, trees), {})
