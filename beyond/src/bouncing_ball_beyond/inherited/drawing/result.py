"""Labelled datasets that draw themselves: results of public functions, and files of a run."""

import re
from collections.abc import Callable, Iterable, Mapping
from importlib import import_module
from pathlib import Path
from typing import TYPE_CHECKING, Any, Self

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike

from bouncing_ball_beyond.inherited.datasets import CASE, DRAWING
from bouncing_ball_beyond.inherited.datasets.labelled import Grid
from bouncing_ball_beyond.inherited.datasets.variables import described
from bouncing_ball_beyond.inherited.errors import (
    ModelError,
    ParameterError,
    extra,
    one_of,
    shortened,
    suggesting,
)

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

MADE_BY = "made_by"
"""The attribute with the name of the command or the call that made a result."""
# A file may name any function, and only one that draws is called.
_FUNCTION = re.compile(r"(bouncing_ball_\w+(?:\.[a-z]\w*)*[._]figures):([a-z]\w*)")


class Result(xr.Dataset):
    """A labelled dataset with the method ``plot()``.

    The call that made it is among its attributes, so that a part of a result, such as
    ``found.isel(n=0)``, and results that are joined have their figure as well.

    Examples
    --------
    >>> found = Result.of(xr.Dataset({"phase": ("n", [0.5])}), "orbit")
    >>> type(found.isel(n=0)).__name__, found.isel(n=0).attrs
    ('Result', {'made_by': 'orbit'})
    """

    __slots__ = ()

    @classmethod
    def of(cls, found: xr.Dataset, made_by: str) -> Self:
        """A dataset as the result of a command or a call, of which this is the name."""
        return cls(found.data_vars, found.coords, {**found.attrs, MADE_BY: made_by})

    @classmethod
    def on_grid(cls, grid: Grid, columns: Mapping[str, ArrayLike], made_by: str) -> Self:
        """The result of a call for each place of a grid, with the axes of the grid.

        ``columns`` has an entry for each place, one after another, or one entry for all.

        Examples
        --------
        >>> found = Result.on_grid(Grid(n=[1, 2]), {"phase": [0.5, 1.0]}, "orbit")
        >>> found.phase.sel(n=2).item()
        1.0
        """
        rows = {name: (CASE, np.broadcast_to(x, grid.size)) for name, x in columns.items()}
        return cls.of(grid.unfold(described(rows)), made_by)

    # The accessor of the same name of an xarray.Dataset is no method.
    def plot(  # type: ignore[override]
        self,
        path: str | Path | None = None,
        *,
        ax: "Axes | Iterable[Axes] | None" = None,
        size: tuple[float, float] | None = None,
        font_size: float | None = None,
    ) -> "Figure":
        """This result as a figure in the common style, which is written to ``path`` if it is given.

        The docstring of the call that made the result tells what the figure shows. The dataset of
        an artifact has the figure of the artifact.

        Parameters
        ----------
        path : str or Path, optional
            A file that ends in ``.pdf``, ``.png`` or ``.svg``. In PDF and SVG texts are text.
        ax : Axes, or several, optional
            Axes of matplotlib into which the figure is drawn, one for each of its panels; the
            legend is then in the first one.
        size : tuple of float, optional
            Width and height in inches.
        font_size : float, optional
            Size of titles and labels in points; all other texts keep their proportion to it.

        Raises
        ------
        ModelError
            If the suffix of the path is not that of a picture, or the file cannot be written, if
            a computation with the result has dropped its attributes, if an artifact has no
            figure, or if the number of axes is not that of the panels.
        """
        with extra("plot"):
            from bouncing_ball_beyond.inherited.drawing.files import write
            from bouncing_ball_beyond.inherited.drawing.fitted import (
                axes_in,
                drawn_into,
                fit_figure,
            )
            from bouncing_ball_beyond.inherited.drawing.style import style
        draw, title = self._drawing()
        with style():
            with drawn_into(ax):
                figure = draw(self)
            if (size, font_size) != (None, None):
                fit_figure(figure, axes_in(ax), size, font_size)
            if path is not None:
                write(figure, Path(path), title)
        return figure

    @staticmethod
    def figures() -> "Mapping[str, Callable[[xr.Dataset], Figure]]":
        """The figure of the result of each call, by its name."""
        from bouncing_ball_beyond.inherited.drawing.result_figures import FIGURES

        return FIGURES

    def _drawing(self) -> "tuple[Callable[[xr.Dataset], Figure], str]":
        """The function that draws this dataset, and the title of the file of the figure."""
        if MADE_BY in self.attrs:
            maker = self.attrs[MADE_BY]
            return one_of("call", maker, self.figures()), f"bouncing-ball {maker}"
        if DRAWING in self.attrs:
            return _function(self.attrs[DRAWING]), str(self.attrs["title"])
        if "title" in self.attrs:
            raise ModelError(f"the dataset {self.attrs['title']!r} has no figure")
        raise ModelError("this dataset has lost the attributes of the result of a call")


@suggesting
def open(path: str | Path) -> Result:
    """The dataset in a netCDF file, such as that of an artifact of the replication.

    ``bouncing_ball_beyond.inherited.open("figures/fig06.nc").plot("talk.pdf")`` draws the
    artifact's figure from it.

    Raises
    ------
    ModelError
        If there is no such file, or if it is damaged.
    """
    # Imported here, because studies make results and read no files.
    from bouncing_ball_beyond.inherited.datasets.files import read_dataset

    if not isinstance(path, str | Path):
        raise ParameterError("{path} = {} is not the path of a file", shortened(path))
    data = read_dataset(path)
    return Result(data.data_vars, data.coords, data.attrs)


def _function(name: str) -> Callable[..., Any]:
    """The function of this package that a dataset names as ``package.module:function``.

    This is the only place of the library that imports by a name, because the functions that draw
    artifacts are above it. Only modules of figures are imported, and of their functions only those
    of the package that return a figure are called: a module may share one with the calls, as that
    of Figs. 8 and 9 does.
    """
    found = _FUNCTION.fullmatch(str(name))
    if not found:
        raise ModelError(f"drawing = {shortened(name)} is no function of this package that draws")
    try:
        function = getattr(import_module(found[1]), found[2])
    except (ModuleNotFoundError, AttributeError):
        raise ModelError(f"this version of the package has no {name}, which draws it") from None
    returned = getattr(function, "__annotations__", {}).get("return")
    ours = getattr(function, "__module__", "").startswith("bouncing_ball_")
    if not ours or getattr(returned, "__name__", "") != "Figure":
        raise ModelError(f"drawing = {shortened(name)} is no function of this package that draws")
    return function
