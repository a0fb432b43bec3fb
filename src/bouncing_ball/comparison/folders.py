"""Two folders of artifacts: what is there, what it is compared as, what decides.

A folder holds ``figures/`` with datasets, pictures and tables, and
``paper.md``; nothing else in it is looked at. Files of one name and different
suffixes are one artifact.

Data decide. A picture or a text is made from data: where it differs, that is
reported, and it decides only if both sides say that they were made with the
same versions of everything. Then nothing but the code can be the reason.
"""

import json
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path

from bouncing_ball.comparison.datasets import VariableResult, compare_datasets
from bouncing_ball.comparison.pictures import (
    PictureError,
    PictureResult,
    compare_pictures,
    versions_of,
)
from bouncing_ball.comparison.texts import compare_tables, compare_texts, without_metadata
from bouncing_ball.comparison.tolerances import Tolerances
from bouncing_ball.comparison.verdicts import Verdict, worst
from bouncing_ball.datasets.netcdf import read_dataset

FIGURES, PAPER = "figures", "paper.md"
# In the order in which they are read: the data first, as the others lean on them.
SUFFIXES = (".nc", ".csv", ".png", ".svg", ".md", ".tex")
_VERSIONS = "provenance_versions"


class ComparisonError(ValueError):
    """Two folders that cannot be compared at all, in one line."""


@dataclass(frozen=True)
class Part:
    """What became of one file of an artifact.

    ``decides`` is false where a difference is only reported. ``images`` are
    the record's and the new picture, None where there is none.
    """

    file: str
    verdict: Verdict
    decides: bool = True
    share: float | None = None
    note: str = ""
    variables: tuple[VariableResult, ...] = ()
    picture: PictureResult | None = None
    images: tuple[bytes | None, bytes | None] = (None, None)


@dataclass(frozen=True)
class Artifact:
    """A figure, a table or the paper: its files."""

    name: str
    parts: tuple[Part, ...]

    @property
    def verdict(self) -> Verdict:
        """The worst verdict of what decides; what is only reported costs identity."""
        found = worst(part.verdict for part in self.parts if part.decides)
        reported = any(part.verdict is not Verdict.IDENTICAL for part in self.parts)
        return worst([found, Verdict.WITHIN if reported else Verdict.IDENTICAL])

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
    def verdict(self) -> Verdict:
        """The worst verdict."""
        return worst(artifact.verdict for artifact in self.artifacts)


@dataclass(frozen=True)
class _Sides:
    """The two contents of one file."""

    record: bytes
    new: bytes

    def texts(self) -> tuple[str, str]:
        record, new = (content.decode("utf-8") for content in (self.record, self.new))
        return record, new


def artifacts_in(folder: Path) -> dict[str, list[str]]:
    """Names of the artifacts and their files, relative to the folder.

    Raises
    ------
    ComparisonError
        If there is no such folder, or no artifact in it.
    """
    if not folder.is_dir():
        raise ComparisonError(f"no folder {folder}")
    found: dict[str, list[str]] = {}
    for path in sorted((folder / FIGURES).glob("*")):
        # Files that begin with a point are halfway written.
        if path.suffix in SUFFIXES and path.is_file() and not path.name.startswith("."):
            found.setdefault(path.stem, []).append(f"{FIGURES}/{path.name}")
    if (folder / PAPER).is_file():
        found.setdefault(Path(PAPER).stem, []).append(PAPER)
    if not found:
        raise ComparisonError(f"nothing to compare in {folder}: neither {FIGURES}/ nor {PAPER}")
    return found


def _same_versions(record: str | None, new: str | None) -> bool:
    """Whether both sides name the versions they were made with, and the same."""
    try:
        return None not in (record, new) and json.loads(record) == json.loads(new)
    except (TypeError, ValueError):
        return False


def _dataset(
    file: str, artifact: str, folders: tuple[Path, Path], rules: Tolerances
) -> tuple[Part, bool]:
    """The part, and whether both datasets were made with the same versions."""
    sides = []
    for side, folder in zip(("record", "new"), folders, strict=True):
        try:
            sides.append(read_dataset(folder / file))
        # What netCDF4 and xarray raise on a damaged file.
        except (OSError, RuntimeError, ValueError, KeyError) as error:
            reason = " ".join(str(error).split()).replace(str(folder), "…")[:120]
            return Part(file, Verdict.UNREADABLE, note=f"{side}: {reason}"), False
    results = tuple(compare_datasets(artifact, *sides, rules))
    verdict = worst(result.verdict for result in results)
    shares = [result.share for result in results if result.share is not None]
    unknown = [result.name for result in results if rules.of(artifact, result.name) is None]
    unknown = [name for name in unknown if not name.startswith("(")]
    notes = [f"no entry for {', '.join(unknown)}"] if unknown else []
    first = results[0] if results else None
    if first is not None and first.verdict is not Verdict.IDENTICAL:
        where = f" at {first.place}" if first.place else ""
        notes.insert(0, f"{first.name}{where}" + (f": {first.note}" if first.note else ""))
    part = Part(file, verdict, True, max(shares, default=None), "; ".join(notes), results)
    versions = (data.attrs.get(_VERSIONS) for data in sides)
    return part, _same_versions(*versions)


