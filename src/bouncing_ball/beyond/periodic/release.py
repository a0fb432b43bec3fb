"""The grazing of a release: the highest point within a contact, and how it depends on the orbit.

A contact ends where δ + κ δ′ rises through 0, and before this it is negative. Where its highest
local maximum touches 0 the contact opens. Because the derivative with respect to the time vanishes
at a maximum, the gradient of the maximum is that at the fixed time of the maximum.
"""

from typing import NamedTuple

import numpy as np

from bouncing_ball.beyond.periodic.problem import PeriodicOrbits
from bouncing_ball.numerics.arrays import pick
from bouncing_ball.paper.contact.contact import Contact, Span

# Samples of a contact: evenly, and in geometric progression from this fraction of the duration on,
# because the oscillations after an impact decay.
_EVEN, _GEOMETRIC, _FIRST = 160, 160, 1e-6
# The bracket of a maximum is narrowed to a quarter by each of these rounds of this many samples.
# The error of the parabola through the last three is of the fourth order of their distance.
_ROUNDS, _SAMPLES = 7, 9
# The height where there is no maximum, and thus no event near.
_FAR = -1.0


class _Tops(NamedTuple):
    """The largest local maximum within each contact and its time since the start of the contact,
    shape (..., k); -1 and NaN if there is none.
    """

    height: np.ndarray
    time: np.ndarray


def release_margin(orbits: PeriodicOrbits, y: np.ndarray) -> np.ndarray:
    """Minus the largest local maximum of δ + κ δ′ within the contacts of each orbit, of the leading
    shape of y; 1 where there is none, where impacts are instants, and for laws without a κ.
    """
    return -_tops(orbits, y).height.max(axis=-1)


def release_condition(orbits: PeriodicOrbits, y: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The margin and its gradient, of the leading shape and of the shape of y."""
    tops = _tops(orbits, y)
    points = orbits.around(y, everywhere=True)
    shape = (*points.shape[:-1], orbits.impacts)
    # Only the contact with the largest maximum counts.
    counts = np.arange(orbits.impacts) == tops.height.argmax(axis=-1)[..., np.newaxis]
    which = np.flatnonzero(np.broadcast_to(counts, shape))
    time = np.broadcast_to(tops.time, shape).ravel()[which]
    height = np.zeros(shape)
    height.ravel()[which] = _heights(orbits, points, which, time)
    change = height[2::2] - height[1::2]
    return -tops.height.max(axis=-1), orbits.gradient(y, change)


def _contacts(orbits: PeriodicOrbits, y: np.ndarray) -> tuple[Contact, Span] | None:
    """All contacts of the orbits in a row, None if there are none or if they have no κ."""
    legs = orbits.legs(y)
    dynamics, _ = orbits.dynamics(y)
    if dynamics is None or dynamics.contact is None or dynamics.contact.lag is None:
        return None
    span = Span(
        displacement=legs.impact.displacement,
        velocity=legs.impact.velocity,
        phase=legs.impact.phase,
        amplitude=np.broadcast_to(dynamics.amplitude, legs.passed.shape),
        duration=legs.duration.ravel(),
        release_displacement=legs.departure.flight.displacement,
        release_velocity=legs.departure.flight.velocity,
    )
    return dynamics.contact, span


def _heights(
    orbits: PeriodicOrbits, y: np.ndarray, which: np.ndarray, time: np.ndarray
) -> np.ndarray:
    """δ + κ δ′ at a time in each of the contacts with these indices, NaN if it is not known."""
    found = np.full(which.shape, np.nan)
    contacts = _contacts(orbits, y)
    if contacts is not None:
        contact, span = contacts
        known = np.isfinite(span.duration[which]) & np.isfinite(time)
        part = which[known]
        found[known] = _at(contact.take(part), pick(span, part), time[np.newaxis, known])[0]
    return found


def _tops(orbits: PeriodicOrbits, y: np.ndarray) -> _Tops:
    """The largest local maximum of δ + κ δ′ within each contact, and its time."""
    shape = (*y.shape[:-1], orbits.impacts)
    height = np.full(shape, _FAR)
    at = np.full(shape, np.nan)
    contacts = _contacts(orbits, y)
    if contacts is None:
        return _Tops(height, at)
    contact, span = contacts
    known = np.flatnonzero(np.isfinite(span.duration) & (span.duration > 0))
    if known.size:
        with np.errstate(all="ignore"):
            found = _highest(contact.take(known), pick(span, known))
        height.ravel()[known], at.ravel()[known] = found
    return _Tops(height, at)


def _highest(contact: Contact, span: Span) -> _Tops:
    """The largest local maximum within each contact of a row, all of finite duration."""
    evenly = np.linspace(0, 1, _EVEN)[1:]
    densely = np.geomspace(_FIRST, 1, _GEOMETRIC)
    share = np.union1d(evenly, densely)
    value = _at(contact, span, share[:, np.newaxis] * span.duration)
    inner = value[1:-1]
    is_top = (inner > value[:-2]) & (inner >= value[2:])
    top = np.where(is_top, inner, -np.inf).argmax(axis=0)
    found = is_top.any(axis=0)
    left = share[top] * span.duration
    right = share[top + 2] * span.duration
    rows = np.arange(top.size)
    for _ in range(_ROUNDS):
        time = left + (right - left) * np.linspace(0, 1, _SAMPLES)[:, np.newaxis]
        value = _at(contact, span, time)
        best = np.clip(value.argmax(axis=0), 1, _SAMPLES - 2)
        left = time[best - 1, rows]
        right = time[best + 1, rows]
    before, middle, after = (value[best + j, rows] for j in (-1, 0, 1))
    slope = (after - before) / 2
    bend = before - 2 * middle + after
    height = middle - slope * slope / (2 * bend)
    at = (left + right) / 2 - slope / bend * (right - left) / 2
    return _Tops(np.where(found, height, _FAR), np.where(found, at, np.nan))


def _at(contact: Contact, span: Span, time: np.ndarray) -> np.ndarray:
    """δ + κ δ′ at times of shape (samples, contacts)."""
    samples = len(time)
    whole = Span(*(np.tile(x, samples) for x in span))
    several = contact.take(np.tile(np.arange(time.shape[1]), samples))
    displacement, velocity = several.during(whole, time.ravel())
    return (displacement + several.lag * velocity).reshape(time.shape)
