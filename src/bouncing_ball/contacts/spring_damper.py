r"""Spring-damper contact: the exact flow in relative coordinates (Eqs. 10-13).

With δ = z - w, the ball in contact obeys ::

    δ″ + 2ζϖ δ′ + ϖ² δ = -1 + Λ sin(s + φ)

where s is the time since the contact started and φ the phase of the table at
that moment. The paper writes the solution with constants A and B fitted to
the start of contact; here they are eliminated, so that the flow is affine in
(δ₀, δ′₀, Λ cos φ, Λ sin φ) and regular at the resonance ζ = 0, ϖ = 1::

    δ(s) = δ₀ (g′ + 2ζϖ g) + δ′₀ g - G + Λ cos φ · P + Λ sin φ · Q

with g the impulse response, G the response to a constant force and Q + iP
that to e^{is}, all from :mod:`bouncing_ball.contacts.oscillator`.

All quantities are dimensionless: time Ωt, length Ω²y/g.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar, NamedTuple, Self

import numpy as np
from numpy.typing import ArrayLike

from bouncing_ball.contacts.contact_law import ContactLaw
from bouncing_ball.contacts.damping import damping_ratio, restitution_coefficient
from bouncing_ball.contacts.oscillator import Response, exponential_response, impulse_response
from bouncing_ball.contacts.release import Release
from bouncing_ball.errors import require

ARGUMENTS = (
    "time",
    "displacement",
    "velocity",
    "phase",
    "amplitude",
    "frequency_ratio",
    "damping_ratio",
)
"""Order of the last axis of :attr:`ContactFlow.jacobian`."""


class ContactFlow(NamedTuple):
    """State δ, δ′ after a time in contact, δ″, and the exact Jacobian.

    ``jacobian`` has shape (..., 2, 7): rows (δ, δ′), columns as in
    :data:`ARGUMENTS`.
    """

    displacement: np.ndarray
    velocity: np.ndarray
    acceleration: np.ndarray
    jacobian: np.ndarray


class Responses(NamedTuple):
    """Impulse response g, response G to gravity and Q + iP to the table."""

    impulse: Response
    gravity: Response
    table: Response


def check_contact(frequency_ratio: ArrayLike, damping_ratio: ArrayLike) -> None:
    """Raise :class:`ModelError` unless ϖ > 0 and ζ ≥ 0, both finite."""
    omega, zeta = (np.asarray(x, dtype=float) for x in (frequency_ratio, damping_ratio))
    require((omega > 0) & np.isfinite(omega), omega, "frequency ratio ϖ", "finite and positive")
    require((zeta >= 0) & np.isfinite(zeta), zeta, "damping ratio ζ", "finite and ≥ 0")


def responses(time: ArrayLike, frequency_ratio: ArrayLike, damping_ratio: ArrayLike) -> Responses:
    """The three responses of the contact at a time (dimensionless, broadcast)."""
    omega = np.asarray(frequency_ratio, dtype=float)
    zeta = np.asarray(damping_ratio, dtype=float)
    a, q = zeta * omega, omega * omega
    g = impulse_response(time, a, q, q * (1 - zeta) * (1 + zeta))
    return Responses(
        impulse=g,
        gravity=exponential_response(0, time, a, q, g),
        table=exponential_response(1j, time, a, q, g),
    )


def _jacobian(rows, phase, amplitude, omega, zeta) -> np.ndarray:
    """Derivatives of δ and δ′ by the :data:`ARGUMENTS`.

    A row holds those by s, δ₀ and δ′₀, the response to the table, whose phase is φ
    and whose size Λ, and the derivatives by a = ζϖ and q = ϖ².
    """
    cosine, sine = np.cos(phase), np.sin(phase)
    x, y = amplitude * cosine, amplitude * sine
    jacobian = np.empty((*phase.shape, 2, len(ARGUMENTS)))
    for row, (by_time, by_d0, by_v0, forced, by_a, by_q) in enumerate(rows):
        jacobian[..., row, 0] = by_time
        jacobian[..., row, 1] = by_d0
        jacobian[..., row, 2] = by_v0
        jacobian[..., row, 3] = x * np.real(forced) - y * np.imag(forced)
        jacobian[..., row, 4] = cosine * np.imag(forced) + sine * np.real(forced)
        jacobian[..., row, 5] = zeta * by_a + 2 * omega * by_q
        jacobian[..., row, 6] = omega * by_a
    return jacobian


def contact_flow(
    time: ArrayLike,
    displacement: ArrayLike,
    velocity: ArrayLike,
    phase: ArrayLike,
    amplitude: ArrayLike,
    frequency_ratio: ArrayLike,
    damping_ratio: ArrayLike,
) -> ContactFlow:
    """Relative state of the ball a time ``s`` after (δ₀, δ′₀), in contact.

    Parameters
    ----------
    time, displacement, velocity, phase : array_like
        s, δ₀, δ′₀ and the table's phase φ at the start.
    amplitude, frequency_ratio, damping_ratio : array_like
        Λ, ϖ > 0 and ζ ≥ 0.

    Returns
    -------
    ContactFlow
        Shapes follow the broadcast of the arguments.

    Raises
    ------
    ModelError
        If ϖ or ζ is outside its range.

    Examples
    --------
    Without table and damping, gravity and spring balance at δ = -1/ϖ²:

    >>> flow = contact_flow(3.0, -0.25, 0.0, 0.0, 0.0, 2.0, 0.0)
    >>> round(float(flow.displacement), 14), abs(round(float(flow.velocity), 14))
    (-0.25, 0.0)
    """
    check_contact(frequency_ratio, damping_ratio)
    args = (time, displacement, velocity, phase, amplitude, frequency_ratio, damping_ratio)
    args = np.broadcast_arrays(*(np.asarray(x, dtype=float) for x in args))
    s, d0, v0, phi, lam, omega, zeta = args
    a, q = zeta * omega, omega * omega
    g, G, h = responses(s, omega, zeta)
    x, y = lam * np.cos(phi), lam * np.sin(phi)

    def combine(free, push, weight, forced):
        # forced is the complex response Q + iP: x P + y Q.
        return d0 * free + v0 * push - weight + x * np.imag(forced) + y * np.real(forced)

    d = combine(g.rate + 2 * a * g.value, g.value, G.value, h.value)
    v = combine(-q * g.value, g.rate, G.rate, h.rate)
    acc = -2 * a * v - q * d - 1 + lam * np.sin(s + phi)

    d_a = combine(g.rate_d_a + 2 * g.value + 2 * a * g.d_a, g.d_a, G.d_a, h.d_a)
    v_a = combine(-q * g.d_a, g.rate_d_a, G.rate_d_a, h.rate_d_a)
    d_q = combine(g.rate_d_q + 2 * a * g.d_q, g.d_q, G.d_q, h.d_q)
    v_q = combine(-g.value - q * g.d_q, g.rate_d_q, G.rate_d_q, h.rate_d_q)

    rows = (
        (v, g.rate + 2 * a * g.value, g.value, h.value, d_a, d_q),
        (acc, -q * g.value, g.rate, h.rate, v_a, v_q),
    )
    return ContactFlow(d, v, acc, _jacobian(rows, phi, lam, omega, zeta))


@dataclass(frozen=True, repr=False)
class SpringDamper(ContactLaw):
    """The paper's contact: ϖ, ζ and the rule that ends it, with f = ϖ² p + 2ζϖ p′.

    The contact law whose motion is known in closed form.

    Parameters
    ----------
    frequency_ratio, damping_ratio : float or array
        ϖ > 0 and ζ ≥ 0, dimensionless.
    release : Release or str
        What ends the contact; the paper's choice is the default.

    Raises
    ------
    ModelError
        If ϖ or ζ is outside its range, or the release is unknown.

    Examples
    --------
    >>> contact = SpringDamper.from_restitution(1.0, [5.0, 10.0], "force")
    >>> contact[1].release, float(contact[1].frequency_ratio)
    (<Release.FORCE: 'force'>, 10.0)
    """

    frequency_ratio: float | np.ndarray
    damping_ratio: float | np.ndarray
    release: Release = Release.DISPLACEMENT

    name: ClassVar[str] = "linear"
    formula: ClassVar[str] = "W² p + 2 Z W p′"
    root: ClassVar[int] = 1

    def __post_init__(self):
        check_contact(self.frequency_ratio, self.damping_ratio)
        object.__setattr__(self, "release", Release.of(self.release))

    def force(self, penetration: np.ndarray, rate: np.ndarray) -> np.ndarray:
        """ϖ² p + 2ζϖ p′."""
        omega = self.frequency_ratio
        return omega * (omega * penetration + 2 * self.damping_ratio * rate)

    @classmethod
    def of_scales(cls, group: ArrayLike, length: ArrayLike, speed: ArrayLike) -> Self:
        """ϖ = v/P and ζ = group."""
        omega = np.asarray(speed, dtype=float) / np.asarray(length, dtype=float)
        return cls(omega, np.asarray(group, dtype=float) + 0 * omega)

    @classmethod
    def group_of(cls, restitution: float) -> float:
        """ζ of a restitution coefficient, with the displacement release."""
        return float(damping_ratio(restitution))

    @classmethod
    def from_restitution(
        cls,
        restitution: ArrayLike,
        frequency_ratio: ArrayLike,
        release: str = Release.DISPLACEMENT,
        *,
        measured: bool = False,
    ) -> SpringDamper:
        """The contact whose damping is that of a restitution coefficient r.

        Parameters
        ----------
        restitution, frequency_ratio : array_like
            r in (0, 1] and ϖ.
        release : Release or str
            What ends the contact.
        measured : bool
            Whether r is what a free impact with this release really has.
            Otherwise it is the r of Eq. 16, that of the displacement release.

        Examples
        --------
        >>> float(SpringDamper.from_restitution(1.0, 10.0).damping_ratio)
        0.0
        """
        rule = Release.of(release)
        zeta = damping_ratio(restitution, rule if measured else Release.DISPLACEMENT)
        return cls(np.asarray(frequency_ratio, dtype=float), zeta, rule)

    @property
    def release_sine(self) -> np.ndarray:
        """sin α = κϖ/2."""
        return self.release.sine(self.damping_ratio)

    @property
    def lag(self) -> np.ndarray:
        """κ: the contact ends where δ + κ δ′ = 0."""
        return 2 * self.release_sine / self.frequency_ratio

    @property
    def restitution(self) -> np.ndarray:
        """Restitution coefficient of a free impact with this release, ζ < 1."""
        return restitution_coefficient(self.damping_ratio, self.release)

    @property
    def free_angle(self) -> np.ndarray:
        """π - 2α: the angle ϖ_d s at which the free contact, unforced and weightless, ends.

        Raises
        ------
        ModelError
            If ζ ≥ 1: an overdamped contact has no oscillation to count in.
        """
        self._require_underdamped()
        return self.release.free_angle(self.damping_ratio)

    @property
    def damped_frequency(self) -> np.ndarray:
        """ϖ_d = ϖ√(1 - ζ²), for ζ < 1."""
        self._require_underdamped()
        zeta = np.asarray(self.damping_ratio)
        return self.frequency_ratio * np.sqrt((1 - zeta) * (1 + zeta))

    @property
    def free_duration(self) -> np.ndarray:
        """Duration of the free contact, (π - 2α)/ϖ_d."""
        return self.free_angle / self.damped_frequency

    def _require_underdamped(self) -> None:
        zeta = np.asarray(self.damping_ratio, dtype=float)
        require(zeta < 1, zeta, "damping ratio ζ", "below 1: the contact does not oscillate")

    def flow(
        self,
        time: ArrayLike,
        displacement: ArrayLike,
        velocity: ArrayLike,
        phase: ArrayLike,
        amplitude: ArrayLike,
    ) -> ContactFlow:
        """Relative state a time after (δ₀, δ′₀): :func:`contact_flow`."""
        return contact_flow(
            time, displacement, velocity, phase, amplitude, self.frequency_ratio, self.damping_ratio
        )
