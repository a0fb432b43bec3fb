"""The comparison of two folders of artifacts, with the result for each artifact.

Data are judged by their budgets; texts, tables and the words of SVG files line by line; PNG files
by their pixels, and SVG files by all that they draw. A picture may move only if its data did. Every
file is judged alone: if a file is damaged, its outcome is that it could not be compared, with the
reason, and the other files are compared nevertheless.

For an artifact that differs, the comparison names the cause
(:mod:`bouncing_ball.pipeline.diff.cause`). An artifact that is made from others, such as the
verdicts on the claims or the article, differs because of those of them that do not agree with the
record.
"""

import re
import warnings
from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from PIL import Image

from bouncing_ball.datasets.files import read_dataset
from bouncing_ball.errors import ModelError
from bouncing_ball.pipeline.artifacts import (
    DATASET,
    PICTURES,
    TEXTS,
    ArtifactFiles,
    artifacts_among,
    artifacts_in,
    digests_of_code,
)
from bouncing_ball.pipeline.diff import budgets
from bouncing_ball.pipeline.diff.cause import (
    UNKNOWN_ORIGIN,
    Origin,
    code_changes,
    made_from,
    origin_of,
    own_causes,
    require_origin,
)
from bouncing_ball.pipeline.diff.datasets import compare_datasets, word_rows
from bouncing_ball.pipeline.diff.outcome import ComparedItem, Outcome, Whole, worst
from bouncing_ball.pipeline.diff.texts import compare_drawings, compare_texts, words_of


def redrawn(record: bytes, new: bytes) -> str:
    """A note that two pictures name different versions of matplotlib; empty if they do not.

    Examples
    --------
    >>> redrawn(b'{"matplotlib": "3.10.8"}', b'{"matplotlib": "3.11.0"}')
    'drawn by matplotlib 3.10.8 → 3.11.0, not judged'
    """
    old, now = (re.search(rb"matplotlib\W+([0-9.]+)", content) for content in (record, new))
    if not old or not now or old[1] == now[1]:
        return ""
    return f"drawn by matplotlib {old[1].decode()} → {now[1].decode()}, not judged"


def read_picture(path: Path) -> np.ndarray:
    """Red, green and blue of a PNG file on white, shape (height, width, 3), as 16-bit integers.

    Raises
    ------
    OSError
        If the file is missing or damaged.
    """
    with Image.open(path) as picture:
        whole = picture.convert("RGBA")
    ground = Image.new("RGBA", whole.size, "white")
    return np.asarray(Image.alpha_composite(ground, whole).convert("RGB"), dtype=np.int16)


def compare_pictures(
    record: np.ndarray, new: np.ndarray, budget: float | None = budgets.PICTURE
) -> list[ComparedItem]:
    """The difference of two pictures of :func:`read_picture`: no row if all pixels are identical.

    Parameters
    ----------
    record, new : ndarray
    budget : float, optional
        The root mean square that is allowed, in grey levels; None if the data did not move, so that
        no pixel may change by more than :data:`~.budgets.PIXEL`.

    Examples
    --------
    >>> black = np.zeros((1, 2, 3), dtype=np.int16)
    >>> [(row.name, str(row.outcome)) for row in compare_pictures(black, black + 255)]
    [('pixels', 'drifted')]
    """
    if record.shape != new.shape:
        old_size, new_size = (f"{shape[1]} × {shape[0]}" for shape in (record.shape, new.shape))
        return [ComparedItem("size in pixels", Outcome.STRUCTURE, old_size, new_size)]
    changed = (new != record).any(axis=-1)
    if not changed.any():
        return []
    difference = (new - record).astype(float)
    if budget is None:
        share = float(np.max(np.abs(difference))) / budgets.PIXEL
    else:
        share = float(np.sqrt(np.mean(difference**2))) / budget
    outcome = Outcome.WITHIN if share <= 1 else Outcome.DRIFTED
    return [
        ComparedItem(
            "pixels", outcome, share=share, note=f"{100 * changed.mean():.2g} % of all changed"
        )
    ]


def _content(path: Path) -> bytes | None:
    return path.read_bytes() if path.exists() else None


