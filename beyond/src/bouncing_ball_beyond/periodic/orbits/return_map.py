"""The return map next to a periodic orbit, with its derivative.

The equations of :mod:`~bouncing_ball_beyond.periodic.orbits.problem` are solved by orbits alone.
Here the map is evaluated at states beside the first impact of an orbit: each flight lands near the
time at which the orbit lands, and each contact ends near the time at which that of the orbit does,
so that the map is the smooth continuation of that of the orbit.
"""

from typing import NamedTuple

import numpy as np

from bouncing_ball_beyond.inherited.numerics.elementary import reduce_angle
from bouncing_ball_beyond.periodic.orbits.balls import Balls
from bouncing_ball_beyond.periodic.orbits.legs import arrived, lag_of, landed
from bouncing_ball_beyond.periodic.orbits.problem import OrbitEquations

# Newton's method for a landing doubles its digits in each round.
_ROUNDS = 12
_SETTLED = 4e-16
# The largest last step relative to the time, of which the square is a rounding error.
_SMALL = 1e-8


class Returned(NamedTuple):
    """Images of states under the return map: their distances from the first impact of the orbit,
    shape (states, 2), and the derivatives of the map, shape (states, 2, 2).
    """

    distance: np.ndarray
    derivative: np.ndarray


def returned(
    equations: OrbitEquations, y: np.ndarray, aside: np.ndarray, balls: Balls | None = None
) -> Returned:
    """The images of states at distances ``aside`` (dφ, dδ′) from the first impact of an orbit.

    Parameters
    ----------
    equations : OrbitEquations
        The equations of one orbit.
    y : ndarray, shape (N + parameters,)
        The orbit.
    aside : ndarray, shape (states, 2)
    balls : Balls, optional
        Other balls than those of the orbit, one for each state.

    Returns
    -------
    Returned
        NaN for states that do not return.
    """
    one = equations.at(y)
    dynamics = one.dynamics() if balls is None else balls.dynamics()
    phases, velocities = equations.states(y)
    lasts = equations.legs(y).duration
    interval = equations.intervals(y)
    turned = aside[:, 0]
    velocity = velocities[0] + aside[:, 1]
    derivative = np.broadcast_to(np.eye(2), (len(aside), 2, 2))
    k = equations.impacts
    whole = np.ones(len(aside), dtype=bool)
    with np.errstate(all="ignore"):
        for i in range(k):
            after = (i + 1) % k
            lag = lag_of(dynamics, whole & equations.resuming[i])
            ahead = dynamics.section(lag_of(dynamics, whole & equations.resuming[after]))
            impact = dynamics.section(lag).impact(reduce_angle(phases[i] + turned), velocity)
            departure = dynamics.depart(impact, near=np.full(len(aside), lasts[i]))
            due = interval[i] - turned
            for _ in range(_ROUNDS):
                landing = landed(ahead, impact, departure, departure.duration, due)
                due = due + landing.late
                if not np.any(np.abs(landing.late) > _SETTLED * np.abs(due)):
                    break
            lands = np.abs(landing.late) <= _SMALL * np.abs(due)
            time = np.where(lands, landing.time + landing.late, np.nan)
            speed = landing.velocity + landing.late * landing.acceleration
            end, passed = arrived(ahead, departure, time, speed)
            change = dynamics.jacobian(impact, departure, end, passed)
            matrix = np.moveaxis(np.array([[change.a, change.b], [change.c, change.d]]), -1, 0)
            derivative = matrix @ derivative
            phase, velocity = ahead.state(end)
            turned = reduce_angle(phase - phases[after])
    distance = np.stack([turned, velocity - velocities[0]], axis=-1)
    return Returned(distance, derivative)
