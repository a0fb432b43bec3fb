"""One file of an artifact against its counterpart in the record, each kind by its own measure.

Data by their budgets, texts, tables and the words of SVG files line by line, PNG files by
their pixels. Every file is judged alone: whatever is wrong with one, it could not be
compared, with the reason, and the others are compared all the same.

A folder of artifacts may come from anywhere. Nothing in it is run, no link in it is
followed, and what is printed of it passes through :func:`bouncing_ball.errors.printable`.
"""

import re
import warnings
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from bouncing_ball.compare.data import compare_datasets
from bouncing_ball.compare.outcome import Outcome, Row, worst
from bouncing_ball.compare.pictures import compare_pictures, read_picture
from bouncing_ball.compare.texts import compare_texts, words_of
from bouncing_ball.datasets.netcdf import read_dataset
from bouncing_ball.errors import ModelError, printable

MAX_BYTES = 16 * 2**20
"""Size of a file; the largest artifact of the record has half a megabyte."""
_DRAWN = (".png", ".svg")


@dataclass(frozen=True)
class Part:
    """The result for one file of an artifact.

    Parameters
    ----------
    file : str
        Relative to either folder.
    rows : tuple of Row
        What was compared, worst first; none where the bytes are the same.
    redrawn : str
        How the versions of matplotlib differ; a difference is only reported then.
    pictures : tuple
        The record's and the new picture as PNG files.
    """

    file: str
    rows: tuple[Row, ...] = ()
    redrawn: str = ""
    pictures: tuple[bytes | None, bytes | None] = (None, None)

    @property
    def outcome(self) -> Outcome:
        """The worst outcome of its rows."""
        return worst(row.outcome for row in self.rows)

    @property
    def moved(self) -> list[Row]:
        """The rows that are not identical."""
        return [row for row in self.rows if row.outcome is not Outcome.IDENTICAL]

    @property
    def share(self) -> float | None:
        """The largest share of a budget."""
        return max((row.share for row in self.rows if row.share is not None), default=None)

    @property
    def note(self) -> str:
        """Where it differs most, in a few words."""
        if not self.moved:
            return self.redrawn
        first, *rest = self.moved
        where = " at ".join(filter(None, [first.where, first.at]))
        more = f"{where} and {len(rest)} more" if rest else where
        return ": ".join(filter(None, [more, first.note, self.redrawn]))


def redrawn(record: bytes, new: bytes) -> str:
    """How two pictures name different versions of matplotlib; empty if they do not.

    Examples
    --------
    >>> redrawn(b'{"matplotlib": "3.10.8"}', b'{"matplotlib": "3.11.0"}')
    'drawn by matplotlib 3.10.8 → 3.11.0'
    """
    found = [re.findall(rb"matplotlib\W+([0-9.]+)", content) for content in (record, new)]
    if not all(found) or found[0][0] == found[1][0]:
        return ""
    return f"drawn by matplotlib {found[0][0].decode()} → {found[1][0].decode()}"


def _content(path: Path) -> bytes | None:
    """The bytes of a regular file of a bounded size; None if there is none."""
    if path.is_symlink():
        raise ModelError("a link; links are not followed")
    if not path.exists():
        return None
    if not path.is_file():
        raise ModelError("not a regular file")
    if path.stat().st_size > MAX_BYTES:
        raise ModelError(f"larger than {MAX_BYTES} bytes")
    return path.read_bytes()


def _judge(file: str, folders: tuple[Path, Path], data: Outcome | None) -> Part:
    old, now = (folder / file for folder in folders)
    record, new = _content(old), _content(now)
    rows: list[Row] = []
    if record is None or new is None:
        rows = [Row("", Outcome.EXTRA if record is None else Outcome.MISSING)]
    elif record == new:
        pass
    elif old.suffix == ".nc":
        rows = compare_datasets(old.stem, read_dataset(old), read_dataset(now))
    elif old.suffix == ".png":
        rows = compare_pictures(read_picture(old), read_picture(now))
    else:
        rows = compare_texts(words_of(old), words_of(now), data)
    rows.sort(key=lambda row: (-row.outcome.rank, -(row.share or 0.0)))
    drawn = redrawn(record, new) if record and new and old.suffix in _DRAWN else ""
    return Part(file, tuple(rows), drawn, (record, new) if old.suffix == ".png" else (None, None))


def judge(file: str, folders: tuple[Path, Path], data: Outcome | None) -> Part:
    """A file of the record's or the new folder, or of both; never an error.

    Parameters
    ----------
    file : str
        Relative to either folder.
    folders : tuple
    data : Outcome, optional
        The worst of the datasets that a text is made from.
    """
    # Warnings of the libraries about a damaged file become one line.
    with warnings.catch_warnings(), np.errstate(all="ignore"):
        warnings.simplefilter("ignore")
        try:
            return _judge(file, folders, data)
        # What the libraries raise on a damaged file has no end.
        except Exception as error:
            why = " ".join(str(error).split()) or type(error).__name__
            row = Row("", Outcome.UNREADABLE, note=printable(why, 120))
            return Part(file, (row,))