def _rows(old: Path, now: Path, data: Outcome | None) -> list[ComparedItem]:
    """The rows of a file, see :func:`compared_file`; the library that reads it may raise errors."""
    record = _content(old)
    new = _content(now)
    if record == new:
        return []
    if record is None:
        return [ComparedItem("", Outcome.EXTRA)]
    if new is None:
        return [ComparedItem("", Outcome.MISSING)]
    if old.suffix == DATASET:
        both = read_dataset(old), read_dataset(now)
        return word_rows(*both) + compare_datasets(old.stem, *both)
    if old.suffix in PICTURES and (note := redrawn(record, new)):
        return [ComparedItem("", Outcome.WITHIN, note=note)]
    if old.suffix == ".png":
        budget = None if data is Outcome.IDENTICAL else budgets.PICTURE
        rows = compare_pictures(read_picture(old), read_picture(now), budget)
    else:
        rows = compare_texts(words_of(old, data), words_of(now, data), data)
        if old.suffix == ".svg":
            rows = rows or compare_drawings(record.decode(), new.decode(), data)
    if data is Outcome.PARAMETERS and now.name not in TEXTS:
        return [replace(row, outcome=Outcome.PARAMETERS, share=0.0) for row in rows]
    return rows


def _is_stale(file: str, results: Path) -> bool:
    """Whether other code than that of the working tree made a file of a run, as far as known."""
    # An SVG file is made together with its PNG file.
    if not file.endswith((DATASET, ".png")) or not (results / file).exists():
        return False
    digests = digests_of_code(results, file)
    if digests is None:
        return False
    return origin_of(results / file).code not in ("", digests)


@dataclass(frozen=True)
class Compared:
    """What is compared: the folder of the record, the new folder, and files that were not made.

    Each of these files has a reason. An older version of it may still be in the new folder.
    """

    record: Path
    new: Path
    not_made: Mapping[str, str]

    @property
    def folders(self) -> tuple[Path, Path]:
        """Both folders."""
        return self.record, self.new


def compared_file(file: str, compared: Compared, data: Outcome | None) -> Whole:
    """The comparison of a file that is in the record, in the new folder, or in both.

    This function raises no error; an error of the comparison becomes the outcome.

    Parameters
    ----------
    file : str
        Path of the file relative to either folder.
    compared : Compared
    data : Outcome, optional
        The worst outcome of the datasets from which a picture or a text is made.
    """
    old, now = (folder / file for folder in compared.folders)
    shown = old.suffix == ".png"
    if file in compared.not_made:
        before = _content(old) if shown else None
        return Whole(file, (ComparedItem("", Outcome.NOT_MADE),), (before, None))
    # Warnings of the libraries about a damaged file become one line.
    with warnings.catch_warnings(), np.errstate(all="ignore"):
        warnings.simplefilter("ignore")
        try:
            rows = _rows(old, now, data)
            if file.endswith((DATASET, ".png")):
                for path in (old, now):
                    require_origin(path)
            if _is_stale(file, compared.new):
                rows.append(ComparedItem("", Outcome.STALE, note="made by older code"))
            pictures = (_content(old), _content(now)) if shown else (None, None)
            return Whole(file, tuple(rows), pictures)
        # On a damaged file the libraries raise errors of many types.
        except Exception as error:
            why = " ".join(str(error).split()) or type(error).__name__
            return Whole(file, (ComparedItem("", Outcome.UNREADABLE, note=why),))


@dataclass(frozen=True)
class _Judged:
    """An artifact with the outcome of its dataset, and how both versions were made."""

    artifact: ArtifactFiles
    data: Whole | None
    record: Origin
    new: Origin

    @property
    def outcome(self) -> Outcome:
        """The outcome of the dataset, ``IDENTICAL`` if there is none."""
        return self.data.outcome if self.data else Outcome.IDENTICAL


def _judged(artifact: ArtifactFiles, compared: Compared) -> _Judged:
    data = compared_file(artifact.dataset, compared, None) if artifact.dataset else None
    # A schematic has no dataset, and a text says nothing about its making.
    carriers = [file for file in artifact.files if file.endswith((DATASET, ".png"))]
    if not carriers:
        return _Judged(artifact, data, UNKNOWN_ORIGIN, UNKNOWN_ORIGIN)
    record, new = (origin_of(folder / carriers[0]) for folder in compared.folders)
    return _Judged(artifact, data, record, new)


def _inputs(judged: _Judged, artifacts: dict[str, ArtifactFiles]) -> list[str]:
    """The names of the artifacts that another one is made from; a text is made from all."""
    if judged.artifact.is_text:
        return [name for name, artifact in artifacts.items() if artifact.dataset]
    return [name for name in artifacts_among(judged.new.inputs) if name in artifacts]


