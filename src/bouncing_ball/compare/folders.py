"""Two folders of artifacts, and the result for each artifact.

A folder holds ``figures/`` with datasets, pictures and tables, and
``paper.md``; nothing else in it is looked at. Files of one name and different
suffixes are one artifact. Every file is judged alone: whatever is wrong with
one, it could not be compared, with the reason, and the others are compared all the same.
"""

import json
import warnings
from collections.abc import Callable, Collection
from dataclasses import dataclass, replace
from io import BytesIO
from pathlib import Path, PurePosixPath
from typing import Any

import numpy as np

from bouncing_ball.compare.data import VariableResult, compare_datasets, read_data
from bouncing_ball.compare.files import read_file
from bouncing_ball.compare.outcome import Outcome, worst
from bouncing_ball.compare.pictures import compare_pictures, read_picture
from bouncing_ball.compare.texts import Line, compare_texts, text_of_page, words_of_drawing
from bouncing_ball.errors import ModelError, printable
from bouncing_ball.provenance.origin import PREFIX, attributes_in

_FIGURES, _PAPER = "figures", "paper.md"
# In the order in which they are compared: the data first, as the others lean on them.
_SUFFIXES = (".nc", ".csv", ".png", ".svg", ".md", ".tex", ".html")
_MAX_FILES = 1000


class ComparisonError(ModelError):
    """Two folders that cannot be compared at all, in one line."""


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


@dataclass(frozen=True)
class Artifact:
    """A figure, a table or the paper: its files."""

    name: str
    parts: tuple[Part, ...]

    @property
    def outcome(self) -> Outcome:
        """The worst outcome of what decides; what is only reported costs identity."""
        decided = worst(part.outcome for part in self.parts if part.decides)
        same = all(part.outcome is Outcome.IDENTICAL for part in self.parts)
        return decided if same else worst([decided, Outcome.WITHIN])

    @property
    def share(self) -> float | None:
        """The largest share of a budget that decides, None without any."""
        shares = [part.share for part in self.parts if part.decides and part.share is not None]
        return max(shares, default=None)


@dataclass(frozen=True)
class Comparison:
    """All artifacts of two folders, worst first."""

    artifacts: tuple[Artifact, ...]

    @property
    def outcome(self) -> Outcome:
        """The worst outcome."""
        return worst(artifact.outcome for artifact in self.artifacts)


def redrawn(record: bytes, new: bytes, suffix: str) -> str:
    """How two pictures name different versions of matplotlib; empty if they do not."""
    found = []
    for content in (record, new):
        try:
            said = attributes_in(BytesIO(content), suffix)[f"{PREFIX}versions"]
            found.append(json.loads(said)["matplotlib"])
        # A picture without provenance is judged as any other.
        except Exception:
            return ""
    return f"drawn by matplotlib {found[0]} → {found[1]}" if found[0] != found[1] else ""


def _summary(file: str, lines: tuple[Line, ...]) -> Part:
    outcome = worst(line.outcome for line in lines)
    count = sum(line.outcome is outcome for line in lines)
    what = "changed" if outcome is Outcome.DRIFTED else "moved with their data"
    note = f"{count} line{'s' * (count != 1)} {what}" if lines else ""
    return Part(file, outcome, note, lines=lines)


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
    if other := redrawn(record, new, suffix):
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


def artifacts_in(folder: Path) -> dict[str, set[str]]:
    """Names of the artifacts and their files, relative to the folder.

    Raises
    ------
    ComparisonError
        If there is no such folder, or no artifact in it, or more than a thousand files.
    """
    if not folder.is_dir():
        raise ComparisonError(f"no folder {printable(folder)}")
    figures = folder / _FIGURES
    if figures.is_symlink():
        raise ComparisonError(f"{printable(figures)}: a link; links are not followed")
    try:
        names = sorted(path.name for path in figures.iterdir()) if figures.is_dir() else []
    except OSError as error:
        raise ComparisonError(f"{printable(figures)}: {error.strerror}") from None
    if len(names) > _MAX_FILES:
        raise ComparisonError(f"{printable(figures)} holds more than {_MAX_FILES} files")
    files = [f"{_FIGURES}/{name}" for name in names]
    files += [_PAPER] * ((folder / _PAPER).is_symlink() or (folder / _PAPER).exists())
    found: dict[str, set[str]] = {}
    for file in files:
        path = PurePosixPath(file)
        # Files that begin with a point are halfway written.
        if path.suffix in _SUFFIXES and not path.name.startswith("."):
            found.setdefault(path.stem, set()).add(file)
    if not found:
        raise ComparisonError(
            f"nothing to compare in {printable(folder)}: neither {_FIGURES}/ nor {_PAPER}"
        )
    return found


def compare_folders(record: Path, new: Path, only: Collection[str] = ()) -> Comparison:
    """All artifacts of two folders, or only those named, worst first.

    Raises
    ------
    ComparisonError
        If one of the folders is not there or holds no artifact, or neither has
        one of those named.
    """
    before, after = artifacts_in(record), artifacts_in(new)
    names = sorted(before.keys() | after.keys())
    if unknown := [name for name in only if name not in names]:
        known = printable(", ".join(names))
        raise ComparisonError(f"unknown artifact {printable(unknown[0])}; known: {known}")

    def artifact(name: str, data: Outcome | None = None) -> Artifact:
        files = before.get(name, set()) | after.get(name, set())
        parts = []
        for file in sorted(files, key=lambda file: _SUFFIXES.index(PurePosixPath(file).suffix)):
            there = (
                record if file in before.get(name, ()) else None,
                new if file in after.get(name, ()) else None,
            )
            parts.append(judge(file, name, there, data))
            if file.endswith(".nc"):
                data = parts[-1].outcome
        return Artifact(name, tuple(parts))

    paper = PurePosixPath(_PAPER).stem
    chosen = set(only or names)
    # The text is made from all datasets: for its sake they are all judged.
    found = [artifact(name) for name in names if name != paper and {name, paper} & chosen]
    if paper in chosen:
        parts = [part for each in found for part in each.parts]
        data = worst(part.outcome for part in parts if part.file.endswith(".nc"))
        found.append(artifact(paper, data))
    found = [each for each in found if each.name in chosen]
    found.sort(key=lambda each: (-each.outcome.rank, -(each.share or 0.0), each.name))
    return Comparison(tuple(found))
