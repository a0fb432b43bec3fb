r"""Contact with the spring-damper, from its start to its release.

The release is the first upward zero of ``y = δ + κ δ′``, which is negative in contact. For the
displacement release κ = 0; for the force release κ = 2ζ/ϖ, so that ``-ϖ² y`` is the force of
the table over the weight. In both cases ::

    y″ + 2a y′ + ϖ² y = -1 + Λ sin τ + κ Λ cos τ,       a = ζϖ
    y(s) = e^{-as} (A cos ϖ_d s + B sin ϖ_d s) - 1/ϖ² + C sin s + D cos s

(Eqs. 12-13 for κ = 0). The transient's derivative of order k is at most
``ϖ^k R e^{-as}``, R = √(A² + B²), and each derivative of the steady part at most
ρ = √(C² + D²). The contact therefore never ends if at some time ::

    R e^{-as} + ρ ≤ 1/ϖ²

Next to the undamped resonance the steady part is lost in rounding, and the contact's flow gives the
motion instead. Let e² = y′² + ϖ² (y + 1/ϖ²)². Damping only decreases it, and the forcing, at most
``F = Λ √(1 + κ²)``, increases e by at most F in a time 1. Within this time \|y′\| ≤ e + F, and
bounds of the higher derivatives follow from the equation of motion.
"""

from dataclasses import dataclass

import numpy as np

from bouncing_ball.numerics.elementary import (
    arctangent,
    exponential,
    sine_and_cosine,
    sine_and_versine,
)
from bouncing_ball.numerics.first_zero import Motion, State, first_zero
from bouncing_ball.paper.contact.spring_damper import SpringDamper
from bouncing_ball.paper.motion.deviations import Deviation, Jacobian
from bouncing_ball.paper.motion.dynamics import Departure, Impact
from bouncing_ball.paper.motion.flight import Flight, table
from bouncing_ball.paper.motion.resumption import ResumingDynamics
from bouncing_ball.paper.motion.sequence import Status

# The closed form is used for √γ above this value: the relative error of the steady part is ε/√γ.
_RESONANCE = 1e-4
# Number of steps after which the expensive bound of :meth:`ContactMotion.skip` is used.
_PATIENCE = 12
# Bound of the rounding errors of the three terms of the inequality above.
_ROUNDING = 8 * np.finfo(float).eps


def _resistance(contact: SpringDamper):
    """ϖ² - 1 and 2ζϖ, the sum of whose squares is γ."""
    omega = np.asarray(contact.frequency_ratio, dtype=float)
    return (omega - 1) * (omega + 1), 2 * np.asarray(contact.damping_ratio) * omega


def has_closed_form(contact: SpringDamper) -> bool:
    """Whether all contacts are underdamped and away from the undamped resonance ζ = 0, ϖ = 1.

    Examples
    --------
    >>> has_closed_form(SpringDamper(2.0, 0.1)), has_closed_form(SpringDamper(1.0, 0.0))
    (True, False)
    """
    underdamped = np.all(np.asarray(contact.damping_ratio) < 1)
    return bool(underdamped and np.all(np.hypot(*_resistance(contact)) >= _RESONANCE))


