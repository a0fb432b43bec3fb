"""CSV tables stored beside modules, and files that are written completely or not at all."""

import csv
import os
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path

from bouncing_ball.errors import ModelError

PICTURES = (".pdf", ".png", ".svg")
"""Suffixes of the figures that users request."""


def rows_beside(module: str) -> list[dict[str, str]]:
    """The rows of the CSV table beside a module with the same name; ``module`` is its ``__file__``.

    Examples
    --------
    >>> from bouncing_ball.datasets import variables
    >>> rows_beside(variables.__file__)[0]["symbol"]
    'n'
    """
    text = Path(module).with_suffix(".csv").read_text(encoding="utf-8")
    return list(csv.DictReader(text.splitlines()))


def require_writable(path: Path | None, suffixes: Sequence[str] = ()) -> None:
    """Refuse a file that cannot be written, before its contents are computed; None is no file.

    Raises
    ------
    ModelError
        If the path has none of the suffixes, or the lowest folder on it that exists is not
        writable.

    Examples
    --------
    >>> require_writable(Path("page.jpg"), PICTURES)
    Traceback (most recent call last):
    ...
    bouncing_ball.errors.ModelError: 'page.jpg' does not end in .pdf or .png or .svg
    """
    if path is None:
        return
    if suffixes and path.suffix not in suffixes:
        raise ModelError(f"'{path}' does not end in {' or '.join(suffixes)}")
    folder = next(each for each in path.absolute().parents if os.path.exists(each))
    if not folder.is_dir() or not os.access(folder, os.W_OK):
        raise ModelError(f"{path} cannot be written: {folder} is no folder that can be written to")


@contextmanager
def replacing(path: str | Path) -> Iterator[Path]:
    """A temporary path in the same folder, whose file replaces ``path`` if no error occurs.

    On an error the temporary file is removed. Its suffix is that of ``path``, because writers take
    the format from the suffix.

    Raises
    ------
    OSError
        If the file cannot be replaced.
    """
    path = Path(path)
    path.parent.mkdir(parents=True, exist_ok=True)
    temporary = path.with_name(f".{path.stem}.part{path.suffix}")
    try:
        yield temporary
        os.replace(temporary, path)
    finally:
        temporary.unlink(missing_ok=True)


def write_text(path: str | Path, text: str) -> None:
    """Write UTF-8 text, with the same line endings on every system.

    Raises
    ------
    OSError
        If the file cannot be written.
    """
    with replacing(path) as temporary:
        temporary.write_text(text, encoding="utf-8", newline="\n")
