"""Labelled results of periodic orbits and of balls over time, computed on the grid of arguments.

All quantities are dimensionless, and times are in units of 1/Ω. The axes of the arguments come
first in every result. Each class of results has the method ``plot()``, which draws its figure.
"""

import math
from collections.abc import Callable, Sequence
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
import xarray as xr

from bouncing_ball.calls.balls import Ball, ModelBall
from bouncing_ball.datasets import CASE
from bouncing_ball.datasets.labelled import Grid, Labelled
from bouncing_ball.datasets.variables import Variable, describe
from bouncing_ball.errors import ModelError, NoOrbitError, extra, require
from bouncing_ball.numerics.continuation import ContinuationError
from bouncing_ball.paper.motion.flight import Flight, land, table
from bouncing_ball.paper.motion.history import history as of_one_ball
from bouncing_ball.paper.motion.sequence import ImpactSequence, Status
from bouncing_ball.paper.orbits import observables
from bouncing_ball.paper.orbits.branch import whole_branch
from bouncing_ball.paper.orbits.model import ImpactModel
from bouncing_ball.paper.orbits.observables import branch_columns, columns, joined, no_branch
from bouncing_ball.paper.orbits.orbit import OBSERVABLES
from bouncing_ball.paper.orbits.restitution_model import RestitutionModel
from bouncing_ball.paper.orbits.stability import Side

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_OF_SIMULATIONS = {
    "impact": Variable("number of the impact"),
    "impact_phase": Variable("phase of the table at the impact", symbol="φ", units="rad"),
    "status": Variable("what the ball does after the last of these impacts"),
}
# Number of impacts of a ball that are simulated at first, and the largest number allowed.
_FIRST, _MOST = 4, 65_536
# Largest number of states of all balls. A state takes about fifty bytes, and as much again while
# it is computed.
_STATES = 10_000_000
_LARGEST_STEP = 0.1


class Orbits(Labelled):
    """Orbits over the axes of the arguments: the observables, ``stable`` and ``admissible``."""

    __slots__ = ()

    def plot(self, path: str | Path | None = None) -> "Figure":  # type: ignore[override]
        """Phase of impact and greatest height over the last axis, as a figure, which is written to
        ``path`` if it is given.

        Raises
        ------
        ModelError
            If the suffix of the path is not that of a picture, or the file cannot be written.
        """
        with extra("plot"):
            from bouncing_ball.calls import figures
        return figures.shown(figures.orbits, self, path, "orbit")


class Limits(Labelled):
    """Amplitude and phase of saddle-nodes and period doublings over the axes of the arguments."""

    __slots__ = ()

    def plot(self, path: str | Path | None = None) -> "Figure":  # type: ignore[override]
        """Both limits over the last axis, as a figure; for the path see :meth:`Orbits.plot`."""
        with extra("plot"):
            from bouncing_ball.calls import figures
        return figures.shown(figures.limits, self, path, "limits")


class PermanentContact(Labelled):
    """The Λ up to which a ball stays on the table, over the axes of the arguments."""

    __slots__ = ()

    def plot(self, path: str | Path | None = None) -> "Figure":  # type: ignore[override]
        """The threshold over the last axis, as a figure; for the path see :meth:`Orbits.plot`."""
        with extra("plot"):
            from bouncing_ball.calls import figures
        return figures.shown(figures.permanent_contact, self, path, "permanent-contact")


class Branches(Labelled):
    """Branches of orbits over Λ; the variables are those of
    :func:`~bouncing_ball.paper.orbits.observables.orbits_in_columns`.
    """

    __slots__ = ()

    def plot(self, path: str | Path | None = None) -> "Figure":  # type: ignore[override]
        """The phases of the branches over Λ, as a figure; for the path see :meth:`Orbits.plot`."""
        with extra("plot"):
            from bouncing_ball.calls import figures
            from bouncing_ball.paper.exhibits.continuation_of_orbits_figures import over_amplitude
        return figures.shown(over_amplitude, self, path, "branch")


class Simulation(Labelled):
    """Sequences of impacts; the last axis is ``impact``."""

    __slots__ = ()

    def plot(self, path: str | Path | None = None) -> "Figure":  # type: ignore[override]
        """Phases and velocities of the impacts over time, as a figure; for the path see
        :meth:`Orbits.plot`.
        """
        with extra("plot"):
            from bouncing_ball.calls import figures
        return figures.shown(figures.impacts, self, path, "simulate")


