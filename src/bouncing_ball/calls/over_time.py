"""Calls that follow a ball from its first impact, or from the height at which it is dropped."""

import math
from typing import Annotated, Any

from bouncing_ball.calls.balls import AnyAmplitude, Positive, model, model_of_impact
from bouncing_ball.calls.signatures import check, takes
from bouncing_ball.errors import Range, count
from bouncing_ball.paper.orbits.model import labelled

Finite = Annotated[Any, Range()]
# One impact takes a third of a millisecond, so that the largest number takes half a minute.
Impacts = Annotated[int, count(100_000)]
Periods = Annotated[float, Range(0, 10_000, "(]")]
Samples = Annotated[int, count(100_000)]


@takes(model)
def simulate(
    amplitude: AnyAmplitude,
    *,
    phase: Finite = 0.0,
    velocity: Finite = -math.pi,
    impacts: Impacts = 100,
    **impact: Any,
) -> Any:
    """The sequence of impacts that begins with a given first impact.

    Parameters
    ----------
    amplitude : array_like
        Excitation amplitude Λ.
    phase : array_like
        Phase of the table at the first impact.
    velocity : array_like
        Absolute velocity of the ball before the first impact.
    impacts : int
        Largest number of impacts.
    impact
        The parameters of :func:`bouncing_ball.model`.

    Returns
    -------
    ImpactSequence
        Arrays with one entry for each impact; of several balls shape (impact, ...).

    Raises
    ------
    ModelError
        If a parameter is missing, out of range or contradicts another.

    Examples
    --------
    >>> simulate(0.0, restitution=0.5, velocity=-4.0, impacts=3).time.tolist()
    [0.0, 4.0, 6.0]
    """
    check(simulate, locals())
    of = model_of_impact(amplitude, phase, velocity, **impact)
    return of.simulate(amplitude, phase, velocity, impacts)


@takes(simulate, without=("impacts",))
def history(
    amplitude,
    *,
    phase=0.0,
    velocity=-math.pi,
    periods: Periods = 10.0,
    samples: Samples = 200,
    **impact: Any,
) -> Any:
    """A ball over time, from a first impact as in :func:`simulate`.

    Parameters
    ----------
    periods : float
        Number of periods 2π of the table.
    samples : int
        Number of samples in each period.

    Returns
    -------
    Labelled
        ``ball`` z, ``ball_velocity`` z′, ``table`` w and whether they are in ``contact``. The
        last axis is ``time``; each argument that is an array has an axis before it.

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
    grid = labelled().Grid(amplitude=amplitude, phase=phase, velocity=velocity, **impact)
    return labelled().history(grid, model_of_impact, periods, samples)


@takes(history, without=("velocity",))
def drop(
    height: Positive, amplitude=0.0, *, phase=0.0, periods=10.0, samples=200, **impact: Any
) -> Any:
    """A ball that is dropped at rest above a table, which does not move unless Λ is given.

    The other parameters are those of :func:`history`.

    Parameters
    ----------
    height : array_like
        Height of the ball above the middle of the table's motion, in units of g/Ω².
    phase : array_like
        Phase of the table when the ball is dropped.

    Returns
    -------
    Labelled
        As for :func:`history`; the time begins when the ball is dropped.

    Raises
    ------
    ModelError
        If a parameter is missing, out of range or contradicts another, or if the ball
        would be dropped below the table.

    Examples
    --------
    From h a ball falls for √(2h), and rises to r²h:

    >>> found = drop(8.0, restitution=0.5, periods=1.0, samples=1000)
    >>> round(float(found.ball.where(found.time > 4.0).max()), 4)
    2.0
    """
    check(drop, locals())
    grid = labelled().Grid(height=height, amplitude=amplitude, phase=phase, **impact)
    return labelled().drop(grid, model_of_impact, periods, samples)
