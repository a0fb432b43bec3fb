"""How many balls and impacts are followed for an answer, so that it takes seconds.

A contact law is integrated in time: an impact on it takes several milliseconds, a hundred times as
long as one on a linear contact, though hardly longer for many balls than for a few.
"""

import math
from typing import NamedTuple


class Sampling(NamedTuple):
    """The samples of balls: the number of balls is rounded up to multiples of ``unit``; unless one
    is asked for it is ``usual``. The means are examined after each of the numbers of ``impacts`` of
    a ball. At least ``before`` first impacts are left out.
    """

    unit: int
    usual: int
    impacts: tuple[int, ...]
    before: int


class Effort(NamedTuple):
    """What is followed of balls on a contact.

    Parameters
    ----------
    starts : int
        Starts along each axis of the grid of starts.
    impacts : int
        Impacts of a ball in the search for the motion on which it ends.
    samples : Sampling
        The samples for means over time.
    samples_of_change : Sampling
        The samples if r, k or g change.
    amplitude : float
        The largest Λ; beyond it a contact is so small a part of a flight that it takes longer.
    """

    starts: int
    impacts: int
    samples: Sampling
    samples_of_change: Sampling
    amplitude: float


LINEAR = Effort(
    starts=12,
    impacts=600,
    samples=Sampling(unit=256, usual=4096, impacts=(25, 75, 150), before=50),
    samples_of_change=Sampling(unit=1024, usual=1024, impacts=(75,), before=50),
    amplitude=math.inf,
)
"""The effort on a linear contact."""

# As many starts as on a linear contact would take some twenty seconds. At the largest Λ a motion
# takes up to eight.
OF_LAW = Effort(
    starts=6,
    impacts=250,
    samples=Sampling(unit=128, usual=256, impacts=(20, 40), before=40),
    samples_of_change=Sampling(unit=128, usual=128, impacts=(20,), before=40),
    amplitude=1e5,
)
"""The effort on a contact law."""
