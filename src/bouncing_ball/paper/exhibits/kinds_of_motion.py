"""Periodic, subharmonic and chaotic motions of the restitution model, one ball for each.

A few balls that start alike are followed from impact to impact on tables of different Λ, until it
is known after how many impacts their motions repeat (:mod:`bouncing_ball_beyond.motions.recurrence`). The
simulation then shows whether a ball is back in its state up to rounding. If a motion does not
repeat, a small deviation of the ball is mapped from impact to impact by the derivative of the map
(:mod:`bouncing_ball_beyond.motions.lyapunov`); in a chaotic motion the deviation grows exponentially.

A ball that sticks leaves in a state that does not depend on its earlier motion, so that a motion
that sticks again and again repeats in the end. The amplitudes of the run are chosen so that no ball
sticks.
"""

from typing import Annotated

import numpy as np
import xarray as xr
from bouncing_ball_beyond.models.rigid import RestitutionModel
from bouncing_ball_beyond.models.sequence import ImpactSequence
from bouncing_ball_beyond.motions.destination import final_motions
from bouncing_ball_beyond.motions.motions import Kind, Motions

from bouncing_ball.datasets.parameters import Amplitude, Many, Parameters, Restitution, number
from bouncing_ball.datasets.variables import Variable, described
from bouncing_ball.errors import ModelError
from bouncing_ball.numerics.elementary import reduce_angle

VARIABLES = {
    "stickings": Variable("number of impacts after which the ball sticks to the table"),
}
# Largest difference of two states, φ and δ′, that differ by rounding only.
_ROUNDING = 1e-12


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


def _require_bouncing(found: Motions, amplitude: np.ndarray) -> None:
    resting = np.flatnonzero(found.kind == Kind.PERMANENT_CONTACT)
    if resting.size:
        ball = resting[0]
        raise ModelError(
            f"the ball at Λ = {amplitude[ball]:g} comes to rest on the table after "
            f"{found.followed[ball] + 1} impacts, and stays there: only above Λ = 1 does the table "
            "throw it off"
        )


def is_back(sequence: ImpactSequence, impacts: np.ndarray) -> np.ndarray:
    """Whether the last impact of each ball is the one so many impacts before, up to rounding.

    Examples
    --------
    Flights of half a period, of an elastic ball on a table at rest:

    >>> path = RestitutionModel(1.0).simulate(0.0, 0.0, np.full(2, -np.pi / 2), 5)
    >>> is_back(path, np.array([1, 2])).tolist()
    [False, True]
    """
    before = -1 - impacts
    ball = np.arange(impacts.size)
    turn = reduce_angle(sequence.phase[-1] - sequence.phase[before, ball])
    change = sequence.relative_velocity[-1] - sequence.relative_velocity[before, ball]
    return np.maximum(np.abs(turn), np.abs(change)) <= _ROUNDING


def kinds_of_motion(parameters: BallsAlike) -> xr.Dataset:
    """Whether the motion of each ball repeats, and how fast its neighbours separate from it.

    The dataset has, over ``amplitude``, ``impacts`` and ``periods`` of the table until the motion
    repeats up to rounding, 0 if it does not; ``stickings``, after how many impacts the ball sticks
    before its motion is known; and ``lyapunov_exponent`` with its error
    ``lyapunov_error``, per period of the table, NaN for a motion that repeats or sticks.

    Raises
    ------
    ModelError
        If a ball comes to rest on the table for ever.
    """
    amplitude = np.array(parameters.amplitude)
    model = RestitutionModel(parameters.restitution)
    velocity = amplitude * np.cos(parameters.phase) - parameters.impact_speed
    start = amplitude, parameters.phase, velocity
    found = final_motions(model, *start, impacts=parameters.impacts)
    _require_bouncing(found, amplitude)
    sequence = model.simulate(*start, parameters.impacts + 1)
    repeats = (found.impacts > 0) & is_back(sequence, found.impacts)
    wanders = (found.impacts == 0) & (found.times_stuck == 0)
    return described(
        {
            "impacts": ("amplitude", np.where(repeats, found.impacts, 0)),
            "periods": ("amplitude", np.where(repeats, found.periods, 0)),
            "stickings": ("amplitude", found.times_stuck),
            "lyapunov_exponent": ("amplitude", np.where(wanders, found.exponent, np.nan)),
            "lyapunov_error": ("amplitude", np.where(wanders, found.exponent_error, np.nan)),
        },
        coords={"amplitude": amplitude},
        variables=VARIABLES,
    )
