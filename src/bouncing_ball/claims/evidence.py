"""What statements of the paper in words are decided by, read off the figures' datasets.

Nothing is simulated or solved: datasets in, numbers out. A *softening* is the change
from one row of Table 1 to the next softer one.
"""

from collections.abc import Mapping

import numpy as np
import xarray as xr

from bouncing_ball.claims import as_printed as printed
from bouncing_ball.claims.parameters import PERMANENT_CONTACT, STIFF, TOLERANCE
from bouncing_ball.claims.verdict import largest
from bouncing_ball.orbits import restitution_orbit
from bouncing_ball.orbits.stability import Bifurcation

Data = Mapping[str, xr.Dataset]
BOUNDS = tuple(map(str, Bifurcation))
# A logarithmic grid meets its round numbers, and a sample a bifurcation, but for rounding.
_GRID = 1e-9


def sampled_threshold(error: np.ndarray, ratio: np.ndarray, tolerance: float) -> float:
    """The ϖ above which a sampled error stays within a tolerance.

    Between the last sample outside and the next one the error is taken for a
    power of ϖ. NaN if no sample, or the last one, is outside, or if a sample
    that is needed has no finite error.

    Examples
    --------
    >>> ratio = np.array([1.0, 10.0, 100.0])
    >>> round(sampled_threshold(1 / ratio, ratio, 0.05), 10)
    20.0
    """
    outside = np.flatnonzero(~(error <= tolerance))
    if not outside.size or outside[-1] == len(ratio) - 1:
        return np.nan
    pair = slice(outside[-1], outside[-1] + 2)
    x, y = np.log(ratio[pair]), np.log(np.maximum(error[pair], np.finfo(float).tiny))
    share = (np.log(tolerance) - y[0]) / (y[1] - y[0])
    return float(np.exp(x[0] + share * (x[1] - x[0]))) if np.isfinite(y).all() else np.nan


def worst_when_stiff(values: xr.DataArray) -> xr.DataArray:
    """Largest value among contacts that the paper takes for stiff, NaN if there is none."""
    stiff = values.frequency_ratio >= STIFF * (1 - _GRID)
    return values.where(stiff).max("frequency_ratio")


def _curves(data: Data, names: tuple[str, ...], dim: str, read) -> xr.DataArray:
    """What is read off each sweep, along one dimension of the curves of all of them."""
    parts = []
    for name in names:
        values = read(data[name]).reset_coords(drop=True).rename(case=dim)
        pairs = zip(data[name].restitution.values, data[name].amplitude.values, strict=True)
        # The digits that rounding leaves, so that no two are called alike.
        labels = [f"{name} r={r:.12g} Λ={lam:.12g}" for r, lam in pairs]
        parts.append(values.assign_coords({dim: labels}))
    return xr.concat(parts, dim)


def apparent(data: Data, read) -> xr.DataArray:
    """What is read off r_a - r and r, curve by curve of Figs. 5 and 6."""

    def of(sweep: xr.Dataset) -> xr.DataArray:
        return read((sweep.apparent_restitution - sweep.restitution), sweep.restitution)

    return _curves(data, ("fig05", "fig06"), "curve", of)


def rebound(data: Data) -> xr.DataArray:
    """How much farther from r the apparent restitution is than for some softer contact."""

    def of(difference: xr.DataArray, _: xr.DataArray) -> xr.DataArray:
        error = abs(difference)
        axis = error.get_axis_num("frequency_ratio")
        closest = error.copy(data=np.fmin.accumulate(error.values, axis=axis))
        return (error - closest).max("frequency_ratio")

    return apparent(data, of)


def dip(data: Data, amplitude: float) -> xr.DataArray:
    """How far the curve of Fig. 6 at an amplitude sinks below r."""
    dips = apparent(data, lambda difference, _: -difference.min("frequency_ratio"))
    return dips.sel(curve=f"fig06 r=0.65 Λ={amplitude:g}")


