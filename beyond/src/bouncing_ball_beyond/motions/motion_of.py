"""The motions on which balls end: of one ball, over a range of Λ, or from a grid of starts."""

from __future__ import annotations

import numpy as np

from bouncing_ball_beyond.drawing.result import Result
from bouncing_ball_beyond.inherited.datasets.arguments import (
    AMPLITUDE,
    POSITIVE,
    SAMPLES,
    Amplitude,
    AmplitudeAxis,
    Positive,
    SampleCount,
    StartAxis,
    checked,
    checked_number,
)
from bouncing_ball_beyond.inherited.datasets.labelled import Grid
from bouncing_ball_beyond.inherited.errors import ParameterError, suggesting
from bouncing_ball_beyond.inherited.models import history
from bouncing_ball_beyond.models.ball import Ball
from bouncing_ball_beyond.models.docstrings import as_in
from bouncing_ball_beyond.models.given_ball import a_single_ball
from bouncing_ball_beyond.motions import grids
from bouncing_ball_beyond.motions.destination import FOLLOWED, IMPACTS, FollowedImpacts
from bouncing_ball_beyond.motions.over_time import VELOCITY, first_impacts, simulate


@suggesting
@as_in(history.simulate, simulate)
def motion_of(
    ball: Ball,
    *,
    amplitude: AmplitudeAxis,
    phase: StartAxis = 0.0,
    velocity: StartAxis = VELOCITY,
    relative_velocity: StartAxis | None = None,
    impacts: FollowedImpacts = IMPACTS,
) -> Result:
    """The motion on which a ball ends, after a first impact as in
    :func:`bouncing_ball_beyond.simulate`.

    Parameters
    ----------
    ball : Ball
    impacts : int
        Number of impacts after which the search for a repetition ends. With more of them, long
        transients before a motion that repeats are not called chaotic.

    Returns
    -------
    Result
        ``kind``, one of "orbit", "subharmonic", "locked", "permanent contact", "chaotic" and
        "undecided" (:class:`bouncing_ball_beyond.motions.motions.Kind`), the ``periods`` of the
        table and the ``impacts`` until the motion repeats, its ``lyapunov_exponent`` per period of
        the table with ``lyapunov_error``, the ``reason`` if it is undecided or if it is locked with
        an unknown period, and one of its impacts. ``followed`` is the number of impacts for which
        it was followed, up to ``followed_time``, ``in_words`` says both, and ``digits_lost`` is the
        number of decimal digits of the start that were lost on the way: a double has 16.
        ``times_stuck`` is the number of contacts at which the ball stuck to the table meanwhile,
        and ``first_lift_off`` the time at which the first of them ended. The figure shows the
        periods of the motions over an argument.

    Raises
    ------
    ModelError
        If a parameter is missing, of a wrong type or shape, or out of range.

    Examples
    --------
    A ball that sticks to the table and is thrown off again, each time in the same way:

    >>> from bouncing_ball_beyond import rigid
    >>> found = motion_of(rigid(restitution=0.6), amplitude=3.0)
    >>> found.kind.item(), found.periods.item()
    ('locked', 13)
    """
    grid, first = first_impacts(ball, amplitude, phase, velocity, relative_velocity)
    most = checked_number("impacts", impacts, FOLLOWED)
    found = grids.motions(first.model(ball, grid), *first, most)
    return Result.of(grid.unfold(found), "motion")


@suggesting
@as_in(motion_of)
def lyapunov_exponent(
    ball: Ball,
    *,
    amplitude: AmplitudeAxis,
    phase: StartAxis = 0.0,
    velocity: StartAxis = VELOCITY,
    relative_velocity: StartAxis | None = None,
    impacts: FollowedImpacts = IMPACTS,
) -> Result:
    """The two Lyapunov exponents of the motion on which a ball ends, per period of the table.

    Returns
    -------
    Result
        ``lyapunov_exponent`` with ``lyapunov_error``: twice this error on both sides is an interval
        of about 95 %. The error is NaN if the ball was followed for less than 25 times the number
        of impacts in which areas contract by e, about 1/(1 - r²): 2500 impacts at r = 0.995 and
        12500 at r = 0.999. The exponent of a nearly elastic ball falls as its speed rises, and may
        be wrong by half of it then. The ``kind`` is that of the motion, and ``in_words`` says for
        how many impacts the ball was ``followed``. Where the motion looks chaotic, 32 balls that
        start next to its end are followed for as many impacts. If one of them comes to rest on the
        table or repeats its motion, chaos cannot be told from a long transient: the ``kind`` is
        "undecided", the ``reason`` says so, and the exponent is NaN. That of the impacts followed
        is in :func:`motion_of`. For a periodic motion the exponent follows from the larger
        multiplier, and is -∞ if the later motion does not depend on earlier impacts.
        ``exponent_sum`` is the sum of both exponents: the mean of the logarithm of the determinant
        of the return map, over one repetition, or over as many impacts as the ball was followed
        for. ``second_exponent`` is the difference of the two. The figure shows
        the largest exponents with their errors.

    Examples
    --------
    The multipliers of the 1-T orbit are complex, of modulus r:

    >>> from bouncing_ball_beyond import rigid
    >>> found = lyapunov_exponent(rigid(restitution=0.85), amplitude=1.0, phase=1.1)
    >>> abs(round(float(found.lyapunov_exponent - np.log(0.85)), 6))
    0.0
    """
    grid, first = first_impacts(ball, amplitude, phase, velocity, relative_velocity)
    most = checked_number("impacts", impacts, FOLLOWED)
    model = first.model(ball, grid)
    found = grids.exponents(model, *first, most)
    return Result.of(grid.unfold(found), "exponent")


