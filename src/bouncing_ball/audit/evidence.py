"""What the paper's statements are decided by, read off the figures' datasets.

Each variable turns a statement in words into numbers; the ledger of claims says
which bound they must meet. Only what no dataset holds already is here. Nothing
is simulated or solved: datasets in, a dataset out.

A *rise* is the change from one sampled contact to the next stiffer one, a
*softening* the change from one row of Table 1 to the next softer one.
"""

from collections.abc import Callable, Mapping
from typing import Any

import numpy as np
import xarray as xr

from bouncing_ball.audit.formulas import as_printed as printed
from bouncing_ball.datasets.variables import described
from bouncing_ball.orbits import restitution_orbit
from bouncing_ball.orbits.stability import Bifurcation

Datasets = Mapping[str, xr.Dataset]
Found = dict[str, xr.DataArray]
BOUNDS = tuple(Bifurcation)
# A logarithmic grid meets its round numbers, and a sample a bifurcation, but for rounding.
_GRID = 1e-9
_EMPTY = np.empty(0)
# Standard errors beyond which a sign is not an accident: once in three million by chance.
_SIGNIFICANT = 5


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
        return float("nan")
    pair = slice(outside[-1], outside[-1] + 2)
    if not np.isfinite(error[pair]).all():
        return float("nan")
    x, y = np.log(ratio[pair]), np.log(np.maximum(error[pair], np.finfo(float).tiny))
    share = (np.log(tolerance) - y[0]) / (y[1] - y[0])
    return float(np.exp(x[0] + share * (x[1] - x[0])))


def _worst_when_stiff(values: xr.DataArray, limit: float) -> xr.DataArray:
    """Largest value among contacts at least as stiff as a limit, NaN if none is."""
    stiff = values.frequency_ratio >= limit * (1 - _GRID)
    return values.where(stiff).max("frequency_ratio")


def _smallest_rise(values: xr.DataArray) -> xr.DataArray:
    return values.diff("frequency_ratio").min("frequency_ratio")


def _largest_rise(values: xr.DataArray) -> xr.DataArray:
    return values.diff("frequency_ratio").max("frequency_ratio")


def _apparent_restitution(data: Datasets, stiff: float) -> Found:
    """Figs. 5 and 6: how far r_a is from r, and whether it only comes closer."""
    found: dict[str, list[xr.DataArray]] = {
        key: [] for key in ("error", "difference", "rebound", "dip")
    }
    for name in ("fig05", "fig06"):
        sweep = data[name]
        signed = (sweep.apparent_restitution - sweep.restitution).reset_coords(drop=True)
        error = np.abs(signed)
        # How much farther from r than some softer contact is.
        axis = error.get_axis_num("frequency_ratio")
        closest = error.copy(data=np.fmin.accumulate(error.values, axis=axis))
        for key, values in (
            ("error", _worst_when_stiff(error, stiff)),
            ("difference", (error / sweep.restitution).max("frequency_ratio")),
            ("rebound", (error - closest).max("frequency_ratio")),
            ("dip", -signed.min("frequency_ratio")),
        ):
            named = values.reset_coords(drop=True).rename(case="curve")
            found[key].append(named.assign_coords(curve=_curves(name, sweep)))
    return {
        f"apparent_restitution_{key}": xr.concat(parts, "curve") for key, parts in found.items()
    } | _curves_of_fig06(data["fig06"])


@np.errstate(divide="ignore", invalid="ignore")  # without damping there is no dip
def _curves_of_fig06(sweep: xr.Dataset) -> Found:
    """Order of the three curves of Fig. 6, and the law of their stiff end.

    To first order in 1/ϖ, ``r_a - r = -ζ(1 + r)²(1 - Λ sin φ)/(nπϖ)`` with the
    phase of Eq. 6: r_a comes from below r exactly where Λ sin φ < 1. The limit of
    nπϖ(r_a - r) is extrapolated from the two ends of the stiffest decade.
    """
    apparent, ratio = sweep.apparent_restitution, sweep.frequency_ratio
    spread = apparent.max("case") - apparent.min("case")
    widest = apparent.isel(frequency_ratio=int(np.nan_to_num(spread.values, nan=-1.0).argmax()))
    steps = np.diff(widest.values[np.argsort(sweep.amplitude.values)])

    n, r = sweep.attrs["n"], sweep.restitution
    phase, _ = printed.fixed_point(n, r, sweep.amplitude)
    short_of_lift = 1 - sweep.amplitude * np.sin(phase)
    scaled = n * np.pi * ratio * (apparent - r)
    stiffest = ratio.values[-1]
    softer = int(np.argmin(np.abs(np.log(ratio.values / (stiffest / 10)))))
    pair = [(scaled * ratio).isel(frequency_ratio=k) for k in (-1, softer)]
    limit = (pair[0] - pair[1]) / (stiffest - ratio.values[softer])
    measured = -limit / (printed.damping_ratio(r) * (1 + r) ** 2)
    return {
        "apparent_restitution_spread": spread.max(),
        "apparent_restitution_order": xr.DataArray(steps.min() if steps.size else np.nan),
        "apparent_restitution_law_error": np.abs(measured - short_of_lift).max(),
        "short_of_lift": short_of_lift.min(),
    }


