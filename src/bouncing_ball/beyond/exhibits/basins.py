"""The motions on which balls with many starts end, in the three models (beyond the paper)."""

from functools import partial
from typing import Annotated

import numpy as np
import xarray as xr

from bouncing_ball.beyond.exhibits.locked_orbits import Place, columns
from bouncing_ball.beyond.exhibits.motion_samples import (
    MODELS,
    Confidence,
    Impacts,
    exponent,
    models,
    share,
    with_limits,
)
from bouncing_ball.beyond.long_run.destination import final_motions
from bouncing_ball.beyond.long_run.motions import Kind, Motions
from bouncing_ball.datasets.parameters import FrequencyRatio, Many, Seed, Sharded, number
from bouncing_ball.datasets.shards import Arrays, Found, Part
from bouncing_ball.datasets.variables import Variable, described
from bouncing_ball.paper.contact.damping import Release

VARIABLES = {
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
    "case_ratio": Variable("frequency ratio of a case", symbol="ϖ"),
}
MOTIONS = ("permanent contact", "1-T orbit", "other orbits", "locked", "no repetition")
"""The motions on which a ball may end. An orbit is called locked if one of its contacts lasts
longer than an oscillation."""


class Case(Place):
    """One contact and one Λ."""

    frequency_ratio: FrequencyRatio


class Basins(Sharded):
    """Starts on an even grid for the picture, and random ones for shares and exponents."""

    cases: Many[Case]
    velocity_max: Annotated[
        float, number("largest relative speed of the first impact", ge=0.1, le=100)
    ]
    starts: Annotated[int, number("starts along each axis, at middles of cells", ge=10, le=1000)]
    random: Annotated[int, number("random starts for each case", ge=10, le=10**6)]
    shifts: Many[Annotated[float, number("changes of the phase at the start", "rad", gt=0, le=1)]]
    impacts: Impacts
    confidence: Confidence
    seed: Seed

    def grid(self) -> np.ndarray:
        """Phases and speeds at middles of cells, shape (2, starts)."""
        middle = (np.arange(self.starts) + 0.5) / self.starts
        return np.stack([2 * np.pi * middle - np.pi, self.velocity_max * middle])


def _destination(found: Motions) -> np.ndarray:
    """Indices of motions in :data:`MOTIONS`."""
    kind = found.kind
    first = (kind == Kind.ORBIT) & (found.periods == 1) & (found.impacts == 1)
    others = (kind == Kind.ORBIT) | (kind == Kind.SUBHARMONIC)
    where = [kind == Kind.PERMANENT_CONTACT, first, others, kind == Kind.LOCKED]
    return np.select(where, range(len(where)), len(where))


def destinations(parameters: Basins, release: Release, part: Part = np.asarray) -> Arrays:
    """The motions on which balls end, for the starts of the picture and for the random ones.

    Returns
    -------
    dict of array
        ``destination``, indices into :data:`MOTIONS`, shape (case, model, start). The starts of the
        picture, row by row of one speed, are followed by the random starts, first without a change
        of their phases and then with each of the changes.
    """
    random = np.random.default_rng(parameters.seed)
    drawn = random.uniform(-np.pi, np.pi, parameters.random)
    fast = random.uniform(0, parameters.velocity_max, parameters.random)
    beside = drawn + np.array([[0.0], *np.array(parameters.shifts)[:, np.newaxis]])
    sample = np.stack([beside, fast + 0 * beside]).reshape(2, -1)
    image = np.reshape(np.meshgrid(*parameters.grid()), (2, -1))
    start, towards = part(np.concatenate([image, sample], axis=1))
    r, lam, ratio = columns(parameters.cases)[..., np.newaxis]
    ends = []
    for model in models(r, ratio, release):
        velocity = lam * np.cos(start) - towards
        found = final_motions(model.impact_law, lam, start, velocity, impacts=parameters.impacts)
        ends.append(_destination(found))
    return {"destination": np.stack(ends, axis=1).astype(np.int8)}


def basins(parameters: Basins, release: Release, found: Found = None) -> xr.Dataset:
    """The motions on which balls end after first impacts (φ, δ′), in three models of each case.

    ``destination`` (case, model, start_speed, start_phase) is an index into :data:`MOTIONS`; φ in
    rad and the speed -δ′ are at the middles of cells. For the random starts, ``basin_share`` (case,
    model, motion) is the share that ends on a motion, ``uncertain_share`` (case, model, shift) is
    the share that ends on another motion if φ changes by the shift, and ``uncertainty_exponent``
    (case, model) is the exponent of this share. Each has limits, ``_low`` and ``_high``.
    ``case_restitution``, ``case_ratio`` and ``case_amplitude`` are over the case.
    """
    (r, lam, ratio), (phase, speed) = columns(parameters.cases), parameters.grid()
    count, level, shifts = parameters.starts, parameters.confidence, np.array(parameters.shifts)
    ends = (found or destinations(parameters, release))["destination"]
    shape = lam.size, len(MODELS)
    image, sample = np.split(ends, [count * count], axis=-1)
    first, *others = np.moveaxis(sample.reshape(*shape, -1, parameters.random), 2, 0)
    changed = np.stack([x != first for x in others], axis=2)
    kinds, dims = np.arange(len(MOTIONS))[:, np.newaxis], ("case", "model")
    shares = partial(np.apply_along_axis, lambda x: share(x, level)[1:], -1)
    exponents = [[exponent(x.T, shifts, level) for x in case] for case in changed]
    estimates: dict[str, tuple] = {
        "basin_share": ((*dims, "motion"), shares(first[:, :, np.newaxis] == kinds)),
        "uncertain_share": ((*dims, "shift"), shares(changed)),
        "uncertainty_exponent": (dims, exponents),
    }
    image = image.reshape(*shape, count, count)
    return described(
        {
            "destination": ((*dims, "start_speed", "start_phase"), image),
            **with_limits(estimates),
            "case_restitution": ("case", r),
            "case_ratio": ("case", ratio),
            "case_amplitude": ("case", lam),
        },
        coords={
            "model": list(MODELS),
            "motion": list(MOTIONS),
            "shift": shifts,
            "start_phase": phase,
            "start_speed": speed,
        },
        variables=VARIABLES,
    )
