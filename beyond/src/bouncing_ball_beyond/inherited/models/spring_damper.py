r"""The spring-damper model: contacts with a spring and a damper (Eqs. 10-13, 23).

In the relative coordinate δ = z - w, the ball in contact obeys (Eqs. 10 and 11) ::

    δ″ + 2ζϖ δ′ + ϖ² δ = -1 + Λ sin(s + φ)

where s is the time since the contact started and φ the phase of the table at that moment. The paper
writes the solution, Eq. 12, with constants A and B, which the start of the contact determines. Here
they are eliminated: the flow is affine in (δ₀, δ′₀, Λ cos φ, Λ sin φ), and regular at the resonance
ζ = 0, ϖ = 1::

    δ(s) = δ₀ (I′ + 2ζϖ I) + δ′₀ I - J + Λ cos φ · P + Λ sin φ · Q

I is the impulse response of the oscillator, J its response to a constant force, and Q + iP that to
e^{is}. With its eigenvalues λ± = -ζϖ ± iϖ_d, ϖ_d = ϖ√(1 - ζ²), they are divided differences of the
exponential function, of which the one with ν = 0 is J, and that with ν = i is Q + iP::

    I = (e^{λ₊s} - e^{λ₋s})/(λ₊ - λ₋)
    H = [(e^{νs} - e^{λ₊s})/(ν - λ₊) - I]/(ν - λ₋)

The second denominator is never small, and the first quotient is regular where ν = λ₊. For a short
time the difference of the two numbers in the bracket loses digits, and the sum of a series is in
use, with the complete homogeneous symmetric polynomials h_k of λ₊, λ₋ and ν::

    H = Σ h_k s^{k+2}/(k + 2)!

The contact ends at the first upward zero of y = δ + κ δ′, with κ = 0 for the displacement release
(Eq. 23) and κ = 2ζ/ϖ for the force release, for which -ϖ² y is the force of the table over the
weight. y moves as δ does, with the forcing Λ sin τ + κ Λ cos τ, of which the amplitude is
F = Λ√(1 + κ²)::

    y(s) = e^{-ζϖs} (A cos ϖ_d s + B sin ϖ_d s) - 1/ϖ² + ρ sin(s + ψ),      ρ = F/√γ
    γ = (ϖ² - 1)² + (2ζϖ)²

(Eq. 12 without the table). With R = √(A² + B²), the derivative of order k of the first term is at
most ``ϖ^k R e^{-ζϖs}``, and that of the last one at most ρ. The contact therefore never ends if at
some time ``R e^{-ζϖs} + ρ ≤ 1/ϖ²``.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any, ClassVar, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from bouncing_ball_beyond.inherited.datasets.arguments import (
    DAMPING_RATIO,
    FREQUENCY_RATIO,
    RESTITUTION,
    Axis,
    DampingRatioAxis,
    FrequencyRatioAxis,
    ReleaseName,
    RestitutionAxis,
    checked,
    chosen,
    is_array,
)
from bouncing_ball_beyond.inherited.errors import ParameterError, suggesting
from bouncing_ball_beyond.inherited.models.damping import (
    Release,
    check_damping,
    check_positive,
    damped_frequency,
    damping_ratio,
)
from bouncing_ball_beyond.inherited.models.flight import matrix_of, table
from bouncing_ball_beyond.inherited.models.model import Departure, Model, Status
from bouncing_ball_beyond.inherited.models.permanent_contact import permanent_contact_threshold
from bouncing_ball_beyond.inherited.numerics.first_zero import Derivatives, Motion, first_zero

# Below this √γ the steady motion, of the amplitude ρ, is no useful bound.
_RESONANCE = 0.03
# Number of steps of a search after which the time is skipped in which y is certainly negative.
_PATIENCE = 12
_TURN = 2 * np.pi
# The quotient (e^x - 1)/x is 1 for an x below this, by which it could not be divided.
_SMALLEST = 1e-300
# Terms of the series of a short time, of which the one of order k is below s²/(2 k!).
_TERMS = 20
# A bound of the rounding errors of the terms that decide whether a contact ends.
_ROUNDING = 8 * np.finfo(float).eps


class Responses(NamedTuple):
    """The responses of the contact a time after its start: I and its rate of change I′, J, and the
    parts Q and P of the response to the table.
    """

    impulse: np.ndarray
    impulse_rate: np.ndarray
    gravity: np.ndarray
    in_phase: np.ndarray
    quadrature: np.ndarray


def _quotient(nu: complex, pole: np.ndarray, time: np.ndarray) -> np.ndarray:
    """(e^{νs} - e^{λs})/(ν - λ), which is s e^{νs} where ν = λ."""
    difference = (pole - nu) * time
    apart = np.abs(difference) > _SMALLEST
    quotient = np.where(apart, np.expm1(difference) / np.where(apart, difference, 1.0), 1.0)
    return time * np.exp(nu * time) * quotient


def _double_quotient(
    nu: complex, time: np.ndarray, omega: np.ndarray, zeta: np.ndarray, g: np.ndarray
) -> np.ndarray:
    """H of the module's docstring: the response to e^{νs}, with I of the same contact."""
    decay_rate = zeta * omega
    pole = -decay_rate + 1j * damped_frequency(zeta, omega)
    found = np.asarray((_quotient(nu, pole, time) - g) / (nu - np.conj(pole)))
    short = np.abs(time) * (omega + abs(nu)) < 1
    if not short.any():
        return found
    s = time[short]
    loss = 2 * decay_rate[short]
    stiffness = (omega * omega)[short]
    power = s * s / 2
    total = power + 0j
    before = np.zeros_like(s)
    of_poles = np.ones_like(s)
    of_all = np.ones_like(total)
    for k in range(1, _TERMS):
        # h_k of λ₊ and λ₋ alone, which are the roots of λ² + 2ζϖλ + ϖ² = 0, and then of all three.
        following = -loss * of_poles - stiffness * before
        before = of_poles
        of_poles = following
        of_all = nu * of_all + of_poles
        power = power * s / (k + 2)
        total = total + of_all * power
    found[short] = total
    return found


