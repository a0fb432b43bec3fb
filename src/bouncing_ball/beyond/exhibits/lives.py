"""How long balls wander before they stick, in the restitution model and on contacts (beyond the
paper).

A life ends with the same event in all models: the end of the first contact in which the ball sticks
to the table, where the table releases it. In the restitution model the ball rests on the table
until then, and is on its locked orbit from there on. On a contact of finite stiffness it is the end
of the first contact that lasts longer than one of its damped oscillations. A motion that has stuck
need not repeat there, so that the share of the balls that end on a locked orbit is given beside it.
"""

from collections.abc import Sequence
from typing import Annotated

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
    Interval,
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

VARIABLES = {
    "life_ratio": Variable(
        "frequency ratio of the contact, infinite for the restitution model", symbol="ϖ"
    ),
    "life": Variable("time from the start in periods of the table"),
    "survival": Variable("share of the balls that have not stuck to the table yet"),
    "mean_life": Variable(
        "mean time from the start to the end of the first sticking in periods of the table, of the "
        "balls that stick"
    ),
    "mean_life_low": Variable("lower limit of the confidence interval of the mean time to stick"),
    "mean_life_high": Variable("upper limit of the confidence interval of the mean time to stick"),
    "life_difference": Variable(
        "mean difference of the times to stick, contact minus restitution model, of balls that "
        "start alike and stick in both, in periods of the table"
    ),
    "life_difference_low": Variable(
        "lower limit of the mean difference of the times to stick; the limits of all differences "
        "hold together with the given confidence"
    ),
    "life_difference_high": Variable(
        "upper limit of the mean difference of the times to stick, as the lower one"
    ),
    "pairs": Variable("balls that stick on the contact and in the restitution model"),
    "unstuck_share": Variable("share of the balls that have not stuck in all impacts followed"),
    "unstuck_share_low": Variable(
        "lower limit of the confidence interval of the share that has not stuck"
    ),
    "unstuck_share_high": Variable(
        "upper limit of the confidence interval of the share that has not stuck"
    ),
    "lock_share": Variable("share of the balls that end on a locked orbit"),
    "lock_share_low": Variable(
        "lower limit of the confidence interval of the share that ends on a locked orbit"
    ),
    "lock_share_high": Variable(
        "upper limit of the confidence interval of the share that ends on a locked orbit"
    ),
}
# Number of times at which the survival is given.
_TIMES = 60
# The first of these times, in periods of the table.
_FIRST = 0.1


class Place(Parameters):
    """One r and one Λ."""

    restitution: LossyRestitution
    amplitude: Amplitude


ImpactSpeed = Annotated[float, number("relative speed -δ′ of the first impact", gt=0, le=1000)]


class ImpactSpeeds(Interval):
    """Speeds of first impacts, uniformly distributed."""

    min: ImpactSpeed
    max: ImpactSpeed


class Transients(Sharded):
    """Balls with random starts, at several places."""

    cases: Many[Place]
    frequency_ratio: Many[FrequencyRatio]
    impact_speeds: ImpactSpeeds
    balls: Annotated[int, number("random starts for each case and ϖ", ge=10, le=10000)]
    impacts: Annotated[int, number("largest number of impacts of a ball", ge=50, le=100000)]
    confidence: Confidence
    seed: Seed


def columns_of_cases(cases: Sequence[Place]) -> np.ndarray:
    """The values of cases in the order of their fields, shape (values, cases)."""
    return np.array([[value for _, value in case] for case in cases]).T


def mean_with_limits(values: np.ndarray, confidence: float) -> tuple[float, float, float]:
    """The mean of independent values with the limits of its confidence interval.

    The interval is that of Student's distribution with the standard deviation of the values. Lives
    that are exponential are not assumed; of many values the mean is nearly normal by itself.

    Parameters
    ----------
    values : array, shape (count,)
    confidence : float
        The probability with which the interval contains the mean, in (0, 1).

    Returns
    -------
    tuple of float
        Mean, lower limit and upper limit; NaN where there are too few values.

    Examples
    --------
    >>> mean, low, high = mean_with_limits(np.array([1.0, 3.0]), 0.95)
    >>> float(mean), round(float(high - mean), 3) == round(float(mean - low), 3)
    (2.0, True)
    """
    if not values.size:
        return np.nan, np.nan, np.nan
    mean = values.mean()
    if values.size == 1:
        return mean, np.nan, np.nan
    quantile = scipy.special.stdtrit(values.size - 1, (1 + confidence) / 2)
    width = quantile * (values.std(ddof=1) / np.sqrt(values.size))
    return mean, mean - width, mean + width


