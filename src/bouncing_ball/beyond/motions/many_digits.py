r"""Balls of the restitution model, followed with as many digits as their motions need.

A ball that sticks leaves in the state of the lift-off, and whether it sticks again follows from
(Λ, r) alone. On a long way to the next sticking a double loses all its digits. Here the ball is
followed in ball arithmetic: each number is an interval that certainly contains the true one. Its
width grows with the deviations of the motion, and if it becomes too large, the motion is computed
again with twice as many digits.

The landing is searched for in doubles and then improved by Newton's method. The interval of the
landing time follows from an interval Newton step: if ::

    N = s - δ(s)/δ′(S)

lies within the interval S around s, S contains exactly one landing, and it lies in N. That it is
the first one is known to rounding errors of the doubles only: a ball that grazes the table within
them is given up, as is one whose chattering ends there at the lift-off.
"""

import math
from typing import Any, NamedTuple

import numpy as np
from flint import arb, ctx

from bouncing_ball.models.flight import Flight, land

# Bits of the first attempt. Each further attempt has twice as many.
_BITS = 192
_MOST_BITS = 1 << 13
# Bits of a slope, of which only the sign and some digits matter.
_ROUGH = 64
# Width of the interval of the phase above which an attempt has too few bits.
_WIDE = 1e-9
# Largest difference between the landing of the doubles and that of the intervals.
_SAME = 1e-6
# Chattering is summed up once it takes less than this number times 1 - Λ sin φ. The next term of
# its sum is below 10⁻¹⁵ then, as in the simulation with doubles.
_CHATTER = 1e-5
# A wait for the lift-off below this length is not told from none.
_NO_WAIT = 1e-9


class Stop(NamedTuple):
    """The sticking of a ball: the ``impacts`` before it and the ``time`` of its lift-off.

    ``digits`` are the decimal digits of the start that were lost on the way.
    """

    impacts: int
    time: float
    digits: float


class _TooFewBitsError(Exception):
    """The interval of a motion became too wide."""


class _GrazesError(Exception):
    """A ball meets the table, or the lift-off, within a rounding error of a double."""


class _Ball(NamedTuple):
    """A ball in flight after an impact, or after its lift-off: intervals."""

    time: arb
    phase: arb
    # Λ cos φ, Λ sin φ and δ′.
    x: arb
    y: arb
    rate: arb


