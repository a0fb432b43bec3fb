"""Proof that an orbit's contact holds and its flight stays above the table, by bounds.

The orbit is admissible if δ is negative during the contact and positive during the flight. At the
ends of both, where δ vanishes, the sign of δ′ decides; between them balls of time are divided until
the enclosure of δ has one sign.
"""

from collections.abc import Callable

from flint import arb

from bouncing_ball_beyond.proofs.branch import EnclosedContact, Point

# Largest number of balls of time for one function, and the parts into which the time is divided
# first.
_MOST = 20_000
_PARTS = 16


def _ball(low: arb, high: arb) -> arb:
    return low.union(high)


def keeps_sign(function: Callable[[arb], arb], low: arb, high: arb, sign: int) -> bool:
    """Whether ``sign`` times a function is proved to be positive on an interval of time."""
    step = (high - low) / _PARTS
    waiting = [(low + k * step, low + (k + 1) * step) for k in range(_PARTS)]
    looked_at = 0
    while waiting:
        left, right = waiting.pop()
        looked_at += 1
        if looked_at > _MOST:
            return False
        if sign * function(_ball(left, right)) > 0:
            continue
        middle = ((left + right) / 2).mid()
        # The value at a point of the wrong sign ends the search.
        if sign * function(middle) < 0:
            return False
        waiting += [(left, middle), (middle, right)]
    return True


def _near_end(function: Callable[[arb], arb], start: arb, length: arb, sign: int) -> arb | None:
    """A length, next to an end, over which ``sign`` times a function is positive, by halving."""
    for _ in range(60):
        end = start + length
        if sign * function(_ball(start, end)) > 0:
            return length
        length = length / 2
    return None


def contact_holds(contact: EnclosedContact, orbit: Point) -> bool:
    """Whether δ < 0 is proved for all times in the contact."""

    def gap(time: arb) -> arb:
        return contact.state(time, orbit.u, orbit.x, orbit.y)[0]

    def rate(time: arb) -> arb:
        return contact.state(time, orbit.u, orbit.x, orbit.y)[1]

    duration = orbit.duration
    first = _near_end(rate, arb(0), duration / 2, -1)
    last = _near_end(rate, duration, -duration / 2, +1)
    if first is None or last is None:
        return False
    return keeps_sign(gap, first, duration + last, -1)


def flight_is_free(orbit: Point) -> bool:
    """Whether δ > 0 is proved for all times in the flight."""
    turn_sine, turn_cosine = orbit.duration.sin_cos()
    x = orbit.x * turn_cosine - orbit.y * turn_sine
    y = orbit.y * turn_cosine + orbit.x * turn_sine

    def gap(time: arb) -> arb:
        sine, cosine = time.sin_cos()
        return (
            orbit.gap + orbit.rate * time - time * time / 2 + y * (1 - cosine) + x * (time - sine)
        )

    def rate(time: arb) -> arb:
        sine, cosine = time.sin_cos()
        return orbit.rate - time + y * sine + x * (1 - cosine)

    flight = orbit.flight
    first = _near_end(rate, arb(0), flight / 4, +1)
    last = _near_end(rate, flight, -flight / 4, -1)
    if first is None or last is None:
        return False
    return keeps_sign(gap, first, flight + last, +1)
