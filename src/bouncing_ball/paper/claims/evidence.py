"""The numbers that decide the verbal statements of the paper, taken from the figures' datasets.

This module simulates and solves nothing.
"""

import numpy as np
import xarray as xr

from bouncing_ball.paper.claims import as_printed as printed
from bouncing_ball.paper.claims.paper_parameters import Data
from bouncing_ball.paper.exhibits.printed_table1 import PERMANENT_CONTACT
from bouncing_ball.periodic.orbit import Bifurcation

BOUNDS = tuple(map(str, Bifurcation))
TOLERANCE = 0.01
"""The paper's limit for the error of the restitution model, 1 % (Eqs. 37 and 38)."""
STIFF = 100.0
"""ϖ above which the paper treats both models as equal."""
# Up to rounding a point of a logarithmic grid equals a round number, a sample a bifurcation, and
# without damping r_a equals r.
GRID = 1e-9


def curves(data: Data, *names: str) -> xr.Dataset:
    """The sweeps of figures along ϖ with all their curves; dimensions ``orbit``,
    ``frequency_ratio``.
    """
    read = [
        "restitution",
        "amplitude",
        "apparent_restitution",
        "bounce_velocity",
        "max_height",
        "phase",
    ]
    parts = []
    for name in names:
        sweep = data[name].reset_coords()[read].rename(case="orbit")
        pairs = zip(sweep.restitution.values, sweep.amplitude.values, strict=True)
        # Rounding does not change six digits, and six digits distinguish the curves.
        labels = [f"{name} r={r:.6g} Λ={lam:.6g}" for r, lam in pairs]
        parts.append(sweep.assign(n=data[name].attrs["n"]).assign_coords(orbit=labels))
    return xr.concat(parts, "orbit", data_vars="all")


def apparent(data: Data) -> xr.DataArray:
    """r_a - r along the curves of Figs. 5 and 6, over ``orbit`` and ``frequency_ratio``."""
    sweep = curves(data, "fig05", "fig06")
    return sweep.apparent_restitution - sweep.restitution


def worst_when_stiff(values: xr.DataArray) -> xr.DataArray:
    """Largest value among contacts that the paper regards as stiff; NaN without such contacts."""
    stiff = values.frequency_ratio >= STIFF * (1 - GRID)
    return values.where(stiff).max("frequency_ratio")


def rise_of_error(data: Data) -> xr.DataArray:
    """Largest increase of |r_a - r| above its value at a more compliant contact, by ``orbit``."""
    error = abs(apparent(data)).transpose("orbit", "frequency_ratio")
    smallest_so_far = np.fmin.accumulate(error.values, axis=1)
    return (error - smallest_so_far).max("frequency_ratio")


def dip(data: Data, amplitude: float) -> xr.DataArray:
    """Greatest depth below r that the curve of Fig. 6 for an amplitude reaches."""
    sweep = curves(data, "fig06").sel(orbit=f"fig06 r=0.65 Λ={amplitude:g}")
    return -(sweep.apparent_restitution - sweep.restitution).min("frequency_ratio")


def short_of_lift(data: Data) -> xr.DataArray:
    """The smallest 1 - Λ sin φ of Fig. 6, with φ of Eq. 6.

    Where it is positive, r_a approaches r from below, because
    ``r_a - r = -ζ(1 + r)²(1 - Λ sin φ)/(nπϖ)`` to first order in 1/ϖ.
    """
    sweep = data["fig06"]
    phase, _ = printed.fixed_point(sweep.attrs["n"], sweep.restitution, sweep.amplitude)
    return (1 - sweep.amplitude * np.sin(phase)).min()


@np.errstate(divide="ignore", invalid="ignore")  # the phase is 0 at the saddle-node
def stiff_orbit_error(data: Data) -> xr.DataArray:
    """Figs. 5, 6 and 10: largest relative errors of the restitution model among stiff contacts.

    The result is over ``orbit`` and ``measure``. The relative error of a phase depends on the
    origin of the phase, so that the error is also given as a share of a cycle.
    """
    sweep = curves(data, "fig05", "fig06", "fig10")
    n = sweep.n
    r = sweep.restitution
    lam = sweep.amplitude
    phase, velocity = printed.fixed_point(n, r, lam)
    errors = {
        "max_height": sweep.max_height / (lam * np.sin(phase) + velocity**2 / 2) - 1,
        "bounce_velocity": sweep.bounce_velocity / velocity - 1,
        "apparent_restitution": sweep.apparent_restitution / r - 1,
        "phase": sweep.phase / phase - 1,
        "phase in cycles": (sweep.phase - phase) / (2 * np.pi),
    }
    every = xr.concat(errors.values(), xr.Variable("measure", list(errors)))
    return worst_when_stiff(abs(every)).transpose("orbit", "measure")


