"""The frequency ratio at which a period doubling is lowest.

With falling ϖ the period doubling first moves to smaller Λ, turns, and then moves to larger Λ. The
paper says that it rises (Figs. 8 and 9, Table 1).
"""

import numpy as np
import xarray as xr
from bouncing_ball_beyond.models.contact_model import ContactModel
from bouncing_ball_beyond.models.damping import Release, damping_ratio
from bouncing_ball_beyond.models.spring_damper import SpringDamper
from bouncing_ball_beyond.periodic.one_impact import n_t

from bouncing_ball.datasets.parameters import Family, LossyRestitution, Many, Parameters, Span
from bouncing_ball.datasets.variables import described


class FamiliesAlongRatio(Parameters):
    """Several families, whose period doublings are followed along ϖ."""

    n: Many[Family]
    restitution: LossyRestitution
    frequency_ratio: Span


def lowest_along_ratio(
    ratios: np.ndarray, amplitude: np.ndarray, zeta: float, release: Release, n: np.ndarray
) -> np.ndarray:
    """The ϖ at which the period doubling of each family is lowest, shape (n,).

    Parameters
    ----------
    ratios : ndarray, shape (ϖ,)
        Increasing grid.
    amplitude : ndarray, shape (n, ϖ)
        Λ of the period doublings on the grid; NaN where there is none.
    zeta : float
        The damping ratio ζ.
    release : Release
    n : ndarray, shape (n,)
        The families.

    Returns
    -------
    ndarray
        NaN for a family whose period doubling is lowest at an end of the grid.
    """
    # This module of scipy is not loaded on first use, and its import takes a third of a second.
    from scipy.optimize.elementwise import find_minimum

    def doubling(log_ratio: np.ndarray, n: np.ndarray) -> np.ndarray:
        model = ContactModel(SpringDamper(np.exp(log_ratio), zeta, release))
        return n_t.period_doubling(model, n).amplitude

    lowest = np.argmin(np.where(np.isnan(amplitude), np.inf, amplitude), axis=-1)
    # Elsewhere the neighbours of the lowest sample are no bracket of a minimum.
    inside = np.flatnonzero((lowest > 0) & (lowest < ratios.size - 1))
    turns = np.full(lowest.shape, np.nan)
    if inside.size:
        bracket = tuple(np.log(ratios[lowest[inside] + k]) for k in (-1, 0, 1))
        found = find_minimum(doubling, bracket, args=(n[inside],))
        turns[inside] = np.where(found.success, np.exp(found.x), np.nan)
    return turns


def lowest_period_doublings(parameters: FamiliesAlongRatio, release: Release) -> xr.Dataset:
    """The ϖ at which the period doubling of each family is lowest, and its Λ there.

    The dataset has ``period_doubling_turn``, a ϖ, and ``period_doubling_amplitude``, shape (n,);
    NaN for a family whose period doubling is lowest at an end of the scan.
    """
    families = np.array(parameters.n)
    ratios = parameters.frequency_ratio.grid()
    zeta = float(damping_ratio(parameters.restitution))
    scanned = ContactModel(SpringDamper(ratios, zeta, release))
    amplitude = n_t.period_doubling(scanned, families[:, np.newaxis]).amplitude
    turns = lowest_along_ratio(ratios, amplitude, zeta, release, families)
    known = np.isfinite(turns)
    lowest = np.full(turns.shape, np.nan)
    at_turns = ContactModel(SpringDamper(turns[known], zeta, release))
    lowest[known] = n_t.period_doubling(at_turns, families[known]).amplitude
    return described(
        {
            "period_doubling_turn": ("n", turns),
            "period_doubling_amplitude": ("n", lowest),
        },
        coords={"n": families},
    )
