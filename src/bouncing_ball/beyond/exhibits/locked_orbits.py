"""Locked orbits (beyond the paper): how long balls wander before they lock, in the restitution
model and on contacts, and the ϖ above which a contact has the restitution model's locked orbit.
"""

from collections.abc import Mapping, Sequence
from typing import Annotated, Any

import numpy as np
import xarray as xr
from scipy.stats import CensoredData, chi2, ecdf, norm, spearmanr

from bouncing_ball.beyond.exhibits.motion_samples import (
    Confidence,
    ParameterPlane,
    share_with_limits,
    three_models,
    uncertainty_exponent,
    with_limits,
)
from bouncing_ball.beyond.long_run.destination import final_motions
from bouncing_ball.beyond.long_run.lift_off import Return, returns
from bouncing_ball.beyond.long_run.motions import Kind
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
from bouncing_ball.numerics.elementary import reduce_angle
from bouncing_ball.paper.contact.damping import Release

VARIABLES = {
    "node": Variable("place in the plane of amplitude and restitution coefficient"),
    "sensitivity": Variable(
        "derivative of the phase at which chattering ends by 1/ϖ, its magnitude", symbol="S"
    ),
    "wait": Variable("phase from the end of chattering to the lift-off", symbol="w"),
    "peak": Variable(
        "largest derivative of a phase of impact by 1/ϖ on the way, its magnitude", symbol="P"
    ),
    "scale": Variable("scale of the needed frequency ratio"),
    "quantile": Variable("share of the places below this value"),
    "needed_over_scale": Variable("quantiles of the needed frequency ratio over a scale"),
    "beyond_scale": Variable("share of the places that need a larger frequency ratio than a scale"),
    "beyond_scale_low": Variable("lower limit of the confidence interval of the share beyond"),
    "beyond_scale_high": Variable("upper limit of the confidence interval of the share beyond"),
    "same": Variable(
        "share of the places at which the contact locks with the restitution model's period"
    ),
    "same_low": Variable(
        "lower limit of the confidence interval of the share with the same period"
    ),
    "same_high": Variable(
        "upper limit of the confidence interval of the share with the same period"
    ),
    "predicted": Variable(
        "frequency ratio over its scale, middle of a range", symbol="ϖ/max(S/w, P)"
    ),
    "same_by_prediction": Variable("share with the same period by the prediction"),
    "same_by_prediction_low": Variable(
        "lower limit of the confidence interval of the share by the prediction"
    ),
    "same_by_prediction_high": Variable(
        "upper limit of the confidence interval of the share by the prediction"
    ),
    "predictor": Variable("what predicts the needed frequency ratio"),
    "rank_correlation": Variable("rank correlation of a predictor with the needed frequency ratio"),
    "rank_correlation_low": Variable(
        "lower limit of the confidence interval of the rank correlation"
    ),
    "rank_correlation_high": Variable(
        "upper limit of the confidence interval of the rank correlation"
    ),
    "reached_share": Variable("share of the places whose needed frequency ratio is finite"),
    "reached_share_low": Variable("lower limit of the confidence interval of the share reached"),
    "reached_share_high": Variable("upper limit of the confidence interval of the share reached"),
    "reached_correlation": Variable(
        "rank correlation of a predictor with the needed frequency ratio where this is finite"
    ),
    "reached_correlation_low": Variable(
        "lower limit of the confidence interval of the rank correlation where it is finite"
    ),
    "reached_correlation_high": Variable(
        "upper limit of the confidence interval of the rank correlation where it is finite"
    ),
    "correlation_gain": Variable(
        "rank correlation of a scale less that of the locked period, where the ratio is finite"
    ),
    "correlation_gain_low": Variable(
        "lower limit of the confidence interval of the difference of rank correlations"
    ),
    "correlation_gain_high": Variable(
        "upper limit of the confidence interval of the difference of rank correlations"
    ),
    "jump_share": Variable("share of the places whose locked period changes with the amplitude"),
    "jump_share_low": Variable(
        "lower limit of the confidence interval of the share next to a discontinuity"
    ),
    "jump_share_high": Variable(
        "upper limit of the confidence interval of the share next to a discontinuity"
    ),
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
    low = 2 * total / chi2.ppf((1 + confidence) / 2, 2 * count + 2)
    if not count:
        return np.inf, low, np.inf
    high = 2 * total / chi2.ppf((1 - confidence) / 2, 2 * count)
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
    ``case_restitution`` and ``case_amplitude`` are over the case.
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
        lives_so_far = CensoredData.right_censored(time[k][may_lock[k]], ~locks[k][may_lock[k]])
        survival[k] = ecdf(lives_so_far).sf.evaluate(times)
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
            "case_restitution": ("case", r),
            "case_amplitude": ("case", lam),
        },
        coords={"life_ratio": [*parameters.frequency_ratio, np.inf], "life": times},
        variables=VARIABLES,
    )


