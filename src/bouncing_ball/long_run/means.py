"""Means over the motions of balls: flights, height, received power, growth of deviations.

The means of height and power follow from integrals over contacts and flights. The work of the table
w = Λ sin τ on a ball is, per unit of mass, ::

    ∫ (z″ + 1) w′ dτ = [z′ w′ + w] + ∫ z′ w dτ

because w″ = -w. The law of the contact gives the integrals over contacts. The table does no work in
a flight. At an instantaneous impact its work is the impulse times w′, and while a ball rests on the
table it is the integral of (1 - w) w′. Over a long time the mean work equals the mean dissipation
of the contacts.
"""

from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from bouncing_ball.long_run.motions import Motions
from bouncing_ball.models.contacts_and_flights import Departure, Impact
from bouncing_ball.models.dynamics import Dynamics, HasDynamics, Leg
from bouncing_ball.models.flight import table
from bouncing_ball.models.linear_flow import change_in_contact
from bouncing_ball.models.sequence import Status


def over_steps(
    law: Any,
    amplitude: Any,
    duration: Any,
    phase: np.ndarray,
    gap: np.ndarray,
    rate: np.ndarray,
    flown: Any,
) -> tuple[np.ndarray, np.ndarray]:
    """The integral ∫ z dτ and the work of the table, over contacts and the flights after them.

    Parameters
    ----------
    law : ContactLaw or None
        None if impacts are instantaneous; a contact with a duration is then a rest on the table.
    amplitude, duration : array_like
        Λ and the duration D of the contacts.
    phase, gap, rate : array, shape (2, ...)
        φ, δ and δ′ at the start and at the end of the contacts.
    flown : array_like
        The duration of the flights.

    Examples
    --------
    A ball that leaves a table at rest with z′ = 3 flies for 6, and its mean height is 3:

    >>> phase, gap, rate = np.zeros((2, 1)), np.zeros((2, 1)), np.array([[-3.0], [3.0]])
    >>> [float(x[0]) for x in over_steps(None, 0.0, 0.0, phase, gap, rate, 6.0)]
    [18.0, 0.0]
    """
    w_rate, w = table(phase, amplitude)
    if law is None:
        held = -change_in_contact(w_rate)
        moved = change_in_contact(w * w) / 2
    else:
        held, moved = law.over_contact(amplitude, duration, phase, gap, rate)
    release_height = gap[1] + w[1]
    velocity = rate + w_rate
    height = held + (release_height + (velocity[1] / 2 - flown / 6) * flown) * flown
    work = change_in_contact(velocity * w_rate + w) + moved
    return height, work


def means(model: HasDynamics, amplitude: ArrayLike, found: Motions, samples: int) -> np.ndarray:
    """Means over the motions on which balls end: over one period, or over ``samples`` impacts if
    the motion does not repeat.

    Returns
    -------
    array
        Shape (4, ...); NaN for a ball that stays on the table. For each ball, the entries are the
        flights per table period 2π, infinite in the restitution model if the ball sticks; the mean
        of the height z; the power that the table transfers; and the growth per table period of the
        logarithm of a deviation. If an impact reduces the deviation to zero, a new deviation takes
        its place.

    Examples
    --------
    In each period the 1-T orbit dissipates ½(1 - r²)v², where (1 + r) v = 2π:

    >>> from bouncing_ball.long_run.destination import final_motions
    >>> from bouncing_ball.models.rigid import RestitutionModel
    >>> model = RestitutionModel(0.5)
    >>> flights, _, power, _ = means(model, 1.2, final_motions(model, 1.2, 1.0, -3.0), 100)
    >>> float(flights.round(6)), bool(np.isclose(power, np.pi / 3))
    (1.0, True)
    """
    lam, phase, velocity = np.broadcast_arrays(amplitude, found.end_phase, found.end_velocity)
    # A ball that stays on the table has no impacts; its state here is that of a ball at rest.
    falls = np.isfinite(phase)
    phase = np.where(falls, phase, 0 * lam)
    velocity = np.where(falls, velocity, lam)
    dynamics, start, relative, shape = model.dynamics(lam).first_impacts(phase, velocity)
    impacts = np.where(found.impacts > 0, found.impacts, samples).ravel() * falls.ravel()
    total = np.full((5, impacts.size), np.nan)
    _add_up(dynamics, dynamics.start(start, relative), impacts, total)
    time, flights, height, work, growth = total.reshape(5, *shape)
    turns = time / (2 * np.pi)
    return np.stack([flights / turns, height / time, work / time, growth / turns])