def amplitude_matters_below(data: Data) -> float:
    """Fig. 10: the interpolated ϖ below which the curves differ by more than 1 % of nπ."""
    sweep = data["fig10"]
    ratio = sweep.frequency_ratio.values
    apart = sweep.bounce_velocity.max("case") - sweep.bounce_velocity.min("case")
    share = np.ravel(apart / sweep.restitution_bounce_velocity)
    last = int(np.flatnonzero(share > TOLERANCE).max(initial=0))
    # Between these two points the share falls with ϖ.
    pair = slice(last + 1, last - 1 if last else None, -1)
    return float(np.exp(np.interp(TOLERANCE, share[pair], np.log(ratio[pair]))))


def inadmissible_orbits(data: Data) -> int:
    """Number of inadmissible orbits in our versions of the paper's figures."""
    figures = ("fig03", "fig05", "fig06", "fig08", "fig09", "fig10", "fig13", "fig14", "fig15")
    return sum(int((~data[name].admissible.astype(bool)).sum()) for name in figures)


def contact_durations(data: Data, place: int) -> list[xr.DataArray]:
    """Shortest and longest contact of a branch of Figs. 8 and 9.

    ``place`` is 0 for the most compliant contact and -1 for the stiffest.
    """
    ends = []
    for name in ("fig08", "fig09"):
        figure = data[name].sortby("frequency_ratio")
        durations = figure.contact_duration.isel(frequency_ratio=place)
        ends += [durations.min(), durations.max()]
    return ends


def folds(data: Data) -> int:
    """The smallest number of saddle-nodes on a branch of Figs. 8 and 9."""
    counts = []
    for name in ("fig08", "fig09"):
        is_fold = data[name].special_kind == Bifurcation.SADDLE_NODE
        counts.append(int(is_fold.sum("special").min()))
    return min(counts)


@np.errstate(invalid="ignore")  # a range without an end
def range_error(data: Data) -> xr.DataArray:
    """Relative errors of the restitution model at both ends of the range of Fig. 15.

    The result is over ``bound``, and NaN for an end that does not exist. The special points are in
    the order of the branch, which ends on the stable side.
    """
    both = data["fig15"].isel(frequency_ratio=0)
    kinds = both.special_kind.values
    lam = both.special_amplitude.values
    ends = [lam[kinds == kind][-1] if np.any(kinds == kind) else np.nan for kind in BOUNDS]
    rigid = np.array([both.saddle_node_amplitude, both.period_doubling_amplitude], dtype=float)
    return xr.DataArray(np.abs(ends / rigid - 1), {"bound": list(BOUNDS)})


def _rows(data: Data, source: str) -> xr.DataArray:
    """Table 1, ``computed`` or ``printed``, from the stiffest row to the most compliant."""
    return data["table1"][source].sortby("frequency_ratio", ascending=False)


def row_shift(data: Data) -> xr.DataArray:
    """Change of the computed ends of Table 1 from each row to the next more compliant row."""
    return _rows(data, "computed").diff("frequency_ratio")


def stiff_difference(data: Data, source: str, impact_map: str) -> xr.DataArray:
    """Distance of the stiffest row of Table 1 from the restitution model's ranges, in Λ."""
    ranges = data["table1"].restitution_range.sel(impact_map=impact_map)
    return np.abs(_rows(data, source).isel(frequency_ratio=0) - ranges)


def printed_slight_move(data: Data) -> xr.DataArray:
    """The largest relative change of the printed ends from the stiffest row of Table 1 to the next.

    The paper calls this change slight.
    """
    rows = _rows(data, "printed")
    stiffest = rows.isel(frequency_ratio=0, drop=True)
    following = rows.isel(frequency_ratio=1, drop=True)
    return np.abs(following / stiffest - 1).max()


def period_doubling_lowest(data: Data) -> xr.DataArray:
    """The ϖ at which the period doubling is lowest, for the families n of Table 1."""
    return data["lowest_doubling"].period_doubling_turn.reindex(n=data["table1"].n)


def permanent_contact_error(data: Data) -> float:
    """Fig. 16: the relative error at the printed threshold; NaN outside the scan."""
    error = data["fig16"].relative_error
    grid = np.log(error.frequency_ratio.values)
    where = np.log(PERMANENT_CONTACT)
    return float(np.interp(where, grid, error.values, left=np.nan, right=np.nan))
