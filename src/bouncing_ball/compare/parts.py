"""One file of an artifact against its counterpart in the record, each kind by its own measure.

Data by their budgets, texts and tables line by line, PNG files by their pixels, SVG files by
their words. Every file is judged alone: whatever is wrong with one, it could not be
compared, with the reason, and the others are compared all the same.
"""

import re
import warnings
from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path, PurePosixPath
from typing import Any

import numpy as np

from bouncing_ball.compare.data import VariableResult, compare_datasets, read_data
from bouncing_ball.compare.files import read_file
from bouncing_ball.compare.outcome import Outcome, worst
from bouncing_ball.compare.pictures import compare_pictures, read_picture
from bouncing_ball.compare.texts import Line, compare_texts, text_of_page, words_of_drawing
from bouncing_ball.errors import printable


@dataclass(frozen=True)
class Part:
    """The result for one file of an artifact.

    Parameters
    ----------
    file : str
        Relative to either folder.
    outcome : Outcome
    note : str
        What is different, in a few words.
    share : float, optional
        Largest share of a budget.
    decides : bool
        False where a difference is only reported.
    variables : tuple of VariableResult
        Of a dataset, worst first.
    lines : tuple of Line
        Of a text or a vector graphic: all that are not the same.
    pictures : tuple
        The record's and the new picture and their difference as PNG files.
    """

    file: str
    outcome: Outcome
    note: str = ""
    share: float | None = None
    decides: bool = True
    variables: tuple[VariableResult, ...] = ()
    lines: tuple[Line, ...] = ()
    pictures: tuple[bytes | None, bytes | None, bytes | None] = (None, None, None)


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


_READERS: dict[str, Callable[[bytes], Any]] = {
    ".nc": read_data,
    ".png": read_picture,
    ".svg": words_of_drawing,
    ".html": text_of_page,
}


def _of_data(file: str, artifact: str, record: Any, new: Any) -> Part:
    found = tuple(compare_datasets(artifact, record, new))
    outcome = worst(each.outcome for each in found)
    note = ""
    if outcome is not Outcome.IDENTICAL:
        place = f" at {found[0].largest[0].place}" if found[0].largest else ""
        note = ": ".join(filter(None, [found[0].name + place, found[0].note]))
    share = max((each.share for each in found if each.share is not None), default=None)
    return Part(file, outcome, note, share, variables=found)


def _of_text(file: str, record: str, new: str, data: Outcome | None) -> Part:
    lines = compare_texts(record, new, data)
    outcome = worst(line.outcome for line in lines)
    count = sum(line.outcome is outcome for line in lines)
    what = "changed" if outcome is Outcome.DRIFTED else "moved with their data"
    return Part(file, outcome, f"{count} lines {what}" if lines else "", lines=lines)


def _compared(file: str, artifact: str, record: bytes, new: bytes, data: Outcome | None) -> Part:
    suffix = PurePosixPath(file).suffix
    before, after = (_READERS.get(suffix, bytes.decode)(content) for content in (record, new))
    if suffix == ".nc":
        return _of_data(file, artifact, before, after)
    if suffix == ".png":
        seen = compare_pictures(before, after)
        pictures = (record, new, seen.difference)
        part = Part(file, seen.outcome, seen.note, seen.share, pictures=pictures)
    else:
        part = _of_text(file, before, after, data)
    if other := redrawn(record, new):
        return replace(part, decides=False, note=f"{part.note}; {other}".strip("; "))
    return part


def judge(
    file: str, artifact: str, folders: tuple[Path | None, Path | None], data: Outcome | None
) -> Part:
    """A file of one folder or of both; never an error.

    Parameters
    ----------
    file : str
    artifact : str
        Whose file it is.
    folders : tuple
        That of the record and the new one; None where the file is not there.
    data : Outcome, optional
        The worst of the datasets that a text is made from.
    """
    # Warnings of the libraries about a damaged file become one line.
    with warnings.catch_warnings(), np.errstate(all="ignore"):
        warnings.simplefilter("ignore")
        try:
            record, new = (read_file(folder, file) if folder else None for folder in folders)
            if record is not None and new is not None and record != new:
                return _compared(file, artifact, record, new, data)
        # What the libraries raise on a damaged file has no end.
        except Exception as error:
            why = " ".join(str(error).split()) or type(error).__name__
            return Part(file, Outcome.UNREADABLE, printable(why, 120))
    outcome = Outcome.EXTRA if record is None else Outcome.MISSING
    outcome = Outcome.IDENTICAL if record == new else outcome
    shown = (record, new, None) if file.endswith(".png") else (None, None, None)
    return Part(file, outcome, pictures=shown)
