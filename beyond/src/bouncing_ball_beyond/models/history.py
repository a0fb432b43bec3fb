"""The motion of one ball at arbitrary times, from its sequence of impacts."""

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from bouncing_ball_beyond.inherited.models.flight import table
from bouncing_ball_beyond.inherited.models.model import Status
from bouncing_ball_beyond.models.contact import ContactSpan
from bouncing_ball_beyond.models.flight import Flight
from bouncing_ball_beyond.models.sequence import ImpactSequence


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


def motion_at(sequence: ImpactSequence, time: ArrayLike) -> History:
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
    >>> from bouncing_ball_beyond.models.restitution import RestitutionDynamics
    >>> sequence = RestitutionDynamics.of(1.0, 0.0).simulate(0.0, -2.0, 2)
    >>> motion_at(sequence, [0.0, 2.0, 4.0]).height.tolist()
    [0.0, 2.0, 0.0]
    """
    if np.ndim(sequence.status):
        raise ValueError("the sequence has several balls: name one, as in sequence[0]")
    t = np.asarray(time, dtype=float)
    lam = sequence.amplitude
    last = int(sequence.impacts) - 1
    row = np.clip(np.searchsorted(sequence.time[: last + 1], t, side="right") - 1, 0, None)
    since = t - sequence.time[row]
    duration = sequence.contact_duration[row]
    touching = (since >= 0) & (since <= duration)
    # The end of the last flight is not known.
    flying = (since > duration) & ((row < last) | (sequence.status != Status.BOUNCING))
    left = sequence.phase[row] + np.where(flying, duration, 0.0)
    displacement = sequence.release_displacement[row]
    velocity = sequence.relative_bounce_velocity[row]
    flight = Flight(displacement, velocity, *table(left, lam), lam)
    gap, speed, _, _ = flight.gap(np.where(flying, since - duration, 0.0))
    gap = np.where(flying, gap, np.nan)
    speed = np.where(flying, speed, np.nan)
    gap[touching], speed[touching] = _in_contact(sequence, row[touching], since[touching])
    w_rate, w = table(sequence.phase[row] + since, lam)
    return History(
        time=t, height=gap + w, velocity=speed + w_rate, table=w, gap=gap, touching=touching
    )


def _in_contact(
    sequence: ImpactSequence, row: np.ndarray, since: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """δ and δ′ at times since the starts of contacts; 0 while a ball rests on the table."""
    if sequence.contact is None or not row.size:
        return np.zeros_like(since), np.zeros_like(since)
    span = ContactSpan(
        displacement=sequence.displacement[row],
        velocity=sequence.relative_velocity[row],
        phase=sequence.phase[row],
        amplitude=sequence.amplitude * np.ones_like(since),
        duration=sequence.contact_duration[row],
        release_displacement=sequence.release_displacement[row],
        release_velocity=sequence.relative_bounce_velocity[row],
    )
    return sequence.contact.during(span, since)
