"""At which ϖ a contact has the locked orbit of the restitution model (beyond the paper)."""

from collections.abc import Mapping
from typing import Annotated

import numpy as np
import xarray as xr
from scipy.stats import norm, spearmanr

from bouncing_ball.attractors.lift_off import returns
from bouncing_ball.attractors.mapper import label
from bouncing_ball.attractors.motions import Kind
from bouncing_ball.contacts.spring_damper import Release
from bouncing_ball.datasets.shards import Arrays, Found, Part
from bouncing_ball.datasets.variables import described
from bouncing_ball.parameters import Many, Seed, number
from bouncing_ball.studies.attractors import Grid, models, share, with_limits
from bouncing_ball.studies.uncertainty import exponent

# Edges of the ranges of ϖ w/S.
_EDGES = np.geomspace(1e-4, 1e4, 17)
PREDICTORS = ("S/w", "periods")


class LockedOrbits(Grid):
    """Random places in a range of (Λ, r), and places at which transients are followed."""

    nodes: Annotated[int, number("random places", ge=10, le=100000)]
    shifts: Many[Annotated[float, number("changes of Λ", gt=0, le=1)]]
    seed: Seed

    def places(self) -> np.ndarray:
        random, of = np.random.default_rng(self.seed), (self.restitution, self.amplitude)
        return np.array([random.uniform(x.min, x.max, self.nodes) for x in of])


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
        The correlation, its lower limit and its upper limit.
    """
    rho = spearmanr(one, other).statistic
    width = norm.ppf((1 + confidence) / 2) * np.sqrt((1 + rho**2 / 2) / (one.size - 3))
    return np.array([rho, *np.tanh(np.arctanh(rho) + width * np.array([-1, 1]))])


def returns_at_places(
    parameters: LockedOrbits, release: Release, part: Part = np.asarray
) -> Arrays:
    """The returns of the restitution model at each place, and whether the contact locks as it does.

    Returns
    -------
    dict of array
        The fields of :class:`~bouncing_ball.attractors.lift_off.Return`, shape (change, place),
        first without a change of Λ and then with each change; and ``same``, shape (ϖ, place),
        whether the contact has a locked orbit of the same period.
    """
    r, lam = part(parameters.places())
    ratios, shifts = (np.array([x]).T for x in (parameters.frequency_ratio, parameters.shifts))
    found = returns(r, lam + np.concatenate([[[0.0]], shifts]), parameters.impacts)
    contact = models(r, ratios, release)[-1].impact_law
    motion = label(contact, lam, -np.pi / 2, 0.0, impacts=parameters.impacts)
    same = (motion.kind == Kind.LOCKED) & (motion.periods == found.periods[0])
    return {**found._asdict(), "same": same}


def locked_orbits(
    data: Mapping[str, xr.Dataset], parameters: LockedOrbits, release: Release, found: Found = None
) -> xr.Dataset:
    """The places at which a contact has the locked orbit of the restitution model, and predictors.

    The places are uniformly distributed in Λ and r. Over ``node`` the dataset has ``restitution``
    and ``amplitude``, and ``periods``, ``sensitivity`` S and ``wait`` w of
    :func:`bouncing_ball.attractors.lift_off.returns`, which are 0 or NaN where the ball is not
    found to stick again; such places are left out of all shares. ``needed_ratio`` is the smallest
    of the given ϖ above which the contact locks with the same period after a rest on the table; it
    is infinite if the contact does not do so at the largest ϖ.
    ``same`` (frequency_ratio) is the share of places with the same period, and
    ``same_by_prediction`` (predicted) this share in ranges of ϖ w/S, for all ϖ together.
    ``rank_correlation`` (predictor) is the correlation of a predictor with the smallest ϖ.
    ``jump_share`` (shift) is the share of places next to a discontinuity, at which the period
    changes, or is not found, if Λ changes by the shift, and ``uncertainty_exponent`` its exponent.
    Each has a lower and an upper limit, ``_low`` and ``_high``. The variables of
    :func:`bouncing_ball.studies.transients.transients`, ``ext_lives``, are added.
    """
    found, level = found or returns_at_places(parameters, release), parameters.confidence
    ratios, shifts = (np.array(x) for x in (parameters.frequency_ratio, parameters.shifts))
    (r, lam), (period, *moved), same = parameters.places(), found["periods"], found["same"]
    s, wait = found["sensitivity"][0], found["wait"][0]
    sticks, changed = period > 0, np.array(moved) != period
    right = np.logical_and.accumulate(same[::-1])[::-1]
    least = np.where(right.any(axis=0), ratios[np.argmax(right, axis=0)], np.inf)
    place = np.digitize(ratios[:, np.newaxis] * wait / s, _EDGES) - 1
    by_place = [share(same[(place == k) & sticks], level)[1:] for k in range(_EDGES.size - 1)]
    same, changed = same[:, sticks], changed[:, sticks]
    correlations = [correlation(x[sticks], least[sticks], level) for x in (s / wait, period)]
    nodes = {"restitution": r, "amplitude": lam, "periods": period, "sensitivity": s}
    nodes |= {"wait": wait, "needed_ratio": np.where(sticks, least, np.nan)}
    limited = {
        "same": ("frequency_ratio", [share(x, level)[1:] for x in same]),
        "same_by_prediction": ("predicted", by_place),
        "rank_correlation": ("predictor", correlations),
        "jump_share": ("shift", [share(x, level)[1:] for x in changed]),
        "uncertainty_exponent": ((), exponent(changed.T, shifts, level)),
    }
    orbits = described(
        {name: ("node", values) for name, values in nodes.items()} | with_limits(limited),
        coords={
            "frequency_ratio": ratios,
            "predicted": np.sqrt(_EDGES[1:] * _EDGES[:-1]),
            "predictor": list(PREDICTORS),
            "shift": shifts,
        },
    )
    return orbits.merge(data["ext_lives"])
