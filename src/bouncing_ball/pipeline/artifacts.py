"""What an artifact is: a dataset, and the figure, the table or the page that are made from it."""

from dataclasses import dataclass

FOLDER = "results/figures"
"""The folder of all artifacts of a run."""


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
    study, places : str, optional
        Functions of ``module``: the study that computes the dataset, and, if it can be divided into
        shards, the function that computes the arrays of some of its places.
    drawing, table : str, optional
        Functions of ``figures`` that take the dataset and return a figure, or the columns of a
        table.
    reads : sequence of str
        Names of the artifacts whose datasets the study takes as ``data``.
    accepted : str, optional
        The file of a dataset that is accepted by hand. A run reads it and does not make it.
    page : bool
        Whether the dataset becomes a page in HTML.

    Examples
    --------
    >>> artifact = Artifact(
    ...     name="table1",
    ...     module="paper.exhibits.orbits",
    ...     figures="paper.exhibits.orbits_figures",
    ...     title="Table 1",
    ...     study="ranges",
    ...     table="table1",
    ... )
    >>> artifact.files
    ['results/figures/table1.nc', 'results/figures/table1.csv', 'results/figures/table1.md']
    >>> artifact.wing, artifact.dataset
    ('paper', 'results/figures/table1.nc')
    """

    name: str
    module: str
    figures: str
    title: str
    study: str | None = None
    places: str | None = None
    drawing: str | None = None
    table: str | None = None
    reads: tuple[str, ...] = ()
    accepted: str | None = None
    page: bool = False

    @property
    def wing(self) -> str:
        """The wing of the house, which is also the section of the configuration."""
        return self.module.partition(".")[0]

    @property
    def dataset(self) -> str | None:
        """The dataset that others read; None for a figure without data, such as a schematic."""
        if self.accepted:
            return self.accepted
        return f"{FOLDER}/{self.name}.nc" if self.study else None

    @property
    def files(self) -> list[str]:
        """The files that a run makes."""
        kinds = []
        if self.study and not self.accepted:
            kinds += ["nc"]
        if self.drawing:
            kinds += ["png", "svg"]
        if self.table:
            kinds += ["csv", "md"]
        if self.page:
            kinds += ["html"]
        return [f"{FOLDER}/{self.name}.{kind}" for kind in kinds]