def _curves(name: str, sweep: xr.Dataset) -> list[str]:
    """Names of the curves of a figure.

    Examples
    --------
    >>> case = ("case", [0.65]), ("case", [1 + 1e-9])
    >>> _curves("fig06", xr.Dataset({"restitution": case[0], "amplitude": case[1]}))
    ['fig06 r=0.65 Λ=1.000000001']
    """
    pairs = zip(sweep.restitution.values, sweep.amplitude.values, strict=True)
    # The digits that rounding leaves, so that no two are called alike.
    return [f"{name} r={r:.12g} Λ={lam:.12g}" for r, lam in pairs]


@np.errstate(divide="ignore", invalid="ignore")  # the phase is 0 at the saddle-node
def _stiff_orbits(data: Datasets, stiff: float) -> Found:
    """Figs. 5, 6 and 10: errors of the restitution model among stiff contacts.

    They are relative; that of a phase depends on its origin, and is there as a
    share of a cycle too. With it how hard the contacts pull at release.
    """
    parts, pulls = [], []
    for name in ("fig05", "fig06", "fig10"):
        sweep = data[name]
        n, r, lam = sweep.attrs["n"], sweep.restitution, sweep.amplitude
        phase, velocity = printed.fixed_point(n, r, lam)
        rigid = {
            "max_height": restitution_orbit.max_height(n, lam, phase),
            "bounce_velocity": velocity,
            "apparent_restitution": r,
            "phase": phase,
        }
        errors = {
            **{key: np.abs(sweep[key] / value - 1) for key, value in rigid.items()},
            "phase in cycles": np.abs(sweep.phase - phase) / (2 * np.pi),
        }
        columns = [values.reset_coords(drop=True) for values in errors.values()]
        joined = xr.concat(columns, xr.Variable("measure", list(errors)))
        worst = _worst_when_stiff(joined, stiff).rename(case="orbit")
        parts.append(worst.assign_coords(orbit=_curves(name, sweep)))
        leaving = sweep.bounce_velocity - lam * np.cos(sweep.release_phase)
        pull = 2 * printed.damping_ratio(r) * sweep.frequency_ratio * leaving
        pulls.append(float(pull.max()))
    return {
        "stiff_orbit_error": xr.concat(parts, "orbit").transpose("orbit", "measure"),
        "release_pull": xr.DataArray(max(pulls)),
    }


def _bounce(data: Datasets) -> Found:
    """Fig. 10: the bouncing-off velocity against nπ."""
    sweep, tolerances = data["fig10"], data["thresholds"].tolerance
    velocity, limit = sweep.bounce_velocity, sweep.restitution_bounce_velocity
    ratio = sweep.frequency_ratio.values
    error = np.abs(velocity - limit) / limit
    spread = (velocity.max("case") - velocity.min("case")) / limit

    def crossings(values: xr.DataArray) -> xr.DataArray:
        found = [sampled_threshold(values.values, ratio, x) for x in tolerances.values]
        return xr.DataArray(found, {"tolerance": tolerances.values})

    return {
        "bounce_velocity_error_soft": error.isel(frequency_ratio=0).min(),
        "bounce_velocity_departure": crossings(error.max("case")),
        "bounce_velocity_spread_end": crossings(spread),
        "bounce_velocity_rise": _smallest_rise(velocity).min(),
    }


def _convergence(data: Datasets) -> Found:
    """Figs. 13 and 14 and the thresholds: what happens with rising ϖ."""
    sweep, errors = data["fig13"], data["thresholds"].relative_error
    found = {
        "contact_duration_rise": _largest_rise(sweep.contact_duration).max(),
        "max_height_rise": _smallest_rise(data["fig14"].max_height),
        "stiffest_error": errors.isel(frequency_ratio=-1),
        "softest_error": errors.isel(frequency_ratio=0),
    }
    for name in ("phase", "release_phase"):
        error = np.abs(sweep[name] - sweep.restitution_phase) / sweep.restitution_phase
        found[f"{name}_error"] = error.isel(frequency_ratio=-1).max()
    return found