def _with_inputs(
    wanted: Collection[str], artifacts: dict[str, ArtifactFiles], compared: Compared
) -> dict[str, _Judged]:
    """The named artifacts, and all that they are made from, with their datasets compared."""
    found: dict[str, _Judged] = {}
    pending = list(wanted)
    while pending:
        name = pending.pop()
        if name not in found:
            found[name] = _judged(artifacts[name], compared)
            pending += _inputs(found[name], artifacts)
    return found


def _roots(name: str, judged: dict[str, _Judged], artifacts: dict[str, ArtifactFiles]) -> set[str]:
    """The artifacts from which the differences in the inputs of an artifact come."""
    found: set[str] = set()
    for source in _inputs(judged[name], artifacts):
        if source != name and not judged[source].outcome.agrees:
            behind = _roots(source, judged, artifacts)
            found |= behind
            if not behind or judged[source].outcome is Outcome.PARAMETERS:
                found.add(source)
    return found


def _ordered(names: Collection[str], judged: dict[str, _Judged]) -> list[str]:
    """Names of artifacts, those with other parameters first."""
    return sorted(names, key=lambda name: (judged[name].outcome is not Outcome.PARAMETERS, name))


def _origins(whole: Whole, judged: _Judged, compared: Compared) -> tuple[Origin, Origin]:
    """How both versions of what differs were made: of the dataset, or of the picture alone."""
    pictures = [file.name for file in whole.moved if file.name.endswith(".png")]
    if judged.outcome is Outcome.IDENTICAL and pictures:
        # Drawn by other code from the same data.
        record, new = (origin_of(folder / pictures[0]) for folder in compared.folders)
        return record, new
    return judged.record, judged.new


def _cause(
    whole: Whole, judged: _Judged, origins: tuple[Origin, Origin], roots: Sequence[str], why: str
) -> str:
    """Why an artifact differs from the record; ``why`` is not empty if it was not made."""
    if why:
        return f"not made, {why}"
    causes = own_causes(*origins)
    if roots:
        causes.append(made_from(roots))
    match whole.outcome:
        case Outcome.STALE:
            causes.insert(0, "made by older code than that of the working tree")
        case Outcome.MISSING:
            causes = ["a file is missing"]
        case Outcome.EXTRA:
            causes = ["a file is not in the record"]
        case Outcome.UNREADABLE:
            causes = ["a file could not be compared"]
    if causes:
        return "; ".join(causes)
    if judged.outcome is Outcome.STRUCTURE:
        return "the structure of the dataset changed"
    if judged.outcome is not Outcome.IDENTICAL:
        return "numbers moved within their budgets" if whole.outcome.agrees else "numbers moved"
    if any(file.name.endswith(PICTURES) for file in whole.moved):
        return "the picture changed"
    return "the text changed"


def compare_folders(
    record: Path,
    new: Path,
    only: Collection[str] = (),
    not_made: Mapping[str, str] | None = None,
) -> Whole:
    """The comparison of all artifacts of two folders, or of the named artifacts, worst first.

    ``not_made`` are files that a run did not make, each with its reason.

    Raises
    ------
    ModelError
        If one of the folders holds no artifact, or neither folder has a named artifact.
    """
    compared = Compared(record, new, not_made or {})
    artifacts = artifacts_in(record, new, not_made=compared.not_made)
    if unknown := [name for name in only if name not in artifacts]:
        raise ModelError(f"unknown artifact {unknown[0]}; known: {', '.join(artifacts)}")
    wanted = list(only or artifacts)
    judged = _with_inputs(wanted, artifacts, compared)
    found = []
    for name in wanted:
        artifact = artifacts[name]
        data = judged[name].data
        made_of = _inputs(judged[name], artifacts) if artifact.is_text else [name]
        outcome = worst(judged[source].outcome for source in made_of)
        others = [compared_file(file, compared, outcome) for file in artifact.others]
        whole = Whole(name, tuple([data, *others] if data else others))
        origins = _origins(whole, judged[name], compared)
        whole = replace(whole, code=code_changes(*origins))
        if whole.outcome is not Outcome.IDENTICAL:
            roots = _ordered(_roots(name, judged, artifacts), judged)
            reasons = [compared.not_made.get(file.name, "") for file in whole.parts]
            why = next(filter(None, reasons), "")
            whole = replace(whole, cause=_cause(whole, judged[name], origins, roots, why))
        found.append(whole)
    found.sort(key=lambda whole: (-whole.outcome.rank, -whole.share, whole.name))
    return Whole("", tuple(found))
