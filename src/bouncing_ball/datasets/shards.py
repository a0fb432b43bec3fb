"""Dividing the places of a study among jobs.

A study with shards consists of two functions. The first, ``places`` in the rule of its stage,
computes arrays by name, with the places of the study along their last axes, either for all places
or for those that its argument ``part`` selects. The second makes the dataset: it takes these arrays
as the argument ``found``, and calls the first function if they are not given. The places are
independent, so that the dataset does not depend on the division.
"""

from collections.abc import Callable

import numpy as np

from bouncing_ball.errors import ParameterError

Arrays = dict[str, np.ndarray]
Found = Arrays | None
Part = Callable[[np.ndarray], np.ndarray]
"""Selects places along the last axis of an array; :func:`numpy.asarray` selects all of them."""


def shard_names(count: int) -> list[str]:
    """Names of shards with their number and count, so that another division has other names.

    Examples
    --------
    >>> shard_names(2)
    ['0000-of-0002', '0001-of-0002']
    """
    return [f"{k:04d}-of-{count:04d}" for k in range(count)]


def part_of(shard: str) -> Part:
    """The function that selects the places of a shard.

    Examples
    --------
    >>> part_of("0001-of-0002")(np.arange(5))
    array([3, 4])
    """
    number, count = map(int, shard.split("-of-"))

    def part(places: np.ndarray) -> np.ndarray:
        if count > (most := places.shape[-1]):
            raise ParameterError(f"shards: {count} are more than the {most} places of the study")
        return np.array_split(places, count, axis=-1)[number]

    return part
