r"""Periodic, subharmonic and chaotic motions of the restitution model, one ball for each.

A few balls that start alike are simulated on tables of different Λ. The first impacts belong to the
way to a motion. Two questions are asked about the later ones:

* After how many impacts is the ball back in its state up to rounding, again and again in the last
  quarter of its impacts?
* How fast does a small deviation of the ball grow in the last three quarters? The derivative of the
  map takes it from impact to impact. The Lyapunov exponent is the sum of the logarithms of its
  growth over the time passed. Its standard error follows from its scatter over blocks of impacts.

Balls are followed with the operations + - × ÷ and √ only, see
:mod:`bouncing_ball.numerics.elementary`, so that the same bits give the same chaotic motion on
every processor.

A ball that sticks leaves in a state that does not depend on its earlier motion, so that a motion
that sticks again and again repeats in the end. The amplitudes of the run are chosen so that no ball
sticks.
"""

from typing import Annotated

import numpy as np
import xarray as xr

from bouncing_ball.datasets.parameters import Amplitude, Many, Parameters, Restitution, number
from bouncing_ball.datasets.variables import Variable, described
from bouncing_ball.errors import ModelError
from bouncing_ball.models.flight import flight_derivative, table
from bouncing_ball.models.model import Status
from bouncing_ball.models.restitution import RestitutionModel
from bouncing_ball.models.simulation import ImpactSequence, impacts_of
from bouncing_ball.numerics.elementary import reduce_angle

VARIABLES = {
    "stickings": Variable("number of impacts after which the ball sticks to the table"),
}
# Largest difference of two states, φ and δ′, that differ by rounding only.
_ROUNDING = 1e-12
# The number of impacts in a block over which the growth of a deviation is summed up.
_BLOCK = 32


class BallsAlike(Parameters):
    """One ball for each Λ. All balls start alike."""

    restitution: Restitution
    amplitude: Many[Amplitude]
    phase: Annotated[float, number("phase φ of the first impact", "rad", ge=-10, le=10)]
    impact_speed: Annotated[float, number("relative speed -δ′ of the first impact", gt=0, le=1000)]
    impacts: Annotated[
        int,
        number(
            "impacts of each ball; an exponent with its error needs some hundreds",
            ge=256,
            le=100_000,
        ),
    ]


def period(phase: np.ndarray, velocity: np.ndarray) -> int:
    """The smallest number of impacts after which the states of a ball repeat up to rounding, to the
    end; 0 if they do not repeat twice.

    Examples
    --------
    >>> period(np.array([0.1, 0.2, 0.1, 0.2, 0.1, 0.2]), np.full(6, -1.0))
    2
    """

    def apart(later: slice, earlier: slice) -> np.ndarray:
        turned = np.abs(reduce_angle(phase[later] - phase[earlier]))
        return np.maximum(turned, np.abs(velocity[later] - velocity[earlier]))

    like_the_last = apart(slice(-1, None), slice(-2, -2 - len(phase) // 2, -1)) <= _ROUNDING
    for count in 1 + np.flatnonzero(like_the_last):
        if apart(slice(count, None), slice(None, -count)).max() <= _ROUNDING:
            return int(count)
    return 0


def growth(path: ImpactSequence, ball: int) -> np.ndarray:
    """The logarithms of the growth of a deviation (dφ, dδ′) from each impact to the next."""
    phase = path.phase[:, ball]
    velocity = path.relative_velocity[:, ball]
    lam = path.amplitude[ball]
    time = np.diff(path.time[:, ball])
    of_impact = path.model.derivative(0.0, phase[:-1], velocity[:-1], lam)
    maps = flight_derivative(phase[:-1], time, velocity[1:], lam) @ of_impact
    deviation = np.array([1.0, 0.0])
    found = np.empty(len(maps))
    for k, each in enumerate(maps):
        deviation = each @ deviation
        length = np.linalg.norm(deviation)
        deviation /= length
        found[k] = np.log(length)
    return found


def exponent(path: ImpactSequence, ball: int) -> tuple[float, float]:
    """The Lyapunov exponent per period of the table, with its standard error: that of a ratio of
    means over blocks, of which the first quarter is left out.
    """
    blocks = 3 * (len(path.time) - 1) // (4 * _BLOCK)
    grown = growth(path, ball)[-blocks * _BLOCK :].reshape(blocks, _BLOCK).sum(axis=1)
    passed = np.diff(path.time[-blocks * _BLOCK - 1 :: _BLOCK, ball]) / (2 * np.pi)
    rate = grown.sum() / passed.sum()
    scatter = np.sum((grown - rate * passed) ** 2) * blocks / (blocks - 1)
    return rate, np.sqrt(scatter) / passed.sum()


def kinds_of_motion(parameters: BallsAlike) -> xr.Dataset:
    """Whether the motion of each ball repeats, and how fast its neighbours separate from it.

    The dataset has, over ``amplitude``, ``impacts`` and ``periods`` of the table until the motion
    repeats up to rounding, 0 if it does not; ``stickings``, after how many impacts the ball sticks;
    and ``lyapunov_exponent`` with its error ``lyapunov_error``, per period of the table, NaN
    for a motion that repeats or sticks.

    Raises
    ------
    ModelError
        If a ball comes to rest on the table for ever.
    """
    amplitude = np.array(parameters.amplitude)
    velocity, _ = table(np.array(parameters.phase), amplitude)
    velocity = velocity - parameters.impact_speed
    model = RestitutionModel(parameters.restitution)
    path = impacts_of(model, amplitude, parameters.phase, velocity, parameters.impacts)
    if np.any(path.status == Status.PERMANENT_CONTACT):
        ball = int(np.argmax(path.status == Status.PERMANENT_CONTACT))
        raise ModelError(
            f"the ball at Λ = {amplitude[ball]:g} comes to rest on the table after "
            f"{int(np.isfinite(path.time[:, ball]).sum())} impacts, and stays there: only above "
            "Λ = 1 does the table throw it off"
        )
    settled = 3 * parameters.impacts // 4
    balls = range(amplitude.size)
    states = path.phase[settled:], path.relative_velocity[settled:]
    impacts = np.array([period(*(x[:, k] for x in states)) for k in balls])
    lasts = path.time[settled + impacts, balls] - path.time[settled]
    stickings = np.sum(path.contact_duration > 0, axis=0)
    found = [(np.nan, np.nan) if impacts[k] or stickings[k] else exponent(path, k) for k in balls]
    rate, error = np.array(found).T
    return described(
        {
            "impacts": ("amplitude", impacts),
            "periods": ("amplitude", np.rint(lasts / (2 * np.pi)).astype(int)),
            "stickings": ("amplitude", stickings),
            "lyapunov_exponent": ("amplitude", rate),
            "lyapunov_error": ("amplitude", error),
        },
        coords={"amplitude": amplitude},
        variables=VARIABLES,
    )
