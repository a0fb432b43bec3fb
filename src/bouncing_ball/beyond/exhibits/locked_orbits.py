"""The ϖ above which a contact has the locked orbit of the restitution model, and its predictors
(beyond the paper).
"""

from collections.abc import Mapping
from typing import Annotated

import numpy as np
import scipy
import xarray as xr

from bouncing_ball.beyond.exhibits.lives import VARIABLES as OF_LIVES
from bouncing_ball.beyond.exhibits.motion_samples import (
    ParameterPlane,
    share_with_limits,
    three_models,
    uncertainty_exponent,
    with_limits,
)
from bouncing_ball.datasets.parameters import (
    Many,
    Seed,
    number,
)
from bouncing_ball.datasets.shards import Arrays, Found, Part
from bouncing_ball.datasets.variables import Variable, describe, described
from bouncing_ball.long_run.destination import final_motions
from bouncing_ball.long_run.lift_off import Lap, laps
from bouncing_ball.long_run.motions import Kind
from bouncing_ball.models.damping import Release

VARIABLES = {
    "case_restitution": Variable("restitution coefficient of a case of transients", symbol="r"),
    "case_amplitude": Variable("amplitude of a case of transients", symbol="Λ"),
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
}

# Edges of the ranges of ϖ over its scale.
_EDGES = np.geomspace(1e-4, 1e4, 17)
SCALES = ("max(S/w, P)", "S/w")
PREDICTORS = (*SCALES, "periods")
# Quantiles of the needed ϖ over a scale.
_QUANTILES = (0.0, 0.05, 0.5, 0.95, 1.0)


class LockedOrbits(ParameterPlane):
    """Random places in a range of (Λ, r)."""

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
    rho = scipy.stats.spearmanr(one, other).statistic
    width = scipy.stats.norm.ppf((1 + confidence) / 2) * np.sqrt((1 + rho**2 / 2) / (one.size - 3))
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
        ranked = (
            scipy.stats.spearmanr(x[kept], found[kept]).statistic for x in (predictor, baseline)
        )
        return next(ranked) - next(ranked)

    everywhere = np.arange(found.size)
    without_one = np.array([gain(np.delete(everywhere, k)) for k in everywhere])
    error = np.sqrt((found.size - 1) * without_one.var())
    width = scipy.stats.norm.ppf((1 + confidence) / 2) * error
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
        The fields of :class:`~bouncing_ball.long_run.lift_off.Lap`, shape (change,
        place), first without a change of Λ and then with each change; and ``same``, shape (ϖ,
        place), whether the contact has a locked orbit of the same period.
    """
    r, lam = part(parameters.places())
    ratios = np.array(parameters.frequency_ratio)[:, np.newaxis]
    changes = np.array([0.0, *parameters.shifts])[:, np.newaxis]
    found = laps(r, lam + changes, parameters.impacts)
    contact = three_models(r, ratios, release).contact
    motion = final_motions(contact, lam, -np.pi / 2, 0.0, impacts=parameters.impacts)
    same = (motion.kind == Kind.LOCKED) & (motion.periods == found.periods[0])
    return {**found._asdict(), "same": same}


def locked_orbits(
    data: Mapping[str, xr.Dataset], parameters: LockedOrbits, release: Release, found: Found = None
) -> xr.Dataset:
    """The places at which a contact has the locked orbit of the restitution model, and predictors.

    The places are uniformly distributed in Λ and r. Over ``node``, with the coordinates
    ``restitution`` and ``amplitude``, the dataset has ``periods``, ``sensitivity`` S, ``peak`` P
    and ``wait`` w of :func:`bouncing_ball.long_run.lift_off.laps`, which are 0 or NaN where the
    ball is not found to stick again; such places are left out of all shares. ``needed_ratio`` is
    the smallest of the given ϖ above which the contact locks with the same period after a rest on
    the table; it is infinite if the contact does not do so at the largest ϖ.
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
    :func:`bouncing_ball.beyond.exhibits.lives.transients`, ``ext_lives``, are added; the
    coordinates of its cases are ``case_restitution`` and ``case_amplitude`` here.
    """
    found = found or returns_at_places(parameters, release)
    level = parameters.confidence
    ratios = np.array(parameters.frequency_ratio)
    shifts = np.array(parameters.shifts)
    r, lam = parameters.places()
    period, *periods_beside = found["periods"]
    unshifted = {name: found[name][0] for name in Lap._fields}
    back = Lap(**unshifted)
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
            "restitution": ("node", r),
            "amplitude": ("node", lam),
            "scale": list(SCALES),
            "quantile": list(_QUANTILES),
            "frequency_ratio": ratios,
            "predicted": np.sqrt(_EDGES[1:] * _EDGES[:-1]),
            "predictor": list(PREDICTORS),
            "shift": shifts,
        },
        variables=VARIABLES,
    )
    lives = data["ext_lives"].rename(restitution="case_restitution", amplitude="case_amplitude")
    return describe(orbits.merge(lives), VARIABLES | OF_LIVES)


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