class ManyDigits(NamedTuple):
    """The motions of a ball with r on a table of amplitude Λ, both taken to be exact."""

    restitution: float
    amplitude: float

    def _lifted(self) -> _Ball:
        """A ball at its lift-off."""
        lam = arb(self.amplitude)
        rate = (lam * lam - 1).sqrt()
        return _Ball(arb(0), (1 / lam).asin(), rate, arb(1), arb(0))

    def _thrown(self, phase: float, velocity: float) -> _Ball:
        """A ball after an impact with the absolute velocity z′ before it."""
        at = arb(phase)
        x = self.amplitude * at.cos()
        y = self.amplitude * at.sin()
        return _Ball(arb(0), at, x, y, arb(self.restitution) * (x - arb(velocity)))

    def after_lift_off(self, impacts: int) -> Stop | None:
        """The next sticking of a ball after its lift-off, None if there is none within so many
        impacts, or if rounding errors of doubles decide.

        Examples
        --------
        A locked orbit that doubles find as well, and one on which 195 digits are lost:

        >>> stop = ManyDigits(0.6, 3.0).after_lift_off(100)
        >>> stop.impacts, round(stop.time / (2 * math.pi))
        (33, 13)
        >>> stop = ManyDigits(0.4, 2.1).after_lift_off(400)
        >>> stop.impacts, round(stop.time / (2 * math.pi))
        (311, 259)
        """
        return self._sticking(impacts, None)

    def after_impact(self, phase: float, velocity: float, impacts: int) -> Stop | None:
        """The first sticking of a ball after an impact (φ, z′), as :meth:`after_lift_off`."""
        return self._sticking(impacts, (phase, velocity))

    def _sticking(self, impacts: int, start: tuple[float, float] | None) -> Stop | None:
        bits = _BITS
        before = ctx.prec
        try:
            while bits <= _MOST_BITS:
                ctx.prec = bits
                ball = self._lifted() if start is None else self._thrown(*start)
                try:
                    return self._stop_within(ball, impacts, bits)
                except _TooFewBitsError:
                    bits *= 2
        except _GrazesError:
            return None
        finally:
            ctx.prec = before
        return None

    def _stop_within(self, ball: _Ball, impacts: int, bits: int) -> Stop | None:
        for count in range(1, impacts + 1):
            ball = self._next(ball)
            settles = self._settling(ball)
            if settles is not None:
                time = float(ball.time.mid()) + settles
                lost = bits * math.log10(2) + math.log10(max(_width(ball.phase), 1e-300))
                return Stop(count, time, lost)
        return None

    def _next(self, ball: _Ball) -> _Ball:
        """The ball after its next impact."""
        flown = self._landing(ball)
        phase = ball.phase + flown
        if _width(phase) > _WIDE:
            raise _TooFewBitsError
        sine, cosine = phase.sin_cos()
        x = self.amplitude * cosine
        rate = ball.rate - flown + (ball.x - x)
        return _Ball(
            time=ball.time + flown,
            phase=phase,
            x=x,
            y=self.amplitude * sine,
            rate=-arb(self.restitution) * rate,
        )

    def _landing(self, ball: _Ball) -> arb:
        """The time of flight until the next landing."""
        guess = self._in_doubles(ball)
        time = arb(guess)
        bits = ctx.prec
        # Newton's method doubles the number of digits in each step.
        for ctx.prec in _ladder(bits):
            displacement, rate = _gap(ball, time)
            time = (time - displacement / rate).mid()
        ctx.prec = bits
        displacement, slope = _gap(ball, time)
        radius = 4 * (displacement / slope).abs_upper() + arb(2) ** (-bits)
        around = time + radius.union(-radius)
        ctx.prec = _ROUGH
        _, slope = _gap(ball, around)
        ctx.prec = bits
        landing = time - displacement / slope
        if slope.contains(0) or not around.contains(landing):
            raise _TooFewBitsError
        if abs(float(landing.mid()) - guess) > _SAME:
            raise _GrazesError
        return landing

    def _in_doubles(self, ball: _Ball) -> float:
        """The landing of a ball whose state is rounded to doubles."""
        rate, x, y = (np.array([float(value.mid())]) for value in (ball.rate, ball.x, ball.y))
        flight = Flight(np.zeros(1), rate, x, y, self.amplitude)
        return float(land(flight, flight.earliest_landing()).time[0])

    def _settling(self, ball: _Ball) -> float | None:
        """The time from an impact to the lift-off, if the ball sticks after this impact."""
        gravity = 1 - float(ball.y.mid())
        if gravity <= 0:
            return None
        rate = float(ball.rate.mid())
        bounces = 2 * rate / (gravity * (1 - self.restitution))
        if bounces > _CHATTER * gravity / max(self.amplitude, 1.0):
            return None
        lift = math.asin(1 / self.amplitude)
        rest = (lift - float(ball.phase.mid()) - bounces) % (2 * math.pi)
        if min(rest, 2 * math.pi - rest) < _NO_WAIT:
            raise _GrazesError
        return bounces + rest


def _ladder(bits: int) -> list[int]:
    """Numbers of bits that double up to this number, from those of a double on.

    Examples
    --------
    >>> _ladder(384)
    [96, 192, 384]
    """
    steps = [bits]
    while steps[-1] > 2 * _ROUGH:
        steps.append(-(-steps[-1] // 2))
    return steps[::-1]


def _gap(ball: _Ball, time: arb) -> tuple[arb, arb]:
    """δ and δ′ a time after the ball has left the table."""
    sine, cosine = time.sin_cos()
    versine = 1 - cosine
    thrown = time * (ball.rate - time / 2)
    displacement = thrown + ball.y * versine + ball.x * (time - sine)
    rate = ball.rate - time + ball.y * sine + ball.x * versine
    return displacement, rate


def _width(value: Any) -> float:
    """The radius of an interval."""
    return float(value.rad())