@np.errstate(divide="ignore", invalid="ignore")  # without damping there is no dip
def lift(data: Data) -> tuple[xr.DataArray, xr.DataArray]:
    """1 - Λ sin φ of Fig. 6 by Eq. 6, and as measured at the stiff end of its curves.

    To first order in 1/ϖ, ``r_a - r = -ζ(1 + r)²(1 - Λ sin φ)/(nπϖ)``: r_a comes from
    below r exactly where Λ sin φ < 1. The limit of nπϖ(r_a - r) is extrapolated from
    the two ends of the stiffest decade.
    """
    sweep = data["fig06"]
    n, r, ratio = sweep.attrs["n"], sweep.restitution, sweep.frequency_ratio
    phase, _ = printed.fixed_point(n, r, sweep.amplitude)
    scaled = n * np.pi * ratio**2 * (sweep.apparent_restitution - r)
    stiffest = ratio.values[-1]
    high, low = (scaled.sel(frequency_ratio=x, method="nearest") for x in (stiffest, stiffest / 10))
    limit = (high - low) / (high.frequency_ratio - low.frequency_ratio)
    measured = -limit / (printed.damping_ratio(r) * (1 + r) ** 2)
    return 1 - sweep.amplitude * np.sin(phase), measured


def short_of_lift(data: Data) -> xr.DataArray:
    """The smallest 1 - Λ sin φ of Fig. 6."""
    return lift(data)[0].min()


def apparent_restitution_law_error(data: Data) -> xr.DataArray:
    """How far the law of first order is off in Λ sin φ, at most."""
    by_law, measured = lift(data)
    return np.abs(measured - by_law).max()


def curves_of_fig06(data: Data) -> tuple[float, np.ndarray]:
    """Where the curves are farthest apart: by how much, and from each Λ to the next larger."""
    sweep = data["fig06"]
    curves = sweep.apparent_restitution.transpose("frequency_ratio", "case").values
    spread = np.ptp(curves, axis=1)
    widest = curves[int(np.nan_to_num(spread, nan=-1.0).argmax())]
    return float(np.nanmax(spread)), np.diff(widest[np.argsort(sweep.amplitude.values)])


@np.errstate(divide="ignore", invalid="ignore")  # the phase is 0 at the saddle-node
def stiff_orbit_error(data: Data) -> xr.DataArray:
    """Figs. 5, 6 and 10: relative errors of the restitution model among stiff contacts.

    Over ``orbit`` and ``measure``. That of a phase depends on its origin, and is there as
    a share of a cycle too.
    """

    def of(sweep: xr.Dataset) -> xr.DataArray:
        n, r, lam = sweep.attrs["n"], sweep.restitution, sweep.amplitude
        phase, velocity = printed.fixed_point(n, r, lam)
        height = restitution_orbit.max_height(n, lam, phase)
        errors = {
            "max_height": sweep.max_height / height - 1,
            "bounce_velocity": sweep.bounce_velocity / velocity - 1,
            "apparent_restitution": sweep.apparent_restitution / r - 1,
            "phase": sweep.phase / phase - 1,
            "phase in cycles": (sweep.phase - phase) / (2 * np.pi),
        }
        columns = [np.abs(error).reset_coords(drop=True) for error in errors.values()]
        return worst_when_stiff(xr.concat(columns, xr.Variable("measure", list(errors))))

    worst = _curves(data, ("fig05", "fig06", "fig10"), "orbit", of)
    return worst.transpose("orbit", "measure")


def release_pull(data: Data) -> float:
    """How hard a contact of Figs. 5, 6 and 10 pulls as it lets the ball go, in weights: 2ζϖδ′."""

    def of(sweep: xr.Dataset) -> xr.DataArray:
        leaving = sweep.bounce_velocity - sweep.amplitude * np.cos(sweep.release_phase)
        return 2 * printed.damping_ratio(sweep.restitution) * sweep.frequency_ratio * leaving

    return max(float(of(data[name]).max()) for name in ("fig05", "fig06", "fig10"))


def bounce_velocity_error(data: Data) -> xr.DataArray:
    """Fig. 10: the distance of the bouncing-off velocity from nπ, as a share of it."""
    sweep = data["fig10"]
    return np.abs(sweep.bounce_velocity / sweep.restitution_bounce_velocity - 1)