def _add_up(dynamics: Dynamics, impact: Impact, impacts: np.ndarray, total: np.ndarray) -> None:
    """Add up times, flights, heights, works and logarithms in ``total``, shape (5, balls).

    ``impacts`` are the numbers of impacts over which they are added up.
    """
    ball = np.arange(impacts.size)
    along = np.ones(impacts.size)
    across = np.zeros(impacts.size)
    total[:, impacts > 0] = 0.0
    for done, leg in enumerate(dynamics.legs(impact, differentiate=True)):
        bounces = leg.departure.status == Status.BOUNCING
        total[:, ball[~bounces]] = np.nan
        going = np.flatnonzero((impacts[ball] > done) & bounces)
        if going.size < ball.size:
            ball, along, across = leg.keep(going, ball, along, across)
        if not ball.size:
            return
        along, across, growth = _grown(*leg.jacobian().apply(along, across))
        flights = np.where(leg.departure.settling > 0, np.inf, 1.0)
        passed, height, work = over_leg(leg)
        total[:, ball] += np.stack([passed, flights + 0 * passed, height, work, growth])


def _grown(along: np.ndarray, across: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Deviations normalised to length 1, and the logarithms of their lengths."""
    # A long contact may leave 1e-170 of a deviation, of which the square would be zero.
    length = np.hypot(along, across)
    # After a ball of a simple model has stuck, the deviation is zero.
    along = np.where(length > 0, along, 1.0)
    length = np.where(length > 0, length, 1.0)
    return along / length, across / length, np.log(length)


def over_leg(leg: Leg) -> np.ndarray:
    """Time, ∫ z dτ and work from one impact to the next, shape (3, balls); the latter two from one
    instant to the next in the corrected model.
    """
    after, passed = leg.fly()
    lam = leg.dynamics.amplitude
    impact = leg.impact
    departure = leg.departure
    if impact.known is not None:
        integrals = _over_instants(lam, impact.known, departure, after.known, passed)
        return np.array([passed, *integrals])
    flight = departure.flight
    integrals = over_steps(
        leg.dynamics.contact,
        lam,
        departure.duration,
        phase=np.array([impact.phase, departure.phase]),
        gap=np.array([impact.displacement, flight.displacement]),
        rate=np.array([impact.velocity, flight.velocity]),
        flown=passed - departure.duration,
    )
    return np.array([passed, *integrals])


def _over_instants(
    lam: np.ndarray, hit: Any, departure: Departure, next_hit: Any, passed: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """∫ z dτ and the work from one instant of the corrected model to the next.

    A ball that sticks rests on the table after the instant. ``passed`` is the time between the
    starts of the two contacts.
    """
    x, y = table(hit.phase, lam)
    displacement = hit.height - y
    sticks = departure.sticks
    flight = departure.flight
    delay = hit.instant.delay
    duration = np.where(sticks, departure.duration - delay, 0.0)
    between = passed - delay + next_hit.instant.delay
    end_phase = np.where(sticks, departure.phase, hit.phase)
    end_displacement = np.where(sticks, flight.displacement, displacement)
    end_velocity = np.where(sticks, flight.velocity, hit.velocity - x)
    return over_steps(
        None,
        lam,
        duration,
        phase=np.array([hit.phase, end_phase]),
        gap=np.array([displacement, end_displacement]),
        rate=np.array([hit.arrival - x, end_velocity]),
        flown=between - duration,
    )
