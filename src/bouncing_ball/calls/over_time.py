"""Calls that follow a ball from its first impact, or from the height at which it is dropped."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from bouncing_ball.calls.arguments import (
    AMPLITUDE,
    IMPACTS,
    PERIODS,
    POSITIVE,
    SAMPLES,
    STATE,
    Amplitude,
    Impacts,
    Periods,
    Positive,
    Samples,
    State,
    checked,
    checked_number,
)
from bouncing_ball.calls.balls import Ball, a_ball

if TYPE_CHECKING:
    from bouncing_ball.drawing.result import Result


def simulate(
    ball: Ball,
    *,
    amplitude: Amplitude,
    phase: State = 0.0,
    velocity: State = -math.pi,
    impacts: Impacts = 100,
) -> Result:
    """The sequence of impacts that begins with a given first impact.

    Parameters
    ----------
    ball : Ball
    amplitude : float or array
        Excitation amplitude Λ.
    phase : float or array
        Phase of the table at the first impact.
    velocity : float or array
        Absolute velocity of the ball before the first impact.
    impacts : int
        Largest number of impacts.

    Returns
    -------
    Result
        ``time``, ``impact_phase``, ``impact_velocity``, ``contact_duration`` and
        ``bounce_velocity`` of each ``impact``, NaN after the last one; and the ``status`` of the
        ball after it. The last axis is ``impact``; each argument that is an array has an axis
        before it. The figure shows the phases and velocities of the impacts over time.

    Raises
    ------
    ModelError
        If a parameter is missing, of a wrong type or shape, or out of range, or if the ball rises
        from the table at first.

    Examples
    --------
    >>> from bouncing_ball import rigid
    >>> found = simulate(rigid(restitution=0.5), amplitude=0.0, velocity=-4.0, impacts=3)
    >>> found.time.values.tolist(), found.status.item()
    ([0.0, 4.0, 6.0], 'bouncing')
    """
    lam = checked("amplitude", amplitude, AMPLITUDE)
    phi = checked("phase", phase, STATE)
    before = checked("velocity", velocity, STATE)
    count = checked_number("impacts", impacts, IMPACTS)
    a_ball(ball)
    # Imported here, because the command line needs no labels.
    from bouncing_ball.calls.over_time_on_grid import impacts_on_grid

    return impacts_on_grid(ball, lam, phi, before, count)


def history(
    ball: Ball,
    *,
    amplitude: Amplitude,
    phase: State = 0.0,
    velocity: State = -math.pi,
    periods: Periods = 10.0,
    samples: Samples = 200,
) -> Result:
    """A ball over time, from a first impact as in :func:`simulate`.

    Parameters
    ----------
    ball : Ball
    amplitude : float or array
        Excitation amplitude Λ.
    phase : float or array
        Phase of the table at the first impact.
    velocity : float or array
        Absolute velocity of the ball before the first impact.
    periods : float
        Number of periods 2π of the table.
    samples : int
        Number of samples in each period.

    Returns
    -------
    Result
        ``ball`` z, ``ball_velocity`` z′, ``table`` w and whether they are in ``contact``. The
        last axis is ``time``; each argument that is an array has an axis before it. The figure
        shows the heights over time.

    Raises
    ------
    ModelError
        If a parameter is missing, of a wrong type or shape, or out of range, or if a ball has too
        many impacts in this time.

    Examples
    --------
    >>> from bouncing_ball import rigid
    >>> elastic = rigid(restitution=1.0)
    >>> found = history(elastic, amplitude=0.0, velocity=[-1.0, -2.0], periods=1.0, samples=4)
    >>> found.ball.dims, found.ball_velocity.isel(time=1).values + math.pi / 2
    (('velocity', 'time'), array([1., 2.]))
    """
    lam = checked("amplitude", amplitude, AMPLITUDE)
    phi = checked("phase", phase, STATE)
    before = checked("velocity", velocity, STATE)
    length = checked_number("periods", periods, PERIODS)
    count = checked_number("samples", samples, SAMPLES)
    a_ball(ball)
    from bouncing_ball.calls.over_time_on_grid import history_on_grid

    return history_on_grid(ball, lam, phi, before, length, count)


def drop(
    ball: Ball,
    *,
    height: Positive,
    amplitude: Amplitude = 0.0,
    phase: State = 0.0,
    periods: Periods = 10.0,
    samples: Samples = 200,
) -> Result:
    """A ball that is dropped at rest above a table, which does not move unless Λ is given.

    Parameters
    ----------
    ball : Ball
    height : float or array
        Height of the ball above the middle of the table's motion, in units of g/Ω².
    amplitude : float or array
        Excitation amplitude Λ.
    phase : float or array
        Phase of the table when the ball is dropped.
    periods : float
        Number of periods 2π of the table.
    samples : int
        Number of samples in each period.

    Returns
    -------
    Result
        As for :func:`history`; the time begins when the ball is dropped.

    Raises
    ------
    ModelError
        If a parameter is missing, of a wrong type or shape, or out of range, if the ball would be
        dropped below the table, or if it has too many impacts in this time.

    Examples
    --------
    From h a ball falls for √(2h), and rises to r²h:

    >>> from bouncing_ball import rigid
    >>> found = drop(rigid(restitution=0.5), height=8.0, periods=1.0, samples=1000)
    >>> round(float(found.ball.where(found.time > 4.0).max()), 4)
    2.0
    """
    start = checked("height", height, POSITIVE)
    lam = checked("amplitude", amplitude, AMPLITUDE)
    phi = checked("phase", phase, STATE)
    length = checked_number("periods", periods, PERIODS)
    count = checked_number("samples", samples, SAMPLES)
    a_ball(ball)
    from bouncing_ball.calls.over_time_on_grid import drop_on_grid

    return drop_on_grid(ball, start, lam, phi, length, count)