class History(Labelled):
    """Balls and table over time; the last axis is ``time``."""

    __slots__ = ()

    def plot(self, path: str | Path | None = None) -> "Figure":  # type: ignore[override]
        """Heights over time, as a figure; for the path see :meth:`Orbits.plot`."""
        with extra("plot"):
            from bouncing_ball.calls import figures
        return figures.shown(figures.over_time, self, path, "history")


def orbits_on_grid(ball: Ball, n: Any, amplitude: Any, side: Side) -> Orbits:
    """The orbit on one side of the saddle-node at each point of a grid; NaN where there is none."""

    def found(one: Ball, n: Any, amplitude: Any) -> dict[str, np.ndarray]:
        model = one.at_orbit(n, amplitude, side).model
        return _observables(model, n, amplitude, side)

    grid = Grid(n=n, amplitude=amplitude, **ball.parameters)
    missing = _observables(RestitutionModel(1.0), 1, np.nan, Side.STABLE)
    rows = _each_place(grid, ball, ("n", "amplitude"), found, missing)
    return grid.unfold(describe(rows, observables.VARIABLES), Orbits)


def _observables(model: ImpactModel, n: Any, amplitude: Any, side: Side) -> dict[str, np.ndarray]:
    names = (name for name in OBSERVABLES if name != "amplitude")
    return columns(model.orbit(n, amplitude, side), *names)


def limits_on_grid(ball: Ball, n: Any) -> Limits:
    """Amplitude and phase of the saddle-node and the period doubling at each point of a grid.

    The values are NaN where a family has no such bifurcation.
    """

    def found(one: Ball, n: Any) -> dict[str, np.ndarray]:
        model = one.at_limits(n).model
        saddle_node = model.saddle_node(n)
        period_doubling = model.period_doubling(n)
        return {
            "saddle_node_amplitude": saddle_node.amplitude,
            "saddle_node_phase": saddle_node.phase,
            "period_doubling_amplitude": period_doubling.amplitude,
            "period_doubling_phase": period_doubling.phase,
        }

    grid = Grid(n=n, **ball.parameters)
    rows = _each_place(grid, ball, ("n",), found, {})
    return grid.unfold(describe(rows, observables.VARIABLES), Limits)


def permanent_contact_on_grid(ball: ModelBall) -> PermanentContact:
    """The Λ up to which a ball stays on the table, at each point of the grid of its parameters."""
    grid = Grid(**ball.parameters)
    threshold = ball.row(grid).model.permanent_contact_threshold()
    rows = xr.Dataset({"threshold_amplitude": (CASE, threshold)})
    return grid.unfold(describe(rows), PermanentContact)


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


def branches_on_grid(ball: Ball, n: Any, amplitude_max: float | None, points: int) -> Branches:
    """The branch at each point of a grid; NaN, with the reason, where there is no branch.

    The axes of the grid come first.

    Raises
    ------
    NoOrbitError
        If the grid is a single point, and there is no branch.
    """

    def found(one: Ball, n: int) -> xr.Dataset:
        return branch_of(one.at_limits(n).model, n, amplitude_max, points)

    grid = Grid(n=n, **ball.parameters)
    whole = _by_place(grid, ball, ("n",), found, partial(no_branch, points), joined)
    branches = grid.unfold(describe(whole, observables.VARIABLES), Branches)
    return branches if amplitude_max is None else branches.assign_attrs(amplitude_max=amplitude_max)


def branch_of(model: Any, n: int, amplitude_max: float | None, points: int) -> xr.Dataset:
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


class _Starts(NamedTuple):
    """First impacts of a row of balls: Λ, the table's phase φ, and z′_i, each of shape (ball,)."""

    amplitude: np.ndarray
    phase: np.ndarray
    velocity: np.ndarray

    @classmethod
    def on(cls, grid: Grid) -> "_Starts":
        """The first impacts that are given by the arguments of a call."""
        return cls(grid.row("amplitude"), grid.row("phase"), grid.row("velocity"))

    def model(self, ball: Ball, grid: Grid) -> ImpactModel:
        """The model of each ball, whose law may depend on the speed of its first impact."""
        speed = self.amplitude * np.cos(self.phase) - self.velocity
        return ball.row(grid).at_speed(speed if grid.shape else float(speed[0])).model


def model_of_starts(ball: Ball, grid: Grid) -> ImpactModel:
    """The model of the balls that start with the impacts (Λ, φ, z′_i) of a grid."""
    return _Starts.on(grid).model(ball, grid)


