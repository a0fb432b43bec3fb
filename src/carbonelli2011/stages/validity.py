"""Stage: for which stable orbits a frequency ratio is enough for the restitution model.

An orbit has a place between saddle-node (0) and period doubling (1) of the restitution model, which
is linear in Λ. The places are denser at the saddle-node, beside which the errors change fastest.
Shares and largest errors are those of the orbits that are stable in both models: between the
saddle-node and the period doubling of either model. Largest errors include the limits at both ends.
"""

from itertools import pairwise

import numpy as np
import xarray as xr
from numpy.typing import NDArray
from scipy.interpolate import CubicSpline

from bouncing_ball import restitution
from bouncing_ball.continuation import SPECIAL, bifurcations
from bouncing_ball.errors import COMPARED, enough_from, errors_of_orbits, orbits_along
from bouncing_ball.orbits import Family, NoOrbit, contact_of_ball
from bouncing_ball.spring_damper import NO_CONTACT, Contact, damping_ratio, permanent_contact
from paper_replication.datasets import grid

FINER = (16, 8)
"""Steps of the interpolation in each step of the grid of r, and of places. With twice as many, the
shares of the paper's ϖ change by at most 1e-5.
"""


def validity_map(parameters: dict, release: str) -> xr.Dataset:
    """The ϖ from which on errors stay within the tolerance, the largest errors from the advised ϖ
    on, and the parts of the range of stable orbits of either model that the other lacks: next to
    the upper end the contact has doubled its period, and below the lower end it has stable orbits.

    Of the grid of r, the dataset has those that a contact can have.
    """
    advised = parameters["advised"]
    tolerance = parameters["tolerance"]
    ratios = grid(parameters["frequency_ratio"])
    ratios = np.sort([advised, *ratios[~np.isclose(ratios, advised, rtol=1e-9)]])
    r = grid(parameters["restitution"], np.linspace)
    r = r[np.isfinite(damping_ratio(r, release))]
    if r.size < 2:
        raise NoOrbit(f"restitution = {parameters['restitution']}: {NO_CONTACT}")
    n = np.array(parameters["n"])
    place = np.linspace(0, 1, parameters["places"]) ** 3

    enough, errors = along_ranges(n, r, place, ratios, tolerance, release)
    errors = errors[..., ratios >= advised]
    doubled, below = shifts(n, r, advised, release)
    # The period doubling of a compliant contact may be at a larger Λ than in the other model.
    end_place = np.clip(1 - doubled, 0, 1)
    share, mean, up_to, largest = failures(errors, r, place, end_place, tolerance)
    over = ("quantity", "n", "restitution", "place")
    return xr.Dataset(
        {
            # Single precision is more than a picture shows, in half the space.
            "enough_from": (over, enough.astype("float32")),
            "stiff_error": (over, np.abs(errors).max(axis=-1).astype("float32")),
            "stable": (over[1:], (place > 0) & (place < end_place[..., np.newaxis])),
            "largest_error": (over[:2], largest),
            "not_reached": (over[:2], np.isnan(enough).sum(axis=(2, 3))),
            "failing_share": (over[:3], share),
            "failing_mean": (over[:2], mean),
            "failing_up_to": (over[:2], up_to),
            "doubled_share": (over[1:3], np.clip(doubled, 0, 1)),
            "doubled_mean": (over[1:2], [mean_share(r, line) for line in doubled]),
            "below_share": (over[1:3], np.maximum(below, 0)),
            "below_mean": (over[1:2], [mean_share(r, line, np.inf) for line in below]),
        },
        {"quantity": list(COMPARED), "n": n, "restitution": r, "place": place},
    )


