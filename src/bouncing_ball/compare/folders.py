"""The comparison of two folders of artifacts, with the result for each artifact.

A folder holds ``figures/`` with datasets, pictures and tables, and the texts ``paper.md`` and
``supplement.md``, and may hold ``config/engines.nc``, the results of physics engines. Other files
are ignored. Files with the same name and different suffixes are one artifact.
"""

from collections.abc import Collection
from pathlib import Path

from bouncing_ball.compare.outcome import Outcome, Whole, worst
from bouncing_ball.compare.parts import judge
from bouncing_ball.errors import ModelError, printable

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
