"""Two folders of artifacts, and what became of each artifact.

A folder holds ``figures/`` with datasets, pictures and tables, and
``paper.md``; nothing else in it is looked at. Files of one name and different
suffixes are one artifact.
"""

from dataclasses import dataclass
from pathlib import Path

from bouncing_ball.record.diff.outcome import Outcome, worst
from bouncing_ball.record.diff.parts import Part, dataset, one_sided, rendering
from bouncing_ball.record.diff.tolerances import Tolerances

_FIGURES, _PAPER = "figures", "paper.md"
# In the order in which they are compared: the data first, as the others lean on them.
_SUFFIXES = (".nc", ".csv", ".png", ".svg", ".md", ".tex")


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
        raise ComparisonError(f"no folder {folder}")
    candidates = [*(folder / _FIGURES).glob("*"), folder / _PAPER]
    found: dict[str, set[str]] = {}
    for path in candidates:
        # Files that begin with a point are halfway written.
        if path.suffix in _SUFFIXES and path.is_file() and not path.name.startswith("."):
            found.setdefault(path.stem, set()).add(path.relative_to(folder).as_posix())
    if not found:
        raise ComparisonError(f"nothing to compare in {folder}: neither {_FIGURES}/ nor {_PAPER}")
    return found


def _artifact(
    name: str,
    files: tuple[set[str], set[str]],
    folders: tuple[Path, Path],
    rules: Tolerances,
    own: bool | None = None,
    data: Outcome | None = None,
) -> Artifact:
    """An artifact and its files.

    ``own``, whether the versions are the same, and ``data``, the outcome on what
    it is made from, are told by its dataset, if it has one.
    """
    parts: list[Part] = []
    ordered = sorted(files[0] | files[1], key=lambda file: _SUFFIXES.index(Path(file).suffix))
    for file in ordered:
        if file not in files[1]:
            part = one_sided(file, folders[0], Outcome.MISSING)
        elif file not in files[0]:
            part = one_sided(file, folders[1], Outcome.EXTRA)
        elif file.endswith(".nc"):
            part = dataset(file, name, folders, rules)
            own = bool(part.same_versions)
        else:
            part = rendering(file, folders, rules, data, own)
        if file.endswith(".nc"):
            data = part.outcome
        parts.append(part)
    return Artifact(name, tuple(parts))


def compare_folders(record: Path, new: Path, rules: Tolerances) -> Comparison:
    """All artifacts of two folders, worst first.

    Raises
    ------
    ComparisonError
        If one of the folders is not there or holds no artifact.
    """
    before, after = artifacts_in(record), artifacts_in(new)
    paper = Path(_PAPER).stem

    def files(name: str) -> tuple[set[str], set[str]]:
        return before.get(name, set()), after.get(name, set())

    names = before.keys() | after.keys()
    folders = record, new
    artifacts = [_artifact(name, files(name), folders, rules) for name in sorted(names - {paper})]
    if paper in names:
        # The text is made from all datasets.
        made_from = [
            part for found in artifacts for part in found.parts if part.file.endswith(".nc")
        ]
        own = bool(made_from) and all(part.same_versions for part in made_from)
        data = worst(part.outcome for part in made_from) if made_from else None
        artifacts.append(_artifact(paper, files(paper), folders, rules, own, data))
    return Comparison(tuple(sorted(artifacts, key=_severity)))


def _severity(artifact: Artifact) -> tuple:
    return -artifact.outcome.rank, -(artifact.share or 0.0), artifact.name
