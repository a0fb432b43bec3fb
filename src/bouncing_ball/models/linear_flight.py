r"""Flights over a table of several harmonics, with drag or on a spring, and their landings.

With the notation of :mod:`bouncing_ball.models.suspension`, the harmonics
``E_k = X_k + i Y_k = Λ C_k e^{ikφ}`` of W at the phase φ of the release, and the free responses g,
G and H ::

    δ(s) = δ_b + v g + A G - q W′ H + Σ Y_k (1 - cos ks) + X_k (ks - sin ks)
    A = b - q (δ_b + W) - l W′

This form loses no digits in a short flight. The derivative of order j ≥ 1 of p obeys the equation
without load, whose energy ``(p^{(j+1)})² + q (p^{(j)})²`` never rises. From any time on ::

    |δ^{(j)}| ≤ √((p^{(j)})² + q (p^{(j-1)})²) + Λ Σ k^j |C_k|,    j = 2, 3, …

so that the landing search has bounds for every table, drag and spring. In the same way p - b/q
remains within ``R = √((p - b/q)² + p′²/q)``: a mass with ``b/q - R > Λ Σ |C_k|`` never returns to
its stop.
"""

from typing import Any

import numpy as np

from bouncing_ball.models.flight import Lagged
from bouncing_ball.models.suspension import Suspension, free_responses
from bouncing_ball.models.waveform import Waveform, turned
from bouncing_ball.numerics.elementary import sine_and_versine
from bouncing_ball.numerics.first_zero import Derivatives, Motion, first_zero

# The acceleration of a ball that leaves the table from rest vanishes but for rounding errors, which
# are below this part of its terms.
_ROUNDING = 1e-12
_FAR = 1.0


