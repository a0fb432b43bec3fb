"""The ϖ above which a contact has the locked orbit of the restitution model (beyond the paper)."""

from collections.abc import Mapping
from typing import Annotated, Any

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
    Seed,
    Several,
    number,
)
from bouncing_ball.datasets.shards import Arrays, Found, Part
from bouncing_ball.datasets.variables import Variable, describe, described
from bouncing_ball.long_run.destination import final_motions
from bouncing_ball.long_run.lift_off import laps
from bouncing_ball.long_run.motions import Kind
from bouncing_ball.models.damping import Release

VARIABLES = {
    "case_restitution": Variable("restitution coefficient of a case of transients", symbol="r"),
    "case_amplitude": Variable("amplitude of a case of transients", symbol="Λ"),
    "node": Variable("place in the plane of amplitude and restitution coefficient"),
    "same": Variable(
        "share of the places at which the contact locks with the restitution model's period"
    ),
    "same_known": Variable(
        "share of the places at which it is known whether the contact locks with the restitution "
        "model's period"
    ),
    "last_known": Variable(
        "whether it is known if the contact with the largest frequency ratio locks with the "
        "restitution model's period"
    ),
    "same_low": Variable(
        "lower limit of the confidence interval of the share with the same period"
    ),
    "same_high": Variable(
        "upper limit of the confidence interval of the share with the same period"
    ),
    "rank_correlation": Variable(
        "rank correlation of the locked period with the needed frequency ratio"
    ),
    "rank_correlation_low": Variable(
        "lower limit of the confidence interval of the rank correlation"
    ),
    "rank_correlation_high": Variable(
        "upper limit of the confidence interval of the rank correlation"
    ),
    "inner_places": Variable(
        "number of places that need a frequency ratio between the smallest and the largest"
    ),
    "inner_correlation": Variable(
        "rank correlation of the locked period with the needed frequency ratio at places that need "
        "one between the smallest and the largest"
    ),
    "inner_correlation_low": Variable(
        "lower limit of the confidence interval of the rank correlation without ties at the ends"
    ),
    "inner_correlation_high": Variable(
        "upper limit of the confidence interval of the rank correlation without ties at the ends"
    ),
    "jump_share": Variable("share of the places whose locked period changes with the amplitude"),
    "jump_share_low": Variable(
        "lower limit of the confidence interval of the share next to a discontinuity"
    ),
    "jump_share_high": Variable(
        "upper limit of the confidence interval of the share next to a discontinuity"
    ),
}


class LockedOrbits(ParameterPlane):
    """Random places in a range of (Λ, r)."""

    nodes: Annotated[int, number("random places", ge=10, le=100000)]
    shifts: Several[Annotated[float, number("changes of Λ", gt=0, le=1)]]
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
    ranked = min(np.unique(one).size, np.unique(other).size) > 2 and one.size > 3
    if not ranked:
        return np.full(3, np.nan)
    rho = scipy.stats.spearmanr(one, other).statistic
    width = scipy.stats.norm.ppf((1 + confidence) / 2) * np.sqrt((1 + rho**2 / 2) / (one.size - 3))
    low, high = np.tanh(np.arctanh(rho) + width * np.array([-1, 1]))
    return np.array([rho, low, high])


def returns_at_places(
    parameters: LockedOrbits, release: Release, part: Part = np.asarray
) -> Arrays:
    """The returns of the restitution model at each place, and whether the contact locks as it does.

    Returns
    -------
    dict of array
        ``periods`` of :class:`~bouncing_ball.long_run.lift_off.Lap`, shape (change, place), first
        without a change of Λ and then with each change; ``same``, shape (ϖ, place), whether the
        contact has a locked orbit of the same period; and ``known``, of this shape, whether that
        can be told: its motion is decided, and if it is locked, doubles tell its period.
    """
    r, lam = part(parameters.places())
    ratios = np.array(parameters.frequency_ratio)[:, np.newaxis]
    changes = np.array([0.0, *parameters.shifts])[:, np.newaxis]
    periods = laps(r, lam + changes, parameters.impacts).periods
    contact = three_models(r, ratios, release).contact
    motion = final_motions(contact, lam, -np.pi / 2, 0.0, impacts=parameters.impacts)
    same = (motion.kind == Kind.LOCKED) & (motion.periods == periods[0])
    known = (motion.kind != Kind.UNDECIDED) & ~motion.is_unresolved()
    return {"periods": periods, "same": same, "known": known}


def locked_orbits(
    data: Mapping[str, xr.Dataset], parameters: LockedOrbits, release: Release, found: Found = None
) -> xr.Dataset:
    """The places at which a contact has the locked orbit of the restitution model.

    The places are uniformly distributed in Λ and r. Over ``node``, with the coordinates
    ``restitution`` and ``amplitude``, the dataset has ``periods`` of
    :func:`bouncing_ball.long_run.lift_off.laps`, which is 0 where the ball is not found to stick
    again; such places are left out of all shares. ``needed_ratio`` is the smallest of the given ϖ
    above which the contact locks with the same period after a rest on the table; it is infinite if
    the contact is not known to do so at the largest ϖ; ``last_known`` (node) is whether its motion
    there is known. ``same`` (frequency_ratio) is the share of places with the same period, and
    ``same_known`` (frequency_ratio) that at which it is known whether it is the same, so that the
    share may be larger by 1 - ``same_known``.
    ``rank_correlation`` is the correlation of the period of the locked orbit with the smallest ϖ.
    In it all places at which this is infinite are one tie, and those at which it is the smallest ϖ
    are another. ``inner_correlation`` is therefore the correlation at the other places, of which
    ``inner_places`` is the number.
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
    sticks = period > 0
    same = found["same"]
    known = found["known"]
    changed = np.array(periods_beside) != period
    needed = _needed_ratio(ratios, same)
    inner = sticks & np.isfinite(needed) & (needed > ratios.min())
    nodes = {
        "periods": period,
        "needed_ratio": np.where(sticks, needed, np.nan),
        "last_known": known[-1],
    }
    estimates = {
        "same": ("frequency_ratio", [share_with_limits(x[sticks], level) for x in same]),
        "rank_correlation": ((), correlation(period[sticks], needed[sticks], level)),
        "inner_correlation": ((), correlation(period[inner], needed[inner], level)),
        "jump_share": ("shift", [share_with_limits(x[sticks], level) for x in changed]),
        "uncertainty_exponent": ((), uncertainty_exponent(changed[:, sticks].T, shifts, level)),
    }
    variables: dict[str, Any] = {name: ("node", values) for name, values in nodes.items()}
    variables |= {
        "inner_places": ((), float(inner.sum())),
        "same_known": ("frequency_ratio", known[:, sticks].mean(axis=1)),
    }
    orbits = described(
        variables | with_limits(estimates),
        coords={
            "restitution": ("node", r),
            "amplitude": ("node", lam),
            "frequency_ratio": ratios,
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
