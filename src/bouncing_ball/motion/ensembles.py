"""Many balls as flat arrays, computed in blocks."""

from itertools import pairwise
from typing import Any, Self

import numpy as np

# Largest number of balls in a block, chosen such that the arrays stay in the cache. Smaller blocks
# cost more, because a few slow balls determine the number of steps of each block.
BLOCK = 8192


def blocks(size: int, largest: int = BLOCK) -> list[slice]:
    """Slices of about equal length that cover all balls, each of at most ``largest``.

    Examples
    --------
    >>> blocks(3), len(blocks(10_000))
    ([slice(0, 3, None)], 2)
    """
    edges = np.linspace(0, size, -(-size // largest) + 1, dtype=int)
    return [slice(int(a), int(b)) for a, b in pairwise(edges)]


class Row:
    """An object whose attributes are flat arrays over balls, or numbers that apply to all balls."""

    def take(self, which: Any) -> Self:
        """The same object, restricted to some of the balls."""
        part = object.__new__(type(self))
        vars(part).update({name: pick(value, which) for name, value in vars(self).items()})
        return part


def pick(value: Any, which: Any) -> Any:
    """Some entries of a flat array, of a tuple of arrays, or of a :class:`Row`.

    A number applies to all balls and is returned unchanged.

    Examples
    --------
    >>> pick(np.array([1.0, 2.0, 3.0]), [0, 2]).tolist(), pick(0.5, [0, 2])
    ([1.0, 3.0], 0.5)
    """
    if isinstance(value, np.ndarray):
        return value[which] if value.ndim else value
    if isinstance(value, tuple):
        return type(value)(*(pick(x, which) for x in value))
    return value.take(which) if isinstance(value, Row) else value
