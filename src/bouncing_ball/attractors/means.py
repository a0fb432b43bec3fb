"""Means over time of the flights, height, received power and growth of deviations of balls."""

import numpy as np
from numpy.typing import ArrayLike

from bouncing_ball.attractors.motions import Motions
from bouncing_ball.contacts.elementary import table
from bouncing_ball.motion.dynamics import Departure, Dynamics, Impact
from bouncing_ball.motion.linear_contact import LinearContactDynamics
from bouncing_ball.motion.sequence import Status
from bouncing_ball.motion.simulation import Law, dynamics_of
from bouncing_ball.motion.work import over_steps


def means(law: Law, amplitude: ArrayLike, found: Motions, samples: int) -> np.ndarray:
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

    >>> from bouncing_ball.attractors.mapper import label
    >>> flights, _, power, _ = means(0.5, 1.2, label(0.5, 1.2, 1.0, -3.0), 100)
    >>> float(flights.round(6)), bool(np.isclose(power, np.pi / 3))
    (1.0, True)
    """
    lam, phase, velocity = np.broadcast_arrays(amplitude, found.end_phase, found.end_velocity)
    falls = np.isfinite(phase)
    # A ball that stays on the table is not followed.
    state = np.where(falls, [phase, velocity], [0 * lam, lam])
    dynamics, start, relative, shape = dynamics_of(law, lam).first_impacts(*state)
    left = np.where(found.impacts > 0, found.impacts, samples).ravel() * falls.ravel()
    total = np.full((5, left.size), np.nan)
    _add_up(dynamics, dynamics.start(start, relative), left, total)
    time, flights, height, work, growth = total.reshape(5, *shape)
    turns = time / (2 * np.pi)
    return np.stack([flights / turns, height / time, work / time, growth / turns])


def _add_up(dynamics: Dynamics, impact: Impact, left: np.ndarray, total: np.ndarray) -> None:
    """Add up times, flights, heights, works and logarithms in ``total``, over ``left`` impacts."""
    ball = np.arange(left.size)
    along, across, done = np.ones(left.size), np.zeros(left.size), 0
    total[:, left > 0] = 0.0
    while True:
        departure = dynamics.depart(impact, differentiate=True)
        total[:, ball[departure.status != Status.BOUNCING]] = np.nan
        going = np.flatnonzero((left[ball] > done) & (departure.status == Status.BOUNCING))
        if going.size < ball.size:
            rows = impact, departure, ball, along, across
            dynamics, impact, departure, ball, along, across = dynamics.kept(going, *rows)
        if not ball.size:
            return
        after, passed = dynamics.fly(departure)
        change = dynamics.jacobian(impact, departure, after, passed)
        along, across = change.apply(along, across)
        length = np.hypot(along, across)
        # After a ball of a simple model has stuck, the deviation is zero.
        along, length = np.where(length > 0, along, 1.0), np.where(length > 0, length, 1.0)
        along, across = along / length, across / length
        flights = np.where(departure.settling > 0, np.inf, 1.0)
        height, work = _step(dynamics, impact, departure, after, passed)
        total[:, ball] += np.stack([passed, flights + 0 * passed, height, work, np.log(length)])
        impact, done = after, done + 1


def _step(
    dynamics: Dynamics, impact: Impact, departure: Departure, after: Impact, passed: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """∫ z dτ and the work from one impact to the next, or from one instant to the next in the
    corrected model.
    """
    lam, flight, hit = dynamics.amplitude, departure.flight, impact.known
    start, end = impact[:3], (departure.phase, flight.displacement, flight.velocity)
    duration = departure.duration
    if hit is not None:
        (x, y), sticks = table(hit.phase, lam), departure.sticks
        start, thrown = ((hit.phase, hit.height - y, v - x) for v in (hit.arrival, hit.velocity))
        end = tuple(np.where(sticks, *pair) for pair in zip(end, thrown, strict=True))
        begin, late = hit.instant.delay, after.known.instant.delay
        duration, passed = np.where(sticks, duration - begin, 0.0), passed - begin + late
    law = dynamics.law if isinstance(dynamics, LinearContactDynamics) else None
    phase, gap, rate = map(np.array, zip(start, end, strict=True))
    return over_steps(law, lam, duration, phase, gap, rate, passed - duration)