def impacts_on_grid(
    ball: Ball, amplitude: Any, phase: Any, velocity: Any, impacts: int
) -> Simulation:
    """Sequences of impacts from the first impacts (Λ, φ, z′_i) of a grid.

    Raises
    ------
    ModelError
        If a state is outside its range, or if a ball rises from the table.
    """
    grid = Grid(amplitude=amplitude, phase=phase, velocity=velocity, **ball.parameters)
    starts = _Starts.on(grid)
    sequence = starts.model(ball, grid).simulate(*starts, impacts)
    status = [Status(number).name.lower().replace("_", " ") for number in sequence.status.tolist()]
    of_impacts = {
        "time": sequence.time,
        "impact_phase": sequence.phase,
        "impact_velocity": sequence.impact_velocity,
        "contact_duration": sequence.contact_duration,
        "bounce_velocity": sequence.bounce_velocity,
    }
    rows = xr.Dataset({name: ((CASE, "impact"), value.T) for name, value in of_impacts.items()})
    described = describe(rows.assign(status=(CASE, status)), _OF_SIMULATIONS)
    return grid.unfold(described, Simulation)


def history_on_grid(
    ball: Ball, amplitude: Any, phase: Any, velocity: Any, periods: float, samples: int
) -> History:
    """Balls and table over time, from the first impacts (Λ, φ, z′_i) of a grid.

    ``ball``, ``ball_velocity``, ``table`` and ``contact`` are over (…, time).

    Raises
    ------
    ModelError
        If a ball has too many impacts in this time, or a parameter is outside its range.
    """
    grid = Grid(amplitude=amplitude, phase=phase, velocity=velocity, **ball.parameters)
    time = instants(periods, samples, grid.size)
    starts = _Starts.on(grid)
    since = np.broadcast_to(time, (grid.size, time.size))
    return _over_time(grid, time, _followed(starts.model(ball, grid), starts, since))


def drop_on_grid(
    ball: Ball, height: Any, amplitude: Any, phase: Any, periods: float, samples: int
) -> History:
    """Balls and table over time since the balls were released at rest at the height h, with the
    (h, Λ, φ) of a grid.

    Raises
    ------
    ModelError
        If a ball is released below the table, or has too many impacts in this time.
    """
    grid = Grid(height=height, amplitude=amplitude, phase=phase, **ball.parameters)
    time = instants(periods, samples, grid.size)
    start = grid.row("height")
    lam = grid.row("amplitude")
    phi = grid.row("phase")
    rate, level = table(phi, lam)
    require(start >= level, start, "height", "at or above the table, Λ sin φ")
    flight = Flight(start - level, -rate, rate, level, lam)
    falling = land(flight, flight.earliest_landing()).time
    first = _Starts(lam, phi + falling, -falling)
    since = time - falling[:, np.newaxis]
    found = _followed(first.model(ball, grid), first, since)
    above = since < 0
    fallen = start[:, np.newaxis] - time * time / 2
    found["ball"] = np.where(above, fallen, found["ball"])
    found["ball_velocity"] = np.where(above, -time, found["ball_velocity"])
    found["table"] = table(first.phase[:, np.newaxis] + since, lam[:, np.newaxis])[1]
    dropped = _over_time(grid, time, found)
    dropped.time.attrs["long_name"] = "time since the ball was let go"
    return dropped


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


def _followed(model: ImpactModel, starts: _Starts, time: np.ndarray) -> dict[str, np.ndarray]:
    """The variables of :class:`History` for balls at times (ball, sample) since their first
    impacts.
    """
    sequence = _until(model, starts, time[:, -1])
    balls = [of_one_ball(sequence[k], each) for k, each in enumerate(time)]
    return {
        "ball": np.array([one.height for one in balls]),
        "ball_velocity": np.array([one.velocity for one in balls]),
        "table": np.array([one.table for one in balls]),
        "contact": np.array([one.touching for one in balls]),
    }


def _until(model: ImpactModel, starts: _Starts, end: np.ndarray) -> ImpactSequence:
    """The impacts of balls up to a time since their first impacts, shape (ball,).

    Raises
    ------
    ModelError
        If a ball has too many impacts in this time.
    """
    impacts = _FIRST
    while True:
        found = model.simulate(*starts, impacts)
        unfinished = (found.status == Status.BOUNCING) & (found.time[-1] <= end)
        if not np.any(unfinished):
            return found
        if impacts == _MOST:
            raise ModelError(
                f"a ball has more than {_MOST} impacts in this time: use fewer periods"
            )
        impacts *= 4


def _over_time(grid: Grid, time: np.ndarray, found: dict[str, np.ndarray]) -> History:
    rows = {name: ((CASE, "time"), values) for name, values in found.items()}
    return grid.unfold(describe(xr.Dataset(rows, {"time": time})), History)
