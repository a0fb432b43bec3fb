"""Results for balls at each place of the grid that the arguments of a call span."""

from collections.abc import Callable, Mapping, Sequence
from typing import Any

import numpy as np
import xarray as xr

from bouncing_ball_beyond.drawing.result import Result
from bouncing_ball_beyond.inherited.datasets import CASE
from bouncing_ball_beyond.inherited.datasets.arguments import require_memory
from bouncing_ball_beyond.inherited.datasets.labelled import Grid
from bouncing_ball_beyond.inherited.datasets.variables import describe
from bouncing_ball_beyond.inherited.errors import NoOrbitError
from bouncing_ball_beyond.models.ball import Ball
from bouncing_ball_beyond.periodic.branches.observables import OF_BRANCHES

# Largest number of results that are computed one after another; each is a dataset, which takes 4 to
# 20 kilobytes.
_MOST_RESULTS = 100_000


def dataset_of_places(
    made_by: str,
    ball: Ball,
    arguments: Mapping[str, Any],
    found: Callable[..., dict[str, Any]],
    missing: Mapping[str, Any] | None = None,
) -> Result:
    """A dataset with an axis for each argument and each parameter of the ball that is an array.

    Parameters
    ----------
    made_by : str
        The name of the call, which selects the figure of the result.
    ball : Ball
    arguments : mapping
        The arguments by name.
    found : callable
        The variables for a ball and the values of the arguments; all places are one computation if
        the models are known.
    missing : mapping, optional
        The variables at a place where there is no orbit. It is needed for a law that is given by
        the r and D of a free impact, which follows from a search at each place.
    """
    grid = Grid(**arguments, **ball.parameters)
    names = list(arguments)
    if ball.is_known:
        values = found(ball.row(grid), *(grid.flat[name] for name in names))
        columns = {name: (CASE, np.broadcast_to(x, grid.size)) for name, x in values.items()}
        rows = xr.Dataset(columns)
    else:
        rows = by_place(
            grid,
            ball,
            names,
            found=lambda *given: xr.Dataset(found(*given)),
            missing=lambda _: xr.Dataset(missing or {}),
        )
    return Result.of(grid.unfold(describe(rows, OF_BRANCHES)), made_by)


def by_place(
    grid: Grid,
    ball: Ball,
    names: Sequence[str],
    found: Callable[..., xr.Dataset],
    missing: Callable[[NoOrbitError], xr.Dataset],
    joined: Callable[..., xr.Dataset] = xr.concat,
) -> xr.Dataset:
    """The results at each place of a grid, computed one after another.

    Raises
    ------
    ParameterError
        If they would fill the memory.
    """
    require_memory(grid.size, "results", "values", _MOST_RESULTS)
    balls = ball.row(grid)
    rows = []
    for number, place in enumerate(grid.cells()):
        try:
            rows.append(found(balls.take(number), *(place[name] for name in names)))
        except NoOrbitError as error:
            if not grid.shape:
                raise
            rows.append(missing(error))
    return joined(rows, CASE)
