"""The highest points of motions, from samples that close in on them."""

from collections.abc import Callable
from typing import Any

import numpy as np


def about_highest(
    height: Callable[[np.ndarray], np.ndarray], left: Any, right: Any, samples: int, rounds: int
) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """The last samples of motions about their highest points, which each round brings nearer.

    A round takes evenly spaced samples between two times; the next one is between the neighbours of
    the highest sample.

    Parameters
    ----------
    height : callable
        The heights at times of the shape (samples, ...); of a motion all of them may be NaN.
    left, right : array
        The first times between which a motion has its highest point.
    samples, rounds : int
        The number of samples in a round, and the number of rounds.

    Returns
    -------
    tuple of array
        The heights of the last samples; and those of the highest one, or the one beside it at an
        end, and of the two beside it, shape (3, ...), with the times of these two.

    Examples
    --------
    >>> _, (low, top, high), left, right = about_highest(np.sin, 1.0, np.array(2.0), 21, 2)
    >>> round(float(right - left), 12), bool(low < top > high), round(float(top), 6)
    (0.01, True, 1.0)
    """
    share = np.linspace(0, 1, samples).reshape(-1, *(1,) * np.ndim(right))
    for _ in range(rounds):
        time = left + (right - left) * share
        value = height(time)
        inner = np.clip(value.argmax(axis=0), 1, samples - 2)
        three = inner + np.array([-1, 0, 1]).reshape(-1, *(1,) * inner.ndim)
        left, _, right = np.take_along_axis(time, three, axis=0)
    return value, np.take_along_axis(value, three, axis=0), left, right
