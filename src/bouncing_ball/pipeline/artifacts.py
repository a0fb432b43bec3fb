"""Artifacts: a dataset, and the figure, the table or the page that are made from it.

The workflow declares the artifacts of its stages as :class:`Artifact`; :class:`ArtifactFiles` are
the files of an artifact that a folder has. A run writes to a folder, ``results/``; the accepted
record has the same layout at the top of the repository. ``figures/`` holds the artifacts of the
paper, ``figures/beyond/`` those that go past it, and all files of an artifact have its name:
``fig14.nc`` is the dataset, ``fig14.png`` and ``fig14.svg`` are the pictures drawn from it,
``table1.csv`` and ``table1.md`` are tables, and ``explorer.html`` is a page. The article and its
supplement are texts beside ``figures/``, made from all datasets. The measurements of physics
engines, ``config/engines.nc``, are an artifact that no run makes.
"""

from collections.abc import Collection, Iterable
from dataclasses import dataclass
from pathlib import Path, PurePosixPath

from bouncing_ball.errors import ModelError
from bouncing_ball.pipeline.sources import without_versions

FOLDERS = ("figures", "figures/beyond")
"""The folders of the artifacts: those of the paper, and all others."""

_ABOUT = "README.md"  # The page that lists a folder's files; no artifact.

DATASET = ".nc"
PICTURES = (".png", ".svg")
TABLES = (".csv", ".md")
PAGE = ".html"

CARRIERS = (DATASET, *PICTURES)
"""Suffixes of the files that carry their provenance themselves."""

TEXTS = ("paper.md", "supplement.md")
"""The article of the replication, and its supplement."""

MEASURED = "config/engines.nc"
"""Measurements of physics engines, which are compared if both folders have them."""

RECORD = ("figures", *TEXTS)
"""The accepted results in git, which affect no new result."""

# In the order in which files are compared: other files are judged by the outcome of their dataset.
_SUFFIXES = (DATASET, ".csv", *PICTURES, ".md", PAGE)


@dataclass(frozen=True, kw_only=True)
class Artifact:
    """An artifact as its stage in the workflow names it.

    Parameters
    ----------
    name : str
        The name on the command line, in the configuration and of the files.
    module, figures : str
        The modules of the stage, with its studies, and of its figures and tables.
    title : str
        The title of the dataset.
    study : str, optional
        The function of ``module`` that computes the dataset.
    drawing, table : str, optional
        Functions of ``figures`` that take the dataset and return a figure, or the columns of a
        table.
    reads : sequence of str
        Names of the artifacts whose datasets the study takes as ``data``.
    accepted : str, optional
        The file of a dataset that is accepted by hand and has no study. A run reads it.
    page : bool
        Whether the dataset becomes a page in HTML.

    Examples
    --------
    >>> artifact = Artifact(
    ...     name="table1",
    ...     module="paper.exhibits.continuation_of_orbits",
    ...     figures="paper.exhibits.continuation_of_orbits_figures",
    ...     title="Table 1",
    ...     study="stability_ranges",
    ...     table="table1",
    ... )
    >>> artifact.files
    ['results/figures/table1.nc', 'results/figures/table1.csv', 'results/figures/table1.md']
    >>> artifact.part, artifact.stage, artifact.place, artifact.dataset
    ('paper', 'continuation_of_orbits', 'figures/table1', 'results/figures/table1.nc')
    """

    name: str
    module: str
    figures: str
    title: str
    study: str | None = None
    drawing: str | None = None
    table: str | None = None
    reads: tuple[str, ...] = ()
    accepted: str | None = None
    page: bool = False

    @property
    def part(self) -> str:
        """The part of the package: its set of studies, a section of the configuration."""
        return self.module.partition(".")[0]

    @property
    def stage(self) -> str:
        """The name of its stage, which is that of the module."""
        return self.module.rpartition(".")[2]

    @property
    def place(self) -> str:
        """The path of its files in a run and in the record, without their suffixes."""
        paper, beyond = FOLDERS
        return f"{paper if self.part == 'paper' else beyond}/{self.name}"

    @property
    def drawn_by(self) -> str | None:
        """The function that draws its figure, as its dataset names it; None without a figure."""
        return f"bouncing_ball.{self.figures}:{self.drawing}" if self.drawing else None

    @property
    def dataset(self) -> str | None:
        """The dataset that others read; None for a figure without data, such as a schematic."""
        computed = f"results/{self.place}{DATASET}" if self.study else None
        return self.accepted or computed

    @property
    def files(self) -> list[str]:
        """The files that a run makes."""
        suffixes: list[str] = []
        if self.study:
            suffixes += [DATASET]
        if self.drawing:
            suffixes += PICTURES
        if self.table:
            suffixes += TABLES
        if self.page:
            suffixes += [PAGE]
        return [f"results/{self.place}{suffix}" for suffix in suffixes]