def along_ranges(
    n: NDArray, r: NDArray, place: NDArray, ratios: NDArray, tolerance: float, release: str
) -> tuple[NDArray, NDArray]:
    """The ϖ from which on the errors of the orbits at some places stay within a tolerance, shape
    (quantities, n, r, places), and the errors, shape (quantities, n, r, places, ratios).
    """
    shape = (n.size, r.size, place.size)
    # One column of orbits for all n, r and places, the places fastest.
    n, r, place = (axis.reshape(-1, 1) for axis in np.meshgrid(n, r, place, indexing="ij"))
    first = restitution.saddle_node(n, r)
    last = restitution.period_doubling(n, r)
    amplitude = first + place * (last - first)
    family = Family(n, Contact.of_restitution(ratios, r, release))
    orbits = orbits_along(family, amplitude)
    enough = enough_from(family, orbits, r, amplitude, tolerance)
    errors = errors_of_orbits(family, orbits, r, amplitude)
    return enough.reshape(-1, *shape), errors.reshape(-1, *shape, ratios.size)


def shifts(n: NDArray, r: NDArray, ratio: float, release: str) -> tuple[NDArray, NDArray]:
    """How far the contact doubles its period below the upper end of the range of stable orbits of
    the restitution model, and has stable orbits below its lower end; shape (n, r).

    Both are shares of this range, negative where the contact's end is on the other side.
    """
    n, r = np.meshgrid(n, r, indexing="ij")
    first = restitution.saddle_node(n, r)
    last = restitution.period_doubling(n, r)
    contact = Contact.of_restitution(ratio, r.reshape(-1, 1), release)
    node, doubling = (
        bifurcations(n.ravel(), kind, contact)[0].reshape(n.shape) for kind in SPECIAL[:2]
    )
    # The contact may double its period below the saddle-node of the restitution model.
    below = np.minimum(first, doubling) - node
    return (last - doubling) / (last - first), below / (last - first)


def failures(
    errors: NDArray, r: NDArray, place: NDArray, end_place: NDArray, tolerance: float
) -> tuple[NDArray, NDArray, NDArray, NDArray]:
    """Where the errors at some ϖ exceed the tolerance, up to the place where stability ends.

    Returns the share of the places for each r, the mean of this share over r, the largest r, and
    the largest error. Errors have the shape (quantities, n, r, places, ratios), and the ends
    (n, r). Errors are smooth functions of ln r, which gives the damping, and of the square root of
    the place, which gives the phase. Cubic splines interpolate them. The results of a quantity and
    an n are NaN if one of its errors or ends is.
    """
    fine_r = finer(r, FINER[0])
    part = finer(place ** (1 / 2), FINER[1]) ** 2
    share = np.full(errors.shape[:3], np.nan)
    mean, up_to, largest = np.full((3, *errors.shape[:2]), np.nan)
    known = np.isfinite(errors).all(axis=(2, 3, 4)) & np.isfinite(end_place).all(axis=1)
    for index in np.argwhere(known):
        k = tuple(index)
        end = np.clip(CubicSpline(r, end_place[k[1]])(fine_r), 0, 1)
        along = CubicSpline(np.log(r), errors[k])(np.log(fine_r))
        surface = np.stack(
            [
                CubicSpline(place ** (1 / 2), line)((part * upper) ** (1 / 2))
                for line, upper in zip(along, end, strict=True)
            ]
        )
        highest = np.abs(surface).max(axis=-1)
        share[k] = (end * positive_share(highest - tolerance, part))[:: FINER[0]]
        mean[k] = positive_area(highest - tolerance, fine_r, part, end)
        up_to[k] = last_positive(highest.max(axis=-1) - tolerance, fine_r)
        largest[k] = highest.max()
    return share, mean, up_to, largest


def mean_share(r: NDArray, values: NDArray, most: float = 1.0) -> float:
    """The mean over r of values as shares, cut off below 0 and above `most`; NaN if one is missing.

    It is the integral of a cubic spline, and of 0 or `most` where the spline is beyond.
    """
    if np.isnan(values).any():
        return np.nan
    spline = CubicSpline(r, values)
    cuts = np.concatenate(
        [spline.solve(end, extrapolate=False) for end in (0, most) if end < np.inf]
    )
    places = np.unique([r[0], *cuts[np.isfinite(cuts)], r[-1]])
    # Between two places the spline is below 0, from 0 to `most`, or above it, and so is its mean.
    means = [spline.integrate(*part) / np.ptp(part) for part in pairwise(places)]
    return float(np.clip(means, 0, most) @ np.diff(places) / np.ptp(r))


