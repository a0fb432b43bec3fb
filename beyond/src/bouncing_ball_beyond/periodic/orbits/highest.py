"""The highest points of motions, in flight and within contacts, from samples that close in on them.

A contact ends where δ + κ δ′ rises through 0, and before this it is negative. Where its highest
local maximum touches 0 the contact opens: this is the grazing of a release.
"""

from collections.abc import Callable
from typing import Any, NamedTuple, Self

import numpy as np

from bouncing_ball_beyond.periodic.orbits.legs import Legs

# Samples of a contact: evenly, and in geometric progression from this fraction of the duration on,
# because the oscillations after an impact decay.
_SAMPLES_OF_CONTACT = np.union1d(np.linspace(0, 1, 160)[1:], np.geomspace(1e-6, 1, 160))
# Each of these rounds of this many samples narrows the bracket of a maximum to a hundredth. The
# parabola through the last three samples, 1e-4 of the first bracket apart, has an error of the
# fourth order of this distance.
_ROUNDS, _SAMPLES = 2, 201
# The height where there is no maximum, and thus no event near.
_FAR = -1.0


def about_highest(
    height: Callable[[np.ndarray], np.ndarray], left: Any, right: Any, samples: int, rounds: int
) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """The last samples of motions about their highest points, which each round brings nearer.

    A round takes evenly spaced samples between two times; the next one is between the neighbours of
    the highest sample.

    Parameters
    ----------
    height : callable
        The heights at times of the shape (samples, ...); of a motion all of them may be NaN.
    left, right : array
        The first times between which a motion has its highest point.
    samples, rounds : int
        The number of samples in a round, and the number of rounds.

    Returns
    -------
    tuple of array
        The heights of the last samples; and those of the highest one, or the one beside it at an
        end, and of the two beside it, shape (3, ...), with the times of these two.

    Examples
    --------
    >>> _, (low, top, high), left, right = about_highest(np.sin, 1.0, np.array(2.0), 21, 2)
    >>> round(float(right - left), 12), bool(low < top > high), round(float(top), 6)
    (0.01, True, 1.0)
    """
    share = np.linspace(0, 1, samples).reshape(-1, *(1,) * np.ndim(right))
    for _ in range(rounds):
        time = left + (right - left) * share
        value = height(time)
        inner = np.clip(value.argmax(axis=0), 1, samples - 2)
        three = inner + np.array([-1, 0, 1]).reshape(-1, *(1,) * inner.ndim)
        left, _, right = np.take_along_axis(time, three, axis=0)
    return value, np.take_along_axis(value, three, axis=0), left, right


class Tops(NamedTuple):
    """The largest local maximum within each contact and its time since the start of the contact,
    shape (..., k); -1 and NaN if there is none.
    """

    height: np.ndarray
    time: np.ndarray


class _Contacts(NamedTuple):
    """A row of contacts: δ + κ δ′ at times since their starts, and their durations."""

    height: Callable[[np.ndarray], np.ndarray]
    duration: np.ndarray

    @classmethod
    def of(cls, legs: Legs, which: np.ndarray) -> Self | None:
        """The contacts with these indices; None if there are none or if they have no κ."""
        if legs.dynamics is None or not which.size:
            return None
        dynamics, ends = legs.dynamics, (legs.impact, legs.departure)
        if which.size < legs.duration.size:
            dynamics, *ends = dynamics.kept(which, *ends)
        height = dynamics.release_function(*ends)
        return None if height is None else cls(height, legs.duration.ravel()[which])


def heights_within(legs: Legs, which: np.ndarray, time: np.ndarray) -> np.ndarray:
    """δ + κ δ′ at a time in each of the contacts with these indices, NaN if it is not known."""
    found = np.full(which.shape, np.nan)
    known = np.isfinite(legs.duration.ravel()[which]) & np.isfinite(time)
    contacts = _Contacts.of(legs, which[known])
    if contacts is not None:
        found[known] = contacts.height(time[known])
    return found


def tops_of(legs: Legs) -> Tops:
    """The largest local maximum of δ + κ δ′ within each contact, and its time."""
    duration = legs.duration.ravel()
    height = np.full(legs.duration.shape, _FAR)
    at = np.full(legs.duration.shape, np.nan)
    known = np.flatnonzero(np.isfinite(duration) & (duration > 0))
    contacts = _Contacts.of(legs, known)
    if contacts is not None:
        with np.errstate(all="ignore"):
            found = _highest(contacts)
        height.ravel()[known], at.ravel()[known] = found
    return Tops(height, at)


def _highest(contacts: _Contacts) -> Tops:
    """The largest local maximum within each contact of a row, all of finite duration."""
    share = _SAMPLES_OF_CONTACT
    value = contacts.height(share[:, np.newaxis] * contacts.duration)
    inner = value[1:-1]
    is_top = (inner > value[:-2]) & (inner >= value[2:])
    found = is_top.any(axis=0)
    if not found.any():
        return Tops(np.full(found.shape, _FAR), np.full(found.shape, np.nan))
    top = np.where(is_top, inner, -np.inf).argmax(axis=0)
    left = share[top] * contacts.duration
    right = share[top + 2] * contacts.duration
    _, (before, middle, after), left, right = about_highest(
        contacts.height, left, right, _SAMPLES, _ROUNDS
    )
    slope = (after - before) / 2
    bend = before - 2 * middle + after
    height = middle - slope * slope / (2 * bend)
    at = (left + right) / 2 - slope / bend * (right - left) / 2
    return Tops(np.where(found, height, _FAR), np.where(found, at, np.nan))
