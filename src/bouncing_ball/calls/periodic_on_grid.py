"""Labelled results of periodic orbits, computed on the grid of arguments.

All quantities are dimensionless, and times are in units of 1/Ω. The axes of the arguments come
first in every result.
"""

from collections.abc import Callable, Sequence
from functools import partial
from typing import Any

import numpy as np
import xarray as xr

from bouncing_ball.datasets import CASE
from bouncing_ball.datasets.labelled import Grid
from bouncing_ball.datasets.variables import describe
from bouncing_ball.drawing.result import Result
from bouncing_ball.errors import NoOrbitError
from bouncing_ball.models.ball import Ball
from bouncing_ball.models.model import Model
from bouncing_ball.models.rigid import RestitutionModel
from bouncing_ball.numerics.continuation import ContinuationError
from bouncing_ball.periodic import n_t, observables
from bouncing_ball.periodic.branch import whole_branch
from bouncing_ball.periodic.observables import branch_columns, columns, joined, no_branch
from bouncing_ball.periodic.orbit import OBSERVABLES
from bouncing_ball.periodic.stability import Side

# The longest step along a branch, and as a fraction of the largest Λ, if that is large: a branch
# has some thousand points at most.
_LARGEST_STEP = 0.1
_STRIDE = 2e-3


def orbits_on_grid(ball: Ball, n: Any, amplitude: Any, side: Side) -> Result:
    """The orbit on one side of the saddle-node at each point of a grid; NaN where there is none."""

    def found(one: Ball, n: Any, amplitude: Any) -> dict[str, np.ndarray]:
        model = one.at_orbit(n, amplitude, side)
        return _observables(model, n, amplitude, side)

    grid = Grid(n=n, amplitude=amplitude, **ball.parameters)
    missing = _observables(RestitutionModel(1.0), 1, np.nan, Side.STABLE)
    rows = _each_place(grid, ball, ("n", "amplitude"), found, missing)
    return Result.of(grid.unfold(describe(rows, observables.VARIABLES)), "orbit")


def _observables(model: Model, n: Any, amplitude: Any, side: Side) -> dict[str, np.ndarray]:
    names = (name for name in OBSERVABLES if name != "amplitude")
    return columns(n_t.orbit(model, n, amplitude, side), *names)


def limits_on_grid(ball: Ball, n: Any) -> Result:
    """Amplitude and phase of the saddle-node and the period doubling at each point of a grid.

    The values are NaN where a family has no such bifurcation.
    """

    def found(one: Ball, n: Any) -> dict[str, np.ndarray]:
        model = one.at_limits(n)
        saddle_node = n_t.saddle_node(model, n)
        period_doubling = n_t.period_doubling(model, n)
        return {
            "saddle_node_amplitude": saddle_node.amplitude,
            "saddle_node_phase": saddle_node.phase,
            "period_doubling_amplitude": period_doubling.amplitude,
            "period_doubling_phase": period_doubling.phase,
        }

    grid = Grid(n=n, **ball.parameters)
    rows = _each_place(grid, ball, ("n",), found, {})
    return Result.of(grid.unfold(describe(rows, observables.VARIABLES)), "limits")


def permanent_contact_on_grid(ball: Model) -> Result:
    """The Λ up to which a ball stays on the table, at each point of the grid of its parameters."""
    grid = Grid(**ball.parameters)
    threshold = ball.row(grid).permanent_contact_threshold()
    rows = xr.Dataset({"threshold_amplitude": (CASE, threshold)})
    return Result.of(grid.unfold(describe(rows)), "permanent-contact")


def _each_place(
    grid: Grid,
    ball: Ball,
    names: Sequence[str],
    found: Callable[..., dict[str, Any]],
    missing: dict[str, Any],
) -> xr.Dataset:
    """The results at each place of a grid: those of the ball there and the named arguments.

    They are one computation if the models are known. A law that is given by the r and D of a free
    impact follows from a search at each place; where this finds no orbit, the result is
    ``missing``.
    """
    if not ball.is_known:
        return _by_place(
            grid,
            ball,
            names,
            found=lambda *given: xr.Dataset(found(*given)),
            missing=lambda _: xr.Dataset(missing),
        )
    values = found(ball.row(grid), *(grid.flat[name] for name in names))
    return xr.Dataset({name: (CASE, np.broadcast_to(x, grid.size)) for name, x in values.items()})


def _by_place(
    grid: Grid,
    ball: Ball,
    names: Sequence[str],
    found: Callable[..., xr.Dataset],
    missing: Callable[[NoOrbitError], xr.Dataset],
    joined: Callable[..., xr.Dataset] = xr.concat,
) -> xr.Dataset:
    """The results at each place of a grid, computed one after another."""
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


def branches_on_grid(ball: Ball, n: Any, amplitude_max: float | None, points: int) -> Result:
    """The branch at each point of a grid; NaN, with the reason, where there is no branch.

    The axes of the grid come first.

    Raises
    ------
    NoOrbitError
        If the grid is a single point, and there is no branch.
    """

    def found(one: Ball, n: int) -> xr.Dataset:
        return branch_of(one.at_limits(n), n, amplitude_max, points)

    grid = Grid(n=n, **ball.parameters)
    whole = _by_place(grid, ball, ("n",), found, partial(no_branch, points), joined)
    branches = Result.of(grid.unfold(describe(whole, observables.VARIABLES)), "branch")
    return branches if amplitude_max is None else branches.assign_attrs(amplitude_max=amplitude_max)


def branch_of(model: Any, n: int, amplitude_max: float | None, points: int) -> xr.Dataset:
    """The branch of n-T orbits of a single model up to some Λ, shape (point,).

    Raises
    ------
    NoOrbitError
        If the branch begins above this Λ, or if it cannot be followed.
    """
    longest = max(_LARGEST_STEP, _STRIDE * (amplitude_max or 0.0))
    try:
        found = whole_branch(model, n, amplitude_max, longest)
        return branch_columns(found, points)
    except ContinuationError as error:
        raise NoOrbitError(f"the branch of {n}-T orbits for {model.label}: {error}") from None
