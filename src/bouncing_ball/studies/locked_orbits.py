"""At which ϖ a contact has the locked orbit of the restitution model (beyond the paper)."""

from typing import Annotated

import numpy as np
import xarray as xr
from scipy.stats import norm, spearmanr

from bouncing_ball.attractors.lift_off import returns
from bouncing_ball.attractors.mapper import label
from bouncing_ball.attractors.motions import Kind
from bouncing_ball.contacts.spring_damper import Release
from bouncing_ball.datasets.variables import described
from bouncing_ball.parameters import Many, Seed, number
from bouncing_ball.studies.attractors import Grid, models, share, with_limits
from bouncing_ball.studies.transients import Transients, transients
from bouncing_ball.studies.uncertainty import exponent

# Edges of the ranges of ϖ w/S.
_EDGES = np.geomspace(1e-4, 1e4, 17)
PREDICTORS = ("S/w", "periods")


class LockedOrbits(Grid):
    """Random places in the range of (Λ, r)."""

    nodes: Annotated[int, number("random places", ge=10, le=100000)]
    shifts: Many[Annotated[float, number("changes of Λ", gt=0, le=1)]]
    seed: Seed
    transients: Transients


def correlation(one: np.ndarray, other: np.ndarray, confidence: float) -> np.ndarray:
    """Spearman's rank correlation with its limits (D. G. Bonett and T. A. Wright, 2000)."""
    rho = spearmanr(one, other).statistic
    width = norm.ppf((1 + confidence) / 2) * np.sqrt((1 + rho**2 / 2) / (one.size - 3))
    return np.array([rho, *np.tanh(np.arctanh(rho) + width * np.array([-1, 1]))])


def locked_orbits(parameters: LockedOrbits, release: Release) -> xr.Dataset:
    """Where a contact has the restitution model's locked orbit, and what predicts it.

    The places are uniformly distributed in Λ and r. Over each ``node``, ``restitution``,
    ``amplitude``, ``periods``, ``sensitivity`` S and ``wait`` w are those of
    :func:`bouncing_ball.attractors.lift_off.returns`, 0 or NaN where a ball that lifts off is not
    seen to stick again; shares are of the others. ``needed_ratio`` is the smallest ϖ of those tried
    from which on the contact locks with the same period from a rest on the table, infinite if that
    is not seen at the largest one.
    ``same`` (frequency_ratio) is the share with the same period, and ``same_by_prediction``
    (predicted) that by ranges of ϖ w/S, for all ϖ together. ``rank_correlation`` (predictor) is
    that with the smallest ϖ. ``jump_share`` (shift) is the share of the places next to a
    discontinuity, whose period changes with a change of Λ, or is not found any more, and
    ``uncertainty_exponent`` its exponent. Each has a lower and an upper limit, ``_low`` and
    ``_high``. The variables of :func:`bouncing_ball.studies.transients.transients` are added.
    """
    level, random = parameters.confidence, np.random.default_rng(parameters.seed)
    r, lam = (
        random.uniform(x.min, x.max, parameters.nodes)
        for x in (parameters.restitution, parameters.amplitude)
    )
    ratios, shifts = (np.array(x) for x in (parameters.frequency_ratio, parameters.shifts))
    # All changes of Λ, of which the first is 0, are followed together.
    found = returns(r, lam + np.array([[0.0], *shifts[:, np.newaxis]]), parameters.impacts)
    (period, *moved), s, wait = found.periods, found.sensitivity[0], found.wait[0]
    sticks, changed = period > 0, np.array(moved) != period
    contact = models(r, ratios[:, np.newaxis], release)[-1].impact_law
    motion = label(contact, lam, -np.pi / 2, 0.0, impacts=parameters.impacts)
    same = (motion.kind == Kind.LOCKED) & (motion.periods == period)
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
    data = described(
        {name: ("node", values) for name, values in nodes.items()} | with_limits(limited),
        coords={
            "frequency_ratio": ratios,
            "predicted": np.sqrt(_EDGES[1:] * _EDGES[:-1]),
            "predictor": list(PREDICTORS),
            "shift": shifts,
        },
    )
    return data.merge(transients(parameters.transients, release))