class ContactMotion(Motion):
    """The motion y = δ + κ δ′ of balls in contact, away from the resonance.

    Parameters
    ----------
    contact : SpringDamper
        One underdamped contact, or one for each ball.
    amplitude : float or array
        Λ.
    displacement, velocity : array
        δ and δ′ at the start.
    x, y : array
        Λ cos φ and Λ sin φ at the start.
    """

    def __init__(self, contact: SpringDamper, amplitude, displacement, velocity, x, y):
        omega, zeta, lag = contact.frequency_ratio, contact.damping_ratio, contact.lag
        self.omega, self.stiffness, self.decay, self.lag = omega, omega * omega, zeta * omega, lag
        self.damped = contact.damped_frequency
        self.forcing = amplitude * np.sqrt(1 + lag * lag)
        # The forcing Λ sin φ + κ Λ cos φ at the start.
        self.push = y + lag * x
        self.start, self.start_rate = self._observed(displacement, velocity, y)
        self._split(contact, amplitude, x, y)

    def _split(self, contact: SpringDamper, amplitude, x, y) -> None:
        detuning, loss = _resistance(contact)
        gamma, lag = detuning * detuning + loss * loss, self.lag
        # Coefficients of Λ sin τ and Λ cos τ in the steady response to Λ sin τ + κ Λ cos τ.
        in_phase, quadrature = (detuning + lag * loss) / gamma, (lag * detuning - loss) / gamma
        self.steady = amplitude * np.sqrt(in_phase * in_phase + quadrature * quadrature)
        self.sine, self.cosine = in_phase * x - quadrature * y, in_phase * y + quadrature * x
        self.a = self.start + (1 / self.stiffness - self.cosine)
        self.b = (self.start_rate - self.sine + self.decay * self.a) / self.damped
        self.envelope = np.sqrt(self.a * self.a + self.b * self.b)

    def _observed(self, displacement, velocity, y):
        """y and y′ from δ and δ′."""
        acceleration = (y - 1) - 2 * self.decay * velocity - self.stiffness * displacement
        return displacement + self.lag * velocity, velocity + self.lag * acceleration

    def state(self, displacement_rate, y):
        """δ and δ′ at a release with the rate y′, where ``y`` is the table's height Λ sin τ."""
        lag = self.lag
        velocity = displacement_rate - lag * (y - 1)
        return -lag * velocity, velocity

    def __call__(self, time: np.ndarray) -> State:
        angles = np.array([self.damped * time, time])
        (sine, slow_sine), (cosine, slow_cosine) = sine_and_cosine(angles)
        decay = exponential(-self.decay * time)
        a, b = self.a * decay, self.b * decay
        free = a * cosine + b * sine
        free_rate = self.damped * (b * cosine - a * sine) - self.decay * free
        free_second = -2 * self.decay * free_rate - self.stiffness * free
        free_third = -2 * self.decay * free_second - self.stiffness * free_rate
        forced = self.sine * slow_sine + self.cosine * slow_cosine
        forced_rate = self.sine * slow_cosine - self.cosine * slow_sine
        level = 1 / self.stiffness
        envelope = self.envelope * decay
        bound = self.stiffness * envelope
        return State(
            (free - level) + forced,
            free_rate + forced_rate,
            free_second - forced,
            free_third - forced_rate,
            bound + self.steady,
            self.omega * bound + self.steady,
            self.stiffness * bound + self.steady,
            envelope + (self.steady - level) <= _ROUNDING * level,
        )

    def skip(self, time: np.ndarray, steps: int) -> np.ndarray:
        """A time up to which y is negative, because its bound by the transient's envelope is.

        The bound is negative until the steady part rises through 1/ϖ² - R e^{-as}. Without it
        a stiff, weakly damped contact would need steps over about ϖ oscillations.
        """
        if steps < _PATIENCE:
            return time
        level = 1 / self.stiffness - self.envelope * exponential(-self.decay * time)
        ratio = level / np.maximum(self.steady, 1e-300)
        inside = np.abs(ratio) < 1
        ratio = np.where(inside, ratio, 0.0)
        rising = arctangent(ratio, np.sqrt((1 - ratio) * (1 + ratio)))
        now = time + arctangent(self.cosine, self.sine)
        below = inside & (sine_and_cosine(now)[0] < ratio)
        # The result precedes the crossing by more than the rounding error of the crossing.
        wait = np.mod(rising - now, 2 * np.pi) - 1e-9
        # Rounding must not postpone a crossing at the present time by a full turn.
        wait = np.where(wait > 2 * np.pi - 1e-6, 0.0, wait)
        return time + np.where(below, np.maximum(wait, 0.0), 0.0)

    def sure(self) -> np.ndarray:
        """A time before which the contact has certainly not ended, within half a period.

        Replace the forcing by a constant P, its largest value within the half period. The
        contact then ends earlier, because the impulse response is positive there.
        Its motion is ``e^{-as} (A′ cos θ + B′ sin θ) + P/ϖ²``, which is
        negative where ``A′ cos θ + B′ sin θ < -e^{aπ/ϖ_d} P/ϖ²``; once it is
        positive it remains positive for longer than half a period.
        """
        half = np.pi / self.damped
        # Near critical damping the exponent is limited against overflow; a factor of this size
        # already makes the bound ineffective.
        growth = exponential(np.minimum(self.decay * half, 690.0))
        forcing = np.minimum(self.push + self.forcing * half, self.forcing) - 1
        level = np.maximum(forcing, 0.0) / self.stiffness
        a = self.start - level
        b = (self.start_rate + self.decay * a) / self.damped
        radius = np.sqrt(a * a + b * b)
        depth = np.minimum(growth * level / np.maximum(radius, 1e-300), 1.0)
        # The angle of (a, b), rotated by half a turn because that avoids a jump for a < 0, and the
        # angle whose cosine is ``depth``: their sum is within half a turn.
        rest = np.sqrt((1 - depth) * (1 + depth))
        angle = arctangent(-b * depth - a * rest, b * rest - a * depth)
        angle = np.where((depth < 1) & (angle > 0), angle, 0.0)
        return angle / self.damped


