"""Resolve a function along lines: its jumps, and all roots of a function of one variable.

Complex steps give the derivative. Where the change of the function on a segment is not the integral
of the derivative, the segment is divided again and again. The segments thus become as short as the
scale on which the function changes, and only a jump remains.
"""

from collections.abc import Callable, Iterator
from typing import Any, NamedTuple

import numpy as np
from numpy.polynomial import legendre
from numpy.typing import NDArray
from scipy.optimize.elementwise import find_root

H = 1e-30
"""Imaginary part of a complex step: the imaginary part of f(x + iH) is H f′(x)."""

ALIKE, ROUNDING = (1e-5, 1e-11), 1e-14
"""Largest error of the integral of the derivative over a segment, divided by the change of a smooth
function on it, and divided by the function. `ROUNDING` replaces the second number on parts of
segments.

The quadrature of p^{1/4} between neighbouring samples has a relative error of 1e-11.
"""

PARTS, TO_JUMP, MOST_SEGMENTS = 32, 8, 4000
"""Number of parts into which segments are divided again and again, number of divisions after which
a part contains a jump, and maximum number of parts.

A smooth step as narrow as 1/30,000 of a segment is accepted.
"""

SMALLEST_JUMP = 1e-6
"""Smallest jump that is refused, divided by the function.

Square roots change by 1e-7 of the force on the shortest parts of segments.
"""

FOUR, WEIGHTS_OF_FOUR = (numbers / 2 for numbers in legendre.leggauss(4))
FOUR = FOUR + 0.5
"""Gauss nodes and weights on [0, 1]."""

DOUBLE = 1e-12
"""Largest value of a function at an extremum that is a double root, divided by its size."""


class Division(NamedTuple):
    """Segments of one division of lines in d dimensions.

    Attributes
    ----------
    segments : array, shape (2, d, segments)
        Starts and ends of the segments.
    whole : array, shape (2, d, segments)
        Undivided segments of which they are parts.
    inner : array, shape (segments, 4)
        Values of the function at Gauss nodes, with the derivative along the segment as imaginary
        parts, times H.
    change : array, shape (segments,)
        Change of the function from the start to the end.
    expected : array, shape (segments,)
        Integral of the derivative.
    size : array, shape (segments,)
        Modulus of the function.
    wrong : array of bool, shape (segments,)
        Whether `change` is not `expected`.
    """

    segments: NDArray
    whole: NDArray
    inner: NDArray
    change: NDArray
    expected: NDArray
    size: NDArray
    wrong: NDArray

    @property
    def jumps(self) -> NDArray:
        """Indices of the segments with a jump, in the last division."""
        return np.flatnonzero(self.wrong & (np.abs(self.change) > SMALLEST_JUMP * self.size))


def divisions(function: Callable, points: NDArray, usual: float) -> Iterator[Division]:
    """Divide lines of points, shape (d, …, points), until a function is resolved on them.

    ``usual`` is the usual size of the function: smaller values count as this one. Of more than
    `MOST_SEGMENTS` segments, those with the largest errors are divided: jumps are among them.
    """
    segments: Any = np.stack([points[..., :-1], points[..., 1:]]).reshape(2, len(points), -1)
    whole = segments
    for division in range(TO_JUMP + 1):
        here = segments[0]
        along = (segments[1] - here)[..., np.newaxis]
        inner = function(here[..., np.newaxis] + along * (FOUR + 1j * H))
        expected = inner.imag @ WEIGHTS_OF_FOUR / H
        change = function(segments[1]) - function(here)
        size = np.abs([function(end) for end in whole]).max(axis=0)
        rounded = (ROUNDING if division else ALIKE[1]) * np.maximum(size, usual)
        wrong = np.abs(change - expected) > ALIKE[0] * np.abs(change) + rounded
        yield Division(segments, whole, inner, change, expected, size, wrong)
        if not wrong.any():
            return
        if np.count_nonzero(wrong) > MOST_SEGMENTS:
            error = np.where(wrong, np.abs(change - expected), -1.0)
            wrong = error >= np.sort(error)[-MOST_SEGMENTS]
        ends = np.linspace(segments[0][:, wrong], segments[1][:, wrong], PARTS + 1, axis=-1)
        segments = np.stack([ends[..., :-1], ends[..., 1:]]).reshape(2, len(points), -1)
        whole = np.repeat(whole[..., wrong], PARTS, axis=2)


