"""Results of beyond's calls, which draw themselves."""

from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING, Any

import xarray as xr

from bouncing_ball_beyond.inherited.drawing import result
from bouncing_ball_beyond.inherited.drawing.result import MADE_BY as MADE_BY
from bouncing_ball_beyond.inherited.errors import did_you_mean

if TYPE_CHECKING:
    from matplotlib.figure import Figure


class Result(result.Result):
    """A labelled dataset whose ``plot()`` knows the figures of beyond's calls, too.

    An unknown attribute is answered with the variable that it resembles.

    Examples
    --------
    >>> Result({"phase": ("n", [0.5])}).phse
    Traceback (most recent call last):
    AttributeError: 'Result' object has no attribute 'phse'; did you mean phase?
    """

    __slots__ = ()

    # A type checker would accept every attribute.
    if not TYPE_CHECKING:

        def __getattr__(self, name: str) -> Any:
            try:
                return super().__getattr__(name)
            except AttributeError as error:
                known = () if name.startswith("_") else map(str, self.variables)
                raise AttributeError(f"{error}{did_you_mean(name, known)}") from None

    @staticmethod
    def figures() -> "Mapping[str, Callable[[xr.Dataset], Figure]]":
        """The figure of the result of each call, by its name."""
        from bouncing_ball_beyond.drawing.result_figures import FIGURES

        return FIGURES