def departure(data: Data, tolerance: float) -> float:
    """Fig. 10: the ϖ above which every velocity stays within a tolerance of nπ."""
    error = bounce_velocity_error(data).max("case")
    return sampled_threshold(error.values, error.frequency_ratio.values, tolerance)


def spread_end(data: Data) -> float:
    """Fig. 10: the ϖ above which the curves are within the paper's limit of each other."""
    sweep = data["fig10"]
    velocity, limit = sweep.bounce_velocity, sweep.restitution_bounce_velocity
    spread = (velocity.max("case") - velocity.min("case")) / limit
    return sampled_threshold(spread.values, sweep.frequency_ratio.values, TOLERANCE)


def end_error(data: Data, name: str) -> xr.DataArray:
    """Fig. 13: the relative error of a phase at the stiffest contact."""
    last = data["fig13"].isel(frequency_ratio=-1)
    return np.abs(last[name] / last.restitution_phase - 1)


def stability_exceptions(data: Data) -> int:
    """Orbits of Fig. 3 that are stable elsewhere than between both bifurcations."""
    orbits = data["fig03"]
    doubling = orbits.period_doubling_amplitude.sel(impact_map="exact")
    node, lam = orbits.saddle_node_amplitude, orbits.amplitude
    between = (orbits.phase > 0) & (lam > node) & (lam < doubling)
    # At a bifurcation itself rounding decides.
    beside = (np.abs(lam / node - 1) > _GRID) & (np.abs(lam / doubling - 1) > _GRID)
    return int(((orbits.stable != between) & beside).sum())


def inadmissible_orbits(data: Data) -> int:
    """Orbits drawn in the paper's figures that are not orbits of the ball."""
    drawn = [data[f"fig{k:02d}"].admissible for k in (3, 5, 6, 8, 9, 10, 13, 14, 15)]
    return sum(int((~flags.astype(bool)).sum()) for flags in drawn)


def fold_duration(branches: xr.Dataset) -> float:
    """Duration of the contact at the saddle-node of the softest branch, NaN without one."""
    soft = branches.sortby("frequency_ratio").isel(frequency_ratio=0)
    # A soft branch may fold again, at a higher Λ, or not exist at all.
    folds = soft.where(soft.special_kind == BOUNDS[0], drop=True)
    order = np.argsort(folds.special_amplitude.values)
    return next(iter(folds.special_contact_duration.values[order]), np.nan)


def durations_at_one_amplitude(data: Data) -> int:
    """How many orbits of a branch of Figs. 8 and 9 share one Λ, for the branch with the fewest."""
    rows = [row[np.isfinite(row)] for k in (8, 9) for row in data[f"fig{k:02d}"].amplitude.values]
    return min(_shared(row) for row in rows if row.size > 1)


def _shared(amplitude: np.ndarray) -> int:
    """How many points of a sampled branch share one Λ, at most.

    Examples
    --------
    >>> _shared(np.array([2.0, 1.0, 3.0])), _shared(np.array([1.0, 2.0]))
    (2, 1)
    """
    below, above = np.sort(np.sort([amplitude[:-1], amplitude[1:]], axis=0), axis=1)
    levels = np.unique(amplitude)
    between = (levels[:-1] + levels[1:]) / 2
    return int(np.max(np.searchsorted(below, between) - np.searchsorted(above, between)))


def existence_domains(data: Data) -> int:
    """How many of Figs. 8-10 are drawn over the amplitude, with bifurcations."""
    located = [data[f"fig{k:02d}"].get("special_amplitude") for k in (8, 9, 10)]
    return sum(bool(np.isfinite(values).any()) for values in located if values is not None)


def ranges_of_fig15(data: Data) -> tuple[np.ndarray, np.ndarray]:
    """Ends of the stable range of Fig. 15: spring-damper model and restitution model.

    The special points are in the branch's order, which ends on the stable side: the
    last saddle-node, and the first period doubling after it; NaN where there is none.
    """
    both = data["fig15"].isel(frequency_ratio=0)
    kinds, lam = both.special_kind.values, both.special_amplitude.values
    nodes, doublings = (np.flatnonzero(kinds == kind) for kind in BOUNDS)
    doublings = doublings[doublings > nodes[-1]] if nodes.size else doublings[:0]
    ends = [lam[part[0]] if part.size else np.nan for part in (nodes[-1:], doublings)]
    rigid = both.saddle_node_amplitude, both.period_doubling_amplitude
    return np.array(ends), np.array(rigid, dtype=float)


