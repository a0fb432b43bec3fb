"""The comparison of two folders of artifacts, with the result and the cause for each artifact.

Data are judged by their budgets, pictures by their pixels and by all that they draw, texts and
tables line by line. A picture may move only if its data did. Every file is judged alone: if a file
is damaged, its outcome is that it could not be compared, and the others are compared nevertheless.
"""

import warnings
from collections import defaultdict
from collections.abc import Collection, Mapping
from dataclasses import replace
from pathlib import Path, PurePosixPath
from types import MappingProxyType
from typing import Any

import numpy as np

from bouncing_ball_beyond.inherited.datasets.files import read_dataset, require_readable
from bouncing_ball_beyond.inherited.errors import ModelError
from bouncing_ball_beyond.inherited.pipeline.artifact_files import (
    CARRIERS,
    DATASET,
    FIGURES,
    PICTURES,
    by_artifact,
    files_in,
)
from bouncing_ball_beyond.inherited.pipeline.diff.causes import causes, suspects, touched_files
from bouncing_ball_beyond.inherited.pipeline.diff.datasets import compare_datasets
from bouncing_ball_beyond.inherited.pipeline.diff.outcome import Outcome, Row, Whole
from bouncing_ball_beyond.inherited.pipeline.diff.pictures import compare_drawings, compare_pixels
from bouncing_ball_beyond.inherited.pipeline.diff.texts import compare_texts, words_of
from bouncing_ball_beyond.inherited.pipeline.provenance import provenance_in
from bouncing_ball_beyond.inherited.pipeline.sources import parts_of_note

# Without a cause, by the first file that differs.
_KINDS = {DATASET: "numbers moved", **dict.fromkeys(PICTURES, "the picture changed")}


