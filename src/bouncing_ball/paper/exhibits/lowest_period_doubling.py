"""The frequency ratio at which a period doubling is lowest.

With falling ϖ the period doubling first moves to smaller Λ, turns, and then moves to larger Λ. The
paper says that it rises (Figs. 8 and 9, Table 1).
"""

import numpy as np
import xarray as xr

from bouncing_ball.datasets.parameters import Family, LossyRestitution, Many, Parameters, Span
from bouncing_ball.datasets.variables import described
from bouncing_ball.models.damping import Release
from bouncing_ball.models.spring_damper import SpringDamper
from bouncing_ball.periodic.explicit import explicit_branch
from bouncing_ball.periodic.orbit import Bifurcation


class FamiliesAlongRatio(Parameters):
    """Several families, whose period doublings are followed along ϖ."""

    n: Many[Family]
    restitution: LossyRestitution
    frequency_ratio: Span


def lowest_period_doublings(parameters: FamiliesAlongRatio, release: Release) -> xr.Dataset:
    """The ϖ at which the period doubling of each family is lowest, and its Λ there.

    The dataset has ``period_doubling_turn``, a ϖ, and ``period_doubling_amplitude``, shape (n,);
    NaN for a family whose period doubling is lowest at an end of the scan.
    """
    # This module of scipy is not loaded on first use, and its import takes a third of a second.
    from scipy.optimize.elementwise import find_minimum

    def doubling(log_ratio: np.ndarray, n: np.ndarray) -> np.ndarray:
        contacts = SpringDamper.from_restitution(parameters.restitution, np.exp(log_ratio), release)
        return explicit_branch(contacts).bifurcation(Bifurcation.PERIOD_DOUBLING, n).amplitude

    families = np.array(parameters.n)
    places = np.log(parameters.frequency_ratio.grid())
    scanned = doubling(places, families[:, np.newaxis])
    lowest = np.argmin(np.where(np.isnan(scanned), np.inf, scanned), axis=-1)
    turns = np.full(families.size, np.nan)
    amplitude = np.full(families.size, np.nan)
    # At an end of the scan the neighbours of the lowest sample are no bracket of a minimum.
    inside = np.flatnonzero((lowest > 0) & (lowest < places.size - 1))
    if inside.size:
        bracket = tuple(places[lowest[inside] + k] for k in (-1, 0, 1))
        found = find_minimum(doubling, bracket, args=(families[inside],))
        known = inside[found.success]
        turns[known] = np.exp(found.x[found.success])
        amplitude[known] = doubling(found.x[found.success], families[known])
    return described(
        {
            "period_doubling_turn": ("n", turns),
            "period_doubling_amplitude": ("n", amplitude),
        },
        coords={"n": families},
    )
