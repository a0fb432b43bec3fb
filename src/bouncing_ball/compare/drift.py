"""Drifts of numbers: pure functions of arrays.

A drift is dimensionless: a difference divided by a scale. The drift between two NaN, or between
two infinities of the same sign, is zero; the drift between a finite value and one that is not
finite is infinite.
"""

import numpy as np
from numpy.typing import ArrayLike

# Number of samples by which a point may slide along a curve.
_REACH = 2


def span(values: ArrayLike) -> float:
    """The scale of a variable: max - min over its finite values.

    The scale of a constant is its magnitude, or 1 if the constant is 0. The scale is not the value
    of a single entry, because that would be tiny next to a zero of the variable.

    Examples
    --------
    >>> span([-1.0, 3.0, np.nan]), span([5.0, 5.0]), span([0.0])
    (4.0, 5.0, 1.0)
    """
    values = np.asarray(values, dtype=float)
    finite = values[np.isfinite(values)]
    if not finite.size:
        return 1.0
    return float(np.ptp(finite)) or float(np.max(np.abs(finite))) or 1.0


def same(record: ArrayLike, new: ArrayLike) -> np.ndarray:
    """Whether values are equal, entry by entry; NaN is equal to NaN.

    Examples
    --------
    >>> same([np.nan, 1.0, np.inf], [np.nan, 2.0, np.inf]).tolist()
    [True, False, True]
    """
    record, new = np.asarray(record), np.asarray(new)
    return (record == new) | ((record != record) & (new != new))


def pointwise(record: ArrayLike, new: ArrayLike, scale: ArrayLike) -> np.ndarray:
    """|new - record| / scale, element by element.

    Examples
    --------
    >>> pointwise([0.0, 1.0, np.nan], [0.5, 1.0, np.nan], 2.0).tolist()
    [0.25, 0.0, 0.0]
    >>> pointwise([1.0, 1.0], [np.nan, 2.0], [1.0, np.nan]).tolist()
    [inf, inf]
    """
    record, new = np.asarray(record, dtype=float), np.asarray(new, dtype=float)
    with np.errstate(invalid="ignore", divide="ignore"):
        distance = np.abs(new - record) / scale
    return np.where(same(record, new), 0.0, np.where(np.isnan(distance), np.inf, distance))


def _to_polyline(x, y, line_x, line_y) -> np.ndarray:
    """Distance of point k from the segments k - 1 - reach … k + reach of a polyline."""
    count = x.shape[-1]
    # The distance from the vertex itself, because a vertex between two gaps has no segment.
    best = np.hypot(x - line_x, y - line_y)
    for offset in range(-_REACH - 1, _REACH + 1) if count > 1 else ():
        left = np.clip(np.arange(count) + offset, 0, count - 2)
        ax, ay = line_x[..., left], line_y[..., left]
        dx, dy = line_x[..., left + 1] - ax, line_y[..., left + 1] - ay
        square = dx * dx + dy * dy
        along = ((x - ax) * dx + (y - ay) * dy) / np.where(square > 0, square, 1.0)
        along = np.clip(along, 0.0, 1.0)
        # fmin, because a segment with an end that is not finite does not count.
        best = np.fmin(best, np.hypot(x - ax - along * dx, y - ay - along * dy))
    return best


def curve(x: ArrayLike, y: ArrayLike, new_x: ArrayLike, new_y: ArrayLike) -> np.ndarray:
    """Distance between two sampled curves, at each sample, along the last axis.

    All coordinates are divided by their scales. The result is the larger of two distances: of the
    new sample from the record's polyline, and of the record's sample from the new polyline. Samples
    that slide along the curve therefore cause at most the sagitta of a chord, and two curves within
    a distance ε of each other have a drift of at most ε.

    Parameters
    ----------
    x, y, new_x, new_y : array_like, shape (..., N)

    Examples
    --------
    A straight line whose inner sample is moved along the line, and then off the line:

    >>> curve([0, 1, 2], [0, 0, 0], [0.0, 1.5, 2.0], [0, 0, 0]).tolist()
    [0.0, 0.0, 0.0]
    >>> curve([0, 1, 2], [0, 0, 0], [0, 1, 2], [0.0, 0.25, 0.0]).max().item()
    0.25
    """
    x, y, new_x, new_y = (np.asarray(part, dtype=float) for part in (x, y, new_x, new_y))
    with np.errstate(invalid="ignore", over="ignore"):
        distance = np.maximum(_to_polyline(new_x, new_y, x, y), _to_polyline(x, y, new_x, new_y))
    finite = np.isfinite(x) & np.isfinite(y) & np.isfinite(new_x) & np.isfinite(new_y)
    alike = _alike(x, new_x) & _alike(y, new_y)
    return np.where(finite, distance, np.where(alike, 0.0, np.inf))


def _alike(record, new):
    """Whether both values are finite, both NaN, or both infinite with the same sign."""
    return (np.isfinite(record) & np.isfinite(new)) | same(record, new)
