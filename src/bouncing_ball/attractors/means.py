"""Means over time of balls: their flights, height, received power and the growth of deviations.

The work W of the table on a ball (:mod:`bouncing_ball.motion.work`) is none in a flight, and in the
mean over a long time it is what the contacts dissipate. At an instantaneous impact W is the impulse
times w′, and while a ball rests on the table it is the integral of (1 - w) w′.
"""

from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from bouncing_ball.attractors.motions import Motions
from bouncing_ball.motion.angles import table
from bouncing_ball.motion.contact import LinearContactDynamics
from bouncing_ball.motion.dynamics import Departure, Dynamics, Impact
from bouncing_ball.motion.ensembles import pick
from bouncing_ball.motion.sequence import Status
from bouncing_ball.motion.simulation import Law, first_impacts
from bouncing_ball.motion.work import change, over_contact


def means(law: Law, amplitude: ArrayLike, found: Motions, samples: int) -> np.ndarray:
    """Means over the motions on which balls end: over a period, or over so many impacts.

    Returns
    -------
    array
        Of each ball the flights per table period 2π, infinite in the restitution model if it
        sticks; the mean of its height z; the power that the table transfers; and the growth of a
        deviation's logarithm per table period, of a new deviation after each impact that none
        survives. Shape (4, ...); NaN for a ball that stays on the table.

    Examples
    --------
    The 1-T orbit dissipates ½(1 - r²)v² with (1 + r) v = 2π a period:

    >>> from bouncing_ball.attractors.mapper import label
    >>> flights, _, power, _ = means(0.5, 1.2, label(0.5, 1.2, 1.0, -3.0), 100)
    >>> float(flights.round(6)), bool(np.isclose(power, np.pi / 3))
    (1.0, True)
    """
    lam, phase, velocity = np.broadcast_arrays(amplitude, found.end_phase, found.end_velocity)
    falls = np.isfinite(phase)
    # A ball that stays on the table is not followed.
    state = np.where(falls, [phase, velocity], [0 * lam, lam])
    dynamics, start, relative, shape = first_impacts(law, lam, *state)
    left = np.where(found.impacts > 0, found.impacts, samples).ravel() * falls.ravel()
    total = np.full((5, left.size), np.nan)
    _add_up(dynamics, dynamics.start(start, relative), left, total)
    time, flights, height, work, growth = total.reshape(5, *shape)
    turns = time / (2 * np.pi)
    return np.stack([flights / turns, height / time, work / time, growth / turns])


def _add_up(dynamics: Dynamics, impact: Impact, left: np.ndarray, total: np.ndarray) -> None:
    """Sums of times, flights, heights, works and logarithms over as many impacts as are left."""
    ball = np.arange(left.size)
    along, across, done = np.ones(left.size), np.zeros(left.size), 0
    total[:, left > 0] = 0.0
    while True:
        departure = dynamics.depart(impact)
        total[:, ball[departure.status != Status.BOUNCING]] = np.nan
        going = np.flatnonzero((left[ball] > done) & (departure.status == Status.BOUNCING))
        if going.size < ball.size:
            rows = (dynamics.take(going), *(pick(x, going) for x in (impact, departure)))
            dynamics, impact, departure = rows
            ball, along, across = (x[going] for x in (ball, along, across))
        if not ball.size:
            return
        after, passed = dynamics.fly(departure)
        change = dynamics.jacobian(impact, departure, after, passed)
        along, across = change.apply(along, across)
        length = np.hypot(along, across)
        # After a ball of a simple model has stuck no deviation is left.
        along, length = np.where(length > 0, along, 1.0), np.where(length > 0, length, 1.0)
        along, across = along / length, across / length
        flights = np.where(departure.settling > 0, np.inf, 1.0)
        of = _contact if isinstance(dynamics, LinearContactDynamics) else _instant
        height, work, flight, low, thrown = of(dynamics, impact, departure, after, passed)
        height = height + (low + (thrown / 2 - flight / 6) * flight) * flight
        total[:, ball] += np.stack([passed, flights + 0 * passed, height, work, np.log(length)])
        impact, done = after, done + 1


def _contact(dynamics: Dynamics, impact: Impact, departure: Departure, after: Any, passed: Any):
    """Integral of z and work over spring-damper contacts; time, first z and z′ of the flights."""
    lam, flight, time = dynamics.amplitude, departure.flight, departure.duration
    depth, rate = (
        np.array([a, b])
        for a, b in zip(impact[1:3], (flight.displacement, flight.velocity), strict=True)
    )
    x, y = np.array([table(impact.phase, lam), (flight.x, flight.y)]).swapaxes(0, 1)
    height, moved = over_contact(dynamics.law, lam, time, (x, y), depth, rate)
    return (
        height,
        change((rate + x) * x + y) + moved,
        passed - time,
        depth[1] + y[1],
        rate[1] + x[1],
    )


def _instant(dynamics: Dynamics, impact: Impact, departure: Departure, after: Any, passed: Any):
    """The same at instantaneous impacts and while balls rest, from one instant to the next."""
    lam, sticks = dynamics.amplitude, dynamics.sticks(impact, departure)
    hit = impact.known
    if hit is None:
        x, y = table(impact.phase, lam)
        low, thrown, arrival = y, departure.flight.velocity + x, impact.velocity + x
        begin = end = 0.0
    else:
        x, y = table(hit.phase, lam)
        low, thrown, arrival = hit.height, hit.velocity, hit.arrival
        begin, end = hit.instant.delay, after.known.instant.delay
    x1, y1 = departure.flight.x, departure.flight.y
    thrown, low = np.where(sticks, x1, thrown), np.where(sticks, y1, low)
    rest = np.where(sticks, departure.duration - begin, 0.0)
    work = (np.where(sticks, x, thrown) - arrival) * x
    work = work + np.where(sticks, y1 - y - (y1 * y1 - y * y) / 2, 0.0)
    height = np.where(sticks, x - x1, 0.0)
    return height, work, passed - begin + end - rest, low, thrown