# Edges of the ranges of ϖ over its scale.
_EDGES = np.geomspace(1e-4, 1e4, 17)
SCALES = ("max(S/w, P)", "S/w")
PREDICTORS = (*SCALES, "periods")
# Quantiles of the needed ϖ over a scale.
_QUANTILES = (0.0, 0.05, 0.5, 0.95, 1.0)


class LockedOrbits(ParameterPlane):
    """Random places in a range of (Λ, r), and places at which transients are followed."""

    nodes: Annotated[int, number("random places", ge=10, le=100000)]
    shifts: Many[Annotated[float, number("changes of Λ", gt=0, le=1)]]
    seed: Seed

    def places(self) -> np.ndarray:
        random = np.random.default_rng(self.seed)
        r = random.uniform(self.restitution.min, self.restitution.max, self.nodes)
        lam = random.uniform(self.amplitude.min, self.amplitude.max, self.nodes)
        return np.array([r, lam])


def correlation(one: np.ndarray, other: np.ndarray, confidence: float) -> np.ndarray:
    """Spearman's rank correlation with its limits (D. G. Bonett and T. A. Wright, 2000).

    Parameters
    ----------
    one, other : array, shape (count,)
        Pairs of values; only their ranks count, so that infinite values are allowed.
    confidence : float
        The probability with which the interval contains the correlation, in (0, 1).

    Returns
    -------
    array, shape (3,)
        The correlation, its lower limit and its upper limit; NaN if one or other has fewer than
        three different values, which does not rank them.
    """
    if not _rank(one, other):
        return np.full(3, np.nan)
    rho = spearmanr(one, other).statistic
    width = norm.ppf((1 + confidence) / 2) * np.sqrt((1 + rho**2 / 2) / (one.size - 3))
    low, high = np.tanh(np.arctanh(rho) + width * np.array([-1, 1]))
    return np.array([rho, low, high])


def correlation_gain(
    predictor: np.ndarray, baseline: np.ndarray, found: np.ndarray, confidence: float
) -> np.ndarray:
    """How much better a predictor ranks values than a baseline does: the difference of their rank
    correlations with what was found.

    Both correlations are from the same places and so not independent. The standard error of their
    difference is therefore that of the jackknife, which leaves out one place after another.

    Parameters
    ----------
    predictor, baseline, found : array, shape (count,)
        Triples of values, of which only the ranks count.
    confidence : float
        The probability with which the interval contains the difference, in (0, 1).

    Returns
    -------
    array, shape (3,)
        The difference, its lower limit and its upper limit; NaN if one of the three has fewer than
        three different values.

    Examples
    --------
    >>> found = np.arange(5.0)
    >>> correlation_gain(found**2, found, found, 0.95).tolist()
    [0.0, 0.0, 0.0]
    """
    if not _rank(predictor, baseline, found):
        return np.full(3, np.nan)

    def gain(kept: np.ndarray) -> float:
        ranked = (spearmanr(x[kept], found[kept]).statistic for x in (predictor, baseline))
        return next(ranked) - next(ranked)

    everywhere = np.arange(found.size)
    without_one = np.array([gain(np.delete(everywhere, k)) for k in everywhere])
    error = np.sqrt((found.size - 1) * without_one.var())
    width = norm.ppf((1 + confidence) / 2) * error
    return gain(everywhere) + width * np.array([0, -1, 1])


def _rank(*values: np.ndarray) -> bool:
    """Whether arrays have enough different values for a rank correlation and its limits."""
    return min(np.unique(x).size for x in values) > 2 and values[0].size > 3


def returns_at_places(
    parameters: LockedOrbits, release: Release, part: Part = np.asarray
) -> Arrays:
    """The returns of the restitution model at each place, and whether the contact locks as it does.

    Returns
    -------
    dict of array
        The fields of :class:`~bouncing_ball.beyond.long_run.lift_off.Return`, shape (change,
        place), first without a change of Λ and then with each change; and ``same``, shape (ϖ,
        place), whether the contact has a locked orbit of the same period.
    """
    r, lam = part(parameters.places())
    ratios = np.array(parameters.frequency_ratio)[:, np.newaxis]
    changes = np.array([0.0, *parameters.shifts])[:, np.newaxis]
    found = returns(r, lam + changes, parameters.impacts)
    contact = three_models(r, ratios, release).contact
    motion = final_motions(contact, lam, -np.pi / 2, 0.0, impacts=parameters.impacts)
    same = (motion.kind == Kind.LOCKED) & (motion.periods == found.periods[0])
    return {**found._asdict(), "same": same}


