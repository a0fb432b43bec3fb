"""Results that draw themselves: a labelled dataset and its method ``plot()``."""

from abc import abstractmethod
from pathlib import Path
from typing import TYPE_CHECKING, ClassVar

from bouncing_ball.datasets.labelled import Labelled
from bouncing_ball.errors import extra

if TYPE_CHECKING:
    from matplotlib.figure import Figure


class Drawn(Labelled):
    """A labelled result of a call, and its figure.

    ``maker`` is the name of the command or of the call, for the description of the file.
    """

    __slots__ = ()

    maker: ClassVar[str]

    @abstractmethod
    def _figure(self) -> "Figure":
        """The figure in the current style of matplotlib, which is imported here."""

    # The accessor of the same name of an xarray.Dataset is no method.
    def plot(self, path: str | Path | None = None) -> "Figure":  # type: ignore[override]
        """This result as a figure in the common style, which is written to ``path`` if it is given.

        The docstring of the result's class tells what the figure shows.

        Raises
        ------
        ModelError
            If the suffix of the path is not that of a picture, or the file cannot be written.
        """
        with extra("plot"):
            from bouncing_ball.calls.figures import shown
        return shown(self._figure, path, self.maker)
