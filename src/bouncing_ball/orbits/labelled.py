"""Results of a model as labelled datasets: balls over time, and a branch over Λ.

All quantities are dimensionless, and times are in units of 1/Ω. Dimensions of the arguments come
first in every result.
"""

import math
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
import xarray as xr

from bouncing_ball.contacts.spring_damper import SpringDamper
from bouncing_ball.continuation.branch import Branch, ContinuationError, continue_both_ways
from bouncing_ball.continuation.events import parameter_bound
from bouncing_ball.continuation.step_control import StepControl
from bouncing_ball.datasets.labelled import CASE, Grid, Labelled
from bouncing_ball.datasets.variables import describe
from bouncing_ball.errors import ModelError, NoOrbitError, require
from bouncing_ball.motion.angles import table
from bouncing_ball.motion.history import History, history
from bouncing_ball.motion.landing import Flight, land
from bouncing_ball.motion.sequence import Status
from bouncing_ball.orbits.columns import branch_columns, columns, orbits_in_columns
from bouncing_ball.orbits.orbit import OBSERVABLES
from bouncing_ball.orbits.restitution_model import RestitutionModel
from bouncing_ball.orbits.spring_damper_model import SpringDamperModel
from bouncing_ball.orbits.stability import Side

# Number of impacts of a ball that are simulated at first, and the largest number.
_FIRST, _MOST = 64, 65_536
# States of all balls, of some fifty bytes each, with as much again while they are computed.
_STATES = 10_000_000
# By default a branch ends at this multiple of the Λ of its period doubling. A fold below the
# second number belongs to an elastic contact. The third is the number of orbits that are tried as
# starting points of a branch.
_BEYOND, _LOWEST, _STARTS = 1.4, 1e-4, 16
_STEPS = StepControl(largest=0.1)


def instants(periods: float, samples: int, balls: int) -> np.ndarray:
    """Times over some periods of the table, with ``samples`` of them in each period.

    Raises
    ------
    ModelError
        If the states of so many balls at all of them would fill the memory.

    Examples
    --------
    >>> (instants(1.0, 4, 1) / np.pi).tolist()
    [0.0, 0.5, 1.0, 1.5, 2.0]
    """
    count = math.ceil(periods * samples) + 1
    if count * balls > _STATES:
        raise ModelError(f"{count * balls} states in all are more than {_STATES}: ask for less")
    return np.linspace(0.0, 2 * np.pi * periods, count)


def _followed(model: Any, start: Sequence[np.ndarray], time: np.ndarray) -> list[History]:
    """The histories of balls from their first impacts (Λ, φ, z′_i), at times (ball, sample) since
    then.
    """
    impacts = _FIRST
    while True:
        found = model.simulate(*start, impacts)
        if not np.any((found.status == Status.BOUNCING) & (found.time[-1] <= time[:, -1])):
            return [history(found[k], each) for k, each in enumerate(time)]
        if impacts == _MOST:
            raise ModelError(f"a ball has more than {_MOST} impacts in this time: ask for less")
        impacts *= 4


def from_impact(model: Any, grid: Grid, time: np.ndarray) -> Labelled:
    """Balls and table over time from a first impact, with the (Λ, φ, z′_i) of a grid.

    ``ball``, ``ball_velocity``, ``table`` and ``contact`` are over (…, time).

    Raises
    ------
    ModelError
        If a ball has too many impacts in this time, or a parameter is outside its range.
    """
    start = np.atleast_1d(*(grid.flat[name] for name in ("amplitude", "phase", "velocity")))
    start = np.broadcast_arrays(*start, *grid.rows)[:3]
    return _over_time(grid, time, _followed(model, start, np.tile(time, (start[0].size, 1))))


def fall(grid: Grid) -> tuple[np.ndarray, ...]:
    """Λ, φ and z′_i at the first impacts of balls released at rest, and the times of fall.

    Raises
    ------
    ModelError
        If a ball is released below the table.
    """
    values = (np.atleast_1d(grid.flat[name]) for name in ("amplitude", "phase", "height"))
    lam, phi, z = (x * 1.0 for x in np.broadcast_arrays(*values, *grid.rows)[:3])
    rate, level = table(phi, lam)
    require(z >= level, z, "height", "at or above the table, Λ sin φ")
    flight = Flight(z - level, -rate, rate, level, lam)
    time = land(flight, flight.sure()).time
    return lam, phi + time, -time, time


def from_rest(model: Any, grid: Grid, time: np.ndarray) -> Labelled:
    """Balls and table over time since the balls were released at rest, with the (h, Λ, φ) of a
    grid.

    The variables are those of :func:`from_impact`.

    Raises
    ------
    ModelError
        If a ball is released below the table, or has too many impacts in this time.
    """
    *start, falling = fall(grid)
    balls = _followed(model, start, time - falling[:, np.newaxis])
    height = np.broadcast_to(grid.flat["height"], falling.shape)
    for k, ball in enumerate(balls):
        above = time < falling[k]
        balls[k] = ball._replace(
            height=np.where(above, height[k] - time * time / 2, ball.height),
            velocity=np.where(above, -time, ball.velocity),
            table=table(start[1][k] + (time - falling[k]), start[0][k])[1],
        )
    found = _over_time(grid, time, balls)
    found.time.attrs["long_name"] = "time since the ball was let go"
    return found


def _over_time(grid: Grid, time: np.ndarray, balls: list[History]) -> Labelled:
    columns = {"ball": "height", "ball_velocity": "velocity", "table": "table"}
    columns |= {"contact": "touching"}
    of_balls = {
        name: ((CASE, "time"), np.array([getattr(ball, each) for ball in balls]))
        for name, each in columns.items()
    }
    found = describe(xr.Dataset(of_balls, {"time": time}))
    return grid.unfold(found.assign_attrs(kind="history"))


