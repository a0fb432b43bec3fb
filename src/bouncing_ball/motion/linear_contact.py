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
"""

import numpy as np

from bouncing_ball.contacts.elementary import arctangent, exponential, sine_and_cosine
from bouncing_ball.contacts.spring_damper import SpringDamper
from bouncing_ball.motion.first_zero import Motion, State

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
    """The motion y = δ + κ δ′ of balls in contact.

    Parameters
    ----------
    contact : SpringDamper
        One contact, or one for each ball, for which :func:`has_closed_form` is true.
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
        detuning, loss = _resistance(contact)
        gamma = detuning * detuning + loss * loss
        # Coefficients of Λ sin τ and Λ cos τ in the steady response to Λ sin τ + κ Λ cos τ.
        in_phase, quadrature = (detuning + lag * loss) / gamma, (lag * detuning - loss) / gamma
        self.steady = amplitude * np.sqrt(in_phase * in_phase + quadrature * quadrature)
        self.forcing = amplitude * np.sqrt(1 + lag * lag)
        self.sine, self.cosine = in_phase * x - quadrature * y, in_phase * y + quadrature * x
        # The forcing Λ sin φ + κ Λ cos φ at the start.
        self.push = y + lag * x
        self.start, self.start_rate = self._observed(displacement, velocity, y)
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