# What remains of an oscillation after a long time may be below the smallest number, and is then 0;
# and a complex number that is not a number would cause a warning.
@np.errstate(under="ignore", invalid="ignore")
def responses(
    time: ArrayLike,
    frequency_ratio: ArrayLike,
    damping_ratio: ArrayLike,
    swing: tuple[np.ndarray, np.ndarray] | None = None,
) -> Responses:
    """The responses of the contact a time s after its start, arrays of one shape.

    Parameters
    ----------
    time, frequency_ratio, damping_ratio : array_like
        s, ϖ > 0 and 0 ≤ ζ < 1, which broadcast.
    swing : tuple of ndarray, optional
        The sine and the cosine of ϖ_d s, where they are known with more digits than s has.

    Examples
    --------
    Without damping ``g = sin(ϖs)/ϖ``, and a constant force displaces the ball by (1 - cos ϖs)/ϖ²:

    >>> found = responses(np.pi / 2, 2.0, 0.0)
    >>> round(float(found.impulse_rate), 12), round(float(found.gravity), 12)
    (-1.0, 0.5)
    """
    s, omega, zeta = np.broadcast_arrays(*map(np.asarray, (time, frequency_ratio, damping_ratio)))
    decay_rate = zeta * omega
    damped = damped_frequency(zeta, omega)
    sine, cosine = swing or (np.sin(damped * s), np.cos(damped * s))
    decay = np.exp(-decay_rate * s)
    g = decay * sine / damped
    of_table = _double_quotient(1j, s, omega, zeta, g)
    return Responses(
        impulse=g,
        impulse_rate=decay * cosine - decay_rate * g,
        gravity=np.real(_double_quotient(0.0, s, omega, zeta, g)),
        in_phase=np.real(of_table),
        quadrature=np.imag(of_table),
    )


class ContactState(NamedTuple):
    """δ, δ′ and δ″ after a time in contact, arrays of one shape."""

    displacement: np.ndarray
    velocity: np.ndarray
    acceleration: np.ndarray


def force(
    frequency_ratio: ArrayLike, damping_ratio: ArrayLike, penetration: ArrayLike, rate: ArrayLike
) -> np.ndarray:
    """The force over the weight, f = ϖ² p + 2ζϖ p′, of a penetration p = w - z.

    With this force z″ = f - 1. In the paper ::

        m ÿ + c (ẏ - ẇ) + k (y - w) = -m g              (10)
        z″ + 2ζϖ (z′ - w′) + ϖ² (z - w) = -1            (11)

    Examples
    --------
    >>> float(force(2.0, 0.25, 1.0, -3.0))
    1.0
    """
    omega = np.asarray(frequency_ratio, dtype=float)
    loss = 2 * np.asarray(damping_ratio) * omega
    return omega * omega * np.asarray(penetration) + loss * np.asarray(rate)