class LinearFlight(Motion):
    """The motion y = -δ of balls in flight; its first upward zero is the landing.

    Parameters
    ----------
    displacement, velocity : array
        δ_b and v, relative to the table.
    phase : array
        The table's phase φ_b.
    amplitude : float or array
        Λ.
    waveform : Waveform
    suspension : Suspension
    """

    def __init__(
        self,
        displacement: np.ndarray,
        velocity: np.ndarray,
        phase: np.ndarray,
        amplitude: Any,
        waveform: Waveform,
        suspension: Suspension,
    ) -> None:
        self.displacement = displacement
        self.velocity = velocity
        self.amplitude = amplitude
        self.waveform = waveform
        self.loss = suspension.loss
        self.stiffness = suspension.stiffness
        self.load = suspension.load
        coefficients = suspension.coefficients(waveform)
        lam = np.broadcast_to(amplitude, np.shape(phase))[..., np.newaxis]
        whole = lam * turned(coefficients, waveform.orders, phase)
        # X_k and Y_k, shape (balls, N).
        self.real = whole.real
        self.imag = whole.imag
        # Λ |C_k|, for the bounds.
        self.size = np.broadcast_to(lam * np.abs(coefficients), whole.shape)
        self.table = self.imag.sum(axis=-1)
        self.table_velocity = (waveform.orders * self.real).sum(axis=-1)
        # A, the acceleration of p at the start but for -l v.
        self.pull = (
            self.load
            - self.stiffness * (displacement + self.table)
            - self.loss * self.table_velocity
        )

    def bound(self, order: int) -> np.ndarray:
        """A bound of the derivative of W of this order."""
        return (self.waveform.orders**order * self.size).sum(axis=-1)

    @property
    def x(self) -> np.ndarray:
        """The rate of change of δ″ of a ball that rests on the table."""
        return self.gap(np.zeros(np.shape(self.velocity)))[3]

    @property
    def y(self) -> np.ndarray:
        """1 + δ″ of a ball that rests on the table."""
        return 1 + self.gap(np.zeros(np.shape(self.velocity)))[2]

    def _moved(self, time: np.ndarray) -> tuple[tuple[np.ndarray, ...], tuple[np.ndarray, ...]]:
        """The derivatives of δ and of p from order 0 on, after a time of flight."""
        at = free_responses(time, self.loss, self.stiffness)
        k = self.waveform.orders
        sine, versine = sine_and_versine(k * time[..., np.newaxis])
        cosine = 1 - versine
        x = self.real
        y = self.imag
        falling = (y * versine + x * (k * time[..., np.newaxis] - sine)).sum(axis=-1)
        slowing = (k * (y * sine + x * versine)).sum(axis=-1)
        w1 = self.table_velocity
        q = self.stiffness
        free = self.displacement + self.velocity * at.impulse + self.pull * at.step
        gap = free - q * w1 * at.ramp + falling
        rate = self.velocity * at.impulse_rate + self.pull * at.impulse - q * w1 * at.step + slowing
        real = x * cosine - y * sine
        imag = y * cosine + x * sine
        height = gap + imag.sum(axis=-1)
        velocity = rate + (w1 - slowing)
        second = self.load - q * height - self.loss * velocity
        third = -self.loss * second - q * velocity
        fourth = -self.loss * third - q * second
        fifth = -self.loss * fourth - q * third
        of_gap = (
            gap,
            rate,
            second + (k**2 * imag).sum(axis=-1),
            third + (k**3 * real).sum(axis=-1),
            fourth - (k**4 * imag).sum(axis=-1),
        )
        return of_gap, (height, velocity, second, third, fourth, fifth)

    def gap(self, time: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
        """δ, δ′, δ″ and δ‴ after a time of flight."""
        of_gap, _ = self._moved(np.asarray(time, dtype=float))
        return of_gap[0], of_gap[1], of_gap[2], of_gap[3]

    def _bounds(self, free: tuple[np.ndarray, ...], orders: tuple[int, ...]) -> list[np.ndarray]:
        """Bounds of the derivatives of δ of these orders, from a time on."""
        q = self.stiffness
        return [
            np.sqrt(free[j] * free[j] + q * free[j - 1] * free[j - 1]) + self.bound(j)
            for j in orders
        ]

    def __call__(self, time: np.ndarray) -> Derivatives:
        (gap, rate, second, third, _), free = self._moved(time)
        by_second, by_third, by_fourth = self._bounds(free, (2, 3, 4))
        return Derivatives(
            value=-gap,
            rate=-rate,
            second=-second,
            third=-third,
            second_bound=by_second,
            third_bound=by_third,
            fourth_bound=by_fourth,
            ended=self._never_lands(free),
        )

    @property
    def may_miss(self) -> bool:
        """Whether a flight may never end: a mass that rests at a distance from its stop."""
        return bool(np.any(np.asarray(self.stiffness) > 0) and np.any(np.asarray(self.load) > 0))

    def _never_lands(self, free: tuple[np.ndarray, ...]) -> np.ndarray | None:
        if not self.may_miss:
            return None
        height, velocity = free[:2]
        rest = self.load / self.stiffness
        swing = np.sqrt((height - rest) ** 2 + velocity * velocity / self.stiffness)
        return rest - swing > self.bound(0)

    def skip(self, time: np.ndarray, steps: int = 0) -> np.ndarray:
        """The end of the time in which z is above the highest point of the table, or the time
        itself; of a ball without drag.
        """
        if np.any(self.loss) or np.any(self.stiffness):
            return time
        absolute = self.velocity + self.table_velocity
        height = self.displacement + (self.table - self.bound(0))
        root = np.sqrt(np.maximum(absolute * absolute + 2 * height, 0.0))
        above = (time >= absolute - root) & (time < absolute + root)
        return np.where(above, absolute + root, time)

    def earliest_landing(self) -> np.ndarray:
        """A time before which the ball has certainly not landed.

        With the bound K of the acceleration at the start it is the flight time of a ball thrown
        with v from δ_b against K. From rest, with δ″ = a ≥ 0 at the start, it follows from
        ``δ ≥ a s²/2 + δ‴ s³/6 - L s⁴/24``.
        """
        (_, _, second, third, _), free = self._moved(np.zeros(np.shape(self.velocity)))
        strongest, _, fourth = self._bounds(free, (2, 3, 4))
        square = self._level_speed_squared(strongest)
        time = (self.velocity + np.sqrt(np.maximum(square, 0.0))) / strongest
        slack = _ROUNDING * (np.abs(free[2]) + self.bound(2))
        rests = (self.velocity == 0) & (self.displacement == 0) & (second >= -slack)
        if not rests.any():
            return time
        lift = np.maximum(second, 0.0)
        by_lift = np.minimum(lift / np.maximum(np.abs(third), 1e-300), np.sqrt(3 * lift / fourth))
        return np.where(rests, np.maximum(by_lift, 4 * third / fourth), time)

    @property
    def strongest(self) -> np.ndarray:
        """A bound of the acceleration δ″."""
        _, free = self._moved(np.zeros(np.shape(self.velocity)))
        return self._bounds(free, (2,))[0]

    @property
    def largest_change(self) -> np.ndarray:
        """A bound of the rate of change of δ″."""
        _, free = self._moved(np.zeros(np.shape(self.velocity)))
        return self._bounds(free, (3,))[0]

    def _level_speed_squared(self, strongest: np.ndarray) -> np.ndarray:
        return self.velocity * self.velocity + 2 * strongest * self.displacement

    def level_speed_squared(self) -> np.ndarray:
        """v² + 2Kδ_b: the square of the relative speed at the table's level against the bound K of
        the acceleration; see :meth:`.Flight.level_speed_squared`.
        """
        return self._level_speed_squared(self.strongest)

    def lagged(self, time: np.ndarray, lag: Any) -> Lagged:
        """y = δ + κ δ′ after a time, with the bounds of its derivatives from this time on.

        P = p + κ p′ obeys the equation of p, so that the energy of its free oscillation bounds its
        derivatives, and a harmonic of W + κ W′ is √(1 + κ²k²) times that of W.
        """
        of_gap, free = self._moved(time)
        y = tuple(of_gap[j] + lag * of_gap[j + 1] for j in range(4))
        of_free = [free[j] + lag * free[j + 1] for j in range(5)]
        k = self.waveform.orders
        turn = np.asarray(lag, dtype=float)[..., np.newaxis] * k
        size = self.size * np.sqrt(1 + turn * turn)
        q = self.stiffness
        bounds = tuple(
            np.sqrt(of_free[j] * of_free[j] + q * of_free[j - 1] * of_free[j - 1])
            + (k**j * size).sum(axis=-1)
            for j in (2, 3, 4)
        )
        return Lagged(y, bounds, of_gap[0], of_free[0], of_free[1])

    def carried(
        self, by: Any, end: Any, time: np.ndarray, velocity: np.ndarray, lag: np.ndarray | float
    ) -> Any:
        """The deviation at the event that ends the flight, of a deviation at its start."""
        at = free_responses(time, self.loss, self.stiffness)
        k = self.waveform.orders
        sine, versine = sine_and_versine(k * time[..., np.newaxis])
        # The changes of W′ and W″ from the start to the end.
        slowed = (k * (self.imag * sine + self.real * versine)).sum(axis=-1)
        pushed = (k**2 * (self.imag * versine - self.real * sine)).sum(axis=-1)
        w1 = self.table_velocity
        w2 = -(k**2 * self.imag).sum(axis=-1)
        q = self.stiffness
        by_phase = w2 * at.impulse - w1 * q * at.step + slowed
        by_phase_rate = w2 * (at.impulse_rate - 1) - w1 * q * at.impulse - pushed
        at_end = type(by)(
            phase=by.phase,
            displacement=by.displacement * (1 - q * at.step)
            + by.velocity * at.impulse
            + by.phase * by_phase,
            velocity=by.velocity * at.impulse_rate
            - by.displacement * q * at.impulse
            + by.phase * by_phase_rate,
        )
        return at_end.to_event(velocity, self.gap(time)[2], lag)

    def lowest(self, time: np.ndarray) -> np.ndarray:
        """The smallest local minimum of δ within each flight of this duration, 1 if there is none.

        The turning points of δ are certified zeros of δ′, one after the other.
        """
        found = np.full(time.shape, _FAR)
        which = np.flatnonzero(np.isfinite(time) & (time > 0))
        part = self.take(which)
        longest = time[which]
        # From rest δ certainly rises at first.
        now = np.where(part.velocity == 0, part.earliest_landing() / 2, 0.0)
        while which.size:
            top = first_zero(_Turning(part, -1.0, longest), now)
            going = np.flatnonzero(~(top.ended | top.undecided) & (top.time < longest))
            which, longest, now = (x[going] for x in (which, longest, top.time))
            part = part.take(going)
            if not which.size:
                break
            bottom = first_zero(_Turning(part, 1.0, longest), now)
            going = np.flatnonzero(~(bottom.ended | bottom.undecided) & (bottom.time < longest))
            which, longest, now = (x[going] for x in (which, longest, bottom.time))
            part = part.take(going)
            if which.size:
                found[which] = np.minimum(found[which], part.gap(now)[0])
        return found


class _Turning(Motion):
    """The motion ±δ′ of balls in flight, whose search ends with the flight."""

    def __init__(self, flight: LinearFlight, sign: float, longest: np.ndarray) -> None:
        self.flight = flight
        self.sign = sign
        self.longest = longest

    def __call__(self, time: np.ndarray) -> Derivatives:
        flight = self.flight
        (_, rate, second, third, fourth), free = flight._moved(time)
        by_third, by_fourth, by_fifth = flight._bounds(free, (3, 4, 5))
        sign = self.sign
        return Derivatives(
            value=sign * rate,
            rate=sign * second,
            second=sign * third,
            third=sign * fourth,
            second_bound=by_third,
            third_bound=by_fourth,
            fourth_bound=by_fifth,
            ended=time > self.longest,
        )


class Pressure(Motion):
    """δ″ of balls that would rest on the table; it rises through 0 where they lift off.

    The search ends after one period of the table.
    """

    def __init__(self, phase: np.ndarray, amplitude: Any, waveform: Waveform, on: Suspension):
        still = np.zeros(phase.shape)
        self.flight = LinearFlight(still, still, phase, amplitude, waveform, on)

    def __call__(self, time: np.ndarray) -> Derivatives:
        flight = self.flight
        k = flight.waveform.orders
        sine, versine = sine_and_versine(k * time[..., np.newaxis])
        cosine = 1 - versine
        real = flight.real * cosine - flight.imag * sine
        imag = flight.imag * cosine + flight.real * sine
        loss = np.asarray(flight.loss)[..., np.newaxis]
        q = np.asarray(flight.stiffness)[..., np.newaxis]
        # Each harmonic of -(W″ + l W′ + q W) is the imaginary part of -(q - k² + ilk) E_k.
        push = k**2 - q
        turn = loss * k
        of_imag = push * imag - turn * real
        of_real = push * real + turn * imag
        size = np.hypot(push, turn) * flight.size
        return Derivatives(
            value=flight.load + of_imag.sum(axis=-1),
            rate=(k * of_real).sum(axis=-1),
            second=-(k**2 * of_imag).sum(axis=-1),
            third=-(k**3 * of_real).sum(axis=-1),
            second_bound=(k**2 * size).sum(axis=-1),
            third_bound=(k**3 * size).sum(axis=-1),
            fourth_bound=(k**4 * size).sum(axis=-1),
            ended=time > 2 * np.pi + _ROUNDING,
        )
