"""The return map of n-T orbits to third order, and the criticality of a period doubling.

The map takes the start of a contact (φ, δ′) to the next one. About an orbit its Taylor coefficients
follow from the flow of contact and flight, whose durations are series that solve the conditions of
release and landing: the constant slope of Newton's method gains one order with each step.
"""

from typing import NamedTuple

from flint import arb

from bouncing_ball.beyond.proofs.branch import EnclosedContact, Point
from bouncing_ball.beyond.proofs.series import Series


class ReturnMap(NamedTuple):
    """The deviations of the next phase and relative velocity, as series in those of this start."""

    phase: Series
    velocity: Series

    @property
    def monodromy(self) -> tuple[tuple[arb, arb], tuple[arb, arb]]:
        """The linear part."""
        rows = (self.phase, self.velocity)
        (a, b), (c, d) = ((row.coefficient(1, 0), row.coefficient(0, 1)) for row in rows)
        return (a, b), (c, d)


def return_map(contact: EnclosedContact, orbit: Point, order: int = 3) -> ReturnMap:
    """The Taylor series of the return map about an orbit.

    The constant terms of the conditions are exactly 0 on an orbit; they are set to 0.
    """
    phase, speed = (Series.variable(arb(0), k, order) for k in (0, 1))
    u = speed + orbit.u
    sine, cosine = phase.sin_cos()
    x = orbit.x * cosine - orbit.y * sine
    y = orbit.y * cosine + orbit.x * sine
    lag = contact.lag

    # The duration of the contact.
    push = orbit.x * orbit.duration.sin() + orbit.y * orbit.duration.cos()
    pace = orbit.rate + lag * contact.acceleration(orbit.gap, orbit.rate, push)
    later = Series.constant(arb(0), order)
    for _ in range(order):
        gap, rate = contact.state(later + orbit.duration, u, x, y)
        later = later - (gap + lag * rate).without_value() / pace
    gap, rate = contact.state(later + orbit.duration, u, x, y)

    # The duration of the flight, from the table's state at the release.
    turn_sine, turn_cosine = (later + orbit.duration).sin_cos()
    off_x = x * turn_cosine - y * turn_sine
    off_y = y * turn_cosine + x * turn_sine
    more = Series.constant(arb(0), order)
    for _ in range(order):
        height, _velocity = _flight(more + orbit.flight, gap, rate, off_x, off_y)
        more = more - height.without_value() / orbit.u
    _, velocity = _flight(more + orbit.flight, gap, rate, off_x, off_y)
    return ReturnMap(phase + later + more, velocity.without_value())


def _flight(time: Series, gap: Series, rate: Series, x: Series, y: Series):
    """δ and δ′ after a time of flight; (x, y) = (Λ cos, Λ sin) of the phase at the release."""
    sine, cosine = time.sin_cos()
    height = gap + rate * time - time * time / 2 + y * (1 - cosine) + x * (time - sine)
    velocity = rate - time + y * sine + x * (1 - cosine)
    return height, velocity


def flip_coefficient(found: ReturnMap, determinant: arb) -> arb:
    """The cubic coefficient c of the normal form ξ → -ξ + c ξ³ at a period doubling.

    The orbit of twice the period is stable, and the period doubling supercritical, if c > 0
    (Kuznetsov, *Elements of Applied Bifurcation Theory*, Section 5.4)::

        c = ⟨p, C(q, q, q)⟩/6 + ⟨p, B(q, (I - A)⁻¹ B(q, q))⟩/2

    with A q = -q, Aᵀ p = -p and ⟨p, q⟩ = 1.
    """
    (a, b), (c, d) = found.monodromy
    other = -determinant
    # Two forms of each eigenvector, of which one may be uncertain to be different from 0.
    q = (b, -1 - a) if not b.contains(0) else (-1 - d, c)
    p = (c, -1 - a) if not c.contains(0) else (-1 - d, b)
    scale = p[0] * q[0] + p[1] * q[1]
    rows = (found.phase, found.velocity)

    def quadratic(v, w):
        return [
            2 * f.coefficient(2, 0) * v[0] * w[0]
            + f.coefficient(1, 1) * (v[0] * w[1] + v[1] * w[0])
            + 2 * f.coefficient(0, 2) * v[1] * w[1]
            for f in rows
        ]

    def cubic(v):
        return [
            6
            * (
                f.coefficient(3, 0) * v[0] ** 3
                + f.coefficient(2, 1) * v[0] ** 2 * v[1]
                + f.coefficient(1, 2) * v[0] * v[1] ** 2
                + f.coefficient(0, 3) * v[1] ** 3
            )
            for f in rows
        ]

    first = quadratic(q, q)
    # det(I - A) = (1 - μ₁)(1 - μ₂) with μ₁ = -1.
    volume = 2 * (1 - other)
    solved = (
        ((1 - d) * first[0] + b * first[1]) / volume,
        (c * first[0] + (1 - a) * first[1]) / volume,
    )
    mixed = quadratic(q, solved)
    third = cubic(q)
    total = [third[k] / 6 + mixed[k] / 2 for k in (0, 1)]
    return (p[0] * total[0] + p[1] * total[1]) / scale
