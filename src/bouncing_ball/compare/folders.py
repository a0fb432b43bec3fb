"""Two folders of artifacts, and the result for each artifact.

A folder holds ``figures/`` with datasets, pictures and tables, and
``paper.md``; nothing else in it is looked at. Files of one name and different
suffixes are one artifact.
"""

from collections.abc import Collection
from dataclasses import dataclass
from pathlib import Path, PurePosixPath

from bouncing_ball.compare.outcome import Outcome, worst
from bouncing_ball.compare.parts import Part, judge
from bouncing_ball.errors import ModelError, printable

_FIGURES, _PAPER = "figures", "paper.md"
# In the order in which they are compared: the data first, as the others lean on them.
_SUFFIXES = (".nc", ".csv", ".png", ".svg", ".md", ".tex", ".html")


class ComparisonError(ModelError):
    """Two folders that cannot be compared at all, in one line."""


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


def artifacts_in(folder: Path) -> dict[str, set[str]]:
    """Names of the artifacts and their files, relative to the folder.

    Raises
    ------
    ComparisonError
        If there is no such folder, or no artifact in it.
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