class _Comparison:
    """Two folders, and files that a run did not make, each with its reason.

    An older version of such a file may still be in the new folder.
    """

    def __init__(self, record: Path, new: Path, not_made: Mapping[str, str]) -> None:
        self.folders = (record, new)
        self.not_made = not_made
        self.touched = touched_files()
        files = {file for file in not_made if PurePosixPath(file).parts[0] in (FIGURES, file)}
        for folder in self.folders:
            found = files_in(folder)
            # The record of a new house is empty.
            is_empty = not found and (folder == new or not folder.is_dir())
            if is_empty and not not_made:
                raise ModelError(f"nothing to compare in {folder}: neither figures/ nor a text")
            files |= found
        self.artifacts = by_artifact(files)
        # The provenance of both versions of a file, and the datasets of the artifacts.
        self.made: dict[str, list[dict[str, Any]]] = defaultdict(lambda: [{}, {}])
        self.data: dict[str, Whole] = {}

    def dataset(self, name: str) -> Whole:
        """The comparison of the dataset of an artifact, without a name if it has none."""
        if name not in self.data:
            first = self.artifacts[name][0]
            is_data = first.endswith(DATASET)
            self.data[name] = self.file(first, Outcome.IDENTICAL) if is_data else Whole("")
        return self.data[name]

    def inputs(self, name: str) -> list[str]:
        """The names of the artifacts from whose datasets another one is made; a text, from all."""
        first = self.artifacts[name][0]
        if "/" not in first:
            return [each for each, files in self.artifacts.items() if files[0].endswith(DATASET)]
        paths = map(PurePosixPath, self.made[first][1].get("inputs", ()))
        return [x.stem for x in paths if x.suffix == DATASET and x.stem in self.artifacts]

    def file(self, file: str, data: Outcome) -> Whole:
        """The comparison of a file; an error becomes the outcome.

        ``data`` is the outcome of the datasets from which a picture or a text is made.
        """
        if file in self.not_made:
            why = f"not made, {self.not_made[file]}"
            return Whole(file, (Row("", Outcome.NOT_MADE, why),))
        # Warnings of the libraries about a damaged file become one line.
        with warnings.catch_warnings(), np.errstate(all="ignore"):
            warnings.simplefilter("ignore")
            try:
                return self._compared(file, data)
            # On a damaged file the libraries raise errors of many types.
            except Exception as error:
                why = " ".join(str(error).split()) or type(error).__name__
                told = f"a file could not be compared, {why}"
                return Whole(file, (Row("", Outcome.UNREADABLE, told),))

    def _compared(self, file: str, data: Outcome) -> Whole:
        old, now = both = [folder / file for folder in self.folders]
        alone = (
            Row("", Outcome.EXTRA, "a file is not in the record"),
            Row("", Outcome.MISSING, "a file is missing"),
        )
        for path, row in zip(both, alone, strict=True):
            if not path.is_symlink() and not path.exists():
                return Whole(file, (row,))
            require_readable(path)
        if old.suffix in CARRIERS:
            self.made[file] = [provenance_in(path) for path in both]
        made = self.made[file]
        contents = tuple(path.read_bytes() for path in both)
        rows: list[Row] = []
        if contents[0] != contents[1]:
            rows = _rows(old, now, made, data)
        if data is Outcome.PARAMETERS and "/" in file:
            rows = [replace(row, outcome=Outcome.PARAMETERS) for row in rows]
        # A run notes the code with which it would make a file now.
        note = self.folders[1] / "code" / made[1].get("rule", "")
        code = made[1].get("code")
        if code and note.is_file() and code != parts_of_note(note.read_text(errors="replace"))[0]:
            told = "made by older code than that of the working tree"
            rows.append(Row("", Outcome.STALE, told))
        return Whole(file, tuple(rows), contents if old.suffix == ".png" else ())

    def artifact(self, name: str) -> Whole:
        """The comparison of an artifact, with its cause if it does not agree with the record."""
        data = self.dataset(name)
        sources = [name] if data.name or "/" in self.artifacts[name][0] else self.inputs(name)
        outcome = Whole("", tuple(map(self.dataset, sources))).outcome
        others = [self.file(x, outcome) for x in self.artifacts[name] if x != data.name]
        whole = Whole(name, tuple([data, *others] if data.name else others))
        moved = [file for file in whole.parts if not file.outcome.agrees]
        rows = [row.told for file in moved for row in file.parts if row.outcome is whole.outcome]
        if not moved or whole.outcome.rank >= Outcome.STALE.rank:
            return replace(whole, cause=rows[0] if moved else "")
        # Of the first file that is not identical: a dataset that moved within its budgets, too, may
        # be why a picture changed.
        other = [file.name for file in whole.parts if file.outcome is not Outcome.IDENTICAL]
        made = self.made[next((name for name in other if name in self.made), "")]
        code = suspects(made, self.touched)
        inputs = [x for x in self.inputs(name) if not self.dataset(x).outcome.agrees and x != name]
        kind = _KINDS.get(PurePosixPath(moved[0].name).suffix, "the text changed")
        found = causes(made, code, inputs) or [kind]
        return replace(whole, cause="; ".join(found), code=tuple(code))


def _rows(old: Path, now: Path, made: list[dict[str, Any]], data: Outcome) -> list[Row]:
    """The differences of a file; the library that reads it may raise errors."""
    if old.suffix == DATASET:
        return compare_datasets(read_dataset(old), read_dataset(now))
    if old.suffix not in PICTURES:
        record, new = (words_of(path, data is Outcome.IDENTICAL) for path in (old, now))
        return compare_texts(record, new, moved=data is Outcome.ROUNDING)
    compare = compare_pixels if old.suffix == ".png" else compare_drawings
    redrawn = len({side["versions"].get("matplotlib") for side in made} - {None}) > 1
    return compare(old, now, moved=data is not Outcome.IDENTICAL, redrawn=redrawn)


def compare_folders(
    record: Path,
    new: Path,
    only: Collection[str] = (),
    not_made: Mapping[str, str] = MappingProxyType({}),
) -> Whole:
    """The comparison of all artifacts of two folders, or of the named artifacts.

    ``not_made`` are files that a run did not make, each with its reason.

    Raises
    ------
    ModelError
        If there is nothing in the new folder, if there is no folder of the record, or if neither
        folder has a named artifact.
    """
    comparison = _Comparison(record, new, not_made)
    known = comparison.artifacts
    if unknown := [name for name in only if name not in known]:
        raise ModelError(f"unknown artifact {unknown[0]}; known: {', '.join(known)}")
    return Whole("", tuple(map(comparison.artifact, only or known)))
