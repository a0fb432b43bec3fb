"""The ϖ above which a contact has the locked orbit of the restitution model (beyond the paper)."""

from collections.abc import Mapping
from typing import Annotated, Any

import numpy as np
import xarray as xr

from bouncing_ball.beyond.exhibits.lives import VARIABLES as OF_LIVES
from bouncing_ball.beyond.exhibits.locking import laps_by_many_digits
from bouncing_ball.beyond.exhibits.motion_samples import (
    ParameterPlane,
    share_with_limits,
    three_models,
    uncertainty_exponent,
    with_limits,
)
from bouncing_ball.beyond.motions.lift_off import laps
from bouncing_ball.datasets.parameters import (
    Seed,
    Several,
    number,
)
from bouncing_ball.datasets.shards import Arrays, Found, Part
from bouncing_ball.datasets.variables import Variable, describe, described
from bouncing_ball.long_run.destination import final_motions
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
    "refuted_ratio": Variable(
        "largest frequency ratio at which it is known that the contact has not the restitution "
        "model's locked period, 0 if there is none",
        symbol="ϖ",
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
    "period_from": Variable("smallest locked period of the places that are compared"),
    "ordered_pairs": Variable(
        "pairs of places with different locked periods of which it is known which needs the larger "
        "frequency ratio"
    ),
    "concordance": Variable(
        "share of these pairs in which the longer period needs the larger frequency ratio"
    ),
    "concordance_low": Variable("lower limit of the confidence interval of the concordant share"),
    "concordance_high": Variable("upper limit of the confidence interval of the concordant share"),
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


PERIODS_FROM = (1, 5)
"""The smallest locked periods of two groups of places: all, and those without short periods."""

# Samples of the bootstrap, and the seed of its random numbers.
_RESAMPLED = 500
_SEED = 1


def concordance(period: np.ndarray, low: np.ndarray, high: np.ndarray) -> tuple[int, float]:
    """Of pairs whose order is known, how often the longer period needs the larger ϖ.

    The ϖ that a place needs is censored: it is known to lie above ``low``, and not above ``high``.
    Which of two places needs the larger one is known if these ranges do not overlap. Pairs with
    equal periods, and those whose order is not known, are left out, as in Kendall's rank
    correlation τ for censored data; without censoring and ties the share is (1 + τ)/2. As the pairs
    that are left are no random ones, this is an estimate for them alone.

    Parameters
    ----------
    period, low, high : array, shape (places,)
        The locked periods, and the ends of the ranges, low < high; ``high`` may be infinite.

    Returns
    -------
    tuple
        The number of pairs and the share; NaN if there are none.

    Examples
    --------
    The second and the third place need ϖ above 30, but it is not known which needs the larger one:

    >>> concordance(np.array([1, 6, 9]), np.array([0, 30, 30]), np.array([10, 100, np.inf]))
    (2, 1.0)
    """
    longer = period[:, np.newaxis] > period
    needs_more = low[:, np.newaxis] >= high
    agree = int((longer & needs_more).sum())
    pairs = agree + int((longer & needs_more.T).sum())
    return pairs, agree / pairs if pairs else np.nan


def concordance_with_limits(
    period: np.ndarray, low: np.ndarray, high: np.ndarray, confidence: float
) -> tuple[int, np.ndarray]:
    """:func:`concordance` with the limits of its interval, from a bootstrap over the places.

    Returns
    -------
    tuple
        The number of pairs; and the share, its lower limit and its upper limit, shape (3,).
    """
    pairs, found = concordance(period, low, high)
    if not pairs:
        return pairs, np.full(3, np.nan)
    drawn = np.random.default_rng(_SEED).integers(period.size, size=(_RESAMPLED, period.size))
    shares = [concordance(period[k], low[k], high[k])[1] for k in drawn]
    tail = (1 - confidence) / 2
    return pairs, np.array([found, *np.nanquantile(shares, [tail, 1 - tail])])


def returns_at_places(
    parameters: LockedOrbits, release: Release, part: Part = np.asarray
) -> Arrays:
    """The returns of the restitution model at each place, and whether the contact locks as it does.

    Returns
    -------
    dict of array
        ``periods``, shape (place,), of the locked orbit by as many digits as it needs, 0 if the
        ball does not stick again within the impacts; ``periods_by_doubles`` of
        :class:`~bouncing_ball.beyond.motions.lift_off.Lap`, shape (change, place), first without a
        change of Λ and then with each change; ``same``, shape (ϖ, place), whether the
        contact has a locked orbit of the same period; and ``known``, of this shape, whether that
        can be told: its motion is decided, and if it is locked, doubles tell its period.
    """
    r, lam = part(parameters.places())
    ratios = np.array(parameters.frequency_ratio)[:, np.newaxis]
    changes = np.array([0.0, *parameters.shifts])[:, np.newaxis]
    periods, _ = laps_by_many_digits(r, lam, parameters.impacts)
    by_doubles = laps(r, lam + changes, parameters.impacts).periods
    contact = three_models(r, ratios, release).contact
    motion = final_motions(contact, lam, -np.pi / 2, 0.0, impacts=parameters.impacts)
    same = (motion.kind == Kind.LOCKED) & (motion.periods == periods)
    known = (motion.kind != Kind.UNDECIDED) & ~motion.is_unresolved()
    return {"periods": periods, "periods_by_doubles": by_doubles, "same": same, "known": known}


def locked_orbits(
    data: Mapping[str, xr.Dataset], parameters: LockedOrbits, release: Release, found: Found = None
) -> xr.Dataset:
    """The places at which a contact has the locked orbit of the restitution model.

    The places are uniformly distributed in Λ and r. Over ``node``, with the coordinates
    ``restitution`` and ``amplitude``, the dataset has the ``periods`` of
    :func:`bouncing_ball.beyond.exhibits.locking.laps_by_many_digits`, which are 0 where the ball
    does not stick again within the impacts; such places are left out of all shares.
    ``needed_ratio`` is the smallest of the given ϖ above which the contact is known to lock with
    the same period after a rest on the table, infinite if it is not known to do so at the largest
    ϖ, and ``refuted_ratio`` the largest of them at which it is known not to, 0 if there is none:
    the ϖ that is needed lies between them. ``last_known`` (node) is whether its motion at the
    largest ϖ is known. ``same`` (frequency_ratio) is the share of places with the same period, and
    ``same_known`` (frequency_ratio) that at which it is known whether it is the same, so that the
    share may be larger by 1 - ``same_known``.
    ``concordance`` (period_from) is, for the places with at least this period, the share of
    the ``ordered_pairs`` in which the longer period needs the larger ϖ, see :func:`concordance`.
    ``jump_share`` (shift) is the share of places next to a discontinuity, at which the period
    changes, or is not found, if Λ changes by the shift, of those at which doubles find one, and
    ``uncertainty_exponent`` its exponent.
    Each has a lower and an upper limit, ``_low`` and ``_high``. The variables of
    :func:`bouncing_ball.beyond.exhibits.lives.transients`, ``ext_lives``, are added; the
    coordinates of its cases are ``case_restitution`` and ``case_amplitude`` here.
    """
    found = found or returns_at_places(parameters, release)
    level = parameters.confidence
    ratios = np.array(parameters.frequency_ratio)
    shifts = np.array(parameters.shifts)
    r, lam = parameters.places()
    period = found["periods"]
    first, *beside = found["periods_by_doubles"]
    sticks = period > 0
    # A lap that has lost the digits of a double has another period after each change of Λ, by
    # doubles as by many digits.
    by_doubles = first > 0
    same = found["same"]
    known = found["known"]
    changed = np.array(beside) != first
    needed = _needed_ratio(ratios, same)
    refuted = np.where(known & ~same, ratios[:, np.newaxis], 0.0).max(axis=0)
    groups = [sticks & (period >= least) for least in PERIODS_FROM]
    ordered = [
        concordance_with_limits(period[one], refuted[one], needed[one], level) for one in groups
    ]
    nodes = {
        "periods": period,
        "needed_ratio": np.where(sticks, needed, np.nan),
        "refuted_ratio": np.where(sticks, refuted, np.nan),
        "last_known": known[-1],
    }
    estimates = {
        "same": ("frequency_ratio", [share_with_limits(x[sticks], level) for x in same]),
        "concordance": ("period_from", [share for _, share in ordered]),
        "jump_share": ("shift", [share_with_limits(x[by_doubles], level) for x in changed]),
        "uncertainty_exponent": ((), uncertainty_exponent(changed[:, by_doubles].T, shifts, level)),
    }
    variables: dict[str, Any] = {name: ("node", values) for name, values in nodes.items()}
    variables |= {
        "ordered_pairs": ("period_from", [pairs for pairs, _ in ordered]),
        "same_known": ("frequency_ratio", known[:, sticks].mean(axis=1)),
    }
    orbits = described(
        variables | with_limits(estimates),
        coords={
            "restitution": ("node", r),
            "amplitude": ("node", lam),
            "frequency_ratio": ratios,
            "shift": shifts,
            "period_from": list(PERIODS_FROM),
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
