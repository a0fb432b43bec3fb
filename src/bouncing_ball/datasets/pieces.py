"""Dividing a study into pieces that are computed by separate jobs.

A long study has an argument ``follow``. The study calls it once, with a function and the arguments
of this function: arrays with the places of the study along their last axis. The function returns
arrays by name, with the places along the last axis as well. The places are independent, so that
the results do not depend on the division. By default ``follow`` is :func:`operator.call`.
"""

from collections.abc import Callable, Sequence

import numpy as np
import xarray as xr

Follow = Callable[..., dict[str, np.ndarray]]


class Followed(Exception):
    """Ends a study after one piece; the argument of the exception is the result of this piece."""


def only(number: int, pieces: int) -> Follow:
    """A function ``follow`` that computes one of several pieces and then raises :class:`Followed`.

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
    """A function ``follow`` that returns the joined results of all pieces, given in their order.

    Examples
    --------
    >>> joined([xr.Dataset({"twice": ("place", [k, k])}) for k in range(2)])(None)
    {'twice': array([0, 0, 1, 1])}
    """
    whole = {str(x): np.concatenate([p[x].values for p in pieces], axis=-1) for x in pieces[0]}
    # Texts read from a file have the type object.
    found = {x: y.astype(str) if y.dtype == object else y for x, y in whole.items()}
    return lambda *_: found
