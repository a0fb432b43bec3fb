"""Rest on the table, and the lift-off that ends it (Eq. 9).

A ball rests on the table while the load g = 1 - Λ sin τ is positive. It leaves when Λ sin τ rises
through 1, because the table's downward acceleration then exceeds gravity. If g ≤ 0 already, it
leaves at once. For Λ ≤ Λ_CR = 1 it never leaves: this is permanent contact (Eq. 9).
"""

from typing import NamedTuple

import numpy as np

from bouncing_ball_beyond.inherited.models.flight import table
from bouncing_ball_beyond.inherited.models.model import Status
from bouncing_ball_beyond.inherited.models.restitution import lift_off_phase
from bouncing_ball_beyond.inherited.numerics.arrays import pick
from bouncing_ball_beyond.inherited.numerics.elementary import reduce_angle
from bouncing_ball_beyond.models.contacts_and_flights import Departure
from bouncing_ball_beyond.models.flight import Flight

_TURN = 2 * np.pi


class LiftOff(NamedTuple):
    """The next lift-offs of balls that rest on the table.

    ``never`` marks the balls that stay for ever. The others leave after the time ``wait``, at the
    table's ``phase``.
    """

    never: np.ndarray
    wait: np.ndarray
    phase: np.ndarray


def lift_off_velocity(amplitude: np.ndarray) -> np.ndarray:
    """The velocity √(Λ² - 1) of the table at lift-off, for Λ ≥ 1."""
    return np.sqrt((amplitude - 1) * (amplitude + 1))


def lift_off(phase: np.ndarray, amplitude: np.ndarray) -> LiftOff:
    """The next lift-offs of balls that rest on the table from a phase on.

    Examples
    --------
    >>> found = lift_off(np.array([0.0, 0.0]), np.array([1.0, 2.0]))
    >>> found.never.tolist(), bool(np.isclose(found.wait[1], np.pi / 6))
    ([True, False], True)
    """
    lift = lift_off_phase(np.maximum(amplitude, 1.0))
    wait = np.mod(reduce_angle(lift - phase), _TURN)
    # Rounding must not postpone a lift-off at the present phase by a full turn.
    wait = np.where(wait > _TURN - 1e-9, 0.0, wait)
    return LiftOff(amplitude <= 1, wait, lift)


def pressed(x: np.ndarray, y: np.ndarray) -> np.ndarray:
    """Whether a ball at rest stays on the table at the phase with Λ cos τ = x and Λ sin τ = y.

    Examples
    --------
    >>> pressed(np.zeros(2), np.array([0.5, 1.5])).tolist()
    [True, False]
    """
    return (y < 1) | ((y == 1) & (x <= 0))


def stay(departure: Departure, rests: np.ndarray, amplitude: np.ndarray) -> Departure:
    """The departures after the balls marked by ``rests`` have rested on the table.

    These balls rest on the table from the phase of the given departure on until they lift off.
    """
    if not rests.any():
        return departure
    x, y = table(departure.phase, amplitude)
    held = pressed(x, y)
    lift = lift_off(departure.phase, amplitude)
    forever = rests & lift.never
    velocity = lift_off_velocity(np.maximum(amplitude, 1.0))
    rest = np.where(forever, np.inf, np.where(held, lift.wait, 0.0))
    none = np.where(forever, np.nan, 0.0)
    before = departure.flight
    phase = np.where(rests & held, lift.phase, departure.phase)
    # The table's state where the ball leaves; that of a ball that stays for ever is not used.
    flight = Flight(
        displacement=np.where(rests, none, before.displacement),
        velocity=np.where(rests, none, before.velocity),
        x=np.where(rests, np.where(held, velocity, x), before.x),
        # At lift-off Λ sin τ = 1 exactly.
        y=np.where(rests, np.where(held, 1.0, y), before.y),
        amplitude=amplitude,
    )
    return departure._replace(
        phase=phase,
        duration=departure.duration + np.where(rests, rest, 0.0),
        flight=flight,
        status=np.where(forever, Status.PERMANENT_CONTACT, Status.BOUNCING),
    )


def lifted(departure: Departure, amplitude: np.ndarray) -> Departure:
    """The departures with those marked as sticking that leave by lift-off, a state that does not
    depend on their earlier motion.
    """
    at_rest = (departure.flight.velocity == 0) & (departure.flight.displacement == 0)
    (balls,) = at_rest.nonzero()
    sticks = at_rest
    if not balls.size:
        return departure._replace(sticks=sticks)
    lam = np.asarray(pick(amplitude, balls), dtype=float)
    lift = lift_off_phase(np.maximum(lam, 1.0))
    sticks[balls] = departure.phase[balls] == np.where(lam > 1, lift, np.nan)
    return departure._replace(sticks=sticks)