@dataclass(frozen=True)
class ArtifactFiles:
    """The files of one name, as paths relative to the folder; the dataset is the first.

    Examples
    --------
    >>> fig14 = ArtifactFiles("fig14", ("figures/fig14.nc", "figures/fig14.png"))
    >>> fig14.dataset, fig14.others, fig14.is_text
    ('figures/fig14.nc', ('figures/fig14.png',), False)
    """

    name: str
    files: tuple[str, ...]

    @property
    def dataset(self) -> str | None:
        """The file of the dataset; None for a text and for a schematic."""
        return next((file for file in self.files if file.endswith(DATASET)), None)

    @property
    def others(self) -> tuple[str, ...]:
        """The files that are made from the dataset."""
        return tuple(file for file in self.files if file != self.dataset)

    @property
    def is_text(self) -> bool:
        """Whether this is the article or its supplement, which are made from all datasets."""
        return self.files[0] in TEXTS


def files_of_figures(folder: Path) -> list[Path]:
    """The files in the folders of artifacts of a run or of the record.

    Those whose names begin with a point were not written completely, and are left out.
    """
    return [path for each in FOLDERS for path in folder.glob(f"{each}/[!.]*") if path.is_file()]


def _files_in(folder: Path) -> list[str]:
    paths = [path for path in files_of_figures(folder) if path.name != _ABOUT]
    paths += [folder / text for text in TEXTS if (folder / text).exists()]
    return [path.relative_to(folder).as_posix() for path in paths if path.suffix in _SUFFIXES]


def artifacts_in(*folders: Path, not_made: Collection[str] = ()) -> dict[str, ArtifactFiles]:
    """The artifacts of which at least one folder has a file, by name; the texts come last.

    ``not_made`` are files that a run did not make, which may be in neither.

    Raises
    ------
    ModelError
        If one of the folders has no artifact, although nothing is known that was not made.
    """
    files = {file for file in not_made if PurePosixPath(file).suffix in _SUFFIXES}
    for folder in folders:
        found_here = _files_in(folder)
        if not found_here and not not_made:
            raise ModelError(f"nothing to compare in {folder}: neither figures/ nor {TEXTS[0]}")
        files.update(found_here)
    if all((folder / MEASURED).is_file() for folder in folders):
        files.add(MEASURED)
    by_name: dict[str, list[str]] = {}
    for file in sorted(files, key=lambda file: _SUFFIXES.index(PurePosixPath(file).suffix)):
        by_name.setdefault(PurePosixPath(file).stem, []).append(file)
    found = [ArtifactFiles(name, tuple(by_name[name])) for name in sorted(by_name)]
    found.sort(key=lambda artifact: artifact.is_text)
    return {artifact.name: artifact for artifact in found}


def digests_of_code(results: Path, file: str) -> str | None:
    """The digests of the code with which a run would make a dataset or a PNG file now.

    A run notes it in ``code/``; without this file, as in results from elsewhere, it is unknown.
    """
    path = PurePosixPath(file)
    job = path.stem if path.suffix == DATASET else f"draw_{path.stem}"
    note = results / "code" / job
    return without_versions(note.read_text("utf-8", errors="replace")) if note.is_file() else None


def artifacts_among(paths: Iterable[str]) -> list[str]:
    """The names of the artifacts whose datasets are among some paths, in the order of the paths.

    Examples
    --------
    >>> artifacts_among(["results/figures/fig14.nc", "config/engines.nc", "README.md"])
    ['fig14', 'engines']
    """
    return [PurePosixPath(path).stem for path in paths if path.endswith(DATASET)]


def carrier_of(path: Path) -> Path:
    """The file that carries the provenance of a file: the file itself, or its dataset.

    For the article and its supplement it is the dataset of the claims, the last one of a run.

    Raises
    ------
    ModelError
        If the file, or the dataset that should be beside it, does not exist.
    """
    if not path.is_file():
        raise ModelError(f"{path} cannot be read: no such file")
    if path.suffix in CARRIERS:
        return path
    beside = "figures/claims.nc" if path.name in TEXTS else f"{path.stem}{DATASET}"
    dataset = path.parent / beside
    if not dataset.is_file():
        missing = f"there is no {beside} next to it"
        raise ModelError(f"{path} is not an artifact of this workflow: {missing}")
    return dataset