def flow(
    frequency_ratio: ArrayLike,
    damping_ratio: ArrayLike,
    time: ArrayLike,
    phase: ArrayLike,
    velocity: ArrayLike,
    amplitude: ArrayLike,
    displacement: ArrayLike = 0.0,
) -> ContactState:
    """The state of a ball in contact a time s after (δ₀, δ′₀) at the phase φ (Eqs. 12-13).

    Examples
    --------
    On a table at rest a ball without weight would come back after half a period of the contact; the
    weight 1 displaces it by 2/ϖ²:

    >>> state = flow(2.0, 0.0, np.pi / 2, 0.0, -3.0, 0.0)
    >>> round(float(state.displacement), 12), round(float(state.velocity), 12)
    (-0.5, 3.0)
    """
    omega = np.asarray(frequency_ratio, dtype=float)
    loss = 2 * np.asarray(damping_ratio) * omega
    stiffness = omega * omega
    g, rate, gravity, in_phase, quadrature = responses(time, frequency_ratio, damping_ratio)
    x, y = table(np.asarray(phase, dtype=float), np.asarray(amplitude, dtype=float))
    forced = x * quadrature + y * in_phase - gravity
    # The responses obey Q′ = I - P, P′ = Q and J′ = I.
    forced_rate = x * in_phase + y * (g - quadrature) - g
    gap = displacement * (rate + loss * g) + velocity * g + forced
    speed = velocity * rate - displacement * stiffness * g + forced_rate
    _, height = table(np.asarray(phase) + time, np.asarray(amplitude, dtype=float))
    pushed = force(frequency_ratio, damping_ratio, -gap, -speed)
    return ContactState(gap, speed, height - 1 + pushed)


