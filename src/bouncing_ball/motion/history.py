"""Dense time histories of one ball, from its sequence of impacts."""

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from bouncing_ball.contacts.laws.contact_law import ContactLaw
from bouncing_ball.contacts.spring_damper import contact_flow
from bouncing_ball.motion.contact_path import contact_path
from bouncing_ball.motion.landing import Flight
from bouncing_ball.motion.law_motion import Touch
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
    >>> from bouncing_ball.motion.restitution import simulate
    >>> history(simulate(1.0, 0.0, 0.0, 2.0, 2), [0.0, 2.0, 4.0]).height.tolist()
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
    lam, impact, stay = float(sequence.amplitude[index]), row[touching], since[touching]

    def of(table):
        return table[(slice(None), *index)]

    phase, start, rate = map(
        of, (sequence.phase, sequence.displacement, sequence.relative_velocity)
    )
    if isinstance(law, ContactLaw):
        own, duration = law[index] if law.shape else law, of(sequence.contact_duration)
        touch = Touch(-start, -rate, phase, lam)
        depth, entry = contact_path(own, touch, duration, impact, stay)
        out[:, touching] = -depth, -entry
    elif law is not None:
        omega, zeta = (
            np.asarray(x)[index] if np.ndim(x) else x
            for x in (law.frequency_ratio, law.damping_ratio)
        )
        at = start[impact], rate[impact], phase[impact]
        flow = contact_flow(stay, *at, lam, omega, zeta)
        out[:, touching] = flow.displacement, flow.velocity
    return out
