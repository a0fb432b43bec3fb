"""Periodic, subharmonic and chaotic motion of the restitution model."""

from typing import Annotated

import numpy as np
import xarray as xr

from bouncing_ball.datasets.variables import described
from bouncing_ball.motion.regularity import period, stretching
from bouncing_ball.orbits.restitution_model import RestitutionModel
from bouncing_ball.parameters import Family, LossyRestitution, Many, Parameters, number
from bouncing_ball.studies.parameters import OrbitAmplitude

# Two states are equal within this distance: a chaotic motion comes so close to an earlier
# state once in 10⁸ impacts, whereas a stable one approaches it geometrically.
_SAME = 1e-6


class Ensemble(Parameters):
    """Balls that start beside an orbit, with equal steps of the phase."""

    balls: Annotated[int, number("balls that start beside one orbit", ge=8, le=500)]
    displacement: Annotated[
        float,
        number("largest displacement of their phase from the orbit's", "rad", ge=1e-6, le=1),
    ]
    transient: Annotated[int, number("impacts that are not looked at", ge=10, le=1000)]
    impacts: Annotated[int, number("impacts that are looked at", ge=100, le=1000)]
    longest_period: Annotated[
        int, number("longest period looked for, in impacts, of which 100 hold three", ge=2, le=32)
    ]


class Motions(Parameters):
    """Motions beside the n-T orbit, one for each amplitude."""

    n: Family
    restitution: LossyRestitution
    amplitude: Many[OrbitAmplitude]
    ensemble: Ensemble


def kinds_of_motion(parameters: Motions) -> xr.Dataset:
    """The motion of balls that start beside an n-T orbit, one motion for each Λ.

    The dataset has ``amplitude``; ``motion_period``, in impacts, 0 unless all balls have the same
    period; ``lyapunov_exponent`` per period, of all balls together, each until it sticks to the
    table; and its standard error ``lyapunov_error``; all of shape (case,).
    """
    n, r, ensemble = parameters.n, parameters.restitution, parameters.ensemble
    model, balls = RestitutionModel(r), ensemble.balls
    amplitude = np.array(parameters.amplitude)[:, np.newaxis]
    orbit = model.orbit(n, amplitude)
    beside = orbit.phase + ensemble.displacement * np.arange(1, balls + 1) / balls
    table, speed = amplitude * np.cos(beside), orbit.impact_velocity
    # Far from the orbit the table may fall faster than the ball of the orbit, so that there is no
    # impact at this velocity; the ball then starts with the relative velocity of the orbit.
    velocity = np.where(speed < table, speed, table + orbit.relative_impact_velocity)
    impacts = ensemble.transient + ensemble.impacts
    sequence = model.simulate(amplitude, beside, velocity, impacts + 1)

    periods = period(sequence, ensemble.longest_period, _SAME)
    shared = np.where(np.ptp(periods, axis=1) == 0, periods[:, 0], 0)
    parting = stretching(sequence, r, ensemble.transient)
    flight = np.diff(sequence.time, axis=0)[ensemble.transient :]
    counted = np.arange(len(flight))[:, np.newaxis, np.newaxis] < parting.impacts
    # From the mean per impact to that per period of the table.
    time = np.sum(flight, axis=(0, 2), where=counted)
    pace = 2 * np.pi * parting.impacts.sum(axis=1) / time
    exponent, error = (pace * x for x in parting.exponent())
    return described(
        {
            "amplitude": ("case", amplitude[:, 0]),
            "motion_period": ("case", shared),
            "lyapunov_exponent": ("case", exponent),
            "lyapunov_error": ("case", error),
        }
    )
