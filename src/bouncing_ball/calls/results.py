"""Results of a model as labelled datasets: balls over time, and a branch over Λ.

All quantities are dimensionless, and times are in units of 1/Ω. The dimensions of the arguments
come first in every result.
"""

import math
from collections.abc import Callable, Sequence
from functools import partial
from typing import Any

import numpy as np
import xarray as xr

from bouncing_ball.datasets import CASE
from bouncing_ball.datasets.labelled import Grid, Labelled
from bouncing_ball.datasets.variables import describe
from bouncing_ball.errors import ModelError, NoOrbitError, require
from bouncing_ball.numerics.continuation import ContinuationError
from bouncing_ball.paper.motion.flight import Flight, land, table
from bouncing_ball.paper.motion.history import history as of_one_ball
from bouncing_ball.paper.motion.sequence import Status
from bouncing_ball.paper.orbits import observables
from bouncing_ball.paper.orbits.branch import whole_branch
from bouncing_ball.paper.orbits.observables import branch_columns, columns, joined, no_branch
from bouncing_ball.paper.orbits.orbit import OBSERVABLES, Orbit
from bouncing_ball.paper.orbits.restitution_model import RestitutionModel
from bouncing_ball.paper.orbits.stability import Side

# Number of impacts of a ball that are simulated at first, and the largest number allowed.
_FIRST, _MOST = 64, 65_536
# Largest number of states of all balls. A state takes about fifty bytes, and as much again while
# it is computed.
_STATES = 10_000_000
_LARGEST_STEP = 0.1
_SHOWN = {"ball": "height", "ball_velocity": "velocity", "table": "table", "contact": "touching"}


def instants(periods: float, samples: int, balls: int) -> np.ndarray:
    """Times over several periods of the table, with ``samples`` times in each period.

    Raises
    ------
    ModelError
        If the states of this many balls at all these times would fill the memory.

    Examples
    --------
    >>> (instants(1.0, 4, 1) / np.pi).tolist()
    [0.0, 0.5, 1.0, 1.5, 2.0]
    """
    count = math.ceil(periods * samples) + 1
    if count * balls > _STATES:
        raise ModelError(
            f"{count * balls} states exceed the limit of {_STATES}: use fewer samples or balls"
        )
    return np.linspace(0.0, 2 * np.pi * periods, count)


def history(grid: Grid, models: Callable[..., Any], periods: float, samples: int) -> Labelled:
    """Balls and table over time, from the first impacts (Λ, φ, z′_i) of a grid.

    ``ball``, ``ball_velocity``, ``table`` and ``contact`` are over (…, time). ``models`` returns
    the model for the first impact and the other arguments of the grid.

    Raises
    ------
    ModelError
        If a ball has too many impacts in this time, or a parameter is outside its range.
    """
    time = instants(periods, samples, grid.size)
    start = [grid.row(name) for name in ("amplitude", "phase", "velocity")]
    since = np.broadcast_to(time, (grid.size, time.size))
    return _over_time(grid, time, _followed(models(**grid.flat), start, since))


def drop(grid: Grid, models: Callable[..., Any], periods: float, samples: int) -> Labelled:
    """Balls and table over time since the balls were released at rest at the height h, with the
    (h, Λ, φ) of a grid.

    The variables are those of :func:`history`. ``models`` returns the model for the first impact.

    Raises
    ------
    ModelError
        If a ball is released below the table, or has too many impacts in this time.
    """
    time = instants(periods, samples, grid.size)
    height, lam, phi = (grid.row(name) for name in ("height", "amplitude", "phase"))
    rate, level = table(phi, lam)
    require(height >= level, height, "height", "at or above the table, Λ sin φ")
    flight = Flight(height - level, -rate, rate, level, lam)
    falling = land(flight, flight.sure()).time
    start = lam, phi + falling, -falling
    impact = {k: x for k, x in grid.flat.items() if k not in ("height", "amplitude", "phase")}
    h, fall, lam, phi = (x[:, np.newaxis] for x in (height, falling, lam, start[1]))
    found = _followed(models(*start, **impact), start, time - fall)
    above = time < fall
    found["ball"] = np.where(above, h - time * time / 2, found["ball"])
    found["ball_velocity"] = np.where(above, -time, found["ball_velocity"])
    found["table"] = table(phi + (time - fall), lam)[1]
    labelled = _over_time(grid, time, found)
    labelled.time.attrs["long_name"] = "time since the ball was let go"
    return labelled


