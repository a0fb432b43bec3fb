"""The quantities of orbits, and of a branch with its ends, that datasets and answers contain."""

from dataclasses import replace
from typing import Any

import numpy as np

from bouncing_ball.errors import NoOrbitError
from bouncing_ball.numerics.continuation import (
    Branch,
    ContinuationError,
    StepControl,
    continue_both_ways,
)
from bouncing_ball.numerics.events import parameter_bound
from bouncing_ball.paper.orbits.model import ImpactModel

# By default a branch ends at this multiple of the Λ of its period doubling. A fold below the
# second number belongs to an elastic contact. The third is the number of orbits that are tried as
# starting points of a branch.
_BEYOND, _LOWEST, _STARTS = 1.4, 1e-4, 16


def whole_branch(
    model: ImpactModel, n: int, amplitude_max: float | None, largest_step: float, ends: Any = ()
) -> Branch:
    """The branch of n-T orbits of a single model, from one end to the other, up to some Λ.

    It is followed to both sides from the orbit in the middle of the stable range, or from the
    orbit at the nearest Λ that has one.

    Parameters
    ----------
    model : ImpactModel
    n : int
        Index of the family.
    amplitude_max : float, optional
        Λ at which the branch ends; by default 1.4 times that of the period doubling.
    largest_step : float
        Largest step in arclength.
    ends : collection of Bifurcation, optional
        The bifurcations at which the branch is not followed any further.

    Raises
    ------
    NoOrbitError
        If the branch begins above this Λ, or if no orbit is found to start from.
    ContinuationError
        If the continuation stops before an end of the branch or a bound of Λ.
    """
    fold, doubling = (float(f(n).amplitude) for f in (model.saddle_node, model.period_doubling))
    low = fold if fold > 0 else 0.0
    top = amplitude_max or _BEYOND * (doubling if doubling > low else max(2 * low, 1.0))
    none = f"no {n}-T orbit up to Λ = {top:g} for {model.label}"
    if low >= top:
        raise NoOrbitError(f"{none}: the branch begins at Λ = {low:.6g}")
    stable = min(doubling, top)
    tried = np.linspace(low, top, _STARTS + 1)[1:]
    middle = (low + (stable if stable > low else top)) / 2
    tried = np.append(middle, tried[np.argsort(np.abs(tried - middle))])
    system, orbits = model.system(n), model.orbit(n, tried)
    if not np.any(orbits.exists):
        raise NoOrbitError(f"{none} was found to start from")
    start = system.point(orbits[int(np.argmax(orbits.exists))])
    events = [replace(x, terminal=x.terminal or x.name in ends) for x in system.events()]
    events += [
        parameter_bound(x, upper, f"left the window at amplitude {x:g}")
        for x, upper in ((_LOWEST, False), (top, True))
    ]
    control = StepControl(largest=largest_step)
    found = continue_both_ways(system, start, events=events, control=control)
    for end in (found.start, found.end):
        if not end.finished:
            raise ContinuationError(f"the branch is not followed to its end: {end}")
    return found
