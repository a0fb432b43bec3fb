"""How long balls wander before they lock, in the restitution model and on contacts (beyond the
paper).
"""

from collections.abc import Sequence
from typing import Annotated, Any

import numpy as np
import scipy
import xarray as xr

from bouncing_ball.beyond.exhibits.motion_samples import (
    Confidence,
    share_with_limits,
    three_models,
    with_limits,
)
from bouncing_ball.datasets.parameters import (
    Amplitude,
    FrequencyRatio,
    LossyRestitution,
    Many,
    Parameters,
    Seed,
    Sharded,
    number,
)
from bouncing_ball.datasets.shards import Arrays, Found, Part
from bouncing_ball.datasets.variables import Variable, described
from bouncing_ball.long_run.destination import final_motions
from bouncing_ball.long_run.motions import Kind
from bouncing_ball.models.damping import Release
from bouncing_ball.numerics.elementary import reduce_angle

VARIABLES = {
    "life_ratio": Variable(
        "frequency ratio of the contact, infinite for the restitution model", symbol="ϖ"
    ),
    "life": Variable("time from the start in periods of the table"),
    "survival": Variable("share of the balls that are not on their locked orbit yet"),
    "mean_life": Variable("mean time until a ball is on its locked orbit in periods of the table"),
    "mean_life_low": Variable(
        "lower limit of the confidence interval of the mean time until a ball is locked"
    ),
    "mean_life_high": Variable(
        "upper limit of the confidence interval of the mean time until a ball is locked"
    ),
    "chaotic_share": Variable("share of the balls that are chaotic to the end"),
    "chaotic_share_low": Variable(
        "lower limit of the confidence interval of the share that is chaotic to the end"
    ),
    "chaotic_share_high": Variable(
        "upper limit of the confidence interval of the share that is chaotic to the end"
    ),
}
# Distance from an impact of the final motion within which a ball has reached this motion.
_NEAR = 1e-3
# Number of times at which the survival is given.
_TIMES = 60
# Smallest and largest speed of balls at the start.
_SPEEDS = (1.0, 9.0)


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
    total = time.sum()
    count = ends.sum()
    low = 2 * total / scipy.stats.chi2.ppf((1 + confidence) / 2, 2 * count + 2)
    if not count:
        return np.inf, low, np.inf
    high = 2 * total / scipy.stats.chi2.ppf((1 - confidence) / 2, 2 * count)
    return total / count, low, high


def lives(parameters: Transients, release: Release, part: Part = np.asarray) -> Arrays:
    """Times until balls reach the motion on which they end, and the kinds of these motions.

    Returns
    -------
    dict of array
        ``life`` in periods of the table, counted up to the last impact if the ball does not lock,
        and ``life_kind``, shape (case, life_ratio, ball). The restitution model is the last along
        ``life_ratio``.
    """
    random = np.random.default_rng(parameters.seed)
    phases = random.uniform(-np.pi, np.pi, parameters.balls)
    speeds = random.uniform(*_SPEEDS, parameters.balls)
    phase, speed = part(np.stack([phases, speeds]))
    # Arrays over the case, ϖ and the ball.
    r, lam = columns(parameters.cases)[..., np.newaxis, np.newaxis]
    ratios = np.array(parameters.frequency_ratio)[:, np.newaxis]
    models = three_models(r, ratios, release)
    times = []
    kinds = []
    for model in (models.contact, models.restitution):
        time, kind = _time_to_the_end(model, lam, phase, speed, parameters.impacts)
        times.append(time)
        kinds.append(kind)
    return {"life": np.concatenate(times, axis=1), "life_kind": np.concatenate(kinds, axis=1)}


def _time_to_the_end(
    model: Any, lam: np.ndarray, phase: np.ndarray, speed: np.ndarray, impacts: int
) -> tuple[np.ndarray, np.ndarray]:
    """Periods of the table until balls reach their locked orbits, and the kinds of their motions.

    For a ball that does not lock it is the time of the last impact.
    """
    velocity = lam * np.cos(phase) - speed
    shape = np.broadcast_shapes(model.shape, lam.shape, phase.shape)
    path = np.full((3, impacts, *shape), np.nan)
    found = final_motions(model, lam, phase, velocity, impacts=impacts, path=path)
    times, phases, velocities = path
    from_end = np.maximum(
        np.abs(reduce_angle(phases - found.end_phase)), np.abs(velocities - found.end_velocity)
    )
    arrival = (from_end < _NEAR).argmax(axis=0)
    last = np.where(found.kind == Kind.LOCKED, arrival, impacts - 1)
    time = np.take_along_axis(times, last[np.newaxis], axis=0)[0]
    return time / (2 * np.pi), found.kind


def transients(parameters: Transients, release: Release, found: Found = None) -> xr.Dataset:
    """The shares of balls that have not yet reached the motion on which they lock.

    ``survival`` (case, life_ratio, life) is the estimate of Kaplan and Meier, over the time in
    periods of the table. ``mean_life`` (case, life_ratio) and its limits are also in periods; see
    :func:`mean_life`. A ball that is not found to lock is censored at its last impact, and a ball
    that ends on an orbit without sticking is left out. If some balls lock, those that are chaotic
    to the end are taken to be on another attractor and left out of the mean life;
    ``chaotic_share`` (case, life_ratio) is their share of all. The restitution model has ϖ = ∞.
    ``restitution`` and ``amplitude`` are coordinates of the case.
    """
    found = found or lives(parameters, release)
    r, lam = columns(parameters.cases)
    time = found["life"]
    kind = found["life_kind"]
    locks = kind == Kind.LOCKED
    chaotic = kind == Kind.CHAOTIC
    may_lock = (kind != Kind.ORBIT) & (kind != Kind.SUBHARMONIC)
    on_another_attractor = chaotic & locks.any(axis=-1, keepdims=True)
    transient = may_lock & ~on_another_attractor
    times = np.geomspace(1, parameters.impacts, _TIMES)
    shape = time.shape[:-1]
    survival = np.empty((*shape, _TIMES))
    mean_lives = np.empty((*shape, 3))
    chaotic_shares = np.empty((*shape, 3))
    for k in np.ndindex(shape):
        lives_so_far = scipy.stats.CensoredData.right_censored(
            time[k][may_lock[k]], ~locks[k][may_lock[k]]
        )
        survival[k] = scipy.stats.ecdf(lives_so_far).sf.evaluate(times)
        mean_lives[k] = mean_life(
            time[k][transient[k]], locks[k][transient[k]], parameters.confidence
        )
        chaotic_shares[k] = share_with_limits(chaotic[k], parameters.confidence)
    dims = ("case", "life_ratio")
    return described(
        {
            "survival": ((*dims, "life"), survival),
            **with_limits(
                {"mean_life": (dims, mean_lives), "chaotic_share": (dims, chaotic_shares)}
            ),
        },
        coords={
            "restitution": ("case", r),
            "amplitude": ("case", lam),
            "life_ratio": [*parameters.frequency_ratio, np.inf],
            "life": times,
        },
        variables=VARIABLES,
    )
