"""Balls from impact to impact: the Poincaré map, and the simulation of many balls.

A leg is a contact and the flight after it, from one impact to the next (:func:`next_impact`). The
first release and the first landing are certified
(:mod:`bouncing_ball_beyond.inherited.numerics.first_zero`), so that no event is passed over. All
quantities are dimensionless, and times are in units of 1/Ω.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import islice
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from bouncing_ball_beyond.inherited.errors import ModelError
from bouncing_ball_beyond.inherited.models.flight import Flight, fly, table
from bouncing_ball_beyond.inherited.models.model import Departure, Model, Status
from bouncing_ball_beyond.inherited.numerics.arrays import pick
from bouncing_ball_beyond.inherited.numerics.elementary import reduce_angle

# Largest number of impacts of a ball over time.
_MOST = 20_000
# Rounding may give a ball at rest on the table a small upward velocity.
_ROUNDING = 8 * np.finfo(float).eps


class Leg(NamedTuple):
    """From an impact to the next one: the release, the time from the first impact to the second,
    and the phase, δ and δ′ of the second.

    δ = 0 and δ′ ≤ 0 at an impact, except where a contact resumes at δ < 0. After a contact that
    never ends the state is NaN and the time infinite.
    """

    departure: Departure
    time: np.ndarray
    phase: np.ndarray
    displacement: np.ndarray
    velocity: np.ndarray


def next_impact(
    model: Model,
    phase: ArrayLike,
    velocity: ArrayLike,
    amplitude: ArrayLike,
    displacement: ArrayLike = 0.0,
) -> Leg:
    """The Poincaré map: contact and flight from an impact to the next one.

    Parameters
    ----------
    model : Model
    phase, velocity : array_like
        φ and δ′ at the impact.
    amplitude : array_like
        Λ.
    displacement : array_like
        δ at the impact; 0, unless a contact resumes.

    Returns
    -------
    Leg
        Arrays of the shape to which the model and the arguments broadcast.

    Raises
    ------
    ModelError
        If a flight is too long for floating-point numbers.

    Examples
    --------
    The map satisfies both lines of Eq. 5. The first impact, at τ₀ = 0.3, turns δ′ = -2 into 1:

    >>> from bouncing_ball_beyond.inherited import rigid
    >>> r, amplitude, start = 0.5, 1.2, 0.3
    >>> v = 1 + amplitude * np.cos(start)
    >>> after = next_impact(rigid(restitution=r), start, -2.0, amplitude)
    >>> s, end = after.time, start + after.time
    >>> landing = amplitude * (np.sin(end) - np.sin(start)) - (s * v - s**2 / 2)
    >>> bounced = -r * after.velocity + amplitude * np.cos(end)
    >>> expected = -r * (v - s) + (1 + r) * amplitude * np.cos(end)
    >>> bool(abs(landing) < 1e-14), bool(abs(bounced - expected) < 1e-14)
    (True, True)
    """
    given = [np.asarray(x, dtype=float) for x in (phase, velocity, amplitude, displacement)]
    shape = np.broadcast_shapes(model.shape, *(x.shape for x in given))
    start, closing, lam, gap = (np.broadcast_to(x, shape).reshape(-1) for x in given)
    row = model.flat(shape)
    departure = row.impact(start, closing, lam, gap)
    going = np.flatnonzero(departure.status == Status.BOUNCING)
    release = reduce_angle(start[going] + departure.duration[going])
    left = pick(departure, going)
    lag = pick(np.asarray(row.lag), going)
    landing = fly(release, left.displacement, left.velocity, lam[going], lag)
    found = np.full((4, start.size), np.nan)
    found[0] = np.inf
    found[:, going] = [
        left.duration + landing.time,
        reduce_angle(release + landing.time),
        landing.displacement,
        landing.velocity,
    ]
    shaped = Departure(*(values.reshape(shape)[()] for values in departure))
    return Leg(shaped, *(values.reshape(shape)[()] for values in found))


@dataclass(frozen=True, eq=False)
class ImpactSequence:
    """Impacts in order: arrays of shape (impacts, balls), NaN after a contact that does not end.

    An impact is the start of a contact. "Relative" means relative to the table.

    Parameters
    ----------
    model : Model
        A model for all balls, or a row with one for each.
    amplitude : ndarray, shape (balls,)
        Λ.
    status : ndarray of int, shape (balls,)
        What each ball does after its last impact, a :class:`.Status`.
    time, phase : ndarray
        Time of the impact since the first one, and the table's phase, in [-π, π].
    displacement, relative_velocity : ndarray
        δ and δ′ at the impact. δ = 0, except where a contact resumes below the table's level.
    contact_duration : ndarray
        Time until the ball leaves: 0 for an impact with a restitution coefficient unless the ball
        rests on the table, and infinite for permanent contact.
    release_displacement, relative_bounce_velocity : ndarray
        δ and δ′ when the ball leaves.
    """

    model: Model
    amplitude: np.ndarray
    status: np.ndarray
    time: np.ndarray
    phase: np.ndarray
    displacement: np.ndarray
    relative_velocity: np.ndarray
    contact_duration: np.ndarray
    release_displacement: np.ndarray
    relative_bounce_velocity: np.ndarray

    @property
    def impact_velocity(self) -> np.ndarray:
        """Absolute velocity z′_i of the ball at each impact, before it."""
        return self.relative_velocity + table(self.phase, self.amplitude)[0]

    @property
    def bounce_velocity(self) -> np.ndarray:
        """Absolute velocity z′_b of the ball at each release; NaN if the contact never ends."""
        lasts = np.where(np.isfinite(self.contact_duration), self.contact_duration, np.nan)
        return self.relative_bounce_velocity + table(self.phase + lasts, self.amplitude)[0]


def relative_velocities(
    phase: np.ndarray, velocity: np.ndarray, amplitude: np.ndarray
) -> np.ndarray:
    """δ′ ≤ 0 of first impacts with the absolute velocities z′_i.

    Raises
    ------
    ModelError
        If a ball rises from the table.

    Examples
    --------
    >>> relative_velocities(np.zeros(1), np.full(1, -3.0), np.full(1, 0.5)).tolist()
    [-3.5]
    """
    rate, _ = table(phase, amplitude)
    relative = velocity - rate
    rises = relative > _ROUNDING * (np.abs(velocity) + amplitude)
    if np.any(rises):
        k = int(np.argmax(rises))
        raise ModelError(
            "a ball that rises from the table has no impact: its velocity "
            f"z′ = {velocity[k]:g} is above that of the table, w′ = {rate[k]:g}"
        )
    return np.minimum(relative, 0.0)


def _impacts(
    model: Model, amplitude: np.ndarray, phase: np.ndarray, velocity: np.ndarray
) -> Iterator[tuple[np.ndarray, np.ndarray]]:
    """The impacts of balls one after another: the columns of :class:`ImpactSequence` from ``time``
    on, shape (7, balls), and the status of the balls. There is no end to them unless no ball
    bounces any more.
    """
    balls = phase.size
    row = model.flat((balls,))
    status = np.full(balls, Status.BOUNCING)
    state = reduce_angle(phase), relative_velocities(phase, velocity, amplitude), np.zeros(balls)
    passed = np.zeros(balls)
    going = np.arange(balls)
    while going.size:
        start, closing, gap = state
        leg = next_impact(row.take(going), start, closing, amplitude[going], gap)
        columns = np.full((7, balls), np.nan)
        columns[:, going] = [passed, start, gap, closing, *leg.departure[:3]]
        status[going] = leg.departure.status
        yield columns, status
        on = leg.departure.status == Status.BOUNCING
        going = going[on]
        passed = (passed + leg.time)[on]
        state = leg.phase[on], leg.velocity[on], leg.displacement[on]


def impacts_of(
    model: Model, amplitude: ArrayLike, phase: ArrayLike, velocity: ArrayLike, impacts: int
) -> ImpactSequence:
    """The impacts of balls from a first impact on, the first included.

    Parameters
    ----------
    model : Model
        One model, or one for each ball.
    amplitude, phase, velocity : array_like
        Λ, and the table's phase φ and the absolute velocity z′_i just before the first impact; they
        broadcast to a row of balls.
    impacts : int
        Number of impacts. Balls that remain on the table have fewer.

    Raises
    ------
    ModelError
        If a ball rises from the table at first.

    Examples
    --------
    >>> from bouncing_ball_beyond.inherited import rigid
    >>> impacts_of(rigid(restitution=0.5), 0.0, 0.0, [-1.0, -2.0], 3).time.T.tolist()
    [[0.0, 1.0, 1.5], [0.0, 2.0, 3.0]]
    """
    starts = np.broadcast_arrays(*map(np.atleast_1d, (amplitude, phase, velocity)))
    lam, phi, speed = (x.astype(float) for x in starts)
    rows = islice(_impacts(model, lam, phi, speed), impacts)
    return _sequence(model, lam, rows, impacts)


def _sequence(
    model: Model, amplitude: np.ndarray, rows: Iterator[tuple[np.ndarray, np.ndarray]], count: int
) -> ImpactSequence:
    """The sequence of these impacts, with at least ``count`` rows; rows of NaN stand for none."""
    found = []
    status = np.zeros(amplitude.size, dtype=int)
    for columns, after in rows:
        found.append(columns)
        status = after
    missing = [np.full((7, amplitude.size), np.nan)] * (count - len(found))
    columns = np.stack(found + missing, axis=1)
    return ImpactSequence(model, amplitude, status, *columns)


def impacts_until(
    model: Model, amplitude: np.ndarray, phase: np.ndarray, velocity: np.ndarray, end: np.ndarray
) -> ImpactSequence:
    """The impacts of balls up to times since their first impacts, and the first one after each.

    The arguments are rows of one length; otherwise they are those of :func:`impacts_of`.

    Raises
    ------
    ModelError
        If a ball has too many impacts in this time, or rises from the table at first.
    """

    def until_the_end() -> Iterator[tuple[np.ndarray, np.ndarray]]:
        for count, (columns, status) in enumerate(_impacts(model, amplitude, phase, velocity)):
            if count == _MOST:
                raise ModelError(
                    f"a ball has more than {_MOST} impacts in this time: use fewer periods"
                )
            yield columns, status
            if np.all((status != Status.BOUNCING) | (columns[0] > end)):
                return

    return _sequence(model, amplitude, until_the_end(), 0)


class History(NamedTuple):
    """Height z and velocity z′ of a ball, height w of the table, and whether the ball touches the
    table, at each time. The ball's entries are NaN before the first impact, and after the last
    contact, because the end of the last flight is not known.
    """

    height: np.ndarray
    velocity: np.ndarray
    table: np.ndarray
    touching: np.ndarray


def motion_at(sequence: ImpactSequence, ball: int, time: np.ndarray) -> History:
    """The motion of one ball of a sequence at times since its first impact.

    Examples
    --------
    >>> from bouncing_ball_beyond.inherited import rigid
    >>> sequence = impacts_of(rigid(restitution=1.0), 0.0, 0.0, -2.0, 2)
    >>> motion_at(sequence, 0, np.array([0.0, 2.0, 4.0])).height.tolist()
    [0.0, 2.0, 0.0]
    """
    amplitude = sequence.amplitude[ball]
    began = sequence.time[:, ball]
    last = int(np.sum(np.isfinite(began))) - 1
    row = np.clip(np.searchsorted(began[: last + 1], time, side="right") - 1, 0, None)
    since = time - began[row]
    duration = sequence.contact_duration[row, ball]
    touching = (since >= 0) & (since <= duration)
    # The end of the last flight is not known.
    flying = (since > duration) & ((row < last) | (sequence.status[ball] != Status.BOUNCING))
    start = sequence.phase[row, ball]
    rate, height = table(start + since, amplitude)
    gap = np.full(time.shape, np.nan)
    speed = np.full(time.shape, np.nan)
    gap[touching], speed[touching] = sequence.model.take(ball).in_contact(
        since[touching],
        start[touching],
        sequence.relative_velocity[row, ball][touching],
        amplitude,
        sequence.displacement[row, ball][touching],
    )
    flight = Flight(
        start[flying] + duration[flying],
        sequence.release_displacement[row, ball][flying],
        sequence.relative_bounce_velocity[row, ball][flying],
        amplitude,
    )
    gap[flying], speed[flying], *_ = flight.gap(since[flying] - duration[flying])
    return History(gap + height, speed + rate, height, touching)
