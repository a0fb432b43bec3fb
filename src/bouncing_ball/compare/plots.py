"""The plot of a drift over its budget, in the units of the page."""

import math
from dataclasses import dataclass

from bouncing_ball.compare.traces import Trace

LEFT, RIGHT, TOP, BOTTOM = 70, 626, 16, 150
# No more decades than these below the largest drift: what is smaller lies on the axis.
_DECADES = 9
_GRID_LINES = 6


@dataclass(frozen=True)
class Plot:
    """Where things are on the plot; the ordinate is logarithmic.

    Parameters
    ----------
    budget : float
        Ordinate of a drift that is the whole budget.
    grid : tuple of (float, str)
        Ordinates of powers of ten, and their labels.
    ticks : tuple of (float, str)
        Abscissas, and their labels.
    lines : tuple of (str, str, str)
        For each, what it is, a path of stems and a path of dots.
    """

    budget: float
    grid: tuple[tuple[float, str], ...]
    ticks: tuple[tuple[float, str], ...]
    lines: tuple[tuple[str, str, str], ...]


def _decades(shares: list[float]) -> tuple[int, int]:
    """Exponents of ten at both ends of the ordinate, the budget between them.

    Examples
    --------
    >>> _decades([0.004, 770.0]), _decades([math.inf]), _decades([1e-30, 1e-2])
    ((-3, 3), (-1, 1), (-8, 1))
    """
    finite = [math.log10(share) for share in shares if 0 < share < math.inf]
    top = max(1, math.ceil(max(finite, default=1)))
    return max(top - _DECADES, min(-1, math.floor(min(finite, default=-1)))), top


def plot(trace: Trace) -> Plot:
    """The plot of a trace; what is infinite is at its upper edge.

    Examples
    --------
    >>> found = plot(Trace("t", ((0.0, "0"),), (("", (1.0, 0.0, 10.0)),), ()))
    >>> found.budget, [label for _, label in found.grid]
    (83.0, ['0.1', '1', '10'])
    >>> found.lines[0][2]
    'M70 83h0M626 16h0'
    """
    low, high = _decades([share for _, shares in trace.lines for share in shares])

    def ordinate(share: float) -> float:
        exponent = min(max(math.log10(share), low), high) if share < math.inf else high
        return round(BOTTOM - (BOTTOM - TOP) * (exponent - low) / (high - low), 1)

    def paths(shares: tuple[float, ...]) -> tuple[str, str]:
        step = (RIGHT - LEFT) / max(len(shares) - 1, 1)
        places = [(LEFT + k * step, ordinate(share)) for k, share in enumerate(shares) if share > 0]
        stems = "".join(f"M{x:.4g} {BOTTOM}V{y:g}" for x, y in places)
        return stems, "".join(f"M{x:.4g} {y:g}h0" for x, y in places)

    every = math.ceil((high - low) / _GRID_LINES)
    return Plot(
        ordinate(1.0),
        tuple((ordinate(10.0**k), f"{10.0**k:g}") for k in range(low, high + 1) if k % every == 0),
        tuple((round(LEFT + (RIGHT - LEFT) * place, 1), label) for place, label in trace.ticks),
        tuple((label, *paths(shares)) for label, shares in trace.lines),
    )
