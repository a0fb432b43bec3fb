"""Stage: for which stable orbits a frequency ratio is enough for the restitution model.

An orbit has a place between saddle-node (0) and period doubling (1) of the restitution model, which
is linear in Λ. The places are denser at the saddle-node, beside which the errors change fastest.
"""

import sys

import numpy as np
import xarray as xr
from numpy.typing import NDArray
from scipy.interpolate import CubicSpline

from bouncing_ball import restitution
from bouncing_ball.continuation import bifurcations
from bouncing_ball.datasets import grid, save_stage
from bouncing_ball.errors import COMPARED, enough_from, errors_of_orbits, orbits_along
from bouncing_ball.orbits import Family
from bouncing_ball.spring_damper import Contact, damping_ratio


def validity_map(parameters: dict, release: str) -> xr.Dataset:
    """The ϖ from which on errors stay within the tolerance, the largest errors from the advised ϖ
    on, and the orbits whose period has doubled on the contact of the advised ϖ.
    """
    advised = parameters["advised"]
    tolerance = parameters["tolerance"]
    ratios = grid(parameters["frequency_ratio"])
    ratios = np.sort([advised, *ratios[~np.isclose(ratios, advised, rtol=1e-9)]])
    limits = parameters["restitution"]
    r = np.linspace(limits["min"], limits["max"], limits["samples"])
    place = np.linspace(0, 1, parameters["places"]) ** 3

    # One column of orbits for all n, r and places, the places fastest.
    shape = (len(parameters["n"]), r.size, place.size)
    mesh = np.meshgrid(parameters["n"], r, place, indexing="ij")
    n_all, r_all, place_all = (each.reshape(-1, 1) for each in mesh)
    first = restitution.saddle_node(n_all, r_all)
    last = restitution.period_doubling(n_all, r_all)
    amplitude = first + place_all * (last - first)
    enough, errors = scan(n_all, r_all, amplitude, ratios, tolerance, release)
    excess = (errors[..., ratios >= advised].max(axis=-1) - tolerance).reshape(-1, *shape)
    worst = excess.max(axis=-1)
    share = positive_share(excess, place)

    # The orbit that needs the stiffest contact for each quantity, with half the tolerance.
    most = np.argmax(enough, axis=1)
    wider = np.geomspace(ratios[0], 10 * ratios[-1], 2 * ratios.size)
    halved, _ = scan(n_all[most], r_all[most], amplitude[most], wider, tolerance / 2, release)

    # The period doublings of the contact.
    ends = place_all[:, 0] == 1
    contact = Contact(advised, damping_ratio(r_all[ends]), release)
    doubling = bifurcations(n_all[ends, 0], "period doubling", contact)[0]
    doubled = (last[ends] - doubling) / (last[ends] - first[ends])

    curves = parameters["curves"]
    n_curve, r_curve, amplitude_curve = (
        np.array([curve[key] for curve in curves]) for key in ("n", "restitution", "amplitude")
    )
    begin = restitution.saddle_node(n_curve, r_curve)
    end = restitution.period_doubling(n_curve, r_curve)

    over = ("quantity", "n", "restitution", "place")
    enough = enough.reshape(-1, *shape)
    return xr.Dataset(
        {
            # Single precision is more than a picture shows, in half the space.
            "enough_from": (over, enough.astype("float32")),
            "stiff_error": (over, (tolerance + excess).astype("float32")),
            "not_reached": (over[:2], np.isnan(enough).sum(axis=(2, 3))),
            "failing_share": (over[:3], share),
            "failing_mean": (over[:2], np.trapezoid(share, r) / (r[-1] - r[0])),
            "failing_up_to": (over[:2], np.apply_along_axis(last_positive, -1, worst, r)),
            "halved_enough_from": (over[:1], np.diagonal(halved)),
            "doubled_share": (over[1:3], doubled.reshape(shape[:2])),
            "curve_n": ("curve", n_curve),
            "curve_restitution": ("curve", r_curve),
            "curve_amplitude": ("curve", amplitude_curve),
            "curve_place": ("curve", (amplitude_curve - begin) / (end - begin)),
        },
        {"quantity": list(COMPARED), "n": parameters["n"], "restitution": r, "place": place},
    )


def scan(
    n: NDArray, r: NDArray, amplitude: NDArray, ratios: NDArray, tolerance: float, release: str
) -> tuple[NDArray, NDArray]:
    """`enough_from` of orbits, shape (quantities, orbits), and their errors at the ratios, with one
    more axis. n, r and Λ have the shape (orbits, 1).
    """
    family = Family(n, Contact(ratios, damping_ratio(r), release))
    orbits = orbits_along(family, amplitude)
    enough = enough_from(family, orbits, r, amplitude, tolerance)
    return enough, errors_of_orbits(family, orbits, r, amplitude)


def positive_share(values: NDArray, place: NDArray) -> NDArray:
    """The share of the places from 0 to 1, the last axis, at which values are positive.

    Between two places values are linear. The share is NaN if one of them is.
    """
    low = values[..., :-1]
    high = values[..., 1:]
    with np.errstate(invalid="ignore"):
        share = (np.maximum(high, 0) - np.maximum(low, 0)) / (high - low)
    return (np.where(high == low, low > 0, share) * np.diff(place)).sum(axis=-1)


def last_positive(values: NDArray, r: NDArray) -> float:
    """The r up to which there are positive values, by a cubic spline; NaN if there are none."""
    if values[-1] > 0:
        return r[-1]
    if not (values > 0).any() or np.isnan(values).any():
        return np.nan
    return CubicSpline(r, values).roots(extrapolate=False)[-1]


STAGE = {"validity_map": validity_map}

if __name__ == "__main__":
    sys.stderr = open(snakemake.log[0], "w", encoding="utf-8")
    save_stage(STAGE, snakemake)
