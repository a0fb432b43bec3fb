"""The spring-damper model: an impact is a contact of finite duration (Eqs. 10-13, 16, 28-36).

In contact the height δ = z - w of the ball above the table obeys (Eq. 11)

    δ″ + 2ζϖ δ′ + ϖ² δ = -1 + Λ sin(s + φ),

with s the time since the start of the contact, at which δ = 0 and δ′ = u < 0, and φ the phase of
the table there. The motion is linear in u, X = Λ cos φ and Y = Λ sin φ.
"""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from bouncing_ball.restitution import Numbers

RELEASES = ("displacement", "force")


def damping_ratio(r: Numbers) -> NDArray:
    """Damping ratio ζ of the contact on which a free impact has the restitution r (Eq. 16).

    Free means without weight, and with a contact that ends at δ = 0. `free_restitution` is the
    inverse, which has to follow a change of this formula.

    >>> round(float(damping_ratio(0.85)), 5)
    0.05166
    """
    logarithm = np.log(r)
    # The sum has no negative zero for r = 1.
    return 0.0 - logarithm / np.hypot(np.pi, logarithm)


def free_restitution(zeta: Numbers) -> NDArray:
    """Restitution exp(-πζ/√(1 - ζ²)) of a free impact, the inverse of Eq. 16.

    >>> round(float(free_restitution(damping_ratio(0.85))), 12)
    0.85
    """
    zeta = np.asarray(zeta)
    return np.exp(-np.pi * zeta / np.sqrt(1 - zeta**2))


def force_release_restitution(zeta: Numbers) -> NDArray:
    """Restitution of a free impact whose contact ends where its force vanishes, for ζ < 1.

    Schwager and Pöschel (2007): the contact is shorter than half a free oscillation, by the angle
    at which the force leads the displacement.
    """
    zeta = np.asarray(zeta)
    damped = np.sqrt(1 - zeta**2)
    angle = np.pi - np.arctan2(2 * zeta * damped, 1 - 2 * zeta**2)
    return np.exp(-zeta / damped * angle)


class Responses(NamedTuple):
    """Responses of the contact at a time s to unit forces, from rest: see `Contact.responses`."""

    impulse: NDArray
    impulse_rate: NDArray
    constant: NDArray
    sine: NDArray
    cosine: NDArray


class Motion(NamedTuple):
    """Relative displacement δ, velocity δ′ and acceleration δ″ in contact."""

    displacement: NDArray
    velocity: NDArray
    acceleration: NDArray


@dataclass(frozen=True)
class Contact:
    """A linear contact, or an array of them.

    Parameters
    ----------
    frequency_ratio : array_like
        ϖ = ω/Ω > 0, the natural frequency of the contact over the frequency of the table.
    damping_ratio : array_like
        0 <= ζ < 1.
    release : str
        The condition that ends a contact: ``displacement`` for δ = 0 (Eq. 23), or ``force`` for a
        vanishing force of the contact, δ + (2ζ/ϖ) δ′ = 0.
    weight : array_like
        The weight in contact, 1 but for the reading of Table 1 without gravity in contact.
    """

    frequency_ratio: float | NDArray
    damping_ratio: float | NDArray
    release: str = "displacement"
    weight: float | NDArray = 1.0

    def __post_init__(self):
        if self.release not in RELEASES:
            raise ValueError(f"release is {self.release!r}; allowed are {', '.join(RELEASES)}")
        # NaN stays allowed, as the answer where there is no contact.
        if np.any(np.less(self.damping_ratio, 0) | np.greater_equal(self.damping_ratio, 1)):
            raise ValueError(f"the damping ratio is {self.damping_ratio}; it must be 0 <= ζ < 1")

    @property
    def lag(self) -> NDArray:
        """κ in the condition of release δ + κδ′ = 0: zero, or 2ζ/ϖ for the force."""
        if self.release == "displacement":
            return np.zeros_like(self.frequency_ratio, dtype=float)
        return 2 * np.asarray(self.damping_ratio) / self.frequency_ratio

    @property
    def restitution(self) -> NDArray:
        """The restitution coefficient of a free impact, the limit of r_a for a stiff contact."""
        if self.release == "displacement":
            return free_restitution(self.damping_ratio)
        return force_release_restitution(self.damping_ratio)

    def responses(self, s: Numbers) -> Responses:
        """The responses I, I′, J, P and Q at times s, from which the motion in contact is made.

        I and I′ are displacement and velocity after a unit impulse; J, P and Q the displacements
        under the forces 1, sin s and cos s. They are integrals of products of exponentials, written
        with (e^{as} - e^{bs})/(a - b) in a form that is finite for a = b, so that there is no
        singularity at the resonance ζ = 0, ϖ = 1, as Eqs. 12 and 13 have one.
        """
        s = np.asarray(s)
        zeta = np.asarray(self.damping_ratio)
        root = self.frequency_ratio * (-zeta + 1j * np.sqrt(1 - zeta**2))
        free = np.exp(root * s)
        # The real force 1 has a real response, the force e^{is} a complex one.
        unit = _quotient(0, root, s).imag / root.imag
        wave = (_quotient(1j, root, s) - _quotient(1j, np.conj(root), s)) / (root - np.conj(root))
        return Responses(
            impulse=free.imag / root.imag,
            impulse_rate=(free * root).imag / root.imag,
            constant=unit,
            sine=wave.imag,
            cosine=wave.real,
        )

    def motion(
        self,
        s: Numbers,
        u: Numbers,
        x: Numbers,
        impact_height: Numbers,
        response: Responses | None = None,
    ) -> Motion:
        """Motion in contact (Eqs. 12 and 13) at times s, from δ = 0 and δ′ = u.

        x and impact_height are Λ cos φ and Λ sin φ at the start of the contact. The responses at s
        are computed unless they are given.
        """
        response = response or self.responses(s)
        displacement = (
            u * response.impulse
            - self.weight * response.constant
            + x * response.sine
            + impact_height * response.cosine
        )
        velocity = (
            u * response.impulse_rate
            - self.weight * response.impulse
            + x * response.cosine
            + impact_height * (response.impulse - response.sine)
        )
        force = x * np.sin(s) + impact_height * np.cos(s) - self.weight
        damping = 2 * np.asarray(self.damping_ratio) * self.frequency_ratio
        acceleration = force - damping * velocity - self.frequency_ratio**2 * displacement
        return Motion(displacement, velocity, acceleration)