@dataclass(frozen=True, repr=False)
class SpringDamper(Model):
    """A ball on a table with a spring and a damper between them (Eqs. 10-27).

    Parameters
    ----------
    frequency_ratio, damping_ratio : float or array
        ϖ > 0 and ζ in [0, 1).
    release : Release or str
        The condition that ends the contact; the paper's is the default.

    Raises
    ------
    ModelError
        If ϖ or ζ is no number in its range, their shapes do not broadcast, or the release is
        unknown.

    Examples
    --------
    >>> contact = SpringDamper.from_restitution(1.0, [5.0, 10.0], "force")
    >>> contact[1].release, contact[1].label
    (<Release.FORCE: 'force'>, 'ϖ = 10, ζ = 0')
    """

    frequency_ratio: Any
    damping_ratio: Any
    release: Release = Release.DISPLACEMENT

    name: ClassVar[str] = "spring-damper"

    def __post_init__(self) -> None:
        omega = check_positive(self.frequency_ratio, "frequency ratio ϖ")
        zeta = check_damping(self.damping_ratio)
        object.__setattr__(self, "frequency_ratio", omega if omega.ndim else float(omega))
        object.__setattr__(self, "damping_ratio", zeta if zeta.ndim else float(zeta))
        object.__setattr__(self, "release", Release.of(self.release))
        self.check_shape()

    @classmethod
    def from_restitution(
        cls,
        restitution: ArrayLike,
        frequency_ratio: ArrayLike,
        release: str = Release.DISPLACEMENT,
    ) -> SpringDamper:
        """The contact whose damping follows from a restitution coefficient r by Eq. 16.

        Raises
        ------
        ModelError
            If r or ϖ is outside its range, or the release is unknown.

        Examples
        --------
        >>> SpringDamper.from_restitution(1.0, 10.0).damping_ratio
        0.0
        """
        return cls(frequency_ratio, damping_ratio(restitution), Release.of(release))

    @property
    def label(self) -> str:
        return f"ϖ = {self.frequency_ratio:g}, ζ = {self.damping_ratio:.4g}"

    @cached_property
    def lag(self) -> Any:
        """κ: the contact ends where δ + κ δ′ = 0."""
        return 2 * self.release.sine(self.damping_ratio)[()] / self.frequency_ratio

    @cached_property
    def free_angle(self) -> Any:
        """The angle ϖ_d s at which a free contact ends."""
        return self.release.free_angle(self.damping_ratio)[()]

    @cached_property
    def damped_frequency(self) -> Any:
        """ϖ_d = ϖ√(1 - ζ²)."""
        return damped_frequency(self.damping_ratio, self.frequency_ratio)[()]

    def flow(
        self, time: Any, phase: Any, velocity: Any, amplitude: Any, displacement: Any = 0.0
    ) -> ContactState:
        """δ, δ′ and δ″ at times since the starts of contacts: see :func:`flow`."""
        start = phase, velocity, amplitude, displacement
        return flow(self.frequency_ratio, self.damping_ratio, time, *start)

    def in_contact(
        self, time: Any, phase: Any, velocity: Any, amplitude: Any, displacement: Any = 0.0
    ) -> tuple[np.ndarray, np.ndarray]:
        """δ and δ′ at times since the starts of contacts (Eqs. 12 and 13)."""
        return self.flow(time, phase, velocity, amplitude, displacement)[:2]

    def released(
        self, duration: Any, phase: Any, velocity: Any, amplitude: Any
    ) -> tuple[np.ndarray, np.ndarray]:
        """δ and δ′ at the end of contacts of these durations, whether they are releases or not."""
        return self.flow(duration, phase, velocity, amplitude)[:2]

    def impact(
        self,
        phase: np.ndarray,
        velocity: np.ndarray,
        amplitude: np.ndarray,
        displacement: np.ndarray | float = 0.0,
    ) -> Departure:
        """The end of each contact, or permanent contact if it is proved never to end.

        It is the first τ_b > 0 with z(τ_b) = Λ sin(τ_b + φ), that is δ = 0 (Eq. 23), and for the
        force release with δ + κ δ′ = 0.

        Examples
        --------
        Half a period of a stiff contact, on a table whose acceleration balances gravity:

        >>> ball = SpringDamper(1e6, 0.0)
        >>> found = ball.impact(np.full(1, np.pi / 2), np.full(1, -3.0), np.ones(1))
        >>> (1e6 * found.duration / np.pi).round(6).tolist(), found.velocity.round(6).tolist()
        ([1.0], [3.0])
        """
        motion = _Contact(self, phase, velocity, amplitude, displacement + 0.0 * phase)
        end = first_zero(motion, np.zeros(phase.shape))
        _, height = table(phase + end.time, amplitude)
        # y′ = δ′ + κ δ″ with δ″ = Λ sin τ - 1, because the force vanishes at a release with κ > 0.
        # If the ball just reaches the release, rounding may give it a downward velocity.
        rate = np.maximum(end.rate, 0.0) - self.lag * (height - 1)
        status = np.where(end.undecided, Status.UNDECIDED, Status.BOUNCING)
        status = np.where(end.ended, Status.PERMANENT_CONTACT, status)
        leaves = status == Status.BOUNCING
        speed = np.where(leaves, rate, np.nan)
        duration = np.where(leaves, end.time, np.inf)
        return Departure(duration, -self.lag * speed, speed, status)

    def opening_rate(self, duration: Any, phase: Any, velocity: Any, amplitude: Any) -> np.ndarray:
        """δ′ + κ δ″ at the end of contacts of these durations: positive where they open."""
        state = self.flow(duration, phase, velocity, amplitude)
        return state.velocity + self.lag * state.acceleration

    def derivative(self, duration: Any, phase: Any, velocity: Any, amplitude: Any) -> np.ndarray:
        """The derivative of (φ_b, δ′_b) by (φ, δ′), with the release condition, shape (..., 2, 2).

        At a fixed time ``∂δ/∂φ = XQ - YP``, ``∂δ′/∂φ = X(I - P) - YQ``, ``∂δ/∂δ′₀ = I`` and
        ``∂δ′/∂δ′₀ = I′``. The release is later by ``dτ_b = -(dδ + κ dδ′)/(δ′ + κ δ″)``.
        """
        state = self.flow(duration, phase, velocity, amplitude)
        found = responses(duration, self.frequency_ratio, self.damping_ratio)
        x, y = table(np.asarray(phase, dtype=float), amplitude)
        by_phase = x * found.in_phase - y * found.quadrature
        rate_by_phase = x * (found.impulse - found.quadrature) - y * found.in_phase
        opening = state.velocity + self.lag * state.acceleration
        later_by_phase = -(by_phase + self.lag * rate_by_phase) / opening
        later_by_velocity = -(found.impulse + self.lag * found.impulse_rate) / opening
        return matrix_of(
            1 + later_by_phase,
            later_by_velocity,
            rate_by_phase + state.acceleration * later_by_phase,
            found.impulse_rate + state.acceleration * later_by_velocity,
        )

    def contraction(self, duration: Any) -> Any:
        """exp(-2ζϖD), because areas contract in contact at the rate 2ζϖ."""
        return np.exp(-2 * self.damping_ratio * self.frequency_ratio * np.asarray(duration))

    def permanent_contact_threshold(self) -> Any:
        """Λ_SD(ϖ), or Λ_F(ϖ) for the force release (Eq. 33)."""
        found = permanent_contact_threshold(self.frequency_ratio, self.damping_ratio, self.release)
        return found[()]


