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

from collections.abc import Callable
from dataclasses import dataclass
from typing import ClassVar, NamedTuple

import numpy as np

from bouncing_ball_beyond.inherited.models.flight import table
from bouncing_ball_beyond.inherited.models.model import Status
from bouncing_ball_beyond.inherited.models.spring_damper import flow as linear_flow
from bouncing_ball_beyond.inherited.numerics.elementary import (
    arctangent,
    exponential,
    sine_and_versine,
)
from bouncing_ball_beyond.inherited.numerics.first_zero import Derivatives, Motion, Zero, first_zero
from bouncing_ball_beyond.models.contacts_and_flights import Departure, DurationSlopes, Impact
from bouncing_ball_beyond.models.deviations import Deviation, Jacobian, Released
from bouncing_ball_beyond.models.flight import Flight
from bouncing_ball_beyond.models.laws.contact_law import OscillatorLaw
from bouncing_ball_beyond.models.oscillator import steady_response, table_response
from bouncing_ball_beyond.models.resumption import ResumingDynamics

# The number of steps after which the expensive bound of ``skip`` is used.
_PATIENCE = 12
# A bound of the rounding errors of the three terms of the inequality above.
_ROUNDING = np.array(8 * np.finfo(float).eps)
# Constants are arrays without an axis, as in
# :mod:`bouncing_ball_beyond.inherited.numerics.elementary`.
_ZERO = np.array(0.0)
_ONE = np.array(1.0)
_TWO = np.array(2.0)
_PI = np.array(np.pi)
_TURN = np.array(2 * np.pi)
_LARGEST_GROWTH = np.array(690.0)
_TINY = np.array(1e-300)
# Newton's steps to a zero, and the largest last step relative to the time.
_NEWTON_STEPS = 5
_SETTLED = 1e-5


def nearest_zero(motion: "ContactMotion", about: np.ndarray) -> Zero:
    """The zero of each motion near a time, by Newton's method, whether it is the first or not.

    The last step is small against the time, and the error is of the order of its square: equations
    that are solved together with the zero lose nothing, and a zero is its own nearest zero.
    ``undecided`` marks the motions for which the last step was not small.

    Examples
    --------
    >>> class Parabola:
    ...     def up_to_second(self, time):
    ...         return time**2 - 4, 2 * time, np.full_like(time, 2.0)
    >>> found = nearest_zero(Parabola(), np.array([2.0, 2.2]))
    >>> found.time.round(9).tolist(), found.undecided.tolist()
    ([2.0, 2.0], [False, False])
    """
    time = about
    rate = np.full(time.shape, np.nan)
    settled = np.zeros(time.shape, dtype=bool)
    for _ in range(_NEWTON_STEPS):
        value, slope, second = motion.up_to_second(time)
        later = -value / slope
        rate = np.where(settled, rate, slope + later * second)
        time = np.where(settled, time, time + later)
        settled |= np.abs(later) <= _SETTLED * np.abs(time)
        if np.all(settled | np.isnan(later)):
            break
    return Zero(time, rate, np.zeros(time.shape, dtype=bool), ~settled)


class ContactMotion(Motion):
    """The motion y = δ + κ δ′ of balls in contact.

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

    def __init__(self, contact: OscillatorLaw, amplitude, displacement, velocity, x, y):
        self.omega = contact.frequency_ratio
        self.zeta = contact.damping_ratio
        self.lag = contact.lag
        self.damped = contact.damped_frequency
        self.stiffness = contact.stiffness
        self.decay = contact.decay_rate
        # The amplitude of the forcing Λ sin τ + κ Λ cos τ of y, and its value at the start.
        self.forcing = amplitude * np.sqrt(_ONE + self.lag * self.lag)
        self.push = y + self.lag * x
        acceleration = (y - _ONE) - _TWO * self.decay * velocity - self.stiffness * displacement
        self.start = displacement + self.lag * velocity
        self.start_rate = velocity + self.lag * acceleration

    def height(self, time: np.ndarray) -> np.ndarray:
        """y at times since the start."""
        return self(time).value

    def up_to_second(self, time: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """y, y′ and y″ at times since the start."""
        at = self(time)
        return at.value, at.rate, at.second

    def release(self, end: Zero, height: np.ndarray) -> np.ndarray:
        """δ′ at a release, where the table's height is Λ sin τ."""
        return end.rate - self.lag * (height - _ONE)

    def earliest_release(self) -> np.ndarray:
        """A time before which the contact has certainly not ended, within half a period.

        Replace the forcing by a constant P, its largest value within the half period. The
        contact then ends earlier, because the impulse response is positive there.
        Its motion is ``e^{-as} (A′ cos θ + B′ sin θ) + P/ϖ²``, which is
        negative where ``A′ cos θ + B′ sin θ < -e^{aπ/ϖ_d} P/ϖ²``; once it is
        positive it remains positive for longer than half a period.
        """
        half = _PI / self.damped
        # Near critical damping the exponent is limited against overflow; a factor of this size
        # already makes the bound ineffective.
        growth = exponential(np.minimum(self.decay * half, _LARGEST_GROWTH))
        forcing = np.minimum(self.push + self.forcing * half, self.forcing) - _ONE
        level = np.maximum(forcing, _ZERO) / self.stiffness
        a = self.start - level
        b = (self.start_rate + self.decay * a) / self.damped
        radius = np.sqrt(a * a + b * b)
        depth = np.minimum(growth * level / np.maximum(radius, _TINY), _ONE)
        # The angle of (a, b), rotated by half a turn because that avoids a jump for a < 0, and the
        # angle whose cosine is ``depth``: their sum is within half a turn.
        rest = np.sqrt((_ONE - depth) * (_ONE + depth))
        angle = arctangent(-b * depth - a * rest, b * rest - a * depth)
        angle = np.where((depth < _ONE) & (angle > _ZERO), angle, _ZERO)
        return angle / self.damped


