"""The comparison of one file of an artifact with the same file of the record.

Data are judged by their budgets; texts, tables and the words of SVG files line by line; PNG files
by their pixels. Every file is judged alone: if a file is damaged, its outcome is that it could not
be compared, with the reason, and the other files are compared nevertheless.

Because a folder of artifacts may come from anywhere, none of its files is run, no link is followed,
and text from it passes through :func:`bouncing_ball.errors.printable` before printing.

The comparison of two folders of artifacts, with the result for each artifact.

A folder holds ``figures/`` with datasets, pictures and tables, and the texts ``paper.md`` and
``supplement.md``, and may hold ``config/engines.nc``, the results of physics engines. Other files
are ignored. Files with the same name and different suffixes are one artifact.
"""

import re
import warnings
from collections.abc import Collection
from pathlib import Path

import numpy as np
from PIL import Image

from bouncing_ball.datasets.files import read_dataset
from bouncing_ball.errors import ModelError, printable
from bouncing_ball.pipeline.diff.datasets import PICTURE, PICTURES, compare_datasets
from bouncing_ball.pipeline.diff.outcome import Outcome, Row, Whole, worst
from bouncing_ball.pipeline.diff.texts import compare_texts, words_of

MAX_BYTES = 16 * 2**20
"""Files above this size are not read; the largest file of the record has half a megabyte."""


def redrawn(record: bytes, new: bytes) -> str:
    """A note that two pictures name different versions of matplotlib; empty if they do not.

    Examples
    --------
    >>> redrawn(b'{"matplotlib": "3.10.8"}', b'{"matplotlib": "3.11.0"}')
    'drawn by matplotlib 3.10.8 → 3.11.0, not judged'
    """
    found = [re.findall(rb"matplotlib\W+([0-9.]+)", content) for content in (record, new)]
    if not all(found) or found[0][0] == found[1][0]:
        return ""
    old, now = (versions[0].decode() for versions in found)
    return f"drawn by matplotlib {old} → {now}, not judged"


def read_picture(path: Path) -> np.ndarray:
    """Red, green and blue of a PNG file on white, shape (height, width, 3), as 16-bit integers.

    Raises
    ------
    OSError
        If the file is missing or damaged.
    """
    with Image.open(path, formats=["PNG"]) as picture:
        whole = picture.convert("RGBA")
    ground = Image.new("RGBA", whole.size, "white")
    return np.asarray(Image.alpha_composite(ground, whole).convert("RGB"), dtype=np.int16)


def compare_pictures(record: np.ndarray, new: np.ndarray, budget: float = PICTURE) -> list[Row]:
    """The difference of two pictures of :func:`read_picture`: no row if all pixels are identical.

    Examples
    --------
    >>> black = np.zeros((1, 2, 3), dtype=np.int16)
    >>> [(row.name, str(row.outcome)) for row in compare_pictures(black, black + 255)]
    [('pixels', 'drifted')]
    """
    if record.shape != new.shape:
        old, now = (f"{shape[1]} × {shape[0]}" for shape in (record.shape, new.shape))
        return [Row("size in pixels", Outcome.STRUCTURE, old, now)]
    changed = (new != record).any(axis=-1)
    if not changed.any():
        return []
    share = float(np.sqrt(np.mean((new - record).astype(float) ** 2))) / budget
    outcome = Outcome.WITHIN if share <= 1 else Outcome.DRIFTED
    return [Row("pixels", outcome, share=share, note=f"{changed.sum()} of {changed.size} changed")]


def _content(path: Path) -> bytes | None:
    """The bytes of a regular file of bounded size; None if the file does not exist."""
    if path.is_symlink() or (path.exists() and not path.is_file()):
        raise ModelError("a link, or not a regular file")
    if path.exists() and path.stat().st_size > MAX_BYTES:
        raise ModelError(f"larger than {MAX_BYTES} bytes")
    return path.read_bytes() if path.exists() else None


