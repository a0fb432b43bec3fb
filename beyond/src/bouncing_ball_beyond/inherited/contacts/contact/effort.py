"""How many balls and impacts are followed for an answer, so that it takes seconds.

A contact law is integrated in time: an impact on it takes several milliseconds, a hundred times as
long as one on a linear contact, though hardly longer for many balls than for a few.
"""

import math
from typing import NamedTuple


class Effort(NamedTuple):
    """What is followed of balls on a contact.

    Parameters
    ----------
    starts : int
        Starts along each axis of the grid of starts.
    impacts : int
        Impacts of a ball in the search for the motion on which it ends.
    amplitude : float
        The largest Λ; beyond it a contact is so small a part of a flight that it takes longer.
    """

    starts: int
    impacts: int
    amplitude: float


LINEAR = Effort(starts=12, impacts=600, amplitude=math.inf)
"""The effort on a linear contact."""

# As many starts as on a linear contact would take some twenty seconds. At the largest Λ a motion
# takes up to eight.
OF_LAW = Effort(starts=6, impacts=250, amplitude=1e5)
"""The effort on a contact law."""
