"""Relative errors along ϖ with their tolerance and threshold (Figs. 14 and 16)."""

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from numpy.typing import ArrayLike

from bouncing_ball_beyond.inherited.drawing.canvas import logarithmic
from bouncing_ball_beyond.inherited.drawing.style import CONTACT, GUIDE, Look

# The lowest error shown, as a share of the smallest at a sample, and the steps from a zero to the
# samples beside it.
_BELOW = 0.3
_STEPS = 40


def draw_relative_error(
    axes: Axes,
    data: xr.Dataset,
    difference: xr.DataArray,
    name: str,
    digits: int,
    printed: float = np.nan,
) -> None:
    """The relative error on a logarithmic axis, the tolerance, and the ϖ of the last crossing.

    ``difference`` has the sign of the error, which is zero where it changes; the line leaves the
    panel there. ``printed`` is the ϖ that the paper gives for the tolerance, if there is one.
    """
    error = data.relative_error
    tolerance = float(data.attrs["tolerance"])
    signed = np.copysign(error.values, difference.values)
    ratio, size = with_zeros(data.frequency_ratio.values, signed)
    shown = np.isfinite(size)
    axes.plot(ratio[shown], size[shown], color=CONTACT)
    percent = f"{100 * tolerance:g}"
    axes.axhline(tolerance, label=f"tolerance {percent} %", **GUIDE)
    found = float(data.error_threshold)
    if np.isfinite(found):
        axes.axvline(found, **GUIDE)
        value = rf"$\varpi_{{{name},{percent}\%}}={found:.{digits}f}$"
        axes.plot(found, tolerance, "o", color="black", markersize=4, linestyle="none", label=value)
    if np.isfinite(printed):
        look: Look = {"markersize": 5, "markerfacecolor": "none", "linestyle": "none"}
        axes.plot(printed, tolerance, "D", color="black", label=f"printed: {printed:g}", **look)
    positive = error.values[np.isfinite(error.values) & (error.values > 0)]
    lowest = min(positive.min(initial=tolerance), tolerance)
    logarithmic(axes, data.frequency_ratio, yscale="log", ylabel="relative error")
    axes.set_ylim(bottom=_BELOW * lowest)


def with_zeros(
    ratio: np.ndarray, error: np.ndarray, zeros: ArrayLike = ()
) -> tuple[np.ndarray, np.ndarray]:
    """An error along ϖ with its zeros, and its size.

    The zeros that are known become samples; NaN stands for none. Between two samples of different
    signs there is a further zero, where the error is linear in ln ϖ.

    Examples
    --------
    >>> ratio, size = with_zeros(np.array([1.0, 100.0]), np.array([-1.0, 1.0]))
    >>> round(float(ratio[np.argmin(size)]), 12), float(size.min())
    (10.0, 0.0)
    >>> ratio, size = with_zeros(np.array([1.0, 100.0]), np.array([1.0, 1.0]), 20.0)
    >>> round(float(ratio[np.argmin(size)]), 12), float(size.min())
    (20.0, 0.0)
    """
    located = np.log(np.atleast_1d(zeros))
    located = located[np.isfinite(located)]
    place = np.log(ratio)
    order = np.argsort(np.concatenate([place, located]))
    place = np.concatenate([place, located])[order]
    error = np.concatenate([error, np.zeros(located.size)])[order]
    changes = np.flatnonzero(error[1:] * error[:-1] < 0)
    between = [np.interp(0.0, *_rising(error[k : k + 2], place[k : k + 2])) for k in changes]
    every = np.concatenate([located, between])
    parts = [place, every]
    # Nearer and nearer to the zero, as a logarithmic axis shows it.
    shares = 0.5 ** np.arange(1, _STEPS)
    for zero in every:
        sides = place[[np.searchsorted(place, zero) - 1, np.searchsorted(place, zero, "right")]]
        parts += [zero + (side - zero) * shares for side in sides]
    fine = np.unique(np.concatenate(parts))
    size = np.abs(np.interp(fine, place, error))
    size[np.isin(fine, every)] = 0.0
    return np.exp(fine), size


def _rising(values: np.ndarray, places: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Two values in increasing order, with their places."""
    order = np.argsort(values)
    return values[order], places[order]
