"""One file of an artifact against its counterpart in the record.

Everything decides, by a measure of its own: data by their budgets, texts and
tables line by line with numbers that move only as their data do, pictures by
their pixels and the places of their elements. One thing is only reported: a
picture drawn by another matplotlib than the record's, which draws otherwise.

Every file is judged alone. Whatever is wrong with one, it is unreadable, with
the reason, and the others are compared all the same.
"""

import json
import warnings
from collections.abc import Mapping
from contextlib import suppress
from dataclasses import dataclass, replace
from pathlib import Path, PurePosixPath
from typing import Any

import numpy as np
import xarray as xr

from bouncing_ball.compare.data import VariableResult, compare_datasets
from bouncing_ball.compare.drawings import compare_drawings, read_drawing
from bouncing_ball.compare.outcome import Outcome, worst
from bouncing_ball.compare.pages import Page, read_page
from bouncing_ball.compare.pictures import PictureResult, compare_pictures, read_picture
from bouncing_ball.compare.texts import Line, compare_texts, summary
from bouncing_ball.compare.tolerances import Tolerances
from bouncing_ball.record.provenance import Provenance, ProvenanceError
from bouncing_ball.record.reading import (
    MAX_BYTES,
    UnreadableError,
    opened_dataset,
    read_file,
    reason,
)

_VERSIONS = "provenance_versions"


@dataclass(frozen=True)
class Part:
    """What became of one file of an artifact.

    Parameters
    ----------
    file : str
        Relative to either folder.
    outcome : Outcome
    decides : bool
        False where a difference is only reported.
    share : float, optional
        Largest share of a budget.
    note : str
        What is different, in a few words.
    variables : tuple of VariableResult
        Of a dataset, worst first.
    lines : tuple of Line
        Of a text or a vector graphic: all that are not the same.
    picture : PictureResult, optional
    images : tuple
        The record's and the new picture as files, None where there is none.
    made : tuple
        Where the record's and the new file say that they come from, None where
        they do not.
    """

    file: str
    outcome: Outcome
    decides: bool = True
    share: float | None = None
    note: str = ""
    variables: tuple[VariableResult, ...] = ()
    lines: tuple[Line, ...] = ()
    picture: PictureResult | None = None
    images: tuple[bytes | None, bytes | None] = (None, None)
    made: tuple[Provenance | None, Provenance | None] = (None, None)


def read_data(content: bytes) -> xr.Dataset:
    """A dataset from its file's content, whole; numbers are taken for no dates."""
    with opened_dataset(content) as raw:
        store = xr.backends.NetCDF4DataStore(raw)
        backend = xr.backends.StoreBackendEntrypoint()
        return backend.open_dataset(store, decode_times=False, decode_timedelta=False).load()


def _text(content: bytes) -> str:
    try:
        return content.decode("utf-8")
    except UnicodeDecodeError:
        raise UnreadableError("not UTF-8 text") from None


def _page(content: bytes) -> Page:
    return read_page(_text(content))


_READERS = {".nc": read_data, ".png": read_picture, ".svg": read_drawing, ".html": _page}
# Bytes of what is compared line by line or element by element; twenty times our largest.
_MAX_TEXT = 2**21


def _read(folder: Path, file: str) -> bytes:
    """The content of a file."""
    binary = PurePosixPath(file).suffix in (".nc", ".png")
    return read_file(folder, file, MAX_BYTES if binary else _MAX_TEXT)


def _held(file: str, content: bytes) -> Any:
    """What a file holds: dataset, picture, drawing or text."""
    return _READERS.get(PurePosixPath(file).suffix, _text)(content)


def redrawn(record: Mapping[Any, Any], new: Mapping[Any, Any]) -> str:
    """How two pictures' metadata name different versions of matplotlib; empty if not.

    Examples
    --------
    >>> old, new = ({_VERSIONS: f'{{"matplotlib": "3.{k}"}}'} for k in (10, 11))
    >>> redrawn(old, new), redrawn(old, old), redrawn(old, {})
    ('drawn by matplotlib 3.10 → 3.11', '', '')
    """
    found = []
    for metadata in (record, new):
        try:
            versions = json.loads(str(metadata.get(_VERSIONS)))
            found.append(versions["matplotlib"])
        except (ValueError, KeyError, TypeError, RecursionError):
            return ""
    return f"drawn by matplotlib {found[0]} → {found[1]}" if found[0] != found[1] else ""


def _made(side: Any) -> Provenance | None:
    """What a dataset, a picture or a drawing says of where it comes from."""
    for name in ("attrs", "info", "metadata"):
        if isinstance(said := getattr(side, name, None), Mapping):
            with suppress(ProvenanceError):
                return Provenance.of(said)
    return None


