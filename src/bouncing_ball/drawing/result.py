"""The result of a public function: a labelled dataset that draws itself."""

from pathlib import Path
from typing import TYPE_CHECKING, Self

import xarray as xr

from bouncing_ball.errors import ModelError, extra

if TYPE_CHECKING:
    from matplotlib.figure import Figure

MADE_BY = "made_by"
"""The attribute with the name of the command or the call that made a result."""


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

    # The accessor of the same name of an xarray.Dataset is no method.
    def plot(self, path: str | Path | None = None) -> "Figure":  # type: ignore[override]
        """This result as a figure in the common style, which is written to ``path`` if it is given.

        The docstring of the call that made the result tells what the figure shows.

        Raises
        ------
        ModelError
            If the suffix of the path is not that of a picture, or the file cannot be written, or if
            a computation with the result has dropped its attributes.
        """
        if MADE_BY not in self.attrs:
            raise ModelError("this dataset has lost the attributes of the result of a call")
        with extra("plot"):
            from bouncing_ball.drawing.files import write
            from bouncing_ball.drawing.result_figures import FIGURES
            from bouncing_ball.drawing.style import style
        maker = self.attrs[MADE_BY]
        with style():
            figure = FIGURES[maker](self)
            if path is not None:
                write(figure, Path(path), f"bouncing-ball {maker}")
        return figure