class ResonantMotion(ContactMotion):
    """The motion y of balls whose contact is at the undamped resonance, or near it.

    y moves as δ does, with another forcing. The bounds hold for a time 1 and are raised such that
    no step is longer.
    """

    def _split(self, contact: SpringDamper, amplitude, x, y) -> None:
        self.zeta, self.phase = contact.damping_ratio, np.arctan2(self.push, x - self.lag * y)

    def __call__(self, time: np.ndarray) -> State:
        start = self.start, self.start_rate, self.phase, self.forcing
        value, rate, second, _ = SpringDamper(self.omega, self.zeta).flow(time, *start)
        loss, stiffness, forcing = 2 * self.decay, self.stiffness, self.forcing
        third = table(self.phase + time, forcing)[0] - loss * second - stiffness * rate
        moved = np.sqrt(rate * rate + (self.omega * value + 1 / self.omega) ** 2)
        fast = moved + forcing
        by_second = forcing + (loss + self.omega) * fast
        by_third = forcing + loss * by_second + stiffness * fast
        by_fourth = forcing + loss * by_third + stiffness * by_second
        by_second = np.maximum(by_second, -2 * (value + rate))
        by_third = np.maximum(by_third, 3 * np.abs(second))
        by_fourth = np.maximum(by_fourth, 12 * (by_second + np.abs(second)))
        # Without forcing, a free oscillation of at most this size never ends the contact.
        ended = (forcing == 0) & (moved * self.omega <= 1)
        return State(value, rate, second, third, by_second, by_third, by_fourth, ended)

    def skip(self, time: np.ndarray, steps: int) -> np.ndarray:
        return time


@dataclass(frozen=True, repr=False)
class LinearContactDynamics(ResumingDynamics):
    """The dynamics of an underdamped
    :class:`~bouncing_ball.paper.contact.spring_damper.SpringDamper`.
    """

    def depart(self, impact: Impact, *, differentiate: bool = False) -> Departure:
        """The end of each contact, or permanent contact if it is proved never to end."""
        x, y = table(impact.phase, self.amplitude)
        state = impact.displacement, impact.velocity
        kind = ContactMotion if has_closed_form(self.law) else ResonantMotion
        motion = kind(self.law, self.amplitude, *state, x, y)
        # Where the search ended without a release, the contact is permanent.
        end = first_zero(motion, motion.sure())
        phase = impact.phase + end.time
        x, y = table(phase, self.amplitude)
        # If the ball just reaches the table's level, rounding may give it a downward velocity.
        displacement, velocity = motion.state(np.maximum(end.rate, 0.0), y)
        status = np.where(end.ended, Status.PERMANENT_CONTACT, Status.BOUNCING)
        status[end.undecided] = Status.UNDECIDED
        forever = status != Status.BOUNCING
        displacement[forever] = velocity[forever] = np.nan
        end.time[forever] = np.inf
        flight = Flight(displacement, velocity, x, y, self.amplitude)
        # An undamped contact that starts at zero speed under a constant load lasts exactly one
        # oscillation. A longer contact therefore ends because the load changes.
        sticks = end.time * self.law.damped_frequency > 2 * np.pi
        return Departure(phase, end.time, flight, status, sticks=sticks)

    def jacobian(
        self, impact: Impact, departure: Departure, after: Impact, passed: np.ndarray
    ) -> Jacobian:
        """Derivative of the map over contact and flight, in closed form."""
        contact, flight, duration = self.law, departure.flight, departure.duration
        omega, damped, lag = contact.frequency_ratio, contact.damped_frequency, contact.lag
        stiffness, loss = omega**2, 2 * contact.damping_ratio * omega
        sine, versine = sine_and_versine(damped * duration)
        decay = exponential(-loss / 2 * duration)
        impulse = decay * sine / damped
        impulse_rate = decay * (1 - versine) - loss / 2 * impulse
        level = impulse_rate + loss * impulse
        depth, rate = impact.displacement, impact.velocity
        _, y = table(impact.phase, self.amplitude)
        first = (y - 1) - loss * rate - stiffness * depth
        left, speed = flight.displacement, flight.velocity
        last = (flight.y - 1) - loss * speed - stiffness * left
        # A deviation along the motion changes only the time.
        fall = speed - level * rate - impulse * first
        pull = last + stiffness * impulse * rate - impulse_rate * first
        before, held = (np.where(x < 0, lag, 0.0) for x in (depth, after.displacement))
        by_rate = impulse - before * level, impulse_rate + before * stiffness * impulse
        one = np.ones_like(passed)
        moved = Deviation(one, fall, pull), Deviation(0 * one, *by_rate)
        released = (x.to_event(speed, last, lag) for x in moved)
        return self.landed(released, departure, after, passed, held)
