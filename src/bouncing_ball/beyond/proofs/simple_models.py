"""The n-T orbits of the restitution model and of the corrected model, with balls for numbers.

Both models are instants with a delay t_c, a restitution r, a load coefficient σ and a duration D
(docs/impact-as-an-instant.md); in the restitution model t_c = σ = D = 0. With X = Λ cos ψ and
Y = Λ sin ψ at the phase ψ of the instant, their orbits satisfy ::

    (1 + r) X - σ Y = s,    s = nπ (1 - r) - σ,    Λ_SN = s/√((1 + r)² + σ²)

and the period doubling lies where this line meets a second one
(:mod:`bouncing_ball.periodic.one_impact.corrected_branch`). Everything is a closed formula.
"""

from dataclasses import dataclass
from typing import Any, Self

from flint import arb

from bouncing_ball.beyond.proofs.branch import EnclosedContact, Number
from bouncing_ball.beyond.proofs.series import Series, angle


@dataclass(frozen=True)
class SimpleModel:
    """A model whose impacts are instants: r, t_c, σ and D as balls or series, and n."""

    n: int
    restitution: Number
    delay: Number
    load: Number
    duration: Number

    @classmethod
    def restitution_model(cls, contact: EnclosedContact, restitution: arb, n: int) -> Self:
        """The model of Eqs. 1-9."""
        none = 0 * contact.frequency_ratio
        return cls(n, restitution, none, none, none)

    @classmethod
    def corrected(cls, contact: EnclosedContact, restitution: arb, n: int) -> Self:
        """The corrected model of a contact whose free impact has this restitution."""
        r = restitution
        duration = contact.free_angle / contact.damped
        through = duration + contact.lag
        return cls(
            n,
            r,
            delay=r * through / (1 + r),
            load=(1 - r) * through - 2 * contact.damping_ratio * (1 + r) / contact.frequency_ratio,
            duration=duration,
        )

    @property
    def launch(self) -> arb:
        """nπ, the velocity of the ball after an instant."""
        return self.n * arb.pi()

    @property
    def _gain(self) -> Number:
        return 1 + self.restitution

    @property
    def _side(self) -> Number:
        return self.launch * (1 - self.restitution) - self.load

    @property
    def _square(self) -> Number:
        return self._gain * self._gain + self.load * self.load

    def instant(self, amplitude: arb) -> tuple[Number, Number]:
        """(X, Y) of the orbit at Λ on the stable side of the saddle-node."""
        side = self._side
        lift = (self._square * amplitude * amplitude - side * side).sqrt()
        x = (side * self._gain + lift * self.load) / self._square
        y = (lift * self._gain - side * self.load) / self._square
        return x, y

    def max_height(self, amplitude: arb) -> Number:
        """Y - v t_c + (nπ)²/2, the apex of the flight."""
        x, y = self.instant(amplitude)
        return y - (x + self.launch) * self.delay + self.launch * self.launch / 2

    def bounce_velocity(self, amplitude: arb) -> Number:
        """z′_b = nπ - (D - t_c), at every Λ."""
        return self.launch - (self.duration - self.delay)

    def phase(self, amplitude: arb) -> Number:
        """φ = ψ - t_c, where the contact starts."""
        return angle(*self.instant(amplitude)) - self.delay

    def apparent_restitution(self, amplitude: arb) -> Number:
        """Eq. 17 with the table's velocities at both ends of the contact."""
        x, y = self.instant(amplitude)
        sine, cosine = _sin_cos(self.delay)
        later_sine, later_cosine = _sin_cos(self.duration - self.delay)
        start = x * cosine + y * sine
        end = x * later_cosine - y * later_sine
        return (self.bounce_velocity(amplitude) - end) / (self.launch - self.delay + start)

    def saddle_node(self, amplitude: arb) -> Number:
        """Λ of the saddle-node."""
        return self._side / self._square.sqrt()

    def period_doubling(self, amplitude: arb) -> Number:
        """Λ of the period doubling, where two lines aX + bY = s and cX + dY = t meet."""
        r = self.restitution
        lever = self.launch - self.delay
        a = self._gain
        b = -self.load
        c = lever * self.load - (1 - r)
        d = lever * (1 + r) - (1 - r) * self.delay
        t = self.launch * (1 + r) - 2 * self.delay
        determinant = a * d - b * c
        x = (self._side * d - b * t) / determinant
        y = (a * t - self._side * c) / determinant
        return (x * x + y * y).sqrt()


def _sin_cos(value: Any) -> tuple[Any, Any]:
    return (value if isinstance(value, Series) else arb(value)).sin_cos()
