"""The motions on which balls with many starts end, in the three models (beyond the paper)."""

from typing import Annotated

import numpy as np
import xarray as xr

from bouncing_ball.beyond.exhibits.lives import Place, columns_of_cases
from bouncing_ball.beyond.exhibits.motion_samples import (
    MODELS,
    Confidence,
    MostImpacts,
    share_with_limits,
    three_models,
    uncertainty_exponent,
    with_limits,
)
from bouncing_ball.datasets.parameters import FrequencyRatio, Many, Seed, Several, Sharded, number
from bouncing_ball.datasets.shards import Arrays, Found, Part
from bouncing_ball.datasets.variables import Variable, described
from bouncing_ball.long_run.destination import final_motions
from bouncing_ball.long_run.motions import Kind, Motions
from bouncing_ball.models.damping import Release

VARIABLES = {
    "change_of_phase": Variable("change of the phase at the start", units="rad"),
    "basin_share": Variable("share of the starts that end on a motion", budget=0.0001, scale="1"),
    "basin_share_low": Variable(
        "lower limit of the confidence interval of the share that ends on a motion"
    ),
    "basin_share_high": Variable(
        "upper limit of the confidence interval of the share that ends on a motion"
    ),
    "uncertain_share": Variable(
        "share of the starts that end on another motion after a change of the phase"
    ),
    "uncertain_share_low": Variable(
        "lower limit of the confidence interval of the share that changes its motion"
    ),
    "uncertain_share_high": Variable(
        "upper limit of the confidence interval of the share that changes its motion"
    ),
}
MOTIONS = ("permanent contact", "1-T orbit", "other orbits", "locked", "no repetition")
"""The motions on which a ball may end. An orbit is called locked if one of its contacts lasts
longer than an oscillation."""


class BasinCase(Place):
    """One contact and one Λ."""

    frequency_ratio: FrequencyRatio


class BasinStarts(Sharded):
    """Starts on an even grid for the picture, and random ones for shares and exponents."""

    cases: Many[BasinCase]
    velocity_max: Annotated[
        float, number("largest relative speed of the first impact", ge=0.1, le=100)
    ]
    starts: Annotated[int, number("starts along each axis, at middles of cells", ge=10, le=1000)]
    random: Annotated[int, number("random starts for each case", ge=10, le=10**6)]
    shifts: Several[
        Annotated[float, number("changes of the phase at the start", "rad", gt=0, le=1)]
    ]
    impacts: MostImpacts
    confidence: Confidence
    seed: Seed

    def grid(self) -> np.ndarray:
        """Phases and speeds at middles of cells, shape (2, starts)."""
        middle = (np.arange(self.starts) + 0.5) / self.starts
        return np.stack([2 * np.pi * middle - np.pi, self.velocity_max * middle])


def _index_of_motion(found: Motions) -> np.ndarray:
    """Indices of motions in :data:`MOTIONS`."""
    kind = found.kind
    first_orbit = (kind == Kind.ORBIT) & (found.periods == 1) & (found.impacts == 1)
    # np.select takes the first condition that holds, so that these are the remaining orbits.
    other_orbits = (kind == Kind.ORBIT) | (kind == Kind.SUBHARMONIC)
    conditions = [
        kind == Kind.PERMANENT_CONTACT,
        first_orbit,
        other_orbits,
        kind == Kind.LOCKED,
    ]
    return np.select(conditions, range(len(conditions)), MOTIONS.index("no repetition"))