def _quotient(a, b, s):
    """(e^{as} - e^{bs})/(a - b) for complex a and b, also where they are equal."""
    half = (a - b) * s / 2
    small = np.abs(half) < 1e-4
    # Complex arithmetic warns of NaN, which is the answer where there is no orbit.
    with np.errstate(invalid="ignore"):
        # The series of sinh(x)/x, whose next term is x⁴/120 < 1e-18 here.
        ratio = np.where(small, 1 + half**2 / 6, np.sinh(half) / np.where(small, 1, half))
        return s * np.exp((a + b) * s / 2) * ratio


def permanent_contact(ratio: Numbers, zeta: Numbers, release: str = "displacement") -> NDArray:
    """Λ_SD: the amplitude up to which the steady motion stays in contact (Eq. 33).

    Its displacement must not become positive or, with the force release, its force not negative.

    >>> float(permanent_contact(1.0, 0.1))
    0.2
    """
    ratio = np.asarray(ratio, dtype=float)
    resistance = np.hypot(ratio**2 - 1, 2 * zeta * ratio)
    if release == "displacement":
        return resistance / ratio**2
    return resistance / np.hypot(ratio**2, 2 * zeta * ratio)


def lowest_permanent_contact(zeta: float, release: str = "displacement") -> tuple[float, float]:
    """The frequency ratio at which Λ_SD is lowest, and its value there (Eq. 36).

    With the displacement release they are 1/√(1 - 2ζ²) and 2ζ√(1 - ζ²) for ζ < 1/√2; beyond, Λ_SD
    falls towards 1 as the stiffness grows, and the frequency ratio is infinite. With the force
    release the derivative of Λ² by ϖ² vanishes at ϖ² = (1 + √(1 + 8ζ²))/2.
    """
    if release == "force":
        ratio = np.sqrt((1 + np.sqrt(1 + 8 * zeta**2)) / 2)
        return float(ratio), float(permanent_contact(ratio, zeta, release))
    if 2 * zeta**2 >= 1:
        return np.inf, 1.0
    return float(1 / np.sqrt(1 - 2 * zeta**2)), float(2 * zeta * np.sqrt(1 - zeta**2))


def permanent_contact_ratios(amplitude: float, zeta: float) -> tuple[float, float]:
    """The frequency ratios at which Λ_SD has a value below 1, the smaller first (Eqs. 34 and 35).

    They are NaN below the lowest Λ_SD.

    >>> [round(each, 4) for each in permanent_contact_ratios(0.99, 0.1359)]
    [0.7225, 9.8116]
    """
    middle = 1 - 2 * zeta**2
    with np.errstate(invalid="ignore"):
        root = np.sqrt(middle**2 + amplitude**2 - 1)
        squares = (middle + np.array([-root, root])) / (1 - amplitude**2)
        return tuple(np.sqrt(squares).tolist())
