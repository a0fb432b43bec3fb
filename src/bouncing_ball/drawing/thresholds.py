"""Relative errors along ϖ with their tolerance and threshold (Figs. 14 and 16)."""

import numpy as np
import xarray as xr
from matplotlib.axes import Axes

from bouncing_ball.drawing.canvas import logarithmic
from bouncing_ball.drawing.style import CONTACT, GUIDE, Look

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


def with_zeros(ratio: np.ndarray, error: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """A signed error along ϖ with the zeros between its samples, and its size.

    Between two samples of different signs the error is linear in ln ϖ.

    Examples
    --------
    >>> ratio, size = with_zeros(np.array([1.0, 100.0]), np.array([-1.0, 1.0]))
    >>> round(float(ratio[np.argmin(size)]), 12), float(size.min())
    (10.0, 0.0)
    """
    place = np.log(ratio)
    parts = [ratio]
    zeros = []
    for k in np.flatnonzero(error[1:] * error[:-1] < 0):
        zero = np.interp(0.0, *_rising(error[k : k + 2], place[k : k + 2]))
        # Nearer and nearer to the zero, as a logarithmic axis shows it.
        shares = 0.5 ** np.arange(_STEPS)
        parts += [np.exp(zero + (end - zero) * shares[1:]) for end in place[k : k + 2]]
        zeros.append(np.exp(zero))
    fine = np.unique(np.concatenate([*parts, zeros]))
    size = np.abs(np.interp(np.log(fine), place, error))
    size[np.isin(fine, zeros)] = 0.0
    return fine, size


def _rising(values: np.ndarray, places: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Two values in increasing order, with their places."""
    order = np.argsort(values)
    return values[order], places[order]