def _domains(data: Datasets) -> Found:
    """Figs. 3, 8, 9 and 15: existence and stability along Λ."""
    orbits = data["fig03"]
    doubling = orbits.period_doubling_amplitude.sel(impact_map="exact")
    node = orbits.saddle_node_amplitude
    between = (orbits.phase > 0) & (orbits.amplitude > node) & (orbits.amplitude < doubling)
    # At a bifurcation itself rounding decides.
    beside = [np.abs(orbits.amplitude / end - 1) > _GRID for end in (node, doubling)]
    exceptions = (orbits.stable != between) & beside[0] & beside[1]
    found = {"stability_exceptions": exceptions.sum()}
    drawn = [data[f"fig{k:02d}"].admissible for k in (3, 5, 6, 8, 9, 10, 13, 14, 15)]
    found["inadmissible_orbits"] = xr.DataArray(sum(int((~x.astype(bool)).sum()) for x in drawn))
    names = ["fig08", "fig09"]
    # All of the stiffest branch, and the saddle-node of the softest one.
    longest, at_fold = [], []
    for name in names:
        branches = data[name].sortby("frequency_ratio")
        longest.append(float(branches.contact_duration.isel(frequency_ratio=-1).max()))
        soft = branches.isel(frequency_ratio=0)
        # A soft branch may fold again, at a higher Λ, or not exist at all.
        folds = soft.where(soft.special_kind == BOUNDS[0], drop=True)
        order = np.argsort(folds.special_amplitude.values)
        at_fold.append(next(iter(folds.special_contact_duration.values[order]), np.nan))
    found["contact_duration_stiffest"] = xr.DataArray(longest, {"figure": names})
    found["contact_duration_fold"] = xr.DataArray(at_fold, {"figure": names})
    found["durations_at_one_amplitude"] = xr.DataArray(
        min(_durations_at_once(row) for name in names for row in _branches(data[name]) or [_EMPTY])
    )
    bifurcations = [data[f"fig{k:02d}"].get("special_amplitude") for k in (8, 9, 10)]
    shown = [np.isfinite(values).any() for values in bifurcations if values is not None]
    found["existence_domains"] = xr.DataArray(int(sum(shown)))

    both = data["fig15"].isel(frequency_ratio=0)
    rigid = np.array([both.saddle_node_amplitude, both.period_doubling_amplitude])
    soft = _first_range(both.special_kind.values, both.special_amplitude.values)
    found["range_error"] = xr.DataArray(np.abs(soft / rigid - 1), {"bound": list(BOUNDS)})
    found["lowest_amplitude"] = xr.DataArray(np.fmin(soft[0], rigid[0]))
    return found


def _branches(figure: xr.Dataset) -> list[np.ndarray]:
    """Λ along each branch of a figure that has one."""
    rows = [row[np.isfinite(row)] for row in figure.amplitude.values]
    return [row for row in rows if row.size > 1]


def _durations_at_once(amplitude: np.ndarray) -> int:
    """How many points of a sampled branch share one Λ, at most.

    Examples
    --------
    >>> _durations_at_once(np.array([2.0, 1.0, 3.0])), _durations_at_once(np.array([1.0, 2.0]))
    (2, 1)
    """
    steps = np.sort([amplitude[:-1], amplitude[1:]], axis=0)
    below, above = np.sort(steps[0]), np.sort(steps[1])
    levels = np.unique(amplitude)
    between = (levels[:-1] + levels[1:]) / 2
    crossings = np.searchsorted(below, between) - np.searchsorted(above, between)
    return int(crossings.max(initial=0))


def _first_range(kinds: np.ndarray, amplitudes: np.ndarray) -> np.ndarray:
    """Ends of the stable range next to the saddle-node, NaN where there is none.

    The special points are in the branch's order, which ends on the stable
    side: the last saddle-node, and the first period doubling after it.
    """
    node, doubling = (np.flatnonzero(kinds == kind) for kind in BOUNDS)
    doubling = doubling[doubling > node[-1]] if node.size else doubling[:0]
    ends = (node[-1:], doubling[:1])
    return np.array([amplitudes[part[0]] if part.size else np.nan for part in ends])


def _softer_rows(values: xr.DataArray, table: xr.Dataset) -> xr.DataArray:
    """Values of all rows but the stiffest; a table of one row has one, which is NaN."""
    if values.sizes["frequency_ratio"]:
        return values
    return values.reindex(frequency_ratio=table.frequency_ratio)


