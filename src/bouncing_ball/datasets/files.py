"""CSV tables stored beside modules, and files that are written completely or not at all."""

import csv
import os
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path


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