def branches(
    grid: Grid, models: Callable[..., Any], amplitude_max: float | None, points: int
) -> Labelled:
    """The branch at each place of a grid; NaN, with the reason, where there is none.

    The variables are those of :func:`~bouncing_ball.orbits.columns.orbits_in_columns`, behind the
    axes of the grid. ``models`` gives the model of n and the other arguments.

    Raises
    ------
    NoOrbitError
        If a grid of one place has no branch.
    """
    rows = []
    for cell in grid.cells():
        n = cell.pop("n")
        try:
            found = branch(models(n, **cell), n, amplitude_max, points)
        except NoOrbitError as error:
            if not grid.shape:
                raise
            missing = SpringDamperModel(SpringDamper(1.0, 0.0)).system(n)
            none = missing.orbit(np.full((points, 4), np.nan))
            found = orbits_in_columns(none, none[:0], [], [str(error)] * 2)
        rows.append(found)
    whole = xr.concat(rows, CASE, join="outer")
    whole = describe(whole.assign(special_kind=whole.special_kind.fillna("").astype(str)))
    if amplitude_max is not None:
        grid.attrs["amplitude_max"] = float(amplitude_max)
    return grid.unfold(whole.assign_attrs(kind="branch"))


def orbits(grid: Grid, models: Callable[..., Any], side: str) -> Labelled:
    """The orbit on a side of the saddle-node at each place of a grid; NaN where there is none.

    The variables are the observables, ``stable`` and ``admissible``, over the axes of the grid.
    """

    def found(n: Any, amplitude: Any, **impact: Any) -> dict[str, np.ndarray]:
        orbit = models(n, amplitude, Side(side), **impact).orbit(n, amplitude, Side(side))
        return columns(orbit, *(name for name in OBSERVABLES if name != "amplitude"))

    return _each_case(grid, found, "orbit")


def limits(grid: Grid, models: Callable[..., Any]) -> Labelled:
    """Amplitude and phase of saddle-node and period doubling at each place of a grid.

    NaN where a family has no such bifurcation.
    """

    def found(n: Any, **impact: Any) -> dict[str, np.ndarray]:
        model = models(n, **impact)
        ends = {"saddle_node": model.saddle_node(n), "period_doubling": model.period_doubling(n)}
        parts = ("amplitude", "phase")
        return {f"{end}_{x}": getattr(orbit, x) for end, orbit in ends.items() for x in parts}

    return _each_case(grid, found, "limits")


def _each_case(grid: Grid, found: Callable[..., dict[str, np.ndarray]], kind: str) -> Labelled:
    """The results at each place of a grid, in one computation unless a law is given by its name.

    The parameters of a law follow from a search, for one r at a time.
    """
    if "law" in grid.flat:
        cells = [_one_case(found, cell) for cell in grid.cells()]
        whole = xr.concat(cells, CASE)
    else:
        values = {name: np.broadcast_to(x, grid.size) for name, x in found(**grid.flat).items()}
        whole = xr.Dataset({name: (CASE, x) for name, x in values.items()})
    return grid.unfold(describe(whole).assign_attrs(kind=kind))


def _one_case(found: Callable[..., dict[str, np.ndarray]], cell: dict[str, Any]) -> xr.Dataset:
    try:
        return xr.Dataset(found(**cell))
    except NoOrbitError:
        none = RestitutionModel(1.0).orbit(1, -1.0)
        return xr.Dataset(columns(none, *(name for name in OBSERVABLES if name != "amplitude")))


def branch(model: Any, n: int, amplitude_max: float | None, points: int) -> xr.Dataset:
    """The branch of n-T orbits of a single model up to some Λ, shape (point,).

    Raises
    ------
    NoOrbitError
        If there is none up to there, or if it cannot be followed.
    """
    fold, doubling = (float(f(n).amplitude) for f in (model.saddle_node, model.period_doubling))
    low = fold if fold > 0 else 0.0
    top = amplitude_max or _BEYOND * (doubling if doubling > low else max(2 * low, 1.0))
    if low >= top:
        raise NoOrbitError(
            f"no {n}-T orbit up to Λ = {top:g} for {model.label}: "
            f"the branch begins at Λ = {low:.6g}"
        )
    try:
        found = branch_columns(
            model.system(n), _along(model, n, low, min(doubling, top), top), points
        )
    except ContinuationError as error:
        raise NoOrbitError(f"the branch of {n}-T orbits for {model.label}: {error}") from None
    return found


def _along(model: Any, n: int, low: float, stable: float, top: float) -> Branch:
    system = model.system(n)
    # From the middle of the stable range, or the next orbit beside it.
    tried = np.linspace(low, top, _STARTS + 1)[1:]
    middle = (low + (stable if stable > low else top)) / 2
    tried = np.append(middle, tried[np.argsort(np.abs(tried - middle))])
    orbits = model.orbit(n, tried)
    if not np.any(orbits.exists):
        raise ContinuationError("no orbit to start from was found")
    found = continue_both_ways(
        system,
        system.point(orbits[int(np.argmax(orbits.exists))]),
        events=(
            *system.events(),
            parameter_bound(_LOWEST, False, f"left the window at Λ = {_LOWEST:g}"),
            parameter_bound(top, True, f"left the window at Λ = {top:g}"),
        ),
        control=_STEPS,
    )
    for end in (found.start, found.end):
        if not end.finished:
            raise ContinuationError(f"not followed to its end: {end}")
    return found
