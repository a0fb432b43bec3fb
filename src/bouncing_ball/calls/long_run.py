"""Calls about the motions on which balls end: one ball, a range of Λ, or a grid of starts."""

import math
from collections.abc import Mapping
from typing import Annotated, Any

import numpy as np

from bouncing_ball.beyond.long_run import grids as labelled
from bouncing_ball.calls.balls import AnyAmplitude, Positive, impact_model, model_of_impact
from bouncing_ball.calls.over_time import simulate
from bouncing_ball.calls.signatures import check, takes
from bouncing_ball.datasets.labelled import Grid, Labelled
from bouncing_ball.errors import ParameterError, count
from bouncing_ball.paper.orbits.model import ImpactModel

# Number of impacts of one ball, and numbers of starts or samples.
Followed = Annotated[int, count(10_000_000, low=10)]
Many = Annotated[int, count(100_000)]


@takes(simulate)
def motion_of(
    amplitude, *, phase=0.0, velocity=-math.pi, impacts: Followed = 4000, **impact: Any
) -> Labelled:
    """The motion on which a ball ends, after a first impact as in
    :func:`bouncing_ball.simulate`.

    Parameters
    ----------
    impacts : int
        Number of impacts after which the search for a repetition ends.

    Returns
    -------
    Labelled
        ``kind``, one of "orbit", "subharmonic", "locked", "permanent contact", "chaotic" and
        "undecided" (:class:`bouncing_ball.beyond.long_run.motions.Kind`), the ``periods`` of the table
        and the ``impacts`` until the motion repeats, its ``lyapunov_exponent`` per period of the
        table with ``lyapunov_error``, the ``reason`` if it is undecided, and one of its impacts.

    Raises
    ------
    ModelError
        If a parameter is missing, out of range or contradicts another.

    Examples
    --------
    A ball that sticks to the table and is thrown off again, each time in the same way:

    >>> found = motion_of(3.0, restitution=0.6)
    >>> found.kind.item(), found.periods.item()
    ('locked', 13)
    """
    check(motion_of, locals())
    grid = Grid(amplitude=amplitude, phase=phase, velocity=velocity, **impact)
    return labelled.motions(grid, model_of_impact(**grid.flat), impacts)


@takes(motion_of)
def lyapunov_exponent(amplitude: AnyAmplitude, **given: Any) -> Labelled:
    """The largest Lyapunov exponent of the motion on which a ball ends, per period of the table.

    Parameters
    ----------
    amplitude : array_like
        Excitation amplitude Λ.
    given
        The parameters of :func:`motion_of`.

    Returns
    -------
    Labelled
        ``lyapunov_exponent`` with ``lyapunov_error``, its standard error, and the ``kind`` of the
        motion. For a periodic motion it follows from the larger multiplier, and is -∞ if the
        later motion does not depend on earlier impacts.

    Raises
    ------
    ModelError
        If a parameter is missing, out of range or contradicts another.

    Examples
    --------
    The multipliers of the 1-T orbit are complex, of modulus r:

    >>> found = lyapunov_exponent(1.0, restitution=0.85, phase=1.1)
    >>> abs(round(float(found.lyapunov_exponent) - math.log(0.85), 6))
    0.0
    """
    found = motion_of(amplitude, **given)
    return found[["lyapunov_exponent", "lyapunov_error", "kind"]].assign_attrs(kind="exponent")


@takes(motion_of, without=("amplitude", "phase", "velocity"))
def orbit_diagram(
    amplitudes: AnyAmplitude, *, starts: Many = 6, samples: Many = 64, impacts=1000, **impact: Any
) -> Labelled:
    """The attractors over Λ, reached from several starts and by following balls in Λ.

    ``impacts`` and the model are given as in :func:`motion_of`.

    Parameters
    ----------
    amplitudes : array_like
        Excitation amplitudes Λ in rising order.
    starts : int
        Number of balls at each amplitude, spread evenly over phases and speeds. Further balls
        start near the n-T orbits up to n = 3.
    samples : int
        Largest number of impacts recorded of each motion.

    Returns
    -------
    Labelled
        As for :func:`motion_of`, for each ``start`` and for two balls that are followed upwards
        and downwards in Λ; ``impact_phase`` and ``impact_speed`` of each ``impact`` recorded.

    Raises
    ------
    ModelError
        If a parameter is missing, out of range or contradicts another, if there are no
        amplitudes or if they do not rise, or if there are more balls than fit into memory.

    Examples
    --------
    Below and above the period doubling, for the ball that starts near the 1-T orbit:

    >>> found = orbit_diagram([1.5, 1.6], restitution=0.5, impacts=200)
    >>> found.impacts.isel(start=6).values.tolist()
    [1, 2]
    """
    check(orbit_diagram, locals())
    values = np.atleast_1d(np.asarray(amplitudes, dtype=float))
    if not values.size or values.ndim > 1 or np.any(np.diff(values) <= 0):
        raise ParameterError("{amplitudes} must be at least one Λ, in rising order")
    of, grid = _single(impact)
    return grid.unfold(labelled.diagram(of, values, starts, samples, impacts))


@takes(motion_of, without=("phase", "velocity"))
def basins(
    amplitude,
    *,
    starts: Many = 200,
    velocity_max: Positive | None = None,
    impacts=2000,
    **impact: Any,
) -> Labelled:
    """The motions on which balls end that start from a grid of first impacts, and their shares.

    ``amplitude``, ``impacts`` and the model are given as in :func:`motion_of`.

    Parameters
    ----------
    starts : int
        Number of starts along each axis, the phase of the table and the relative speed.
    velocity_max : float, optional
        Largest relative speed of the first impact; balls seldom exceed the default.

    Returns
    -------
    Labelled
        ``destination``, the number of a ``motion`` for each start; and the kind, the periods,
        the impacts and the ``share`` of each motion, with the standard error of the share.

    Raises
    ------
    ModelError
        If a parameter is missing, out of range or contradicts another, or if there are more
        balls than fit into memory.

    Examples
    --------
    >>> found = basins(1.2, restitution=0.5, starts=20)
    >>> set(found.motion_kind.values.tolist()) == {"orbit", "locked"}, float(found.share.sum())
    (True, 1.0)
    """
    check(basins, locals())
    if np.ndim(amplitude):
        raise ParameterError("{amplitude} must be a single Λ")
    of, grid = _single(impact)
    return grid.unfold(labelled.basins(of, float(amplitude), starts, velocity_max, impacts))


def _single(impact: Mapping[str, Any]) -> tuple[ImpactModel, Grid]:
    """The model, and the grid that makes its parameters attributes of the results.

    Each parameter must be a single number.
    """
    grid = Grid(**impact)
    for name in grid.coords:
        raise ParameterError(f"{{{name}}} must be a single number here")
    return impact_model(impact, None), grid