def locked_orbits(
    data: Mapping[str, xr.Dataset], parameters: LockedOrbits, release: Release, found: Found = None
) -> xr.Dataset:
    """The places at which a contact has the locked orbit of the restitution model, and predictors.

    The places are uniformly distributed in Λ and r. Over ``node`` the dataset has ``restitution``
    and ``amplitude``, and ``periods``, ``sensitivity`` S, ``peak`` P and ``wait`` w of
    :func:`bouncing_ball.beyond.long_run.lift_off.returns`, which are 0 or NaN where the ball is not
    found to stick again; such places are left out of all shares. ``needed_ratio`` is the smallest
    of the given ϖ above which the contact locks with the same period after a rest on the table; it
    is infinite if the contact does not do so at the largest ϖ.
    ``same`` (frequency_ratio) is the share of places with the same period, and
    ``same_by_prediction`` (predicted) this share in ranges of ϖ/max(S/w, P), for all ϖ together.
    ``needed_over_scale`` (scale, quantile) has quantiles of the smallest ϖ over a scale, at the
    places at which it is finite, and ``beyond_scale`` (scale) the share of them at which it is
    larger than the scale.
    ``rank_correlation`` (predictor) is the correlation of a predictor with the smallest ϖ. In it
    all places at which this is infinite are one tie. ``reached_share`` is therefore the share of
    the places at which it is finite, ``reached_correlation`` (predictor) the correlation at these
    places only, and ``correlation_gain`` (scale) by how much that of a scale exceeds that of the
    period of the locked orbit.
    ``jump_share`` (shift) is the share of places next to a discontinuity, at which the period
    changes, or is not found, if Λ changes by the shift, and ``uncertainty_exponent`` its exponent.
    Each has a lower and an upper limit, ``_low`` and ``_high``. The variables of
    :func:`bouncing_ball.beyond.exhibits.locked_orbits.transients`, ``ext_lives``, are added.
    """
    found = found or returns_at_places(parameters, release)
    level = parameters.confidence
    ratios = np.array(parameters.frequency_ratio)
    shifts = np.array(parameters.shifts)
    r, lam = parameters.places()
    period, *periods_beside = found["periods"]
    unshifted = {name: found[name][0] for name in Return._fields}
    back = Return(**unshifted)
    sticks = period > 0
    same = found["same"]
    changed = np.array(periods_beside) != period
    needed = _needed_ratio(ratios, same)
    scales = [back.scale(), back.sensitivity / back.wait]
    correlations = [
        correlation(predictor[sticks], needed[sticks], level) for predictor in (*scales, period)
    ]
    known = sticks & np.isfinite(needed)
    reached = [correlation(x[known], needed[known], level) for x in (*scales, period)]
    gains = [correlation_gain(x[known], period[known], needed[known], level) for x in scales]
    over_scales = [needed[known] / scale[known] for scale in scales]
    nodes = {
        "restitution": r,
        "amplitude": lam,
        "periods": period,
        "sensitivity": back.sensitivity,
        "peak": back.peak,
        "wait": back.wait,
        "needed_ratio": np.where(sticks, needed, np.nan),
    }
    by_prediction = _shares_by_prediction(ratios[:, np.newaxis] / scales[0], same, sticks, level)
    estimates = {
        "same": ("frequency_ratio", [share_with_limits(x[sticks], level) for x in same]),
        "same_by_prediction": ("predicted", by_prediction),
        "rank_correlation": ("predictor", correlations),
        "reached_share": ((), share_with_limits(np.isfinite(needed[sticks]), level)),
        "reached_correlation": ("predictor", reached),
        "correlation_gain": ("scale", gains),
        "beyond_scale": ("scale", [share_with_limits(x > 1, level) for x in over_scales]),
        "jump_share": ("shift", [share_with_limits(x[sticks], level) for x in changed]),
        "uncertainty_exponent": ((), uncertainty_exponent(changed[:, sticks].T, shifts, level)),
    }
    quantiles = [np.quantile(x, _QUANTILES) for x in over_scales]
    variables = {name: ("node", values) for name, values in nodes.items()}
    orbits = described(
        variables
        | with_limits(estimates)
        | {"needed_over_scale": (("scale", "quantile"), np.array(quantiles))},
        coords={
            "scale": list(SCALES),
            "quantile": list(_QUANTILES),
            "frequency_ratio": ratios,
            "predicted": np.sqrt(_EDGES[1:] * _EDGES[:-1]),
            "predictor": list(PREDICTORS),
            "shift": shifts,
        },
        variables=VARIABLES,
    )
    return orbits.merge(data["ext_lives"])


def _needed_ratio(ratios: np.ndarray, same: np.ndarray) -> np.ndarray:
    """The smallest ϖ above which the contact has the same period, infinite if there is none.

    ``same`` (ϖ, place) is whether it has the same period at each ϖ.
    """
    from_here_on = np.logical_and.accumulate(same[::-1])[::-1]
    return np.where(from_here_on.any(axis=0), ratios[np.argmax(from_here_on, axis=0)], np.inf)


def _shares_by_prediction(
    predicted: np.ndarray, same: np.ndarray, sticks: np.ndarray, confidence: float
) -> list[tuple[float, float, float]]:
    """The shares with the same period, and their limits, in each range of ϖ over its scale.

    ``predicted`` is ϖ/max(S/w, P) and ``same`` whether the period is the same, shape (ϖ, place);
    places at which the ball does not stick again are left out.
    """
    place = np.digitize(predicted, _EDGES) - 1
    return [
        share_with_limits(same[(place == k) & sticks], confidence) for k in range(_EDGES.size - 1)
    ]