def _rows(old: Path, now: Path, data: Outcome | None) -> list[Row]:
    record, new = _content(old), _content(now)
    if record == new:
        return []
    if record is None or new is None:
        return [Row("", Outcome.EXTRA if record is None else Outcome.MISSING)]
    match old.suffix:
        case ".png" | ".svg" if note := redrawn(record, new):
            return [Row("", Outcome.WITHIN, note=note)]
        case ".nc":
            return compare_datasets(old.stem, read_dataset(old), read_dataset(now))
        case ".png":
            budget = PICTURES.get(old.stem, PICTURE)
            return compare_pictures(read_picture(old), read_picture(now), budget)
        case _:
            return compare_texts(words_of(old, data), words_of(now, data), data)


def judge(file: str, folders: tuple[Path, Path], data: Outcome | None) -> Whole:
    """The comparison of a file that is in the record, in the new folder, or in both.

    This function raises no error; an error of the comparison becomes the outcome.

    Parameters
    ----------
    file : str
        Path of the file relative to either folder.
    folders : tuple
        The folder of the record and the new folder.
    data : Outcome, optional
        The worst outcome of the datasets from which a text is made.
    """
    old, now = (folder / file for folder in folders)
    # Warnings of the libraries about a damaged file become one line.
    with warnings.catch_warnings(), np.errstate(all="ignore"):
        warnings.simplefilter("ignore")
        try:
            rows = tuple(_rows(old, now, data))
            drawn = old.suffix == ".png"
            return Whole(file, rows, (_content(old), _content(now)) if drawn else (None, None))
        # On a damaged file the libraries raise errors of many types.
        except Exception as error:
            why = " ".join(str(error).split()) or type(error).__name__
            return Whole(file, (Row("", Outcome.UNREADABLE, note=printable(why, 120)),))


_TEXTS = ("paper.md", "supplement.md")
# This file is compared if both folders have it, because not every machine has the engines.
_MEASURED = Path("config/engines.nc")
# In the order of comparison: data come first, because the judgement of other files depends on them.
_SUFFIXES = (".nc", ".csv", ".png", ".svg", ".md", ".html")


def artifacts_in(*folders: Path) -> dict[str, set[str]]:
    """Names of the artifacts and their files, relative to the folders.

    Raises
    ------
    ModelError
        If one of the folders has no artifact, or its figures/ is a link.
    """
    found: dict[str, set[str]] = {}
    for folder in folders:
        if (folder / "figures").is_symlink():
            raise ModelError(f"{printable(folder / 'figures')}: a link; links are not followed")
        # Files whose names begin with a point were not written completely.
        paths = [*folder.glob("figures/[!.]*"), *(folder / text for text in _TEXTS)]
        files = [
            path.relative_to(folder) for path in paths if path.suffix in _SUFFIXES and path.exists()
        ]
        if not files:
            where = f"in {printable(folder)}: neither figures/ nor {_TEXTS[0]}"
            raise ModelError(f"nothing to compare {where}")
        for file in files:
            found.setdefault(file.stem, set()).add(file.as_posix())
    if all((folder / _MEASURED).is_file() for folder in folders):
        found[_MEASURED.stem] = {_MEASURED.as_posix()}
    return found


def compare_folders(record: Path, new: Path, only: Collection[str] = ()) -> Whole:
    """The comparison of all artifacts of two folders, or of the named artifacts, worst first.

    Raises
    ------
    ModelError
        If one of the folders holds no artifact, or neither folder has a named artifact.
    """
    files = artifacts_in(record, new)
    # The texts come last, because they are made from all datasets.
    names = sorted(files, key=lambda name: (f"{name}.md" in _TEXTS, name))
    if unknown := [name for name in only if name not in names]:
        known = printable(", ".join(names))
        raise ModelError(f"unknown artifact {printable(unknown[0])}; known: {known}")
    found = []
    data: dict[str, Outcome] = {}
    for name in names:
        parts = []
        for file in sorted(files[name], key=lambda file: _SUFFIXES.index(Path(file).suffix)):
            of = worst(data.values()) if file in _TEXTS else data.get(name)
            parts.append(judge(file, (record, new), of))
            if file.endswith(".nc"):
                data[name] = parts[-1].outcome
        found.append(Whole(name, tuple(parts)))
    wanted = [each for each in found if not only or each.name in only]
    return Whole("", tuple(sorted(wanted, key=lambda x: (-x.outcome.rank, -x.share, x.name))))
