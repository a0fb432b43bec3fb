"""Calls whose answer is a labelled dataset: a ball over time, a ball dropped, a branch over Λ.

A list or an array in place of a number is an axis of the answer, named after its parameter, so
that two of them make a grid; :class:`xarray.DataArray` that share an axis are taken in pairs.
``plot()`` of an answer is its figure, ``plot("name.png")`` writes it.
"""

import math
from typing import Annotated, Any

from bouncing_ball.calls import (
    AnyAmplitude,
    Finite,
    Index,
    Positive,
    model,
    model_of_impact,
    model_of_limits,
)
from bouncing_ball.datasets.labelled import Grid, Labelled
from bouncing_ball.orbits import labelled
from bouncing_ball.signatures import Range, check, takes

Periods = Annotated[float, Range(0, 10_000, "(]")]
Samples = Annotated[int, Range(1, 100_000, "[]")]
Points = Annotated[int, Range(10, 10_000, "[]")]


@takes(model)
def history(
    amplitude: AnyAmplitude,
    *,
    phase: Finite = 0.0,
    velocity: Finite = -math.pi,
    periods: Periods = 10.0,
    samples: Samples = 200,
    **impact: Any,
) -> Labelled:
    """A ball over time, from a first impact.

    Parameters
    ----------
    amplitude : array_like
        Excitation amplitude Λ.
    phase : array_like
        Phase of the table at the first impact.
    velocity : array_like
        Absolute velocity of the ball before the first impact.
    periods : float
        Periods 2π of the table that are shown.
    samples : int
        Samples of each period.
    impact
        The parameters of :func:`bouncing_ball.model`.

    Returns
    -------
    Labelled
        ``ball`` z, ``ball_velocity`` z′, ``table`` w and whether they are in ``contact`` over
        ``time``, behind the axes of the arguments that are arrays.

    Raises
    ------
    ModelError
        If a parameter is missing, out of range or contradicts another.

    Examples
    --------
    >>> found = history(0.0, velocity=[-1.0, -2.0], restitution=1.0, periods=1.0, samples=4)
    >>> found.ball.dims, found.ball_velocity.isel(time=1).values + math.pi / 2
    (('velocity', 'time'), array([1., 2.]))
    """
    check(history, locals())
    grid = Grid(amplitude=amplitude, phase=phase, velocity=velocity, **impact)
    of = model_of_impact(**grid.flat)
    return labelled.from_impact(of, grid, labelled.instants(periods, samples, grid.size))


@takes(model)
def drop(
    height: Positive,
    amplitude: AnyAmplitude = 0.0,
    *,
    phase: Finite = 0.0,
    periods: Periods = 10.0,
    samples: Samples = 200,
    **impact: Any,
) -> Labelled:
    """A ball that is let go at rest above a table, which rests itself unless Λ is given.

    Parameters
    ----------
    height : array_like
        Height of the ball above the middle of the table's motion, in units of g/Ω².
    amplitude : array_like
        Excitation amplitude Λ.
    phase : array_like
        Phase of the table when the ball is let go.
    periods : float
        Periods 2π of the table that are shown.
    samples : int
        Samples of each period.
    impact
        The parameters of :func:`bouncing_ball.model`.

    Returns
    -------
    Labelled
        As of :func:`history`; the time is that since the ball was let go.

    Raises
    ------
    ModelError
        If a parameter is missing, out of range or contradicts another, or if the ball
        would be let go below the table.

    Examples
    --------
    From h a ball falls for √(2h), and rises to r²h:

    >>> found = drop(8.0, restitution=0.5, periods=1.0, samples=1000)
    >>> round(float(found.ball.where(found.time > 4.0).max()), 4)
    2.0
    """
    check(drop, locals())
    grid = Grid(height=height, amplitude=amplitude, phase=phase, **impact)
    lam, phi, velocity, _ = labelled.fall(grid)
    at = dict.fromkeys(("amplitude", "phase", "velocity", "height"))
    of = model_of_impact(lam, phi, velocity, **{k: x for k, x in grid.flat.items() if k not in at})
    return labelled.from_rest(of, grid, labelled.instants(periods, samples, grid.size))


@takes(model)
def branch(
    n: Index,
    *,
    amplitude_max: Positive | None = None,
    points: Points = 300,
    **impact: Any,
) -> Labelled:
    """The branch of n-T orbits over the amplitude Λ, on both sides of its saddle-node.

    Parameters
    ----------
    n : array_like of int
        Index n of the family.
    amplitude_max : float, optional
        The Λ up to which it is followed; by default 1.4 times that of the period doubling.
    points : int
        Points of the branch, at equal steps of arclength.
    impact
        The parameters of :func:`bouncing_ball.model`.

    Returns
    -------
    Labelled
        ``amplitude``, ``phase`` and the other observables of each ``point``, and whether the
        orbit is ``stable`` and ``admissible``; ``special_amplitude`` and others of the
        saddle-nodes, period doublings and grazing orbits. Where one of several branches does not
        exist it is NaN, and ``end_reason`` says why.

    Raises
    ------
    NoOrbitError
        If there is no branch up to this Λ, or if it cannot be followed.
    ModelError
        If a parameter is missing, out of range or contradicts another.

    Examples
    --------
    >>> found = branch(1, restitution=0.85, points=50)
    >>> found.special_kind.values.tolist()
    ['saddle-node', 'period doubling']
    >>> round(float(found.special_amplitude[0]) / math.pi * 1.85 / 0.15, 12)
    1.0
    """
    check(branch, locals())
    return labelled.branches(Grid(n=n, **impact), model_of_limits, amplitude_max, points)