def finer(grid: NDArray, steps: int) -> NDArray:
    """A grid with its steps divided into equal smaller steps."""
    index = np.arange(grid.size)
    return np.interp(np.arange(steps * (grid.size - 1) + 1) / steps, index, grid)


def positive_share(values: NDArray, place: NDArray) -> NDArray:
    """The share of the places from 0 to 1, the last axis, at which values are positive.

    Between two places values are linear.
    """
    low, high = np.sort([values[..., :-1], values[..., 1:]], axis=0)
    with np.errstate(divide="ignore", invalid="ignore"):
        parts = np.select([high <= 0, low <= 0], [0, high / (high - low)], 1)
    return (parts * np.diff(place)).sum(axis=-1)


def positive_area(values: NDArray, r: NDArray, part: NDArray, end: NDArray) -> float:
    """The mean over r of the share of the places on which values are positive.

    The places are `part` of an `end`, which depends on r. A diagonal divides each cell of the grid
    over r and part, the axes of values, into two triangles, on which values are linear.
    """
    diagonal = values[1:, :-1], values[:-1, 1:]
    parts = sum(
        positive_part(np.sort([corner, *diagonal], axis=0))
        for corner in (values[:-1, :-1], values[1:, 1:])
    )
    widths = (end[1:] + end[:-1]) / 2 * np.diff(r)
    return float(widths @ parts @ np.diff(part) / 2 / np.ptp(r))


def positive_part(corners: NDArray) -> NDArray:
    """The share of triangles on which a linear function is positive.

    Its values at the three corners are in ascending order, along the first axis.

    >>> positive_part(np.array([[-1.0, -1.0, 1.0], [-1.0, 1.0, 2.0], [1.0, 1.0, 3.0]])).tolist()
    [0.25, 0.75, 1.0]
    """
    low, middle, high = corners
    with np.errstate(divide="ignore", invalid="ignore"):
        one = high**2 / ((high - low) * (high - middle))
        two = 1 - low**2 / ((high - low) * (middle - low))
    return np.select([high <= 0, middle <= 0, low <= 0], [0, one, two], 1)


def last_positive(values: NDArray, r: NDArray) -> float:
    """The r up to which there are positive values, linear between two r; 0 if there are none."""
    if not (values > 0).any():
        return 0.0
    last = np.flatnonzero(values > 0)[-1]
    if last == r.size - 1:
        return r[-1]
    part = values[last] / (values[last] - values[last + 1])
    return r[last] + part * (r[last + 1] - r[last])


def regimes(parameters: dict, release: str) -> xr.Dataset:
    """The ϖ from which on a quantity of the orbit stays within the tolerance, over Λ, and the
    amplitudes over ϖ between which its contact has the stable orbit, and a ball at rest stays.
    """
    ratios = grid(parameters["frequency_ratio"])
    n = parameters["n"]
    r = parameters["restitution"]
    contact = contact_of_ball(ratios, r, release)
    place = np.linspace(0, 1, parameters["places"]) ** 3
    first = restitution.saddle_node(n, r)
    last = restitution.period_doubling(n, r)
    amplitude = (first + place * (last - first)).reshape(-1, 1)
    column = np.ones_like(amplitude)
    family = Family(n * column, Contact.of_restitution(ratios, r * column, release))
    orbits = orbits_along(family, amplitude)
    enough = enough_from(family, orbits, r * column, amplitude, parameters["tolerance"])
    node, doubling = (bifurcations(n, kind, contact)[0, 0] for kind in SPECIAL[:2])
    return xr.Dataset(
        {
            "amplitude": ("place", amplitude[:, 0]),
            "enough_from": ("place", enough[COMPARED.index(parameters["quantity"])]),
            "saddle_node_amplitude": ("frequency_ratio", node),
            "period_doubling_amplitude": ("frequency_ratio", doubling),
            "threshold_amplitude": (
                "frequency_ratio",
                permanent_contact(ratios, contact.damping_ratio, release),
            ),
            "restitution_threshold": restitution.PERMANENT_CONTACT,
        },
        {"place": place, "frequency_ratio": ratios},
    )


STAGE = {"validity_map": validity_map, "regimes": regimes}