def _followed(model: Any, start: Sequence[np.ndarray], time: np.ndarray) -> dict[str, np.ndarray]:
    """The variables of :func:`history` for balls at times (ball, sample) since their first
    impacts (Λ, φ, z′_i).
    """
    impacts = _FIRST
    while True:
        found = model.simulate(*start, impacts)
        if not np.any((found.status == Status.BOUNCING) & (found.time[-1] <= time[:, -1])):
            balls = [of_one_ball(found[k], each) for k, each in enumerate(time)]
            return {name: np.array([getattr(x, y) for x in balls]) for name, y in _SHOWN.items()}
        if impacts == _MOST:
            raise ModelError(
                f"a ball has more than {_MOST} impacts in this time: use fewer periods"
            )
        impacts *= 4


def _over_time(grid: Grid, time: np.ndarray, found: dict[str, np.ndarray]) -> Labelled:
    rows = {name: ((CASE, "time"), values) for name, values in found.items()}
    return _unfolded(grid, xr.Dataset(rows, {"time": time}), "history")


def _unfolded(grid: Grid, rows: xr.Dataset, kind: str) -> Labelled:
    return grid.unfold(describe(rows, observables.VARIABLES).assign_attrs(kind=kind))


def branches(
    grid: Grid, models: Callable[..., Any], amplitude_max: float | None, points: int
) -> Labelled:
    """The branch at each point of a grid; NaN, with the reason, where there is no branch.

    The variables are those of :func:`~bouncing_ball.paper.orbits.observables.orbits_in_columns`; the axes of
    the grid come first. ``models`` returns the model for n and the other arguments.

    Raises
    ------
    NoOrbitError
        If the grid is a single point, and there is no branch.
    """

    def found(n: int, **impact: Any) -> xr.Dataset:
        return branch(models(n, **impact), n, amplitude_max, points)

    whole = _by_place(grid, found, partial(no_branch, points), joined)
    if amplitude_max is not None:
        grid.attrs["amplitude_max"] = float(amplitude_max)
    return _unfolded(grid, whole, "branch")


def orbits(grid: Grid, models: Callable[..., Any], side: Side) -> Labelled:
    """The orbit on one side of the saddle-node at each point of a grid; NaN where there is none.

    The variables are the observables, ``stable`` and ``admissible``, over the axes of the grid.
    """

    def named(orbit: Orbit) -> dict[str, np.ndarray]:
        return columns(orbit, *(name for name in OBSERVABLES if name != "amplitude"))

    def found(n: Any, amplitude: Any, **impact: Any) -> dict[str, np.ndarray]:
        return named(models(n, amplitude, side, **impact).orbit(n, amplitude, side))

    return _each_case(grid, found, "orbit", named(RestitutionModel(1.0).orbit(1, np.nan)))


def limits(grid: Grid, models: Callable[..., Any]) -> Labelled:
    """Amplitude and phase of the saddle-node and the period doubling at each point of a grid.

    The values are NaN where a family has no such bifurcation.
    """

    def found(n: Any, **impact: Any) -> dict[str, np.ndarray]:
        model = models(n, **impact)
        ends = {"saddle_node": model.saddle_node(n), "period_doubling": model.period_doubling(n)}
        parts = ("amplitude", "phase")
        return {f"{end}_{x}": getattr(orbit, x) for end, orbit in ends.items() for x in parts}

    return _each_case(grid, found, "limits", {})


def _each_case(
    grid: Grid, found: Callable[..., dict[str, Any]], kind: str, missing: dict[str, Any]
) -> Labelled:
    """The results at each point of a grid, in one computation unless a law is given by its name.

    The parameters of such a law follow from a search, which treats one r at a time.
    """
    if "law" in grid.flat:
        rows = _by_place(grid, lambda **at: xr.Dataset(found(**at)), lambda _: xr.Dataset(missing))
    else:
        values = {name: np.broadcast_to(x, grid.size) for name, x in found(**grid.flat).items()}
        rows = xr.Dataset({name: (CASE, x) for name, x in values.items()})
    return _unfolded(grid, rows, kind)


def _by_place(
    grid: Grid,
    found: Callable[..., xr.Dataset],
    missing: Callable[[NoOrbitError], xr.Dataset],
    joined: Callable[..., xr.Dataset] = xr.concat,
) -> xr.Dataset:
    """The results at each point of a grid, computed one after another."""
    rows = []
    for place in grid.cells():
        try:
            rows.append(found(**place))
        except NoOrbitError as error:
            if not grid.shape:
                raise
            rows.append(missing(error))
    return joined(rows, CASE)


def branch(model: Any, n: int, amplitude_max: float | None, points: int) -> xr.Dataset:
    """The branch of n-T orbits of a single model up to some Λ, shape (point,).

    Raises
    ------
    NoOrbitError
        If the branch begins above this Λ, or if it cannot be followed.
    """
    try:
        found = whole_branch(model, n, amplitude_max, _LARGEST_STEP)
        return branch_columns(model.system(n), found, points)
    except ContinuationError as error:
        raise NoOrbitError(f"the branch of {n}-T orbits for {model.label}: {error}") from None
