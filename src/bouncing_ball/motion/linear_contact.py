r"""Contact with the spring-damper, from touching to release.

What is followed is ``y = δ + κ δ′``, with κ = 0 for the displacement release
and κ = 2ζ/ϖ for the force release, where ``-ϖ² y`` is the force of the table
over the weight. In both cases y < 0 in contact, the release is the first
upward zero, and ::

    y″ + 2a y′ + ϖ² y = -1 + Λ sin τ + κ Λ cos τ,       a = ζϖ
    y(s) = e^{-as} (A cos ϖ_d s + B sin ϖ_d s) - 1/ϖ² + C sin s + D cos s

(Eqs. 12-13 for κ = 0). The transient's derivatives of order k are below
``ϖ^k R e^{-as}``, R = √(A² + B²), those of the steady part below ρ = √(C² + D²).
Hence also the certificate that the contact never ends::

    R e^{-as} + ρ ≤ 1/ϖ²
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from bouncing_ball.contacts.spring_damper import SpringDamper
from bouncing_ball.errors import ModelError
from bouncing_ball.motion.angles import sine_and_versine
from bouncing_ball.motion.first_zero import Motion, State, Zero, first_zero

# √γ below which the steady part has lost too many digits: ε/√γ remain.
_RESONANCE = 1e-4
# Steps before the long view of :meth:`ContactMotion.skip` is taken.
_PATIENCE = 12
# Rounding of the three terms of the certificate.
_ROUNDING = 8 * np.finfo(float).eps


class Oscillator(NamedTuple):
    """The constants of the contact, from ϖ, ζ, the release rule and Λ.

    ``lag`` is κ; ``in_phase`` and ``quadrature`` the steady response to
    Λ sin τ + κ Λ cos τ over Λ sin τ and Λ cos τ; ``half`` the half period
    π/ϖ_d and ``growth`` e^{aπ/ϖ_d}.
    """

    amplitude: np.ndarray
    stiffness: np.ndarray
    omega: np.ndarray
    decay: np.ndarray
    damped: np.ndarray
    lag: np.ndarray
    in_phase: np.ndarray
    quadrature: np.ndarray
    steady: np.ndarray
    forcing: np.ndarray
    half: np.ndarray
    growth: np.ndarray


def oscillator(contact: SpringDamper, amplitude: ArrayLike) -> Oscillator:
    """Constants of the contact of each ball; scalars stay scalars.

    Raises
    ------
    ModelError
        If ζ ≥ 1, or ζ and ϖ - 1 are so small that the steady part at the
        resonance does not exist in floating point.
    """
    # By arrays of one element, so that one ball is computed as many are.
    omega, zeta, lam = (
        np.atleast_1d(np.asarray(x, dtype=float))
        for x in (contact.frequency_ratio, contact.damping_ratio, amplitude)
    )
    if not np.all(zeta < 1):
        raise ModelError(
            f"damping ratio ζ = {contact.damping_ratio} is not below 1: "
            "the simulation needs an underdamped contact"
        )
    detuning, loss = (omega - 1) * (omega + 1), 2 * zeta * omega
    gamma = detuning * detuning + loss * loss
    if not np.all(np.sqrt(gamma) >= _RESONANCE):
        raise ModelError(
            f"undamped resonance: ϖ = {contact.frequency_ratio}, ζ = {contact.damping_ratio} "
            "has no steady contact to simulate"
        )
    lag = np.atleast_1d(contact.lag)
    damped = omega * np.sqrt((1 - zeta) * (1 + zeta))
    half = np.pi / damped
    in_phase = (detuning + lag * loss) / gamma
    quadrature = (lag * detuning - loss) / gamma
    constants = Oscillator(
        amplitude=lam,
        stiffness=omega * omega,
        omega=omega,
        decay=zeta * omega,
        damped=damped,
        lag=lag,
        in_phase=in_phase,
        quadrature=quadrature,
        steady=lam * np.sqrt(in_phase * in_phase + quadrature * quadrature),
        forcing=lam * np.sqrt(1 + lag * lag),
        half=half,
        # Nearly critical: any number so large excludes the bound that uses it.
        growth=np.exp(np.minimum(zeta * omega * half, 690.0)),
    )
    return Oscillator(*(x[0] if x.size == 1 else x for x in constants))


class ContactMotion(Motion):
    """The motion y of balls in contact.

    Parameters
    ----------
    constants : Oscillator
    displacement, velocity : array
        δ and δ′ at the start.
    x, y : array
        Λ cos φ and Λ sin φ then.
    """

    def __init__(self, constants: Oscillator, displacement, velocity, x, y):
        self.constants = o = constants
        self.start, self.start_rate = self._observed(displacement, velocity, y)
        self.sine = o.in_phase * x - o.quadrature * y
        self.cosine = o.in_phase * y + o.quadrature * x
        self.a = self.start + (1 / o.stiffness - self.cosine)
        self.b = (self.start_rate - self.sine + o.decay * self.a) / o.damped
        self.envelope = np.sqrt(self.a * self.a + self.b * self.b)
        # The forcing now, and how it may grow.
        self.push = y + o.lag * x

    def _observed(self, displacement, velocity, y):
        """y and y′ from δ and δ′."""
        o = self.constants
        acceleration = (y - 1) - 2 * o.decay * velocity - o.stiffness * displacement
        return displacement + o.lag * velocity, velocity + o.lag * acceleration

    def state(self, displacement_rate, y):
        """δ and δ′ at a release with rate y′, where Λ sin τ is ``y``."""
        lag = self.constants.lag
        velocity = displacement_rate - lag * (y - 1)
        return -lag * velocity, velocity

    def __call__(self, time: np.ndarray) -> State:
        o = self.constants
        sine, versine = sine_and_versine(o.damped * time)
        cosine = 1 - versine
        decay = np.exp(-o.decay * time)
        a, b = self.a * decay, self.b * decay
        free = a * cosine + b * sine
        free_rate = o.damped * (b * cosine - a * sine) - o.decay * free
        free_second = -2 * o.decay * free_rate - o.stiffness * free
        free_third = -2 * o.decay * free_second - o.stiffness * free_rate
        sine, versine = sine_and_versine(time)
        cosine = 1 - versine
        forced = self.sine * sine + self.cosine * cosine
        forced_rate = self.sine * cosine - self.cosine * sine
        level = 1 / o.stiffness
        envelope = self.envelope * decay
        bound = o.stiffness * envelope
        return State(
            (free - level) + forced,
            free_rate + forced_rate,
            free_second - forced,
            free_third - forced_rate,
            bound + o.steady,
            o.omega * bound + o.steady,
            o.stiffness * bound + o.steady,
            envelope + (o.steady - level) <= _ROUNDING * level,
        )

    def skip(self, time: np.ndarray, steps: int) -> np.ndarray:
        """No zero while even the transient's envelope leaves y negative.

        That is until the steady part rises through 1/ϖ² - R e^{-as}: a stiff,
        weakly damped contact would oscillate about ϖ times before.
        """
        if steps < _PATIENCE:
            return time
        o = self.constants
        level = 1 / o.stiffness - self.envelope * np.exp(-o.decay * time)
        ratio = level / np.maximum(o.steady, 1e-300)
        inside = np.abs(ratio) < 1
        rising = np.arcsin(np.where(inside, ratio, 0.0))
        now = time + np.arctan2(self.cosine, self.sine)
        below = inside & (np.sin(now) < ratio)
        # Short of the crossing by more than its rounding.
        wait = np.mod(rising - now, 2 * np.pi) - 1e-9
        return time + np.where(below, np.maximum(wait, 0.0), 0.0)

    def sure(self) -> np.ndarray:
        r"""A time by which the contact has not ended, within half a period.

        With a constant forcing P, the largest within the half period, the
        contact would end earlier (the impulse response is positive there).
        That contact is ``e^{-as} (A′ cos θ + B′ sin θ) + P/ϖ²``, which is
        negative where ``A′ cos θ + B′ sin θ < -e^{aπ/ϖ_d} P/ϖ²``; once it is
        positive it stays so for longer than half a period.
        """
        o = self.constants
        forcing = np.minimum(self.push + o.forcing * o.half, o.forcing) - 1
        level = np.maximum(forcing, 0.0) / o.stiffness
        a = self.start - level
        b = (self.start_rate + o.decay * a) / o.damped
        radius = np.sqrt(a * a + b * b)
        depth = o.growth * level / np.maximum(radius, 1e-300)
        # atan2 of the point turned by half a turn, so that a < 0 gives no jump.
        angle = np.arctan2(-b, -a) + (np.pi / 2 - np.arcsin(np.minimum(depth, 1.0)))
        angle = np.where((depth < 1) & (angle > 0), angle, 0.0)
        return angle / o.damped


def release(motion: ContactMotion) -> Zero:
    """The end of the contact; ``ended`` where it is permanent."""
    return first_zero(motion, motion.sure())
