"""Dense time histories of one ball, from its sequence of impacts."""

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from bouncing_ball.contacts.collocation import Start, states
from bouncing_ball.contacts.spring_damper import SpringDamper
from bouncing_ball.motion.landing import Flight
from bouncing_ball.motion.sequence import ImpactSequence, Status


class History(NamedTuple):
    """Height z and velocity z′ of the ball, height w of the table, and δ = z - w.

    ``touching`` is true in contact, false in flight. NaN before the first impact and
    after the last contact, whose flight is not known to its end.
    """

    time: np.ndarray
    height: np.ndarray
    velocity: np.ndarray
    table: np.ndarray
    gap: np.ndarray
    touching: np.ndarray


def history(sequence: ImpactSequence, time: ArrayLike, ball: int | tuple[int, ...] = ()) -> History:
    """Where a ball is at given times since its first impact.

    Parameters
    ----------
    sequence : ImpactSequence
        From any model.
    time : array_like
        In any order.
    ball : int or tuple of int
        Which ball, for a sequence of several.

    Examples
    --------
    >>> from bouncing_ball.motion.simulation import simulate
    >>> history(simulate(1.0, 0.0, 0.0, -2.0, 2), [0.0, 2.0, 4.0]).height.tolist()
    [0.0, 2.0, 0.0]
    """
    index: tuple[Any, ...] = (ball,) if isinstance(ball, int) else tuple(ball)
    t = np.asarray(time, dtype=float)
    starts = sequence.time[(slice(None), *index)]
    if starts.ndim != 1:
        raise ValueError("the sequence has several balls: name one")
    starts = starts[np.isfinite(starts)]
    row = np.clip(np.searchsorted(starts, t, side="right") - 1, 0, None)

    def of(table):
        return table[(slice(None), *index)][row]

    lam = float(sequence.amplitude[index])
    since = t - starts[row]
    phase, duration = of(sequence.phase), of(sequence.contact_duration)
    touching = (since >= 0) & (since <= duration)
    gap, speed = _in_contact(sequence, index, touching, row, since)
    # Flights: after a permanent contact there is none.
    flying = ~touching & (since > 0)
    hang = np.where(flying, since - np.where(flying, duration, 0.0), 0.0)
    left = phase + np.where(flying, duration, 0.0)
    flight = Flight(
        of(sequence.release_displacement), of(sequence.relative_release_velocity),
        lam * np.cos(left), lam * np.sin(left), lam,
    )  # fmt: skip
    height, rate, _, _ = flight.gap(hang)
    gap = np.where(touching, gap, np.where(flying, height, np.nan))
    speed = np.where(touching, speed, np.where(flying, rate, np.nan))
    unknown = flying & (row == len(starts) - 1)
    if sequence.status[index] == Status.BOUNCING:
        gap, speed = np.where(unknown, np.nan, gap), np.where(unknown, np.nan, speed)
    w, w_rate = lam * np.sin(phase + since), lam * np.cos(phase + since)
    return History(t, gap + w, speed + w_rate, w, gap, touching)


def _in_contact(sequence: ImpactSequence, index, touching, row, since):
    """δ and δ′ at the times of contact, and 0 else."""
    out = np.zeros((2, *since.shape))
    law: Any = sequence.contact
    if law is None:
        return out
    lam, impact, stay = float(sequence.amplitude[index]), row[touching], since[touching]
    law = law[index] if law.shape else law

    def of(table):
        return table[(slice(None), *index)][impact]

    at = of(sequence.displacement), of(sequence.relative_velocity), of(sequence.phase)
    if isinstance(law, SpringDamper):
        flow = law.flow(stay, *at, lam)
        out[:, touching] = flow.displacement, flow.velocity
    elif stay.size:
        one = np.ones_like(stay)
        start = Start(-at[0], -at[1], at[2], lam * one, one)
        ends = (sequence.release_displacement, sequence.relative_release_velocity)
        end = of(sequence.contact_duration), *(-of(x) for x in ends)
        out[:, touching] = -np.array(states(law, start, end, stay))
    return out