class _Contact(Motion):
    """The motion y = δ + κ δ′ of balls in contact, whose first upward zero is the release."""

    def __init__(
        self,
        contact: SpringDamper,
        phase: np.ndarray,
        velocity: np.ndarray,
        amplitude: np.ndarray,
        displacement: np.ndarray,
    ) -> None:
        omega = np.asarray(contact.frequency_ratio)
        zeta = np.asarray(contact.damping_ratio)
        lag = np.asarray(contact.lag)
        self.omega = omega
        self.zeta = zeta
        self.stiffness = omega * omega
        self.loss = 2 * zeta * omega
        self.forcing = amplitude * np.sqrt(1 + lag * lag)
        self.phase = phase + np.arctan(lag)
        _, height = table(phase, amplitude)
        acceleration = height - 1 + force(omega, zeta, -displacement, -velocity)
        self.start = displacement + lag * velocity
        self.start_rate = velocity + lag * acceleration
        detuning = (omega - 1) * (omega + 1)
        root = np.hypot(detuning, self.loss)
        self.resonant = (root < _RESONANCE) & (self.forcing > 0)
        # The steady part ρ sin(s + ψ), and the amplitude R of the transient.
        self.steady = np.where(self.resonant, np.inf, self.forcing / np.where(root > 0, root, 1.0))
        self.steady_phase = self.phase - np.arctan2(self.loss, detuning)
        damped = damped_frequency(zeta, omega)
        rho = np.where(self.resonant, 0.0, self.steady)
        a = self.start + 1 / self.stiffness - rho * np.sin(self.steady_phase)
        rate = self.start_rate - rho * np.cos(self.steady_phase)
        self.envelope = np.hypot(a, (rate + zeta * omega * a) / damped)

    def __call__(self, time: np.ndarray) -> Derivatives:
        start = self.phase, self.start_rate, self.forcing, self.start
        value, rate, second = flow(self.omega, self.zeta, time, *start)
        jerk, _ = table(self.phase + time, self.forcing)
        transient = self.envelope * np.exp(-self.zeta * self.omega * time)
        bounds = [self.omega**k * transient + self.steady for k in (2, 3, 4)]
        third = jerk - self.loss * second - self.stiffness * rate
        if self.resonant.any():
            near = self._near_resonance(value, rate, second)
            bounds = [np.where(self.resonant, *pair) for pair in zip(near, bounds, strict=True)]
        level = 1 / self.stiffness
        ended = transient + (self.steady - level) <= _ROUNDING * level
        return Derivatives._make([value, rate, second, third, *bounds, ended])

    def _near_resonance(
        self, value: np.ndarray, rate: np.ndarray, second: np.ndarray
    ) -> list[np.ndarray]:
        """Bounds of y″, |y‴| and |y⁗| for a time 1, raised such that no step is longer.

        Let e² = y′² + ϖ² (y + 1/ϖ²)². Damping only decreases it, and the forcing, at most F,
        increases e by at most F in a time 1. Within this time |y′| ≤ e + F, and bounds of the
        higher derivatives follow from the equation of motion.
        """
        fast = np.hypot(rate, self.omega * value + 1 / self.omega) + self.forcing
        by_second = self.forcing + (self.loss + self.omega) * fast
        by_third = self.forcing + self.loss * by_second + self.stiffness * fast
        by_fourth = self.forcing + self.loss * by_third + self.stiffness * by_second
        by_second = np.maximum(by_second, -2 * (value + rate))
        return [
            by_second,
            np.maximum(by_third, 3 * np.abs(second)),
            np.maximum(by_fourth, 12 * (by_second + np.abs(second))),
        ]

    def skip(self, time: np.ndarray, steps: int) -> np.ndarray:
        """A time up to which y is negative, because its bound by the transient's envelope is.

        The bound is negative until the steady part rises through 1/ϖ² - R e^{-ζϖs}. Without it a
        stiff, weakly damped contact would need steps over about ϖ oscillations.
        """
        if steps < _PATIENCE:
            return time
        transient = self.envelope * np.exp(-self.zeta * self.omega * time)
        ratio = (1 / self.stiffness - transient) / np.maximum(self.steady, 1e-300)
        inside = (np.abs(ratio) < 1) & ~self.resonant
        rising = np.arcsin(np.where(inside, ratio, 0.0))
        now = time + self.steady_phase
        below = inside & (np.sin(now) < ratio)
        # The result precedes the crossing by more than the rounding error of the crossing, which
        # must not postpone a crossing at the present time by a full turn.
        wait = np.mod(rising - now, _TURN) - 1e-9
        wait = np.where(wait > _TURN - 1e-6, 0.0, wait)
        return time + np.where(below, np.maximum(wait, 0.0), 0.0)


