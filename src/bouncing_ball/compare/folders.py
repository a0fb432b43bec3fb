"""Two folders of artifacts, and the result for each artifact.

A folder holds ``figures/`` with datasets, pictures and tables, and
``paper.md``; nothing else in it is looked at. Files of one name and different
suffixes are one artifact.
"""

from collections.abc import Collection
from dataclasses import dataclass
from pathlib import Path

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
        reported = [Outcome.WITHIN for part in self.parts if part.redrawn and part.moved]
        return worst([*reported, *(part.outcome for part in self.parts if not part.redrawn)])

    @property
    def share(self) -> float | None:
        """The largest share of a budget that decides, None without any."""
        shares = [part.share for part in self.parts if not part.redrawn]
        return max((share for share in shares if share is not None), default=None)


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
    figures = folder / _FIGURES
    if not folder.is_dir():
        raise ComparisonError(f"no folder {printable(folder)}")
    if figures.is_symlink():
        raise ComparisonError(f"{printable(figures)}: a link; links are not followed")
    found: dict[str, set[str]] = {}
    # Files that begin with a point are halfway written.
    for path in [*figures.glob("[!.]*"), *folder.glob(_PAPER)]:
        if path.suffix in _SUFFIXES:
            found.setdefault(path.stem, set()).add(path.relative_to(folder).as_posix())
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
    # The text is made from all datasets: it comes last.
    names = sorted(before.keys() | after.keys(), key=lambda name: (f"{name}.md" == _PAPER, name))
    if unknown := [name for name in only if name not in names]:
        known = printable(", ".join(names))
        raise ComparisonError(f"unknown artifact {printable(unknown[0])}; known: {known}")
    found: list[Artifact] = []
    data: dict[str, Outcome] = {}
    for name in names:
        parts: list[Part] = []
        files = before.get(name, set()) | after.get(name, set())
        for file in sorted(files, key=lambda file: _SUFFIXES.index(Path(file).suffix)):
            of = worst(data.values()) if file == _PAPER else data.get(name)
            parts.append(judge(file, (record, new), of))
            if file.endswith(".nc"):
                data[name] = parts[-1].outcome
        found.append(Artifact(name, tuple(parts)))
    found = [each for each in found if not only or each.name in only]
    found.sort(key=lambda each: (-each.outcome.rank, -(each.share or 0.0), each.name))
    return Comparison(tuple(found))
