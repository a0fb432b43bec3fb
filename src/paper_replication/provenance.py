"""How a result was made: its files of code with their contents, and the versions of libraries.

Nothing here decides a number of a result.
"""

import hashlib
import platform
from collections.abc import Iterable
from functools import cache
from importlib import metadata
from pathlib import Path

import numpy as np

PACKAGES = ("numpy", "scipy", "xarray", "netCDF4", "matplotlib")
"""The libraries on which numbers and pictures depend."""


def content(file: str | Path) -> str:
    """Identify a file by its content: the hash that git gives to it.

    `git show HASH` prints the content if it was committed. Line ends of texts do not count.
    """
    text = Path(file).read_bytes()
    if Path(file).suffix not in (".png", ".nc"):
        text = text.replace(b"\r\n", b"\n")
    return hashlib.sha1(b"blob %d\0" % len(text) + text, usedforsecurity=False).hexdigest()


def contents(files: Iterable[str | Path], top: Path) -> dict[str, str]:
    """The contents of files, by their paths from a folder."""
    paths = [Path(file).resolve() for file in files]
    return {path.relative_to(top.resolve()).as_posix(): content(path) for path in paths}


@cache
def versions() -> dict[str, str]:
    """Return the versions of Python and of PACKAGES."""
    return {"python": platform.python_version()} | {
        name: metadata.version(name) for name in PACKAGES
    }


@cache
def computed_on() -> str:
    """Describe the platform and the library of linear algebra, which decide last digits.

    The text is for the reader of a dataset, and is not compared.
    """
    blas = np.show_config(mode="dicts")["Build Dependencies"]["blas"]
    return f"{platform.platform()}, {blas['name']} {blas['version']}"
