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

CHECKOUT = Path(__file__).resolve().parents[2]
"""The folder of this repository."""

PACKAGES = ("numpy", "scipy", "xarray", "netCDF4", "matplotlib")
"""The libraries on which numbers and pictures depend."""


def contents(files: Iterable[str | Path]) -> dict[str, str]:
    """Identify text files by content: the hash that git gives to each, by the path in CHECKOUT.

    `git show HASH` prints the content if it was committed. Line ends do not count.
    """
    found = {}
    for file in files:
        path = Path(file).resolve()
        text = path.read_bytes().replace(b"\r\n", b"\n")
        blob = b"blob %d\0" % len(text) + text
        name = path.relative_to(CHECKOUT).as_posix()
        found[name] = hashlib.sha1(blob, usedforsecurity=False).hexdigest()
    return found


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