def _table(data: Datasets) -> Found:
    """Table 1: how its ranges move from the stiffest contact to softer ones."""
    # From stiff to soft, so that a difference is what softening does.
    table = data["table1"].sortby("frequency_ratio", ascending=False)
    node, doubling = BOUNDS
    found = {}
    for source in ("computed", "printed"):
        ends = table[source]
        found[f"{source}_softening"] = _softer_rows(ends.diff("frequency_ratio"), table)
        stiffest = ends.isel(frequency_ratio=0, drop=True)
        found[f"{source}_stiff_difference"] = np.abs(stiffest - table.restitution_range)
    # From the stiffest row to the next one, which the paper calls slight.
    moves = _softer_rows(table.printed.diff("frequency_ratio"), table).isel(frequency_ratio=0)
    found["printed_slight_move"] = np.abs(moves / stiffest).max()
    width = table.computed.sel(bound=doubling) - table.computed.sel(bound=node)
    found["computed_widening"] = _softer_rows(width.diff("frequency_ratio"), table)
    exact = table.restitution_range.sel(impact_map="exact")
    softest = table.computed.isel(frequency_ratio=-1, drop=True)
    found["soft_range_shift"] = np.abs(softest - exact) / exact

    curves = data["ext_release"].bifurcation_amplitude
    by_rule = [curves.sel(release=rule, drop=True) for rule in ("displacement", "force")]
    found["release_rule_move"] = np.abs(by_rule[1] - by_rule[0]).max()
    # The families of the table only, so that its rows stay complete.
    curve = by_rule[0].sel(bound=doubling).reindex(n=table.n)
    lowest = curve.min("frequency_ratio")
    turns = data["ext_release"].period_doubling_turn.reindex(n=table.n)
    found["period_doubling_lowest"] = turns.sel(release="displacement")
    found["period_doubling_drop"] = curve.isel(frequency_ratio=-1, drop=True) - lowest
    return found


def _permanent_contact(figure: xr.Dataset, printed_ratio: float) -> Found:
    """Fig. 16: the error at the printed threshold, and the threshold by Eq. 34."""
    error = figure.relative_error.isel(quantity=0)
    grid = np.log(figure.frequency_ratio.values)
    threshold = figure.error_threshold.isel(quantity=0, tolerance=0, drop=True)
    # The error is one-sided there: Λ_SD comes from below.
    level = (1 - figure.tolerance.values[0]) * figure.restitution_threshold
    with np.errstate(invalid="ignore"):
        # NaN where the threshold takes that value nowhere.
        by_formula = printed.permanent_contact_frequency_ratio(level, figure.damping_ratio, 1)
    return {
        "permanent_contact_error": xr.DataArray(
            np.interp(np.log(printed_ratio), grid, error.values, left=np.nan, right=np.nan)
        ),
        "permanent_contact_inverse": np.abs(by_formula / threshold - 1),
    }


def _motions(data: Datasets) -> Found:
    """Kinds of motion among those looked at, each counted once.

    Chaotic is what has no period and an exponent that is positive beyond its
    sampling error.
    """
    motions = data["motions"]
    length, exponent = motions.motion_period, motions.lyapunov_exponent
    kinds = [
        length == 1,
        length > 1,
        (length == 0) & (exponent > _SIGNIFICANT * motions.lyapunov_error),
    ]
    return {"motion_kinds": xr.DataArray(sum(bool(kind.any()) for kind in kinds))}


def evidence(data: Datasets, parameters: Mapping[str, Any]) -> xr.Dataset:
    """All numbers by which statements of the paper are decided.

    Parameters
    ----------
    data : mapping of str to xarray.Dataset
        Figs. 3, 5, 6, 8, 9, 10, 13, 14, 15, 16, Table 1, the table of
        thresholds, the kinds of motion and the extension on release rules, by name.
    parameters : mapping
        ``stiff_frequency_ratio``, from which on the paper takes both models for
        the same, and ``permanent_contact_frequency_ratio``, its own threshold.

    Raises
    ------
    KeyError
        If a dataset is missing.
    """
    stiff = parameters["stiff_frequency_ratio"]
    parts: list[Callable[[Datasets], Found]] = [_bounce, _convergence, _domains, _table, _motions]
    found = _apparent_restitution(data, stiff) | _stiff_orbits(data, stiff)
    for part in parts:
        found |= part(data)
    found |= _permanent_contact(data["fig16"], parameters["permanent_contact_frequency_ratio"])
    return described({k: v.reset_coords(drop=True) for k, v in found.items()})
