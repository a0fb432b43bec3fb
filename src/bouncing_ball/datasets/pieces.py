"""Studies whose places are followed in pieces, each by a job of its own.

A study that takes long has an argument ``follow``, and calls it once with a function of its places
and these, arrays whose last axes are the places. The function returns arrays by name, with the
places along the last axis as well. Places do not depend on each other, so that the numbers do not
depend on the pieces. By default ``follow`` is :func:`operator.call`.
"""

from collections.abc import Callable, Sequence

import numpy as np
import xarray as xr

Follow = Callable[..., dict[str, np.ndarray]]


class Followed(Exception):
    """Ends a study of which one piece was to be followed; its argument is what was found."""


def only(number: int, pieces: int) -> Follow:
    """Follow one of several pieces, and end the study with :class:`Followed`.

    Examples
    --------
    >>> try:
    ...     only(1, 2)(lambda place: {"twice": 2 * place}, np.arange(4))
    ... except Followed as found:
    ...     found.args
    ({'twice': array([4, 6])},)
    """

    def follow(function: Follow, *places: np.ndarray) -> dict[str, np.ndarray]:
        part = (np.array_split(x, pieces, axis=-1)[number] for x in places)
        raise Followed(function(*part))

    return follow


def joined(pieces: Sequence[xr.Dataset]) -> Follow:
    """Take what all pieces, in their order, have found.

    Examples
    --------
    >>> joined([xr.Dataset({"twice": ("place", [k, k])}) for k in range(2)])(None)
    {'twice': array([0, 0, 1, 1])}
    """
    whole = {str(x): np.concatenate([p[x].values for p in pieces], axis=-1) for x in pieces[0]}
    # A file returns texts as objects.
    found = {x: y.astype(str) if y.dtype == object else y for x, y in whole.items()}
    return lambda *_: found
