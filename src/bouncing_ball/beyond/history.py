"""The motion of one ball at arbitrary times, from its sequence of impacts."""

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from bouncing_ball.beyond.laws.collocation import Start, states
from bouncing_ball.paper.contact.spring_damper import SpringDamper
from bouncing_ball.paper.motion.flight import Flight, table
from bouncing_ball.paper.motion.sequence import ImpactSequence, Status


class History(NamedTuple):
    """Height z and velocity z′ of the ball, height w of the table, and δ = z - w, at each time.

    ``touching`` is true in contact and false in flight. The ball's entries are NaN before the first
    impact, and after the last contact, because the end of the last flight is not known.
    """

    time: np.ndarray
    height: np.ndarray
    velocity: np.ndarray
    table: np.ndarray
    gap: np.ndarray
    touching: np.ndarray


def history(sequence: ImpactSequence, time: ArrayLike) -> History:
    """The motion of a ball at given times since its first impact, of the shape of the times.

    Parameters
    ----------
    sequence : ImpactSequence
        The impacts of one ball, from any model. If there are several balls, ``sequence[3]`` selects
        one of them.
    time : array_like
        Times in any order.

    Raises
    ------
    ValueError
        If the sequence has several balls.

    Examples
    --------
    >>> from bouncing_ball.beyond.simulation import simulate
    >>> history(simulate(1.0, 0.0, 0.0, -2.0, 2), [0.0, 2.0, 4.0]).height.tolist()
    [0.0, 2.0, 0.0]
    """
    if np.ndim(sequence.status):
        raise ValueError("the sequence has several balls: name one, as in sequence[0]")
    t, lam = np.asarray(time, dtype=float), sequence.amplitude
    last = int(sequence.impacts) - 1
    row = np.clip(np.searchsorted(sequence.time[: last + 1], t, side="right") - 1, 0, None)
    since, duration = t - sequence.time[row], sequence.contact_duration[row]
    touching = (since >= 0) & (since <= duration)
    # The end of the last flight is not known.
    flying = (since > duration) & ((row < last) | (sequence.status != Status.BOUNCING))
    left = sequence.phase[row] + np.where(flying, duration, 0.0)
    state = sequence.release_displacement[row], sequence.relative_bounce_velocity[row]
    flight = Flight(*state, *table(left, lam), lam)
    gap, speed, _, _ = flight.gap(np.where(flying, since - duration, 0.0))
    gap, speed = (np.where(flying, x, np.nan) for x in (gap, speed))
    gap[touching], speed[touching] = _in_contact(sequence, row[touching], since[touching])
    w_rate, w = table(sequence.phase[row] + since, lam)
    return History(t, gap + w, speed + w_rate, w, gap, touching)


def _in_contact(sequence: ImpactSequence, row: np.ndarray, since: np.ndarray):
    """δ and δ′ at times since the starts of contacts."""
    law, lam = sequence.contact, sequence.amplitude
    at = sequence.displacement[row], sequence.relative_velocity[row], sequence.phase[row]
    if law is None or not row.size:
        return np.zeros((2, row.size))
    if isinstance(law, SpringDamper):
        return law.flow(since, *at, lam)[:2]
    one = np.ones_like(since)
    start = Start(-at[0], -at[1], at[2], lam * one, one)
    ends = -sequence.release_displacement[row], -sequence.relative_bounce_velocity[row]
    return -np.array(states(law, start, (sequence.contact_duration[row], *ends), since))