def destinations(parameters: BasinStarts, release: Release, part: Part = np.asarray) -> Arrays:
    """The motions on which balls end, for the starts of the picture and for the random ones.

    Returns
    -------
    dict of array
        ``destination``, indices into :data:`MOTIONS`, shape (case, model, start). The starts of the
        picture, row by row of one speed, are followed by the random starts, first without a change
        of their phases and then with each of the changes.
    """
    starts = np.concatenate([_picture_starts(parameters), _random_starts(parameters)], axis=1)
    phase, speed = part(starts)
    r, lam, ratio = columns_of_cases(parameters.cases)[..., np.newaxis]
    velocity = lam * np.cos(phase) - speed
    ends = []
    for model in three_models(r, ratio, release):
        found = final_motions(model, lam, phase, velocity, impacts=parameters.impacts)
        ends.append(_index_of_motion(found))
    return {"destination": np.stack(ends, axis=1).astype(np.int8)}


def _picture_starts(parameters: BasinStarts) -> np.ndarray:
    """Phases and speeds of the picture, row by row of one speed, shape (2, starts)."""
    return np.reshape(np.meshgrid(*parameters.grid()), (2, -1))


def _random_starts(parameters: BasinStarts) -> np.ndarray:
    """Random phases and speeds, without a change of the phases and with each, shape (2, starts)."""
    random = np.random.default_rng(parameters.seed)
    phase = random.uniform(-np.pi, np.pi, parameters.random)
    speed = random.uniform(0, parameters.velocity_max, parameters.random)
    shifts = np.array([0.0, *parameters.shifts])[:, np.newaxis]
    shifted = phase + shifts
    return np.stack([shifted.ravel(), np.broadcast_to(speed, shifted.shape).ravel()])


def basins(parameters: BasinStarts, release: Release, found: Found = None) -> xr.Dataset:
    """The motions on which balls end after first impacts (φ, δ′), in three models of each case.

    ``destination`` (case, model, start_speed, start_phase) is an index into :data:`MOTIONS`; φ in
    rad and the speed -δ′ are at the middles of cells. For the random starts, ``basin_share`` (case,
    model, motion) is the share that ends on a motion, ``uncertain_share`` (case, model,
    change_of_phase) is
    the share that ends on another motion if φ changes by the shift, and ``uncertainty_exponent``
    (case, model) is the exponent of this share. Each has limits, ``_low`` and ``_high``.
    ``restitution``, ``frequency_ratio`` and ``amplitude`` are coordinates of the case.
    """
    r, lam, ratio = columns_of_cases(parameters.cases)
    phase, speed = parameters.grid()
    level = parameters.confidence
    shifts = np.array(parameters.shifts)
    found = found or destinations(parameters, release)
    shape = (lam.size, len(MODELS))
    count = parameters.starts
    image, sample = np.split(found["destination"], [count * count], axis=-1)
    image = image.reshape((*shape, count, count))
    sample = sample.reshape((*shape, shifts.size + 1, parameters.random))
    unshifted = sample[:, :, :1]
    # Over the case, the model, the motion or the shift, and the start.
    ends_there = unshifted == np.arange(len(MOTIONS))[:, np.newaxis]
    changed = sample[:, :, 1:] != unshifted
    exponents = [[uncertainty_exponent(x.T, shifts, level) for x in case] for case in changed]
    dims = ("case", "model")
    estimates: dict[str, tuple] = {
        "basin_share": ((*dims, "motion"), _shares(ends_there, level)),
        "uncertain_share": ((*dims, "change_of_phase"), _shares(changed, level)),
        "uncertainty_exponent": (dims, exponents),
    }
    return described(
        {
            "destination": ((*dims, "start_speed", "start_phase"), image),
            **with_limits(estimates),
        },
        coords={
            "restitution": ("case", r),
            "frequency_ratio": ("case", ratio),
            "amplitude": ("case", lam),
            "model": list(MODELS),
            "motion": list(MOTIONS),
            "change_of_phase": shifts,
            "start_phase": phase,
            "start_speed": speed,
        },
        variables=VARIABLES,
    )


def _shares(chosen: np.ndarray, confidence: float) -> np.ndarray:
    """Shares of truth values along the last axis, and their limits, shape (..., 3)."""
    return np.apply_along_axis(share_with_limits, -1, chosen, confidence)
