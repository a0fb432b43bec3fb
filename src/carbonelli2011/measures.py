"""Numbers that follow from the datasets: the claims judge them, and the article prints them."""

import numpy as np
import xarray as xr
from numpy.typing import NDArray
from scipy.interpolate import PchipInterpolator

from bouncing_ball import restitution
from bouncing_ball.spring_damper import Contact, damping_ratio
from carbonelli2011.paper import STIFF
from paper_replication.datasets import parameters
from paper_replication.verdicts import ROUNDING

STIFF_CONTACTS = slice(STIFF * (1 - ROUNDING), None)
"""Frequency ratios of at least `STIFF`."""


def at(values: xr.DataArray, **labels: float | str) -> xr.DataArray | float:
    """Select values at labels of coordinates; NaN if there is no such label."""
    has_them = all(label in values[name].values for name, label in labels.items())
    return values.sel(labels) if has_them else np.nan


def steps(data: xr.DataArray) -> NDArray:
    """Return the changes from each contact to the next stiffer one."""
    return data.sortby("frequency_ratio").diff("frequency_ratio").values


def whole_change(data: xr.DataArray) -> NDArray:
    """Return the changes from the most compliant contact to the stiffest."""
    return steps(data.isel(frequency_ratio=[0, -1]))


def between(curve: xr.DataArray) -> PchipInterpolator:
    """Interpolate a curve without gaps along ϖ, by a monotone piecewise cubic in ln ϖ."""
    return PchipInterpolator(np.log(curve["frequency_ratio"].values), curve.values)


def at_ratio(curve: xr.DataArray, ratio: float) -> float:
    """Interpolate a curve at a frequency ratio; NaN if the curve has gaps."""
    return np.nan if curve.isnull().any() else float(between(curve)(np.log(ratio)))


def crossing(curve: xr.DataArray, level: float) -> float:
    """Return the largest ϖ at which a curve reaches a level; NaN if there is none, or if the curve
    has gaps.
    """
    if curve.isnull().any():
        return np.nan
    places = between(curve).solve(level, extrapolate=False)
    return float(np.exp(places.max())) if places.size else np.nan


def from_the_stiffest(table1: xr.Dataset) -> xr.Dataset:
    """Sort the rows of Table 1 by decreasing ϖ."""
    return table1.sortby("frequency_ratio", ascending=False)


def last_special(branch: xr.Dataset, kind: str) -> float:
    """Return Λ at the last special point of a kind along a branch.

    The range of Table 1 lies at the end of a branch, on the stable side of its last saddle-node.
    NaN if the branch has no such point.
    """
    amplitudes = branch["special_amplitude"].values[branch["special_kind"].values == kind]
    return float(amplitudes[-1]) if amplitudes.size else np.nan


def branches(*figures: xr.Dataset) -> list[xr.Dataset]:
    """Return the branches of figures in order of increasing frequency ratio."""
    return [
        figure.sel(frequency_ratio=ratio)
        for figure in figures
        for ratio in np.sort(figure["frequency_ratio"])
    ]


def stable_ranges(branch: xr.Dataset) -> list[tuple[float, float]]:
    """Return the ranges of Λ with stable orbits, in the order of the branch.

    A range begins and ends at a special point or at an end of the branch. A branch with gaps has no
    ranges.
    """
    if branch["amplitude"].isnull().any():
        return []
    special = branch.isel(special=branch["special_kind"].values != "")
    places = np.array([0.0, *special["special_arclength"].values, 1.0])
    amplitude = branch["amplitude"].values
    ends = np.array([amplitude[0], *special["special_amplitude"].values, amplitude[-1]])
    middles = (places[:-1] + places[1:]) / 2
    stable = branch["stable"].values[np.rint(middles * (amplitude.size - 1)).astype(int)]
    ranges = np.sort(np.stack([ends[:-1], ends[1:]], axis=1), axis=1)
    return [(low, high) for low, high in ranges[stable].tolist()]


def laid_ranges(branch: xr.Dataset) -> list[tuple[float, float]]:
    """Return the ranges of Λ with stable orbits of long contacts that the figure does not have."""
    ranges = np.sort(branch["laid_amplitude"].dropna("laid").values, axis=1)
    return [(low, high) for low, high in ranges.tolist()]


def curve_errors(sweep: xr.Dataset) -> xr.DataArray:
    """Return the errors of the restitution model on the curves of Fig. 5, 6 or 10, by measure.

    They are relative, except for the phase: its error is a fraction of a period of the table. An
    error is negative where the value of the restitution model is larger.
    """
    n = parameters(sweep)["n"]
    r = sweep["restitution"].values
    amplitude = sweep["amplitude"].values
    limits = xr.Dataset(
        {
            "max_height": ("case", restitution.max_height(n, r, amplitude)),
            "bounce_velocity": restitution.bounce_velocity(n),
            "apparent_restitution": ("case", r),
        }
    )
    errors = sweep[[*limits]] / limits - 1
    turn = sweep["phase"] - xr.DataArray(restitution.impact_phase(n, r, amplitude), dims="case")
    return errors.assign(phase=turn / (2 * np.pi)).to_dataarray("measure")


def stiff_errors(*sweeps: xr.Dataset) -> xr.DataArray:
    """Return the largest `curve_errors` at ϖ ≥ 100, over orbit and measure.

    `sweeps` are the datasets of Figs. 5, 6 and 10. An orbit of two figures is listed once.
    """
    errors = []
    for sweep in sweeps:
        stiff = abs(curve_errors(sweep).sel(frequency_ratio=STIFF_CONTACTS))
        orbits = [f"n = {parameters(sweep)['n']}, {case}" for case in sweep["case"].values]
        worst = stiff.max("frequency_ratio", skipna=False)
        errors.append(worst.assign_coords(case=orbits).rename(case="orbit"))
    return xr.concat(errors, "orbit").drop_duplicates("orbit")


def departure(sweep: xr.Dataset) -> xr.DataArray:
    """Return the relative difference of the bouncing-off velocity and nπ."""
    return abs(curve_errors(sweep).sel(measure="bounce_velocity"))


def spread(sweep: xr.Dataset) -> xr.DataArray:
    """Return the largest difference of velocities between amplitudes, divided by nπ."""
    error = curve_errors(sweep).sel(measure="bounce_velocity")
    return error.max("case", skipna=False) - error.min("case", skipna=False)


def error_of_eq_8(thresholds: xr.Dataset) -> float:
    """Return the relative difference of the period doublings of Eq. 8 and of the map of Eq. 5.

    The spring-damper model converges to the period doubling of Eq. 5.
    """
    given = parameters(thresholds)
    limit = restitution.period_doubling(given["n"], given["restitution"])
    printed = restitution.holmes_period_doubling(given["n"], given["restitution"])
    return abs(limit / printed - 1)


def restitution_at_rest(r: float, ratio: float, weight: float = 1.0) -> float:
    """Return the restitution of a ball that hits a table at rest with the velocity π.

    This is the velocity of the 1-T orbit. `weight` multiplies gravity during the contact.
    """
    contact = Contact(ratio, damping_ratio(r), weight=weight)
    time = np.pi / (ratio * np.sqrt(1 - contact.damping_ratio**2))
    for _ in range(20):  # Newton's method for the end of the contact, δ = 0
        motion = contact.motion(time, -np.pi, 0.0, 0.0)
        time = time - motion.displacement / motion.velocity
    return float(contact.motion(time, -np.pi, 0.0, 0.0).velocity / np.pi)
