"""How long balls wander before they lock, in the restitution model and in contacts."""

from collections.abc import Sequence
from typing import Annotated

import numpy as np
import xarray as xr
from scipy.stats import CensoredData, chi2, ecdf

from bouncing_ball.attractors.mapper import label
from bouncing_ball.attractors.motions import Kind
from bouncing_ball.contacts.elementary import reduce_angle
from bouncing_ball.contacts.spring_damper import Release
from bouncing_ball.datasets.shards import Arrays, Found, Part
from bouncing_ball.datasets.variables import described
from bouncing_ball.parameters import (
    Amplitude,
    FrequencyRatio,
    LossyRestitution,
    Many,
    Parameters,
    Seed,
    Sharded,
    number,
)
from bouncing_ball.studies.attractors import Confidence, models, share, with_limits

# Distance from an impact of the final motion within which a ball has reached this motion.
_NEAR = 1e-3
# Number of times at which the survival is given.
_TIMES = 60


class Place(Parameters):
    """One r and one Λ."""

    restitution: LossyRestitution
    amplitude: Amplitude


class Transients(Sharded):
    """Balls with random starts, at several places."""

    cases: Many[Place]
    frequency_ratio: Many[FrequencyRatio]
    balls: Annotated[int, number("random starts for each case and ϖ", ge=10, le=10000)]
    impacts: Annotated[int, number("largest number of impacts of a ball", ge=50, le=100000)]
    confidence: Confidence
    seed: Seed


def columns(cases: Sequence[Place]) -> np.ndarray:
    """The values of cases in the order of their fields, shape (values, cases)."""
    return np.array([[value for _, value in case] for case in cases]).T


def mean_life(time: np.ndarray, ends: np.ndarray, confidence: float) -> tuple[float, ...]:
    """Mean life at a constant rate, and its limits, from times until an end or until censoring.

    It is the sum of all times over the number of ends; its interval is that of a Poisson count.

    Parameters
    ----------
    time : array, shape (count,)
        Times until the end of each life, or until it is no longer observed.
    ends : array of bool, shape (count,)
        Whether the end was observed.
    confidence : float
        The probability with which the interval contains the mean life, in (0, 1).

    Returns
    -------
    tuple of float
        Mean, lower limit and upper limit, in the unit of the times; the mean and the upper limit
        are infinite if no end was observed.

    Examples
    --------
    >>> float(mean_life(np.array([1.0, 3.0]), np.array([True, False]), 0.95)[0])
    4.0
    """
    total, count = time.sum(), ends.sum()
    low = 2 * total / chi2.ppf((1 + confidence) / 2, 2 * count + 2)
    if not count:
        return np.inf, low, np.inf
    return total / count, low, 2 * total / chi2.ppf((1 - confidence) / 2, 2 * count)


def lives(parameters: Transients, release: Release, part: Part = np.asarray) -> Arrays:
    """Times until balls reach the motion on which they end, and the kinds of these motions.

    Returns
    -------
    dict of array
        ``life`` in periods of the table, counted up to the last impact if the ball does not lock,
        and ``life_kind``, shape (case, life_ratio, ball). The restitution model is the last along
        ``life_ratio``.
    """
    random, balls = np.random.default_rng(parameters.seed), parameters.balls
    phase, speed = random.uniform(-np.pi, np.pi, balls), random.uniform(1.0, 9.0, balls)
    phase, speed = part(np.stack([phase, speed]))
    r, table = columns(parameters.cases)[..., np.newaxis, np.newaxis]
    start = table, phase, table * np.cos(phase) - speed
    times, kinds = [], []
    simple, _, contact = models(r, np.array(parameters.frequency_ratio)[:, np.newaxis], release)
    for model in (contact, simple):
        shape = np.broadcast_shapes(model.shape, table.shape, phase.shape)
        passed, at, velocity = path = np.full((3, parameters.impacts, *shape), np.nan)
        found = label(model.impact_law, *start, impacts=parameters.impacts, path=path)
        apart = np.abs(reduce_angle(at - found.end_phase))
        apart = np.maximum(apart, np.abs(velocity - found.end_velocity))
        kinds.append(found.kind)
        last = np.where(found.kind == Kind.LOCKED, (apart < _NEAR).argmax(axis=0), len(at) - 1)
        times.append(np.take_along_axis(passed, last[np.newaxis], axis=0)[0] / (2 * np.pi))
    return {"life": np.concatenate(times, axis=1), "life_kind": np.concatenate(kinds, axis=1)}


def transients(parameters: Transients, release: Release, found: Found = None) -> xr.Dataset:
    """The shares of balls that have not yet reached the motion on which they lock.

    ``survival`` (case, life_ratio, life) is the estimate of Kaplan and Meier, over the time in
    periods of the table. ``mean_life`` (case, life_ratio) and its limits are also in periods; see
    :func:`mean_life`. A ball that is not found to lock is censored at its last impact, and a ball
    that ends on an orbit without sticking is left out. If some balls lock, those that are chaotic
    to the end are taken to be on another attractor and left out of the mean life;
    ``chaotic_share`` (case, life_ratio) is their share of all. The restitution model has ϖ = ∞.
    ``case_restitution`` and ``case_amplitude`` are over the case.
    """
    found, (r, lam) = found or lives(parameters, release), columns(parameters.cases)
    time, kind = found["life"], found["life_kind"]
    end, other = kind == Kind.LOCKED, (kind == Kind.ORBIT) | (kind == Kind.SUBHARMONIC)
    chaotic = kind == Kind.CHAOTIC
    apart = chaotic & end.any(axis=-1, keepdims=True)
    grid, level = np.geomspace(1, parameters.impacts, _TIMES), parameters.confidence
    shape = time.shape[:-1]
    survival, (life, lasting) = np.empty((*shape, _TIMES)), np.empty((2, *shape, 3))
    for k in np.ndindex(shape):
        own, locks = time[k][~other[k]], end[k][~other[k]]
        survival[k] = ecdf(CensoredData.right_censored(own, ~locks)).sf.evaluate(grid)
        stays = ~(other | apart)[k]
        life[k] = mean_life(time[k][stays], end[k][stays], level)
        lasting[k] = share(chaotic[k], level)[1:]
    dims = ("case", "life_ratio")
    return described(
        {
            "survival": ((*dims, "life"), survival),
            **with_limits({"mean_life": (dims, life), "chaotic_share": (dims, lasting)}),
            "case_restitution": ("case", r),
            "case_amplitude": ("case", lam),
        },
        coords={"life_ratio": [*parameters.frequency_ratio, np.inf], "life": grid},
    )
