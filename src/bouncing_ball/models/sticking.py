"""Rest on the table, and the lift-off that ends it (Eq. 9).

A ball rests on the table while the load g = 1 - Λ sin τ is positive. It leaves when Λ sin τ rises
through 1, because the table's downward acceleration then exceeds gravity. If g ≤ 0 already, it
leaves at once. For Λ ≤ Λ_CR = 1 it never leaves: this is permanent contact (Eq. 9).
"""

import numpy as np

from bouncing_ball.models.contacts_and_flights import Departure
from bouncing_ball.models.sequence import Status
from bouncing_ball.models.setting import PAPER, Setting
from bouncing_ball.numerics.arrays import pick


def pressed(x: np.ndarray, y: np.ndarray) -> np.ndarray:
    """Whether a ball at rest stays on the table at the phase with Λ cos τ = x and Λ sin τ = y.

    Examples
    --------
    >>> pressed(np.zeros(2), np.array([0.5, 1.5])).tolist()
    [True, False]
    """
    return (y < 1) | ((y == 1) & (x <= 0))


def stay(
    departure: Departure, rests: np.ndarray, amplitude: np.ndarray, setting: Setting = PAPER
) -> Departure:
    """The departures after the balls marked by ``rests`` have rested on the table.

    These balls rest on the table from the phase of the given departure on until they lift off.
    """
    if not rests.any():
        return departure
    x, y = setting.level(departure.phase, amplitude)
    held = pressed(*setting.at_rest(departure.phase, (x, y), amplitude))
    lift = setting.lift_off(departure.phase, amplitude)
    forever = rests & lift.never
    velocity, top = setting.lifted_level(lift, amplitude)
    rest = np.where(forever, np.inf, np.where(held, lift.wait, 0.0))
    none = np.where(forever, np.nan, 0.0)
    before = departure.flight
    phase = np.where(rests & held, lift.phase, departure.phase)
    # The table's state where the ball leaves; that of a ball that stays for ever is not used.
    level = (
        np.where(rests, np.where(held, velocity, x), before.x),
        np.where(rests, np.where(held, top, y), before.y),
    )
    displacement = np.where(rests, none, before.displacement)
    flight = setting.flight(
        displacement, np.where(rests, none, before.velocity), phase, level, amplitude
    )
    return departure._replace(
        phase=phase,
        duration=departure.duration + np.where(rests, rest, 0.0),
        flight=flight,
        status=np.where(forever, Status.PERMANENT_CONTACT, Status.BOUNCING),
    )


def lifted(departure: Departure, amplitude: np.ndarray, setting: Setting = PAPER) -> Departure:
    """The departures with those marked as sticking that leave by lift-off, a state that does not
    depend on their earlier motion.
    """
    at_rest = (departure.flight.velocity == 0) & (departure.flight.displacement == 0)
    (balls,) = at_rest.nonzero()
    sticks = at_rest
    if not balls.size:
        return departure._replace(sticks=sticks)
    there = departure.phase[balls]
    sticks[balls] = setting.take(balls).lifts_at(there, pick(amplitude, balls))
    return departure._replace(sticks=sticks)
