"""Two folders of artifacts, and what became of each artifact.

A folder holds ``figures/`` with datasets, pictures and tables, and
``paper.md``; nothing else in it is looked at. Files of one name and different
suffixes are one artifact.
"""

import time
from collections.abc import Collection
from dataclasses import dataclass
from pathlib import Path, PurePosixPath

from bouncing_ball.compare.outcome import Outcome, worst
from bouncing_ball.compare.parts import Part, judge
from bouncing_ball.compare.tolerances import Tolerances
from bouncing_ball.record.reading import UnreadableError, names_in, printable

_FIGURES, _PAPER = "figures", "paper.md"
# In the order in which they are compared: the data first, as the others lean on them.
_SUFFIXES = (".nc", ".csv", ".png", ".svg", ".md", ".tex", ".html")
# Of processor time, a hundred times what the record takes; what then is left is not compared.
_SECONDS = 300.0


class ComparisonError(ValueError):
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
    try:
        names = names_in(folder / _FIGURES) if (folder / _FIGURES).is_dir() else []
    except UnreadableError as error:
        raise ComparisonError(f"{printable(folder / _FIGURES)}: {error}") from None
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


def compare_folders(
    record: Path, new: Path, rules: Tolerances, only: Collection[str] = ()
) -> Comparison:
    """All artifacts of two folders, or only those named, worst first.

    Raises
    ------
    ComparisonError
        If one of the folders is not there or holds no artifact, or neither has
        one of those named.
    """
    before, after = artifacts_in(record), artifacts_in(new)
    names = sorted(before.keys() | after.keys())
    for name in only:
        if name not in names:
            known = printable(", ".join(names))
            raise ComparisonError(f"unknown artifact {printable(name)}; known: {known}")
    deadline = time.process_time() + _SECONDS

    def judged(name: str, file: str, data: Outcome | None) -> Part:
        if time.process_time() > deadline:
            note = f"not compared: the {_SECONDS:g} s for all are over"
            return Part(file, Outcome.UNREADABLE, note=note)
        sides = (
            record if file in before.get(name, ()) else None,
            new if file in after.get(name, ()) else None,
        )
        return judge(file, name, sides, rules, data)

    def artifact(name: str, data: Outcome | None = None) -> Artifact:
        files = before.get(name, set()) | after.get(name, set())
        parts = []
        for file in sorted(files, key=lambda file: _SUFFIXES.index(PurePosixPath(file).suffix)):
            parts.append(judged(name, file, data))
            if file.endswith(".nc"):
                data = parts[-1].outcome
        return Artifact(name, tuple(parts))

    paper = PurePosixPath(_PAPER).stem
    chosen = set(only or names)
    # The text is made from all datasets: for its sake they are all judged.
    asked = names if paper in chosen else chosen
    found = [artifact(name) for name in sorted(asked) if name != paper]
    if paper in chosen:
        parts = [part for each in found for part in each.parts]
        data = [part.outcome for part in parts if part.file.endswith(".nc")]
        found.append(artifact(paper, worst(data)))
    found = [each for each in found if each.name in chosen]
    return Comparison(tuple(sorted(found, key=_severity)))


def _severity(artifact: Artifact) -> tuple:
    return -artifact.outcome.rank, -(artifact.share or 0.0), artifact.name