def _joined(*notes: str) -> str:
    return "; ".join(filter(None, notes))


def _dataset(file: str, artifact: str, sides: Any, rules: Tolerances) -> Part:
    record, new = sides
    results = tuple(compare_datasets(artifact, record, new, rules))
    names = sorted(map(str, {*record.variables, *new.variables}))
    unknown = [name for name in names if rules.of(artifact, name) is None]
    first = results[0] if results else None
    note = ""
    if first is not None and first.outcome is not Outcome.IDENTICAL:
        note = first.name + (f" at {first.place}" if first.place else "")
        note += f": {first.note}" if first.note else ""
    return Part(
        file,
        worst(result.outcome for result in results),
        share=max((each.share for each in results if each.share is not None), default=None),
        note=_joined(note, f"no entry for {', '.join(unknown)}" if unknown else ""),
        variables=results,
    )


def _picture(file: str, images: tuple[bytes, bytes], sides: Any, rules: Tolerances) -> Part:
    found = compare_pictures(sides[0], sides[1], rules.pictures.allowed)
    other = redrawn(sides[0].info, sides[1].info)
    return Part(
        file,
        found.outcome,
        decides=not other,
        share=found.share,
        note=_joined(found.note, other if found.outcome is not Outcome.IDENTICAL else ""),
        picture=found,
        images=images,
    )


def _drawing(file: str, sides: Any, rules: Tolerances) -> Part:
    share, lines = compare_drawings(sides[0], sides[1], rules.pictures.allowed)
    outcome = worst(line.outcome for line in lines)
    other = redrawn(sides[0].metadata, sides[1].metadata) if lines else ""
    note = f"{len(lines)} of {len(sides[0].elements)} elements moved" if lines else ""
    return Part(file, outcome, not other, share, _joined(note, other), lines=lines)


def _lines(file: str, sides: Any, data: Outcome | None) -> Part:
    lines = compare_texts(sides[0], sides[1], data)
    outcome, note = summary(lines)
    return Part(file, outcome, note=note, lines=lines)


def _compared(
    file: str, artifact: str, contents: Any, sides: Any, rules: Tolerances, data: Outcome | None
) -> Part:
    match PurePosixPath(file).suffix:
        case ".nc":
            return _dataset(file, artifact, sides, rules)
        case ".png":
            return _picture(file, (contents[0], contents[1]), sides, rules)
        case ".svg":
            return _drawing(file, sides, rules)
        case ".html":
            data_part = _dataset(file, artifact, tuple(side.data for side in sides), rules)
            text_part = _lines(file, tuple(side.text for side in sides), None)
            return replace(
                data_part,
                outcome=worst([data_part.outcome, text_part.outcome]),
                note=_joined(data_part.note, text_part.note),
                lines=text_part.lines,
            )
        case _:
            return _lines(file, sides, data)


def judge(
    file: str,
    artifact: str,
    folders: tuple[Path | None, Path | None],
    rules: Tolerances,
    data: Outcome | None = None,
) -> Part:
    """A file of one folder or of both; never an error.

    Parameters
    ----------
    file : str
    artifact : str
        Whose file it is.
    folders : tuple
        That of the record and the new one; None where the file is not there.
    rules : Tolerances
    data : Outcome, optional
        On the datasets that a text is made from, the worst.
    """
    before, after = folders
    contents: list[bytes | None] = [None, None]
    sides: list[Any] = [None, None]
    reading = ""
    # Warnings of the libraries about a damaged file become one line below.
    with warnings.catch_warnings(), np.errstate(all="ignore"):
        warnings.simplefilter("ignore")
        try:
            if before is not None:
                reading = "record: "
                content = contents[0] = _read(before, file)
                sides[0] = _held(file, content)
            if after is not None:
                reading = "new: "
                content = contents[1] = _read(after, file)
                # Most files are the same bytes, and what they hold is known.
                sides[1] = sides[0] if content == contents[0] else _held(file, content)
            reading = ""
            made = (_made(sides[0]), _made(sides[1]))
            if before is not None and after is not None:
                part = _compared(file, artifact, contents, sides, rules, data)
                return replace(part, made=made)
        # By intent: what the libraries raise on a file made to confuse them has no end.
        except Exception as error:
            return Part(file, Outcome.UNREADABLE, note=f"{reading}{reason(error)}")
    outcome = Outcome.EXTRA if before is None else Outcome.MISSING
    images = (contents[0], contents[1]) if file.endswith(".png") else (None, None)
    return Part(file, outcome, images=images, made=made)
