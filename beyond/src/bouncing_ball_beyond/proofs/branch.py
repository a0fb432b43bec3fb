"""The closed branch of n-T orbits with balls in place of numbers (docs/closed-form.md).

With a contact of duration D, the conditions of release, velocity and landing are linear in (u,
X, Y) = (δ′, Λ cos φ, Λ sin φ). The unknown is the excess angle ε = ϖ_d D - π over the angle at
which a free contact ends. All functions take balls or series and evaluate the formulas as they
stand; nothing is iterated.
"""

from dataclasses import dataclass
from functools import cached_property
from typing import Any, NamedTuple

from flint import arb

Number = Any
"""A ball or a series."""


class EnclosedResponses(NamedTuple):
    """The contact's responses at a time: g, g′, G, P = Im h and Q = Re h (Eq. 4 of the page)."""

    impulse: Number
    impulse_rate: Number
    gravity: Number
    sine: Number
    cosine: Number


@dataclass(frozen=True)
class EnclosedContact:
    """A contact with the displacement release whose parameters are balls: ζ in [0, 1) and ϖ > 0."""

    frequency_ratio: Number
    damping_ratio: Number

    @cached_property
    def root(self) -> Number:
        """√(1 - ζ²)."""
        zeta = self.damping_ratio
        return ((1 - zeta) * (1 + zeta)).sqrt()

    @cached_property
    def damped(self) -> Number:
        """ϖ_d = ϖ √(1 - ζ²)."""
        return self.frequency_ratio * self.root

    @cached_property
    def decay(self) -> Number:
        """a = ζϖ."""
        return self.damping_ratio * self.frequency_ratio

    def duration(self, excess: Number) -> Number:
        """D = (π + ε)/ϖ_d."""
        return (excess + arb.pi()) / self.damped

    def responses(self, time: Number) -> EnclosedResponses:
        """g, g′, G, P and Q after a time in contact.

        The quotients are singular at the undamped resonance ζ = 0, ϖ = 1, where the balls become
        infinite.
        """
        a = self.decay
        q = self.frequency_ratio * self.frequency_ratio
        sine, cosine = (self.damped * time).sin_cos()
        fall = (-(a * time)).exp()
        g = fall * sine / self.damped
        g_rate = fall * (cosine - a * sine / self.damped)
        rest = g_rate + 2 * a * g
        gravity = (1 - rest) / q
        # h = (e^{is} - rest - i g)/(q - 1 + 2ia)
        slow_sine, slow_cosine = time.sin_cos()
        real = slow_cosine - rest
        imaginary = slow_sine - g
        detuning = q - 1
        loss = 2 * a
        square = detuning * detuning + loss * loss
        in_phase = (real * detuning + imaginary * loss) / square
        quadrature = (imaginary * detuning - real * loss) / square
        return EnclosedResponses(g, g_rate, gravity, quadrature, in_phase)

    def state(self, time: Number, u: Number, x: Number, y: Number) -> tuple[Number, Number]:
        """δ and δ′ after a time in contact (Eqs. 2 and 3 of the page)."""
        r = self.responses(time)
        gap = u * r.impulse + x * r.sine + y * r.cosine - r.gravity
        rate = u * r.impulse_rate + x * r.cosine + y * (r.impulse - r.sine) - r.impulse
        return gap, rate


class Point(NamedTuple):
    """A point of the branch: D, T, (u, X, Y), the linear system's determinant, δ_b and δ′_b."""

    duration: Number
    flight: Number
    u: Number
    x: Number
    y: Number
    matrix: Number
    gap: Number
    rate: Number

    @property
    def square(self) -> Number:
        """Λ²."""
        return self.x * self.x + self.y * self.y

    @property
    def bounce_velocity(self) -> Number:
        """z′_b = z′_i + T."""
        return self.u + self.x + self.flight

    @property
    def top(self) -> Number:
        """The apex of the flight; it is the greatest height if it exceeds Λ and z′_b > 0."""
        bounce = self.bounce_velocity
        height = self.y - (bounce + self.u + self.x) / 2 * self.flight
        return height + bounce * bounce / 2


def point(contact: EnclosedContact, n: int, excess: Number) -> Point:
    """The orbit with the excess angle ε, by Cramer's rule for conditions (5)-(7) of the page."""
    duration = contact.duration(excess)
    flight = -duration + 2 * n * arb.pi()
    r = contact.responses(duration)
    sine, cosine = duration.sin_cos()
    # δ and δ′ at the end of the contact are linear in (u, X, Y), with these coefficients.
    gap = (r.impulse, r.sine, r.cosine)
    rate = (r.impulse_rate, r.cosine, r.impulse - r.sine)
    velocity = [rate[0] - 1, rate[1] + cosine - 1, rate[2] - sine]
    landing = [gap[0] + flight, gap[1] + sine + flight, gap[2] + cosine - 1]
    right = (
        r.gravity,
        r.impulse + flight,
        r.gravity - flight * flight / 2,
    )
    (u, x, y), matrix = _solved(gap, velocity, landing, right)
    end, speed = contact.state(duration, u, x, y)
    return Point(
        duration=duration,
        flight=flight,
        u=u,
        x=x,
        y=y,
        matrix=matrix,
        gap=end,
        rate=speed,
    )


def _solved(first, second, third, right) -> tuple[list[Number], Number]:
    """The solution of three equations, and the determinant of their matrix."""

    def determinant(rows):
        (a, b, c), (d, e, f), (g, h, i) = rows
        return a * (e * i - f * h) - b * (d * i - f * g) + c * (d * h - e * g)

    rows = (first, second, third)
    whole = determinant(rows)
    found = []
    for column in range(3):
        replaced = [
            [value if k == column else row[k] for k in range(3)]
            for row, value in zip(rows, right, strict=True)
        ]
        found.append(determinant(replaced) / whole)
    return found, whole
