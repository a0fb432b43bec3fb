"""The branch of n-T orbits of a model, followed from one end to the other.

The branch is a solution curve of the equations of n-T orbits in the unknowns of the paper
(:mod:`bouncing_ball.periodic.one_impact.paper_unknowns`), with Λ as the parameter. It is followed
to both sides from an orbit in the stable range, until the orbits end or Λ leaves a window.
"""

from collections.abc import Collection
from dataclasses import replace

import numpy as np

from bouncing_ball.errors import NoOrbitError
from bouncing_ball.models.model import Model
from bouncing_ball.numerics.continuation import (
    ContinuationError,
    StepControl,
    continue_both_ways,
)
from bouncing_ball.numerics.events import Event
from bouncing_ball.periodic.branches.following import Followed, Range, limits_of
from bouncing_ball.periodic.one_impact import n_t
from bouncing_ball.periodic.one_impact.paper_unknowns import PaperUnknowns
from bouncing_ball.periodic.orbits.balls import LAMBDA
from bouncing_ball.periodic.orbits.orbit import Orbit
from bouncing_ball.periodic.orbits.special import ends_of_contact, passed_by, with_ends
from bouncing_ball.periodic.orbits.stability import Bifurcation

LARGEST_STEP = 0.1
"""Default of the largest step in arclength."""
# By default a branch ends at this multiple of the Λ of its period doubling.
_BEYOND_DOUBLING = 1.4
# Smallest Λ of a branch: a fold below it belongs to an elastic contact.
_LOWEST = 1e-4
# Number of Λ at which an orbit to start from is searched.
_STARTS = 16


def whole_branch(
    model: Model,
    n: int,
    amplitude_max: float | None,
    largest_step: float = LARGEST_STEP,
    ends: Collection[Bifurcation] = (),
) -> Followed:
    """The branch of n-T orbits of a single model, from one end to the other, up to some Λ.

    It is followed to both sides from the orbit in the middle of the stable range, or from the
    orbit at the nearest Λ that has one.

    Parameters
    ----------
    model : Model
    n : int
        Index of the family.
    amplitude_max : float, optional
        Λ at which the branch ends; by default 1.4 times that of the period doubling.
    largest_step : float
        Largest step in arclength.
    ends : collection of Bifurcation, optional
        The bifurcations at which the branch is not followed any further.

    Returns
    -------
    Followed
        The branch in the unknowns of the paper.

    Raises
    ------
    NoOrbitError
        If the branch begins above this Λ, or if no orbit is found to start from.
    ContinuationError
        If the continuation stops before an end of the branch or a bound of Λ.

    Examples
    --------
    >>> from bouncing_ball.models.rigid import RestitutionModel
    >>> found = whole_branch(RestitutionModel(0.85), 1, 1.2, largest_step=0.1)
    >>> [(str(each.kind), round(each.amplitude, 4)) for each in found.special]
    [('saddle-node', 0.2547), ('period doubling', 1.0383)]
    >>> str(found.branch.end)
    'amplitude = 1.2 is reached'
    """
    fold = n_t.saddle_node(model, n).amplitude
    doubling = n_t.period_doubling(model, n).amplitude
    low = fold if fold > 0 else 0.0
    top = amplitude_max or _default_top(low, doubling)
    if low >= top:
        raise NoOrbitError(f"{_none(model, n, top)}: the branch begins at Λ = {low:.6g}")
    stable = min(doubling, top)
    middle = (low + (stable if stable > low else top)) / 2
    start = _start(model, n, middle, low, top)
    problem = PaperUnknowns.of(start)
    events = _events(problem, top, ends)
    control = StepControl(largest=largest_step)
    found = continue_both_ways(problem, problem.point(start), events=events, control=control)
    for end in (found.start, found.end):
        if not end.finished:
            raise ContinuationError(f"the branch is not followed to its end: {end}")
    return Followed(problem, with_ends(problem, found))


def _default_top(low: float, doubling: float) -> float:
    """The largest Λ if none is given; without a period doubling it follows from the fold."""
    return _BEYOND_DOUBLING * (doubling if doubling > low else max(2 * low, 1.0))


def _none(model: Model, n: int, top: float) -> str:
    return f"no {n}-T orbit up to Λ = {top:g} for {model.label}"


def _start(model: Model, n: int, middle: float, low: float, top: float) -> Orbit:
    """The orbit at Λ = ``middle``, or at the nearest of several Λ that has one."""
    others = np.linspace(low, top, _STARTS + 1)[1:]
    nearest_first = others[np.argsort(np.abs(others - middle))]
    orbits = n_t.orbit(model, n, np.append(middle, nearest_first))
    if not np.any(orbits.exists):
        raise NoOrbitError(f"{_none(model, n, top)} was found to start from")
    return orbits[int(np.argmax(orbits.exists))]


def _events(problem: PaperUnknowns, top: float, ends: Collection[Bifurcation]) -> list[Event]:
    """The bifurcations and grazing orbits, of which those in ``ends`` are terminal, the ends of the
    domain in which orbits exist, and the bounds of Λ.
    """
    orbits = problem.orbits
    of_orbits = [
        *passed_by(orbits),
        *ends_of_contact(orbits),
        *limits_of(LAMBDA, Range(_LOWEST, top), orbits.equations),
    ]
    return [
        replace(problem.event(event), terminal=event.terminal or event.name in ends)
        for event in of_orbits
    ]