def range_error(data: Data) -> xr.DataArray:
    """The restitution model's error on both ends of the range of Fig. 15."""
    soft, rigid = ranges_of_fig15(data)
    return xr.DataArray(np.abs(soft / rigid - 1), {"bound": list(BOUNDS)})


def _rows(data: Data, source: str) -> xr.DataArray:
    """Table 1, ``computed`` or ``printed``, from the stiffest row to the softest."""
    return data["table1"][source].sortby("frequency_ratio", ascending=False)


def softening(data: Data, source: str) -> xr.DataArray:
    """How the ends of Table 1, ``computed`` or ``printed``, move to the next softer row."""
    return _rows(data, source).diff("frequency_ratio")


def stiff_difference(data: Data, source: str, impact_map: str) -> xr.DataArray:
    """Distance of the stiffest row of Table 1 from the restitution model's ranges."""
    ranges = data["table1"].restitution_range.sel(impact_map=impact_map)
    return np.abs(_rows(data, source).isel(frequency_ratio=0) - ranges)


def printed_slight_move(data: Data) -> xr.DataArray:
    """The largest printed move from the stiffest row of Table 1 to the next one, relatively:
    what the paper calls slight."""
    stiffest, next_one = (_rows(data, "printed").isel(frequency_ratio=k, drop=True) for k in (0, 1))
    return np.abs(next_one / stiffest - 1).max()


def period_doubling_lowest(data: Data) -> xr.DataArray:
    """The ϖ at which the period doubling is lowest, for the families of Table 1."""
    turns = data["ext_release"].period_doubling_turn.sel(release="displacement", drop=True)
    return turns.reindex(n=data["table1"].n)


def period_doubling_drop(data: Data) -> xr.DataArray:
    """How far the period doubling is above its minimum at the stiffest contact, by family."""
    curve = data["ext_release"].bifurcation_amplitude.sel(
        release="displacement", bound=BOUNDS[1], drop=True
    )
    drop = curve.isel(frequency_ratio=-1, drop=True) - curve.min("frequency_ratio")
    return drop.reindex(n=data["table1"].n)


def permanent_contact_error(data: Data) -> float:
    """Fig. 16: the relative error at the printed threshold; NaN outside the scan."""
    error = data["fig16"].relative_error.isel(quantity=0)
    grid = np.log(error.frequency_ratio.values)
    where = np.log(PERMANENT_CONTACT)
    return float(np.interp(where, grid, error.values, left=np.nan, right=np.nan))


def permanent_contact_inverse(data: Data) -> xr.DataArray:
    """Fig. 16: how far the threshold by Eq. 34 is from the root of Eq. 38."""
    figure = data["fig16"]
    # The error is one-sided there: Λ_SD comes from below.
    level = (1 - figure.tolerance.values[0]) * figure.restitution_threshold
    by_formula = printed.permanent_contact_frequency_ratio(level, figure.damping_ratio, 1)
    return np.abs(by_formula / figure.error_threshold.isel(quantity=0, tolerance=0) - 1)


def motion_kinds(data: Data) -> int:
    """Kinds of motion among those looked at, each counted once.

    Chaotic is what has no period and an exponent that is positive beyond its sampling
    error: by five standard errors, once in three million by chance.
    """
    motions = data["motions"]
    length = motions.motion_period
    chaotic = (length == 0) & (motions.lyapunov_exponent > 5 * motions.lyapunov_error)
    return sum(bool(kind.any()) for kind in (length == 1, length > 1, chaotic))


def route_disagreement(data: Data) -> tuple[float, xr.DataArray]:
    """The largest disagreement of continuation and formula, and its budget."""
    both = data["witness"].sel(comparison="continuation and formula")
    return largest(both.disagreement), both.budget
