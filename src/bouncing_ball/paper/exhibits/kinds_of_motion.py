"""Periodic, subharmonic and chaotic motions of the restitution model, one ball for each.

A few balls that start alike are followed from impact to impact on tables of different Λ. A motion
repeats if its last impacts are those of k impacts before, up to rounding. If it does not repeat, a
small deviation of the ball is mapped from impact to impact by the derivative of the map; in a
chaotic motion the deviation grows exponentially.

A ball that sticks leaves in a state that does not depend on its earlier motion, so that a motion
that sticks again and again repeats in the end. The amplitudes of the run are chosen so that no ball
sticks.
"""

from typing import Annotated, NamedTuple

import numpy as np
import xarray as xr

from bouncing_ball.datasets.parameters import Amplitude, Many, Parameters, Restitution, number
from bouncing_ball.datasets.variables import Variable, described
from bouncing_ball.errors import ModelError
from bouncing_ball.models.restitution import RestitutionDynamics
from bouncing_ball.models.sequence import Status
from bouncing_ball.numerics.elementary import reduce_angle

VARIABLES = {
    "stickings": Variable("number of impacts after which the ball sticks to the table"),
}
# The largest number of impacts in which a motion is found to repeat.
_LONGEST = 64
# Largest difference of two states, φ and δ′, that differ by rounding only.
_ROUNDING = 1e-12
# The growth of a deviation is summed up over sections of this number of impacts, whose scatter
# gives the standard error. The first sections are left out.
_SECTION = 32
_TRANSIENT = 2


class Balls(Parameters):
    """One ball for each Λ. All balls start alike."""

    restitution: Restitution
    amplitude: Many[Amplitude]
    phase: Annotated[float, number("phase φ of the first impact", "rad", ge=-10, le=10)]
    impact_speed: Annotated[float, number("relative speed -δ′ of the first impact", gt=0, le=1000)]
    impacts: Annotated[
        int,
        number(
            "impacts of each ball; an exponent with its standard error needs some hundreds",
            ge=256,
            le=100_000,
        ),
    ]


class Path(NamedTuple):
    """The motions of balls, arrays of shape (impacts, balls)."""

    phase: np.ndarray
    velocity: np.ndarray
    """φ and δ′ at each impact."""
    passed: np.ndarray
    """Time since the impact before."""
    growth: np.ndarray
    """Logarithm of the growth of a deviation since the impact before; NaN after sticking."""
    sticks: np.ndarray
    """Whether the ball stuck to the table after the impact before."""


def follow(dynamics: RestitutionDynamics, phase: float, speed: float, impacts: int) -> Path:
    """The motions of balls and of their small deviations, without the first impact.

    ``dynamics`` has one entry for each ball; all balls start at the phase φ with δ′ = -``speed``.

    Raises
    ------
    ModelError
        If a ball comes to rest on the table for ever, so that it has too few impacts.
    """
    balls = dynamics.amplitude.size
    impact = dynamics.start(np.full(balls, phase), np.full(balls, -speed))
    # The deviation (dφ, dδ′) has length 1 after each impact.
    along = np.ones(balls)
    across = np.zeros(balls)
    rows: list[Path] = []
    for _ in range(impacts):
        departure = dynamics.depart(impact, differentiate=True)
        _require_bouncing(departure.status, dynamics.amplitude, len(rows))
        after, passed = dynamics.fly(departure)
        derivative = dynamics.jacobian(impact, departure, after, passed)
        along, across = derivative.apply(along, across)
        length = np.sqrt(along * along + across * across)
        # After sticking nothing is left of a deviation, and a new one is started.
        left = length > 0
        growth = np.log(length, out=np.full(balls, np.nan), where=left)
        along = np.divide(along, length, out=np.ones(balls), where=left)
        across = np.divide(across, length, out=np.zeros(balls), where=left)
        rows.append(Path(after.phase, after.velocity, passed, growth, departure.sticks))
        impact = after
    return Path(*map(np.array, zip(*rows, strict=True)))


def _require_bouncing(status: np.ndarray, amplitude: np.ndarray, impacts: int) -> None:
    resting = np.flatnonzero(status != Status.BOUNCING)
    if resting.size:
        raise ModelError(
            f"the ball at Λ = {amplitude[resting[0]]:g} comes to rest on the table after "
            f"{impacts + 1} impacts, and stays there: only above Λ = 1 does the table throw it off"
        )


def impacts_until_repetition(path: Path) -> np.ndarray:
    """The smallest number of impacts after which each motion repeats up to rounding, 0 if none.

    The last impacts are compared with earlier ones.

    Examples
    --------
    >>> phase = np.tile([[0.5], [0.7]], (100, 1))
    >>> impacts_until_repetition(Path(phase, phase, phase, phase, phase)).tolist()
    [2]
    """
    found = np.zeros(path.phase.shape[1], dtype=int)
    for k in range(_LONGEST, 0, -1):
        turn = reduce_angle(path.phase[-k:] - path.phase[-2 * k : -k])
        change = path.velocity[-k:] - path.velocity[-2 * k : -k]
        same = np.maximum(np.abs(turn), np.abs(change)).max(axis=0) <= _ROUNDING
        found[same] = k
    return found


def growth_rate(path: Path) -> tuple[np.ndarray, np.ndarray]:
    """The largest Lyapunov exponent, per period of the table, and its standard error.

    It is the ratio of the mean growth to the mean time, over sections of the motion. Both are NaN
    for a ball that sticks.
    """
    whole = len(path.growth) // _SECTION * _SECTION
    shape = whole // _SECTION, _SECTION, -1
    growth = path.growth[:whole].reshape(shape).sum(axis=1)[_TRANSIENT:]
    time = path.passed[:whole].reshape(shape).sum(axis=1)[_TRANSIENT:] / (2 * np.pi)
    rate = growth.sum(axis=0) / time.sum(axis=0)
    sections = len(growth)
    scatter = np.sum((growth - rate * time) ** 2, axis=0) * sections / (sections - 1)
    return rate, np.sqrt(scatter) / time.sum(axis=0)


def kinds_of_motion(parameters: Balls) -> xr.Dataset:
    """Whether the motion of each ball repeats, and how fast its neighbours separate from it.

    The dataset has, over ``amplitude``, ``impacts`` and ``periods`` of the table until the motion
    repeats up to rounding, 0 if it does not repeat within 64 impacts; ``stickings``, after how many
    impacts the ball sticks; and ``lyapunov_exponent`` with its standard error ``lyapunov_error``,
    per period of the table, NaN for a motion that repeats or sticks.
    """
    amplitude = np.array(parameters.amplitude)
    restitution = np.full(amplitude.size, parameters.restitution)
    path = follow(
        RestitutionDynamics.of(restitution, amplitude),
        parameters.phase,
        parameters.impact_speed,
        parameters.impacts,
    )
    impacts = impacts_until_repetition(path)
    times = [path.passed[parameters.impacts - k :, ball].sum() for ball, k in enumerate(impacts)]
    exponent, error = growth_rate(path)
    return described(
        {
            "impacts": ("amplitude", impacts),
            "periods": ("amplitude", np.rint(np.array(times) / (2 * np.pi)).astype(int)),
            "stickings": ("amplitude", path.sticks.sum(axis=0)),
            "lyapunov_exponent": ("amplitude", np.where(impacts > 0, np.nan, exponent)),
            "lyapunov_error": ("amplitude", np.where(impacts > 0, np.nan, error)),
        },
        coords={"amplitude": amplitude},
        variables=VARIABLES,
    )