def check_continuous(what: str, function: Callable, low: float, high: float) -> None:
    """Raise ValueError if a function of one variable jumps between two values of the variable."""
    points = np.geomspace(low, high, SEGMENTS + 1)[np.newaxis]
    with np.errstate(all="ignore"):
        *_, part = divisions(lambda x: function(x[0]), points, 1.0)
    if part.jumps.size:
        k = part.jumps[0]
        raise ValueError(
            f"{what} jumps by {abs(part.change[k]):.3g} near u = {part.segments[0][0, k]:.4g}, but"
            " must be continuous; replace the jump by a smooth step, such as"
            " (1 + np.tanh(x / width)) / 2 with a small width"
        )


SEGMENTS = 1024
"""Number of segments of a range on which functions are resolved, before divisions.

A function that leaves its course and returns to it within one segment may be taken as smooth.
"""


@np.errstate(all="ignore")
def roots(
    function: Callable, low: float, high: float, size: float, segments: int = SEGMENTS
) -> NDArray:
    """Find all roots of an analytic function of one variable in [low, high], in order.

    The function and its derivative are known at the Gauss nodes of segments on which the function
    is resolved. Between neighbouring nodes a root is where the sign changes. Two roots, or a double
    root, are where the function turns back before it leaves its sign.

    Parameters
    ----------
    function : callable
        Function of an array, also a complex one.
    low, high : float
        Ends of the range.
    size : float
        Size of the terms of the function: an extremum below `DOUBLE` times the size is a double
        root.
    segments : int
        Number of segments before divisions.
    """

    def slope(x: NDArray) -> NDArray:
        return function(x + 1j * H).imag / H

    # The range is wider by a segment, because a root may be at its end.
    points = np.linspace(low, high, segments + 1)
    step = points[1] - points[0]
    points = np.concatenate([[low - step], points, [high + step]])[np.newaxis]
    parts = list(divisions(lambda x: function(x[0]), points, size))
    if any(np.count_nonzero(part.wrong) > MOST_SEGMENTS for part in parts):
        raise ValueError(
            f"restitution: r(u) changes too fast from u = {low:.4g} to {high:.4g} to find all"
            " orbits"
        )
    kept = [~part.wrong for part in parts[:-1]] + [np.full(parts[-1].wrong.shape, True)]
    x, f, along = (np.concatenate(nodes) for nodes in zip(*map(_nodes, parts, kept), strict=True))
    order = np.argsort(x)
    order = order[np.isfinite(f[order])]
    x, f, along = x[order], f[order], along[order]
    sign = np.where(f < 0, -1, 1)
    crosses = sign[:-1] != sign[1:]
    turns = ~crosses & (sign[:-1] * along[:-1] < 0) & (sign[1:] * along[1:] >= 0)
    before, after = x[:-1], x[1:]
    top, height = _roots_between(slope, before[turns], after[turns])[0], np.empty(0)
    if top.size:
        height = sign[:-1][turns] * function(top)
    twice = height < -DOUBLE * size
    starts = np.concatenate([before[crosses], before[turns][twice], top[twice]])
    ends = np.concatenate([after[crosses], top[twice], after[turns][twice]])
    single, value = _roots_between(function, starts, ends)
    # The sign also changes at a pole or a jump, which are not roots.
    single = single[np.abs(value) <= 1e-6 * size]
    all_roots = np.sort(np.concatenate([single, top[np.abs(height) <= DOUBLE * size]]))
    return all_roots[(all_roots >= low - DOUBLE * high) & (all_roots <= high + DOUBLE * high)]


def _roots_between(function: Callable, starts: NDArray, ends: NDArray) -> tuple[NDArray, NDArray]:
    """Roots of a function in brackets, and its values there."""
    if not starts.size:
        return starts, starts
    root = find_root(function, (starts, ends))
    return root.x, root.f_x


def _nodes(part: Division, kept: NDArray) -> tuple[NDArray, NDArray, NDArray]:
    """Gauss nodes of the kept segments, and the function and its derivative there."""
    start, end = part.segments[:, 0, kept, np.newaxis]
    along = part.inner[kept].imag / H / (end - start)
    return (start + (end - start) * FOUR).ravel(), part.inner[kept].real.ravel(), along.ravel()