def _picture(file: str, sides: _Sides, rules: Tolerances, own: bool | None) -> Part:
    result = compare_pictures(sides.record, sides.new, rules.pictures.budget)
    if own is None:
        own = _same_versions(versions_of(sides.record), versions_of(sides.new))
    return Part(
        file,
        result.verdict,
        decides=own,
        share=result.share,
        note=result.note,
        picture=result,
        images=(sides.record, sides.new),
    )


def _present(
    file: str,
    artifact: str,
    folders: tuple[Path, Path],
    rules: Tolerances,
    known: tuple[Verdict | None, bool | None],
) -> Part:
    """A file that both sides have, other than a dataset."""
    data, own = known
    try:
        sides = _Sides(*((folder / file).read_bytes() for folder in folders))
        match Path(file).suffix:
            case ".png":
                return _picture(file, sides, rules, own)
            case ".csv":
                return Part(file, *_noted(compare_tables(*sides.texts(), data)))
            case ".svg":
                texts = [without_metadata(text) for text in sides.texts()]
                verdict, note = compare_texts(*texts)
                return Part(file, verdict, decides=False, note=note and "vector graphic differs")
            case _:
                verdict, note = compare_texts(*sides.texts())
                return Part(file, verdict, decides=bool(own), note=note)
    except (OSError, UnicodeDecodeError, PictureError) as error:
        kind = "not UTF-8 text" if isinstance(error, UnicodeDecodeError) else str(error)
        return Part(file, Verdict.UNREADABLE, note=kind.replace(str(folders[1]), "…"))


def _noted(found: tuple[Verdict, str]) -> tuple[Verdict, bool, None, str]:
    verdict, note = found
    return verdict, True, None, note


def _lonely(file: str, folder: Path, verdict: Verdict) -> Part:
    """A file that only one side has."""
    content = (folder / file).read_bytes() if file.endswith(".png") else None
    images = (content, None) if verdict is Verdict.MISSING else (None, content)
    return Part(file, verdict, images=images)


def _parts(
    artifact: str,
    files: tuple[list[str], list[str]],
    folders: tuple[Path, Path],
    rules: Tolerances,
    own: bool | None,
) -> Iterator[tuple[Part, bool | None]]:
    """The parts of an artifact, each with what is known of the versions."""
    data: Verdict | None = None
    names = sorted({*files[0], *files[1]}, key=lambda file: SUFFIXES.index(Path(file).suffix))
    for file in names:
        if file not in files[1]:
            part = _lonely(file, folders[0], Verdict.MISSING)
        elif file not in files[0]:
            part = _lonely(file, folders[1], Verdict.EXTRA)
        elif file.endswith(".nc"):
            part, own = _dataset(file, artifact, folders, rules)
        else:
            part = _present(file, artifact, folders, rules, (data, own))
        if file.endswith(".nc"):
            data = part.verdict
        yield part, own


def compare_folders(record: Path, new: Path, rules: Tolerances) -> Comparison:
    """All artifacts of two folders.

    Raises
    ------
    ComparisonError
        If one of the folders is not there or holds no artifact.
    """
    folders = (record, new)
    found = [artifacts_in(folder) for folder in folders]
    paper = Path(PAPER).stem
    artifacts: list[Artifact] = []
    versions: list[bool | None] = []
    names: Mapping[str, None] = dict.fromkeys(sorted({*found[0], *found[1]} - {paper}))
    for name in [*names, *({paper} & {*found[0], *found[1]})]:
        # The text is made from all datasets.
        known = (bool(versions) and all(versions)) if name == paper else None
        pairs = list(_parts(name, _files(found, name), folders, rules, known))
        artifacts.append(Artifact(name, tuple(part for part, _ in pairs)))
        versions += [own for part, own in pairs if part.file.endswith(".nc")]
    return Comparison(tuple(sorted(artifacts, key=_severity)))


def _files(found: list[dict[str, list[str]]], name: str):
    return tuple(side.get(name, []) for side in found)


def _severity(artifact: Artifact) -> tuple:
    return -artifact.verdict.rank, -(artifact.share or 0.0), artifact.name
