"""Artifacts: a dataset, with the figure and the table that are made from it."""

from dataclasses import dataclass


@dataclass(frozen=True)
class Artifact:
    """An artifact of a house, see :mod:`bouncing_ball_beyond.inherited.pipeline.artifact_files`.

    Parameters
    ----------
    name : str
        The name on the command line, in the configuration and of the files.
    title : str
        The title of the dataset.
    drawing : str, optional
        The function that draws the dataset, ``module:function``, as the dataset names it.

    Examples
    --------
    >>> Artifact("fig14", "Figure 14: greatest height of both models").place
    'figures/fig14'
    """

    name: str
    title: str
    drawing: str = ""

    @property
    def place(self) -> str:
        """The path of its files in a run and in the record, without their suffixes."""
        return f"figures/{self.name}"


def by_name(*artifacts: Artifact) -> dict[str, Artifact]:
    """Artifacts by their names."""
    return {each.name: each for each in artifacts}