LOSSES = ("restitution", "damping_ratio", "measured_restitution")
"""The parameters that determine the loss of an impact; exactly one of them is needed."""


def the_loss(
    restitution: Axis | None, damping_ratio: Axis | None, measured_restitution: Axis | None
) -> str:
    """The name of the one of the :data:`LOSSES` that is given.

    Raises
    ------
    ParameterError
        If none of them is given, or several.
    """
    values = (restitution, damping_ratio, measured_restitution)
    given = [name for name, value in zip(LOSSES, values, strict=True) if value is not None]
    if not given:
        names = " ".join(f"{{{name}}}" for name in LOSSES)
        raise ParameterError(f"one of the arguments {names} is required")
    if len(given) > 1:
        raise ParameterError(f"argument {{{given[1]}}}: not allowed with argument {{{given[0]}}}")
    return given[0]


@suggesting
def spring_damper(
    *,
    frequency_ratio: FrequencyRatioAxis,
    restitution: RestitutionAxis | None = None,
    damping_ratio: DampingRatioAxis | None = None,
    measured_restitution: RestitutionAxis | None = None,
    release: ReleaseName = "displacement",
) -> SpringDamper:
    """A ball on a contact with a spring and a damper (Eqs. 10-27).

    Exactly one of the parameters restitution, damping_ratio and measured_restitution is needed.

    Parameters
    ----------
    frequency_ratio : float or array
        Frequency ratio ϖ of a spring-damper contact; the restitution model has none.
    restitution : float or array, optional
        Restitution coefficient r in (0, 1]. A spring-damper contact then has the damping ratio
        ζ with r = exp(-πζ/√(1 - ζ²)), Eq. 16 of the paper.
    damping_ratio : float or array, optional
        Damping ratio ζ in [0, 1) of the contact, in place of the restitution coefficient.
    measured_restitution : float or array, optional
        Restitution coefficient of a free impact under the given release, in place of the
        parameter restitution, which always refers to the displacement release.
    release : str
        Where a contact ends: "displacement" at the table's level, as in the paper (default), or
        "force" where the contact force vanishes.

    Raises
    ------
    ModelError
        If a parameter is missing, of a wrong type or shape, out of range or contradicts another.

    Examples
    --------
    >>> spring_damper(frequency_ratio=10.0, damping_ratio=0.1).label
    'ϖ = 10, ζ = 0.1'
    """
    rule = Release.of(chosen("release", release, [str(each) for each in Release]))
    loss = the_loss(restitution, damping_ratio, measured_restitution)
    values = dict(zip(LOSSES, (restitution, damping_ratio, measured_restitution), strict=True))
    allowed = DAMPING_RATIO if loss == "damping_ratio" else RESTITUTION
    parameters = {
        loss: checked(loss, values[loss], allowed),
        "frequency_ratio": checked("frequency_ratio", frequency_ratio, FREQUENCY_RATIO),
    }
    flat: Any = parameters
    if any(is_array(value) for value in parameters.values()):
        # Imported here, because a single ball needs no labels, and importing xarray takes longer
        # than computing its orbit.
        from bouncing_ball_beyond.inherited.datasets.labelled import Grid

        flat = Grid(**parameters).flat
    zeta = flat[loss] if loss == "damping_ratio" else _damping_of(flat[loss], loss, rule)
    ball = SpringDamper(flat["frequency_ratio"], zeta, rule)
    return ball.labelled({**parameters, "release": str(rule)})


def _damping_of(restitution: ArrayLike, loss: str, rule: Release) -> np.ndarray:
    """ζ of a restitution coefficient, of the displacement release unless it was measured."""
    return damping_ratio(restitution, rule if loss == "measured_restitution" else "displacement")
