"""The periodic orbit on which a simulated ball ends."""

from typing import Annotated

import numpy as np

from bouncing_ball_beyond.inherited.datasets.arguments import (
    AMPLITUDE_OF_ORBIT,
    START,
    AmplitudeOfOrbit,
    checked_number,
)
from bouncing_ball_beyond.inherited.errors import NoOrbitError, ParameterError, suggesting
from bouncing_ball_beyond.inherited.models.flight import table
from bouncing_ball_beyond.models.ball import Ball
from bouncing_ball_beyond.models.docstrings import as_in
from bouncing_ball_beyond.models.model import Model
from bouncing_ball_beyond.motions.destination import (
    FOLLOWED,
    IMPACTS,
    FollowedImpacts,
    final_motions,
)
from bouncing_ball_beyond.motions.motion_of import motion_of
from bouncing_ball_beyond.motions.over_time import VELOCITY, first_impacts
from bouncing_ball_beyond.periodic.branches.following import point_near
from bouncing_ball_beyond.periodic.orbits.balls import LAMBDA, Balls
from bouncing_ball_beyond.periodic.orbits.orbit import Orbit, orbit_of_point
from bouncing_ball_beyond.periodic.orbits.simulation import simulated


@suggesting
@as_in(motion_of)
def orbit_of_motion(
    ball: Ball,
    *,
    amplitude: AmplitudeOfOrbit,
    phase: Annotated[float, START] = 0.0,
    velocity: Annotated[float, START] = VELOCITY,
    relative_velocity: Annotated[float, START] | None = None,
    impacts: FollowedImpacts = IMPACTS,
) -> Orbit:
    """The periodic orbit on which a ball ends, as a start for :func:`follow`.

    A ball that is given by r and D of a free impact has the law with these at the speed of the
    first impact.

    Parameters
    ----------
    ball : Ball
        A single ball.
    amplitude : float
        Excitation amplitude Λ > 0.
    phase, velocity, relative_velocity : float
        Those of the first impact, as in :func:`bouncing_ball_beyond.motion_of`.

    Returns
    -------
    Orbit

    Raises
    ------
    NoOrbitError
        If the motion does not repeat, or the ball stays on the table; the message gives the reason.
    ModelError
        If a parameter is missing, of a wrong type or shape, or out of range.

    Examples
    --------
    >>> from bouncing_ball_beyond import rigid
    >>> orbit_of_motion(rigid(restitution=0.5), amplitude=1.6)
    Orbit
      impacts               2
      periods               2
      restitution           0.5
      amplitude             1.6
      phase                 [0.403915 1.19435]
      contact_duration      [0 0]
      impact_velocity       [-2.90279 -3.41535]
      bounce_velocity       [3.65826 2.58997]
      apparent_restitution  [0.5 0.5]
      max_height            7.32028
    """
    lam = checked_number("amplitude", amplitude, AMPLITUDE_OF_ORBIT)
    phi = checked_number("phase", phase, START)
    for name, value in (("velocity", velocity), ("relative_velocity", relative_velocity)):
        if value is not None:
            checked_number(name, value, START)
    most = checked_number("impacts", impacts, FOLLOWED)
    grid, first = first_impacts(ball, lam, phi, velocity, relative_velocity)
    if grid.shape:
        name = next(iter(grid.coords))
        raise ParameterError(f"{{{name}}} must be a single number here")
    return of_motion(first.model(ball, grid), lam, phi, float(first.velocity[0]), most)


def of_motion(
    model: Model, amplitude: float, phase: float, velocity: float, impacts: int = IMPACTS
) -> Orbit:
    """The orbit on which a simulated ball ends.

    Parameters
    ----------
    model : Model
        A single model.
    amplitude : float
        Λ.
    phase, velocity : float
        The phase φ of the first impact and the absolute velocity z′ before it.
    impacts : int
        Number of impacts after which the search for a repetition ends.

    Raises
    ------
    NoOrbitError
        If the motion does not repeat, or the ball stays on the table.

    Examples
    --------
    >>> from bouncing_ball_beyond.models.rigid import RestitutionModel
    >>> found = of_motion(RestitutionModel(0.5), 1.6, 0.0, -np.pi)
    >>> found.impacts, found.periods
    (2, 2)
    """
    motion = final_motions(model, amplitude, phase, velocity, impacts=impacts)
    count = int(motion.impacts)
    if not count:
        raise NoOrbitError(
            f"the motion ends on no orbit that could be followed: it is {motion.kind}"
            + (f", because {motion.reason}" if str(motion.reason) else "")
        )
    balls = Balls(model, amplitude)
    return of_impact(balls, float(motion.end_phase), float(motion.end_velocity), count)


def of_impact(balls: Balls, phase: float, velocity: float, impacts: int) -> Orbit:
    """The orbit with k impacts near the impact of a simulation with φ and z′.

    Raises
    ------
    NoOrbitError
        If there is no such orbit.
    """
    dynamics = balls.dynamics()
    relative = velocity - float(table(np.asarray(phase), dynamics.amplitude)[0])
    row, (start, before), _ = dynamics.in_a_row([phase], [relative])
    theta, closing = row.section().state(row.start(start, before))
    problem, guess = simulated(balls, float(theta[0]), float(closing[0]), impacts, (LAMBDA,))
    return orbit_of_point(problem, point_near(problem, guess))
