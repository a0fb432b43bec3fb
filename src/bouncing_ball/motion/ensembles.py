"""Many balls as flat arrays, worked on in blocks."""

from collections.abc import Sequence
from itertools import pairwise

import numpy as np
from numpy.typing import ArrayLike

# Balls computed at once, at most: as many as keep the arrays in the cache. Fewer
# cost more, as a few late balls decide on the number of steps of each block.
BLOCK = 8192


def blocks(size: int, largest: int = BLOCK) -> list[slice]:
    """Slices of about equal length that cover all balls, ``largest`` at most.

    Examples
    --------
    >>> blocks(3), len(blocks(10_000))
    ([slice(0, 3, None)], 2)
    """
    edges = np.linspace(0, size, -(-size // largest) + 1, dtype=int)
    return [slice(int(a), int(b)) for a, b in pairwise(edges)]


def flatten(
    parameters: Sequence[ArrayLike], states: Sequence[ArrayLike]
) -> tuple[list[np.ndarray], list[np.ndarray], tuple[int, ...]]:
    """Broadcast together: parameters flat or scalar, states flat, and the shape.

    A parameter that is the same for all balls stays one number: less to compute.

    Examples
    --------
    >>> parameters, states, shape = flatten([0.5], [[1, 2], 3])
    >>> parameters, states, shape
    ([array(0.5)], [array([1., 2.]), array([3., 3.])], (2,))
    """
    arrays = [np.asarray(x, dtype=float) for x in (*parameters, *states)]
    shape = np.broadcast_shapes(*(x.shape for x in arrays))

    def flat(x):
        return np.ascontiguousarray(np.broadcast_to(x, shape)).reshape(-1)

    count = len(parameters)
    return (
        [flat(x) if x.ndim else x for x in arrays[:count]],
        [flat(x) for x in arrays[count:]],
        shape,
    )


def pick(value, which):
    """Some entries of a flat array; a number is that of all."""
    return value[which] if np.ndim(value) else value