@suggesting
def orbit_diagram(
    ball: Ball,
    *,
    amplitude: AmplitudeAxis,
    starts: SampleCount = 6,
    samples: SampleCount = 64,
    impacts: FollowedImpacts = IMPACTS,
) -> Result:
    """The attractors over Λ, reached from several starts and by following balls in Λ.

    Parameters
    ----------
    ball : Ball
        A single ball.
    amplitude : float or array
        Excitation amplitudes Λ in rising order.
    starts : int
        Number of balls at each amplitude, spread evenly over phases and speeds. Further balls
        start near the n-T orbits up to n = 3.
    samples : int
        Largest number of impacts recorded of each motion.
    impacts : int
        Number of impacts after which the search for a repetition ends.

    Returns
    -------
    Result
        As for :func:`motion_of`, for each ``start`` and for two balls that are followed upwards
        and downwards in Λ; ``impact_phase`` and ``impact_speed`` of each ``impact`` recorded,
        which the figure shows over Λ.

    Raises
    ------
    ModelError
        If a parameter is missing, of a wrong type or shape, or out of range, if the amplitudes do
        not rise, or if there are more balls than fit into memory.

    Examples
    --------
    Below and above the period doubling, for the ball that starts near the 1-T orbit:

    >>> from bouncing_ball_beyond import rigid
    >>> found = orbit_diagram(rigid(restitution=0.5), amplitude=[1.5, 1.6], impacts=200)
    >>> found.impacts.isel(start=6).values.tolist()
    [1, 2]
    """
    lam = np.atleast_1d(np.asarray(checked("amplitude", amplitude, AMPLITUDE)))
    if lam.ndim > 1 or np.any(np.diff(lam) <= 0):
        raise ParameterError("{amplitude} must be at least one Λ, in rising order")
    found = grids.diagram(
        a_single_ball(ball),
        lam,
        starts=checked_number("starts", starts, SAMPLES),
        samples=checked_number("samples", samples, SAMPLES),
        impacts=checked_number("impacts", impacts, FOLLOWED),
    )
    return Result.of(Grid(**ball.parameters).unfold(found), "diagram")


@suggesting
def basins(
    ball: Ball,
    *,
    amplitude: Amplitude,
    starts: SampleCount = 200,
    relative_velocity_max: Positive | None = None,
    impacts: FollowedImpacts = IMPACTS,
) -> Result:
    """The motions on which balls end that start from a grid of first impacts, and their shares.

    Parameters
    ----------
    ball : Ball
        A single ball.
    amplitude : float
        Excitation amplitude Λ.
    starts : int
        Number of starts along each axis, the phase of the table and the relative speed.
    relative_velocity_max : float, optional
        Largest relative speed of the first impact; balls seldom exceed the default.
    impacts : int
        Number of impacts after which the search for a repetition ends.

    Returns
    -------
    Result
        ``destination``, the number of a ``motion`` for each start; and the kind, the periods,
        the impacts and the ``share`` of each motion, with the standard error of the share. The
        figure shows the motion of each start in a colour.

    Raises
    ------
    ModelError
        If a parameter is missing, of a wrong type or shape, or out of range, or if there are more
        balls than fit into memory.

    Examples
    --------
    >>> from bouncing_ball_beyond import rigid
    >>> found = basins(rigid(restitution=0.5), amplitude=1.2, starts=20)
    >>> set(found.motion_kind.values.tolist()) == {"orbit", "locked"}, float(found.share.sum())
    (True, 1.0)
    """
    lam = checked_number("amplitude", amplitude, AMPLITUDE)
    fastest = None
    if relative_velocity_max is not None:
        fastest = checked_number("relative_velocity_max", relative_velocity_max, POSITIVE)
    found = grids.basins(
        a_single_ball(ball),
        lam,
        starts=checked_number("starts", starts, SAMPLES),
        fast=fastest,
        impacts=checked_number("impacts", impacts, FOLLOWED),
    )
    whole = Grid(**ball.parameters).unfold(found.assign_attrs(amplitude=lam))
    return Result.of(whole, "basins")
