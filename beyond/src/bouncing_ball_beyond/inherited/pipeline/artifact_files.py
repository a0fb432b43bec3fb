"""The files of artifacts: a dataset, and the figure, the table or the page made from it.

A run writes to a folder, ``results/``; the accepted record has the same layout at the top of a
*house*, a folder with a Snakefile and its configuration. ``figures/`` holds the artifacts, and all
files of one have its name: ``fig14.nc`` is the dataset, ``fig14.png`` and ``fig14.svg`` are the
pictures drawn from it, ``table1.csv`` and ``table1.md`` are tables, and ``explorer.html`` is a
page. Texts, such as ``paper.md``, stand beside ``figures/`` and are made from all datasets.
"""

from collections.abc import Iterable
from pathlib import Path, PurePosixPath

from bouncing_ball_beyond.inherited.errors import ModelError

FIGURES = "figures"
"""The folder of the artifacts."""

_ABOUT = "README.md"  # The page that lists a folder's files; no artifact.

DATASET = ".nc"
PICTURES = (".png", ".svg")
PAGE = ".html"
TEXT = ".md"

CARRIERS = (DATASET, *PICTURES)
"""Suffixes of the files that carry their provenance themselves."""

# In the order in which files are compared: other files are judged by the outcome of their dataset.
_SUFFIXES = (DATASET, ".csv", *PICTURES, ".md", PAGE)


def files_in(folder: Path) -> set[str]:
    """The files of the artifacts and texts in the folder of a run or of a house, by their paths.

    Those whose names begin with a point were not written completely, and are left out. The texts of
    a house have names in small letters, so that README is none of them.
    """
    found = [*folder.glob(f"{FIGURES}/**/[!.]*.*"), *folder.glob(f"[a-z]*{TEXT}")]
    paths = [path.relative_to(folder) for path in found if path.name != _ABOUT]
    return {path.as_posix() for path in paths if path.suffix in _SUFFIXES}


def by_artifact(files: Iterable[str]) -> dict[str, list[str]]:
    """The files of each artifact by its name, with the dataset first, and the texts last.

    Examples
    --------
    >>> by_artifact(["paper.md", "figures/fig14.png", "figures/fig14.nc"])
    {'fig14': ['figures/fig14.nc', 'figures/fig14.png'], 'paper': ['paper.md']}
    """
    known = (path for path in map(PurePosixPath, files) if path.suffix in _SUFFIXES)
    paths = sorted(known, key=lambda path: (path.name == str(path), path.stem))
    found: dict[str, list[str]] = {path.stem: [] for path in paths}
    for path in sorted(paths, key=lambda path: _SUFFIXES.index(path.suffix)):
        found[path.stem].append(str(path))
    return found


def is_text(path: Path) -> bool:
    """Whether a file stands beside the folder of the artifacts, and is made from all of them."""
    return path.suffix == TEXT and (path.parent / FIGURES).is_dir()


def carrier_of(path: Path) -> Path:
    """The file that carries the provenance of a file: the file itself, or its dataset.

    For a text it is the dataset that was written last.

    Raises
    ------
    ModelError
        If the file, or the dataset that should be beside it, does not exist.
    """
    if not path.is_file():
        raise ModelError(f"{path} cannot be read: no such file")
    if path.suffix in CARRIERS:
        return path
    written = path.parent.glob(f"{FIGURES}/*{DATASET}") if is_text(path) else []
    dataset = max(written, key=lambda x: x.stat().st_mtime, default=path.with_suffix(DATASET))
    if not dataset.is_file():
        missing = f"there is no {dataset.name} next to it"
        raise ModelError(f"{path} is not an artifact of this workflow: {missing}")
    return dataset