def paired_differences(life: np.ndarray, confidence: float) -> tuple[np.ndarray, np.ndarray]:
    """Differences of the lives of balls that start alike, on contacts and in the restitution model.

    Some balls stick in one model only; they are in no difference. All intervals together hold with
    the given confidence: each has the confidence of Bonferroni, 1 - (1 - confidence)/m for m
    differences, each of which holds by Student's distribution.

    Parameters
    ----------
    life : array, shape (case, life_ratio, ball)
        Lives, NaN for a ball that does not stick; the last along the second axis are those of the
        restitution model.
    confidence : float
        The probability with which all intervals contain their means, in (0, 1).

    Returns
    -------
    tuple of array
        Mean difference with its limits, shape (case, life_ratio, 3), and the number of pairs, shape
        (case, life_ratio). Both are NaN and 0 for the restitution model.

    Examples
    --------
    >>> life = np.array([[[3.0, 5.0, np.nan], [1.0, 2.0, 7.0]]])
    >>> differences, pairs = paired_differences(life, 0.95)
    >>> differences[0, 0, 0].item(), pairs.tolist()
    (2.5, [[2, 0]])
    """
    cases, ratios = life.shape[:2]
    many = cases * (ratios - 1)
    of_each = 1 - (1 - confidence) / many if many else confidence
    found = np.full((cases, ratios, 3), np.nan)
    pairs = np.zeros((cases, ratios), dtype=int)
    for k in np.ndindex(cases, ratios - 1):
        difference = life[k] - life[k[0], -1]
        known = difference[np.isfinite(difference)]
        found[k] = mean_with_limits(known, of_each)
        pairs[k] = known.size
    return found, pairs


def lives(parameters: Transients, release: Release, part: Part = np.asarray) -> Arrays:
    """Times until balls have stuck to the table, and the kinds of the motions on which they end.

    Returns
    -------
    dict of array
        ``life`` in periods of the table, up to the end of the first sticking, NaN if the ball does
        not stick; ``life_followed``, the time up to the last impact followed; and ``life_kind``,
        shape (case, life_ratio, ball). The restitution model is the last along ``life_ratio``.
    """
    random = np.random.default_rng(parameters.seed)
    phases = random.uniform(-np.pi, np.pi, parameters.balls)
    speeds = random.uniform(
        parameters.impact_speeds.min, parameters.impact_speeds.max, parameters.balls
    )
    phase, speed = part(np.stack([phases, speeds]))
    # Arrays over the case, ϖ and the ball.
    r, lam = columns_of_cases(parameters.cases)[..., np.newaxis, np.newaxis]
    ratios = np.array(parameters.frequency_ratio)[:, np.newaxis]
    models = three_models(r, ratios, release)
    velocity = lam * np.cos(phase) - speed
    ends = [
        final_motions(model, lam, phase, velocity, impacts=parameters.impacts)
        for model in (models.contact, models.restitution)
    ]
    period = 2 * np.pi
    return {
        "life": np.concatenate([found.first_lift_off for found in ends], axis=1) / period,
        "life_followed": np.concatenate([found.followed_time for found in ends], axis=1) / period,
        "life_kind": np.concatenate([found.kind for found in ends], axis=1),
    }


def transients(parameters: Transients, release: Release, found: Found = None) -> xr.Dataset:
    """The shares of balls that have not stuck to the table yet.

    ``survival`` (case, life_ratio, life) is the estimate of Kaplan and Meier, over the time in
    periods of the table up to the end of the first sticking. A ball that has not stuck is censored
    at its last impact, and one that ends on an orbit without sticking is left out. ``mean_life``
    (case, life_ratio) is the mean of this time over the balls that stick, see
    :func:`mean_with_limits`. ``life_difference`` (case, life_ratio) is the mean difference of the
    times of balls that start alike, contact minus restitution model, over the ``pairs`` that stick
    in both, see :func:`paired_differences`; it is NaN for the restitution model. ``unstuck_share``
    (case, life_ratio) is the share of all balls that are left out of this mean although they end on
    no orbit: they have not stuck in all impacts followed. ``lock_share`` is the share of all balls
    that end on a locked orbit. Each has limits. The restitution model has ϖ = ∞. ``restitution``
    and ``amplitude`` are coordinates of the case.
    """
    found = found or lives(parameters, release)
    r, lam = columns_of_cases(parameters.cases)
    life = found["life"]
    kind = found["life_kind"]
    sticks = np.isfinite(life)
    ends_without = (kind == Kind.ORBIT) | (kind == Kind.SUBHARMONIC)
    unstuck = ~sticks & ~ends_without
    times = np.geomspace(_FIRST, parameters.impacts, _TIMES)
    shape = life.shape[:-1]
    level = parameters.confidence
    survival = np.empty((*shape, _TIMES))
    mean_lives = np.empty((*shape, 3))
    unstuck_shares = np.empty((*shape, 3))
    lock_shares = np.empty((*shape, 3))
    for k in np.ndindex(shape):
        may_stick = sticks[k] | unstuck[k]
        seen = np.where(sticks[k], life[k], found["life_followed"][k])[may_stick]
        lives_so_far = scipy.stats.CensoredData.right_censored(seen, unstuck[k][may_stick])
        survival[k] = scipy.stats.ecdf(lives_so_far).sf.evaluate(times)
        mean_lives[k] = mean_with_limits(life[k][sticks[k]], level)
        unstuck_shares[k] = share_with_limits(unstuck[k], level)
        lock_shares[k] = share_with_limits(kind[k] == Kind.LOCKED, level)
    dims = ("case", "life_ratio")
    differences, pairs = paired_differences(life, level)
    estimates = {
        "mean_life": (dims, mean_lives),
        "life_difference": (dims, differences),
        "unstuck_share": (dims, unstuck_shares),
        "lock_share": (dims, lock_shares),
    }
    return described(
        {
            "survival": ((*dims, "life"), survival),
            "pairs": (dims, pairs),
            **with_limits(estimates),
        },
        coords={
            "restitution": ("case", r),
            "amplitude": ("case", lam),
            "life_ratio": [*parameters.frequency_ratio, np.inf],
            "life": times,
        },
        variables=VARIABLES,
    )
