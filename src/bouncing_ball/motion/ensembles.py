"""Many balls as flat arrays, worked on in blocks."""

from itertools import pairwise
from typing import Any, Self

import numpy as np

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


class Row:
    """What has a flat array, or a number for all, of each of its attributes."""

    def take(self, which: Any) -> Self:
        """Those of some of the balls."""
        part = object.__new__(type(self))
        vars(part).update((name, pick(value, which)) for name, value in vars(self).items())
        return part


def pick(value: Any, which: Any) -> Any:
    """Some entries of a flat array, of a tuple of such, or of a :class:`Row`.

    A number is that of all.
    """
    if isinstance(value, np.ndarray):
        return value[which] if value.ndim else value
    if isinstance(value, tuple):
        return type(value)(*(pick(x, which) for x in value))
    return value.take(which) if isinstance(value, Row) else value
