"""The end of a branch at an orbit whose ball no longer leaves the table as a contact ends.

A contact ends where δ + κ δ′ rises through 0. Along a branch the rate of this rise may fall to 0:
then the contact touches its release without opening, and beyond this orbit it lasts longer. The
duration of the contact is no smooth function of the state there, so that a continuation approaches
this end with ever shorter steps and never arrives.

With the durations as unknowns and the release function itself as their equation, all equations are
smooth::

    δ(T_i) = 0,    δ′(T_i) = v_{i+1},    (δ + κ δ′)(D_i) = 0,    δ′(D_j) + κ δ″(D_j) = 0

T_i are the times of the impacts and j is the contact that is lost. At a release the force of the
contact is zero, and δ″ is that of a free flight. Newton's method solves these equations to the
accuracy of rounding.
"""

from dataclasses import dataclass
from typing import Any

import numpy as np

from bouncing_ball_beyond.inherited.models.flight import table
from bouncing_ball_beyond.inherited.numerics.corrector import checked
from bouncing_ball_beyond.models.dynamics import Dynamics
from bouncing_ball_beyond.models.flight import Flight
from bouncing_ball_beyond.periodic.orbits.legs import Legs
from bouncing_ball_beyond.periodic.orbits.problem import OrbitEquations
from bouncing_ball_beyond.periodic.orbits.short_steps import solve_short
from bouncing_ball_beyond.periodic.orbits.steps import PATIENT

# The Jacobian is a central difference; its error only affects the number of steps.
_DIFFERENCE = 6e-6
# An end that is farther from the last point of a branch is that of another branch. The steps become
# too short at the square of this distance, where the duration varies as the root.
_NEAR = 0.1


def _lag(dynamics: Dynamics) -> Any:
    """κ, and 0 for an instant and for a contact whose release is no line δ + κ δ′ = 0."""
    lag = None if dynamics.contact is None else dynamics.contact.lag
    return 0.0 if lag is None else lag


def rise_of_release(legs: Legs) -> np.ndarray:
    """δ′ + κ δ″ at the ends of all contacts in a row, where δ″ is that of a free flight."""
    flight = legs.departure.flight
    return flight.velocity + _lag(legs.dynamics) * (flight.y - 1)


@dataclass(frozen=True)
class _LostRelease:
    """The equations above for the unknowns of :class:`.OrbitEquations`, with one parameter."""

    equations: OrbitEquations
    contact: int

    def residual(self, y: np.ndarray) -> np.ndarray:
        """Their left sides less their right sides, shape (..., N + 1)."""
        equations = self.equations
        # The durations are unknowns of linear contacts only, whose motion goes on beyond its end.
        dynamics: Any = equations.dynamics(y)[0]
        shape = (*y.shape[:-1], equations.impacts)
        if dynamics is None:
            return np.full((*y.shape[:-1], y.shape[-1]), np.nan)
        impact = equations.impact(dynamics, y)
        duration = equations.durations(y).ravel()
        departure = dynamics.depart(impact, near=duration)
        displacement, velocity = dynamics.within(impact, departure, duration)
        lam = dynamics.amplitude
        flight = Flight(displacement, velocity, *table(impact.phase + duration, lam), lam)
        gap, rate, _, _ = flight.gap(equations.intervals(y).ravel() - duration)
        _, closing = equations.states(y)
        lag = np.broadcast_to(_lag(dynamics), duration.shape)
        release = (displacement + lag * velocity).reshape(shape)
        rise = (velocity + lag * (flight.y - 1)).reshape(shape)
        faster = rate.reshape(shape) - np.roll(closing, -1, axis=-1)
        lost = rise[..., [self.contact]]
        return np.concatenate([gap.reshape(shape), faster, release, lost], axis=-1)

    def equations_at(self, y: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """The residual and its square Jacobian."""
        step = _DIFFERENCE * np.eye(y.shape[-1])
        beside = self.residual(np.concatenate([y + step, y - step]))
        size = y.shape[-1]
        return self.residual(y), (beside[:size] - beside[size:]).T / (2 * _DIFFERENCE)


def lost_release(equations: OrbitEquations, y: np.ndarray) -> np.ndarray | None:
    """The orbit near a point of a branch at which the ball no longer leaves the table, as a point
    y; None if there is none near, or if the durations of the contacts are no unknowns.
    """
    if not equations.selects or equations.resuming.any():
        return None
    legs = equations.legs(y)
    if legs.departure is None or legs.dynamics.contact is None:
        return None
    slowest = int(np.argmin(rise_of_release(legs)))
    with np.errstate(all="ignore"):
        lost = _LostRelease(equations, slowest)
        found = checked(solve_short(lost.equations_at, y, PATIENT), lost.residual)
    near = bool(found.converged) and np.linalg.norm(found.point - y) < _NEAR
    return found.point if near else None