class _Oscillations(NamedTuple):
    """The decay of the transient at some times, the transient A cos θ + B sin θ with this decay,
    the same a quarter of a turn ahead, and the steady part and its rate.
    """

    decay: np.ndarray
    free: np.ndarray
    across: np.ndarray
    forced: np.ndarray
    forced_rate: np.ndarray


class ClosedFormMotion(ContactMotion):
    """The motion y away from the resonance, as the sum of the transient and the steady part: δ of
    Eq. 12 with its constants A and B, and for the force release δ + κ δ′.

    For δ the steady part is that of Eq. 12 less the table, with β and χ - 1 = (ϖ² - 1)/γ::

        δ = z - Λ sin(s + φ) = e^{-ζϖs} (A cos ϖ_d s + B sin ϖ_d s) - 1/ϖ² + C sin s + D cos s
        C sin s + D cos s = βΛ cos(s + φ) + (χ - 1)Λ sin(s + φ)

    The start of the contact, δ₀ and δ′₀, determines A = δ₀ + 1/ϖ² - D and
    B = (δ′₀ - C + ζϖA)/ϖ_d. A, B, C and D are ``a``, ``b``, ``sine`` and ``cosine``.
    """

    def __init__(self, contact: OscillatorLaw, amplitude, displacement, velocity, x, y):
        super().__init__(contact, amplitude, displacement, velocity, x, y)
        # Coefficients of Λ sin τ and Λ cos τ in the steady response to Λ sin τ + κ Λ cos τ.
        in_phase, quadrature = steady_response(
            _ONE, self.lag, contact.detuning, contact.loss, contact.off_resonance
        )
        self.steady = amplitude * np.sqrt(in_phase * in_phase + quadrature * quadrature)
        self.sine = in_phase * x - quadrature * y
        self.cosine = in_phase * y + quadrature * x
        self.a = self.start + (_ONE / self.stiffness - self.cosine)
        self.b = (self.start_rate - self.sine + self.decay * self.a) / self.damped
        self.envelope = np.sqrt(self.a * self.a + self.b * self.b)

    def _oscillations(self, time: np.ndarray) -> _Oscillations:
        angles = np.array([self.damped * time, time])
        (sine, slow_sine), versines = sine_and_versine(angles)
        cosine, slow_cosine = _ONE - versines
        decay = exponential(-self.decay * time)
        a = self.a * decay
        b = self.b * decay
        return _Oscillations(
            decay=decay,
            free=a * cosine + b * sine,
            across=b * cosine - a * sine,
            forced=self.sine * slow_sine + self.cosine * slow_cosine,
            forced_rate=self.sine * slow_cosine - self.cosine * slow_sine,
        )

    def _value(self, at: _Oscillations) -> np.ndarray:
        """y."""
        return (at.free - _ONE / self.stiffness) + at.forced

    def _free_rates(self, at: _Oscillations) -> tuple[np.ndarray, np.ndarray]:
        """The first two derivatives of the transient."""
        rate = self.damped * at.across - self.decay * at.free
        return rate, -_TWO * self.decay * rate - self.stiffness * at.free

    def height(self, time: np.ndarray) -> np.ndarray:
        """y at times since the start."""
        return self._value(self._oscillations(time))

    def up_to_second(self, time: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """y, y′ and y″ at times since the start."""
        at = self._oscillations(time)
        free_rate, free_second = self._free_rates(at)
        return self._value(at), free_rate + at.forced_rate, free_second - at.forced

    def __call__(self, time: np.ndarray) -> Derivatives:
        at = self._oscillations(time)
        free_rate, free_second = self._free_rates(at)
        free_third = -_TWO * self.decay * free_second - self.stiffness * free_rate
        level = _ONE / self.stiffness
        envelope = self.envelope * at.decay
        bound = self.stiffness * envelope
        return Derivatives(
            value=self._value(at),
            rate=free_rate + at.forced_rate,
            second=free_second - at.forced,
            third=free_third - at.forced_rate,
            second_bound=bound + self.steady,
            third_bound=self.omega * bound + self.steady,
            fourth_bound=self.stiffness * bound + self.steady,
            ended=envelope + (self.steady - level) <= _ROUNDING * level,
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
        below = inside & (sine_and_versine(now)[0] < ratio)
        # The result precedes the crossing by more than the rounding error of the crossing.
        wait = np.mod(rising - now, 2 * np.pi) - 1e-9
        # Rounding must not postpone a crossing at the present time by a full turn.
        wait = np.where(wait > 2 * np.pi - 1e-6, 0.0, wait)
        return time + np.where(below, np.maximum(wait, 0.0), 0.0)


class ResonantMotion(ContactMotion):
    """The motion y of balls whose contact is at the undamped resonance, or near it.

    y moves as δ does, with another forcing. The bounds hold for a time 1 and are raised such that
    no step is longer.
    """

    def __init__(self, contact: OscillatorLaw, amplitude, displacement, velocity, x, y):
        super().__init__(contact, amplitude, displacement, velocity, x, y)
        # The phase of the forcing Λ sin τ + κ Λ cos τ at the start.
        self.phase = np.arctan2(self.push, x - self.lag * y)

    def __call__(self, time: np.ndarray) -> Derivatives:
        state = time, self.phase, self.start_rate, self.forcing, self.start
        flow = linear_flow(self.omega, self.zeta, *state)
        value = flow.displacement
        rate = flow.velocity
        second = flow.acceleration
        loss = 2 * self.decay
        stiffness = self.stiffness
        forcing = self.forcing
        third = table(self.phase + time, forcing)[0] - loss * second - stiffness * rate
        # e, and the bound of |y′| within a time 1.
        moved = np.sqrt(rate * rate + (self.omega * value + 1 / self.omega) ** 2)
        fast = moved + forcing
        by_second = forcing + (loss + self.omega) * fast
        by_third = forcing + loss * by_second + stiffness * fast
        by_fourth = forcing + loss * by_third + stiffness * by_second
        by_second = np.maximum(by_second, -2 * (value + rate))
        by_third = np.maximum(by_third, 3 * np.abs(second))
        by_fourth = np.maximum(by_fourth, 12 * (by_second + np.abs(second)))
        return Derivatives(
            value=value,
            rate=rate,
            second=second,
            third=third,
            second_bound=by_second,
            third_bound=by_third,
            fourth_bound=by_fourth,
            # Without forcing, a free oscillation of at most this size never ends the contact.
            ended=(forcing == 0) & (moved * self.omega <= 1),
        )


@dataclass(frozen=True, repr=False)
class LinearContactDynamics(ResumingDynamics):
    """The dynamics of an underdamped
    :class:`~bouncing_ball_beyond.models.spring_damper.SpringDamper`.
    """

    continues: ClassVar[bool] = True

    def depart(
        self, impact: Impact, *, near: np.ndarray | None = None, differentiate: bool = False
    ) -> Departure:
        """The end of each contact, or permanent contact if it is proved never to end.

        It is the first τ_b > 0 with z(τ_b) = Λ sin(τ_b + φ), that is δ = 0 (Eq. 23), and for the
        force release with δ + κ δ′ = 0. With ``near`` it is the end near this duration, also beyond
        an earlier end.
        """
        motion = self._motion(impact)
        if near is not None:
            departure = self._ended(impact, motion, nearest_zero(motion, near))
            released = self._released(impact, departure)
            # Through the release condition.
            slopes = DurationSlopes(released.by_phase.phase - _ONE, released.by_velocity.phase)
            return departure._replace(by=released, slopes=slopes)
        end = first_zero(motion, motion.earliest_release())
        # If the ball just reaches the table's level, rounding may give it a downward velocity.
        return self._ended(impact, motion, end._replace(rate=np.maximum(end.rate, _ZERO)))

    def within(
        self, impact: Impact, departure: Departure, time: np.ndarray
    ) -> tuple[np.ndarray, np.ndarray]:
        """δ and δ′ at times since the starts of contacts, of shape (..., contacts), whether the
        contacts have ended or not.
        """
        start = impact.displacement, impact.velocity, impact.phase
        state = self.law.flow(time, *start, self.amplitude)
        return state.displacement, state.velocity

    def release_function(
        self, impact: Impact, departure: Departure
    ) -> Callable[[np.ndarray], np.ndarray]:
        """δ + κ δ′ within contacts, in closed form."""
        return self._motion(impact).height

    def contraction(self, impact: Impact, departure: Departure) -> np.ndarray:
        """exp(-2ζϖD), because areas contract in contact at the rate 2ζϖ."""
        return np.exp(-self.law.loss * departure.duration)

    def _motion(self, impact: Impact) -> ClosedFormMotion | ResonantMotion:
        """y = δ + κ δ′ in contact."""
        x, y = self.table_at(impact)
        kind = ClosedFormMotion if self.law.has_closed_form else ResonantMotion
        return kind(self.law, self.amplitude, impact.displacement, impact.velocity, x, y)

    def _ended(self, impact: Impact, motion: ContactMotion, end: Zero) -> Departure:
        """The departures of contacts that end at these zeros of their motion."""
        status = np.full(end.time.shape, int(Status.BOUNCING))
        duration = end.time
        phase = impact.phase + end.time
        x, y = table(phase, self.amplitude)
        velocity = motion.release(end, y)
        forever = end.ended | end.undecided
        if forever.any():
            # Where the search ended without a release, the contact is permanent.
            status[end.ended] = Status.PERMANENT_CONTACT
            status[end.undecided] = Status.UNDECIDED
            duration = np.where(forever, np.inf, duration)
            velocity = np.where(forever, np.nan, velocity)
        displacement = -self.law.lag * velocity
        flight = Flight(displacement, velocity, x, y, self.amplitude)
        # An undamped contact that starts at zero speed under a constant load lasts exactly one
        # oscillation. A longer contact therefore ends because the load changes.
        sticks = duration * self.law.damped_frequency > _TURN
        return Departure(phase, duration, flight, status, sticks=sticks)

    def jacobian(
        self, impact: Impact, departure: Departure, after: Impact, passed: np.ndarray
    ) -> Jacobian:
        """Derivative of the map over contact and flight, in closed form."""
        lag = self.law.lag * after.is_resumption
        released = departure.by or self._released(impact, departure)
        return self.over_flight(released, departure, after, passed, lag)

    def _released(self, impact: Impact, departure: Departure) -> Released:
        """The deviations at the release of unit deviations of φ and of δ′ at the impact.

        The responses Q and P to the table (:mod:`bouncing_ball_beyond.models.oscillator`) give that
        of φ. Where a contact forgets its start, the rounding errors of these responses would
        remain. There a deviation of φ is one along the motion, which changes only the time, less
        one of the state at the start, which decays.
        """
        contact = self.law
        flight = departure.flight
        duration = departure.duration
        stiffness = contact.stiffness
        loss = contact.loss
        half = contact.decay_rate
        # The impulse response g, g′, and g′ + 2ζϖ g, the response to a unit displacement.
        angles = np.array([contact.damped_frequency * duration, duration])
        (sine, slow_sine), (versine, slow_versine) = sine_and_versine(angles)
        decay = exponential(-half * duration)
        impulse = decay * sine / contact.damped_frequency
        impulse_rate = decay * (_ONE - versine) - half * impulse
        level = impulse_rate + loss * impulse
        in_phase, quadrature = table_response(
            duration,
            contact.frequency_ratio,
            contact.damping_ratio,
            real=(_ONE - slow_versine) - level,
            imaginary=slow_sine - impulse,
        )
        x, y = self.table_at(impact)
        speed = flight.velocity
        last = (flight.y - _ONE) - loss * speed - stiffness * flight.displacement
        # A contact that resumes starts at δ + κ δ′ = 0: its displacement deviates by -κ dδ′.
        lag = contact.lag * impact.is_resumption
        first = (y - _ONE) - loss * impact.velocity - stiffness * impact.displacement
        # The last digits of this form are multiplied by ϖ and by the decay.
        forgets = decay * contact.frequency_ratio < _ONE
        by_phase = Deviation(
            phase=np.where(forgets, _ZERO, _ONE),
            displacement=np.where(
                forgets,
                -(level * impact.velocity + impulse * first),
                x * in_phase - y * quadrature,
            ),
            velocity=np.where(
                forgets,
                stiffness * impulse * impact.velocity - impulse_rate * first,
                x * (impulse - quadrature) - y * in_phase,
            ),
        )
        by_velocity = Deviation(
            phase=np.zeros(duration.shape),
            displacement=impulse - lag * level,
            velocity=impulse_rate + lag * stiffness * impulse,
        )
        return Released(
            by_phase.to_event(speed, last, contact.lag),
            by_velocity.to_event(speed, last, contact.lag),
        )
