"""Integrals of a ball's height and of the power it receives, over contacts and flights.

The work of the table w = Λ sin τ on a ball is, per unit of mass, ::

    ∫ (z″ + 1) w′ dτ = [z′ w′ + w] + ∫ z′ w dτ

because w″ = -w. In a linear contact ϖ² δ = w - 1 - δ″ - l δ′ with l = 2ζϖ. Integration by parts
gives ::

    ϖ² ∫ δ dτ = -[w′ + δ′ + l δ] - D
    (ϖ² - 1) I + l J = [w²/2 - w - δ′ w′ - δ w - l δ w′],                 I = ∫ δ w′ dτ
    (ϖ² - 1) J - l I = Λ² D/2 + [w′ - w w′/2 - δ′ w + δ w′ - l δ w],      J = ∫ δ w dτ

The table does no work in a flight. Over a long time its mean work equals the mean dissipation of
the contacts. At an instantaneous impact the work is the impulse times w′, and while a ball rests on
the table it is the integral of (1 - w) w′.

Means over time of the flights, height, received power and growth of deviations of balls.
"""

from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from bouncing_ball.beyond.laws.collocation import integrals
from bouncing_ball.beyond.long_run.motions import Motions
from bouncing_ball.beyond.simulation import Law, dynamics_of
from bouncing_ball.paper.contact.spring_damper import SpringDamper
from bouncing_ball.paper.motion.dynamics import Departure, Dynamics, Impact
from bouncing_ball.paper.motion.flight import table
from bouncing_ball.paper.motion.linear_contact import LinearContactDynamics, has_closed_form
from bouncing_ball.paper.motion.sequence import Status


def change(values: np.ndarray) -> np.ndarray:
    """The value at the end of a contact minus the value at its start."""
    return values[1] - values[0]


def over_contact(
    law: SpringDamper, amplitude: ArrayLike, duration: Any, level: Any, gap: Any, rate: Any
) -> tuple[np.ndarray, np.ndarray]:
    """The integrals ∫ z dτ and ∫ z′ w dτ over contacts.

    Parameters
    ----------
    law : SpringDamper
    amplitude, duration : array_like
        Λ and the duration D of the contacts.
    level : tuple of array
        w′ and w, each at the start and at the end of the contacts, shape (2, ...).
    gap, rate : array, shape (2, ...)
        δ and δ′ at the start and at the end.

    Examples
    --------
    On a table at rest z = δ, and the table does no work:

    >>> law, still = SpringDamper(2.0, 0.0), np.zeros((2, 1))
    >>> gap, rate = np.array([[0.0], [0.0]]), np.array([[-1.0], [1.0]])
    >>> [float(x[0]) for x in over_contact(law, 0.0, 2.0, (still, still), gap, rate)]
    [-1.0, 0.0]
    """
    (w_rate, w), stiffness = level, law.frequency_ratio**2
    loss = 2 * law.damping_ratio * law.frequency_ratio
    of_rate = change(w * w / 2 - w - rate * w_rate - gap * w - loss * gap * w_rate)
    of_level = change(w_rate - w * w_rate / 2 - rate * w + gap * w_rate - loss * gap * w)
    of_level = of_level + np.square(amplitude) * duration / 2
    s = stiffness - 1
    by_rate = (s * of_rate - loss * of_level) / (s * s + loss * loss)
    sunk = -(change(w_rate + rate + loss * gap) + duration) / stiffness
    return sunk - change(w_rate), change(gap * w + w * w / 2) - by_rate


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
    if isinstance(law, SpringDamper) and has_closed_form(law):
        held, moved = over_contact(law, amplitude, duration, (w_rate, w), gap, rate)
    else:
        held, moved = -change(w_rate), change(w * w) / 2
        if law is not None:
            held, moved = (held, moved) - integrals(
                law, duration, -gap[0], -rate[0], phase[0], amplitude
            )
    low, velocity = (gap + w)[1], rate + w_rate
    height = held + (low + (velocity[1] / 2 - flown / 6) * flown) * flown
    return height, change(velocity * w_rate + w) + moved


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

    >>> from bouncing_ball.beyond.long_run.destination import final_motions
    >>> flights, _, power, _ = means(0.5, 1.2, final_motions(0.5, 1.2, 1.0, -3.0), 100)
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
