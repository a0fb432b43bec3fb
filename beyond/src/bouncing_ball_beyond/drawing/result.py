"""Results of beyond's calls, which draw themselves."""

from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING

import xarray as xr

from bouncing_ball.drawing import result
from bouncing_ball.drawing.result import MADE_BY as MADE_BY

if TYPE_CHECKING:
    from matplotlib.figure import Figure


class Result(result.Result):
    """A labelled dataset whose ``plot()`` knows the figures of beyond's calls, too."""

    __slots__ = ()

    @staticmethod
    def figures() -> "Mapping[str, Callable[[xr.Dataset], Figure]]":
        """The figure of the result of each call, by its name."""
        from bouncing_ball_beyond.drawing.result_figures import FIGURES

        return FIGURES
