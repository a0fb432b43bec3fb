"""One file of an artifact against its counterpart in the record.

Data decide. A picture or a text is made from data: where it differs, that is
reported, and it decides only if both sides were made with the same versions of
everything. That leaves the code as the reason, or the processor: another one
rounds otherwise. So a picture has a budget, a digit of a table may move with
its data (:func:`~bouncing_ball.record.diff.texts.compare_tables`), and any other
text decides only while its data are identical. Where they have drifted within
their budgets, the text may follow, and the table beside it says how far.
"""

import json
from dataclasses import dataclass
from pathlib import Path

from bouncing_ball.datasets.netcdf import read_dataset
from bouncing_ball.record.diff.data import VariableResult, compare_datasets
from bouncing_ball.record.diff.outcome import Outcome, worst
from bouncing_ball.record.diff.pictures import (
    VERSIONS,
    PictureError,
    PictureResult,
    compare_pictures,
    versions_of,
)
from bouncing_ball.record.diff.texts import (
    PictureTextError,
    TableError,
    check_svg,
    compare_tables,
    compare_texts,
    without_metadata,
)
from bouncing_ball.record.diff.tolerances import Tolerances


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
    same_versions : bool, optional
        Of a dataset: whether both sides name the same versions of everything.
    picture : PictureResult, optional
    images : tuple
        The record's and the new picture as files, None where there is none.
    """

    file: str
    outcome: Outcome
    decides: bool = True
    share: float | None = None
    note: str = ""
    variables: tuple[VariableResult, ...] = ()
    same_versions: bool | None = None
    picture: PictureResult | None = None
    images: tuple[bytes | None, bytes | None] = (None, None)


def same_versions(record: str | None, new: str | None) -> bool:
    """Whether two JSON texts name the same versions; not if one side has none.

    Examples
    --------
    >>> same_versions('{"numpy": "2.4", "scipy": "1.17"}', '{"scipy":"1.17","numpy":"2.4"}')
    True
    >>> same_versions(None, None)
    False
    """
    if record is None or new is None:
        return False
    try:
        return json.loads(record) == json.loads(new)
    except (TypeError, ValueError):
        return False


def one_sided(file: str, folder: Path, outcome: Outcome) -> Part:
    """A file that only one of the folders has, missing or extra."""
    content = (folder / file).read_bytes() if file.endswith(".png") else None
    images = (content, None) if outcome is Outcome.MISSING else (None, content)
    return Part(file, outcome, images=images)


def _summary(results: tuple[VariableResult, ...], unknown: list[str]) -> str:
    """The worst variable and where it is, and those without an entry."""
    notes = []
    if results and results[0].outcome is not Outcome.IDENTICAL:
        first = results[0]
        where = f" at {first.place}" if first.place else ""
        notes.append(f"{first.name}{where}" + (f": {first.note}" if first.note else ""))
    if unknown:
        notes.append(f"no entry for {', '.join(unknown)}")
    return "; ".join(notes)


def dataset(file: str, artifact: str, folders: tuple[Path, Path], rules: Tolerances) -> Part:
    """A dataset that both folders have."""
    sides = []
    for side, folder in zip(("record", "new"), folders, strict=True):
        try:
            sides.append(read_dataset(folder / file))
        # What netCDF4 and xarray raise on a damaged file.
        except (OSError, RuntimeError, ValueError, KeyError) as error:
            reason = " ".join(str(error).split()).replace(str(folder), "…")
            return Part(file, Outcome.UNREADABLE, note=f"{side}: {reason[:120]}")
    record, new = sides
    results = tuple(compare_datasets(artifact, record, new, rules))
    shares = [result.share for result in results if result.share is not None]
    names = sorted(map(str, {*record.variables, *new.variables}))
    unknown = [name for name in names if rules.of(artifact, name) is None]
    return Part(
        file,
        worst(result.outcome for result in results),
        share=max(shares, default=None),
        note=_summary(results, unknown),
        variables=results,
        same_versions=same_versions(record.attrs.get(VERSIONS), new.attrs.get(VERSIONS)),
    )


def _picture(file: str, record: bytes, new: bytes, rules: Tolerances, own: bool | None) -> Part:
    found = compare_pictures(record, new, rules.pictures.allowed)
    if own is None and record != new:
        # A figure without a dataset tells by itself.
        own = same_versions(versions_of(record), versions_of(new))
    return Part(
        file,
        found.outcome,
        decides=bool(own),
        share=found.share,
        note=found.note,
        picture=found,
        images=(record, new),
    )


def _text(file: str, record: str, new: str, data: Outcome | None, own: bool | None) -> Part:
    match Path(file).suffix:
        case ".csv":
            outcome, note = compare_tables(record, new, data)
            return Part(file, outcome, note=note)
        case ".svg":
            for text in (record, new):
                check_svg(text)
            outcome, _ = compare_texts(without_metadata(record), without_metadata(new))
            return Part(file, outcome, decides=False)
        case _:
            outcome, note = compare_texts(record, new)
            if outcome is Outcome.DRIFTED and data is Outcome.WITHIN:
                outcome = Outcome.WITHIN
            return Part(file, outcome, decides=bool(own) and data is Outcome.IDENTICAL, note=note)


def rendering(
    file: str,
    folders: tuple[Path, Path],
    rules: Tolerances,
    data: Outcome | None,
    own: bool | None,
) -> Part:
    """A picture, table or text that both folders have.

    Parameters
    ----------
    file : str
    folders : tuple of Path
        That of the record and the new one.
    rules : Tolerances
    data : Outcome or None
        The outcome on the dataset it is made from; the worst one, of several.
    own : bool or None
        Whether both sides were made with the same versions of everything;
        None if no dataset tells.
    """
    try:
        record, new = ((folder / file).read_bytes() for folder in folders)
        if file.endswith(".png"):
            return _picture(file, record, new, rules, own)
        return _text(file, record.decode("utf-8"), new.decode("utf-8"), data, own)
    except UnicodeDecodeError:
        return Part(file, Outcome.UNREADABLE, note="not UTF-8 text")
    except (PictureError, PictureTextError, TableError) as error:
        return Part(file, Outcome.UNREADABLE, note=str(error))
    except OSError as error:
        return Part(file, Outcome.UNREADABLE, note=str(error.strerror))
