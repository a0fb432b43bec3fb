"""The spring-damper model: an impact is a contact of finite duration (Eqs. 10-13, 16, 28-36).

In contact the height δ = z - w of the ball above the table obeys (Eq. 11)

    δ″ + 2ζϖ δ′ + ϖ² δ = -1 + Λ sin(s + φ),

where s is the time since the start of the contact. At the start, δ = 0, δ′ = u < 0, and the table
has the phase φ. The motion is linear in u, X = Λ cos φ and Y = Λ sin φ.
"""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.optimize.elementwise import find_root

from bouncing_ball.restitution import Numbers, coefficient, required

RELEASES = ("displacement", "force")


def check_release(release: str) -> None:
    """Raise ValueError unless a release is one of `RELEASES`."""
    if release not in RELEASES:
        raise ValueError(f"release is {release!r}: it must be {' or '.join(RELEASES)}")


def check_ratios(frequency_ratio: Numbers, damping_ratio: Numbers) -> None:
    """Raise ValueError unless ϖ > 0 and 0 <= ζ < 1.

    NaN passes, because it marks elements of an array for which no contact exists.
    """
    frequency_ratio = required("ϖ", frequency_ratio, False, "ϖ > 0")
    required("ϖ", frequency_ratio, np.less_equal(frequency_ratio, 0), "ϖ > 0")
    wrong = np.less(damping_ratio, 0) | np.greater_equal(damping_ratio, 1)
    required("ζ", damping_ratio, wrong, "0 <= ζ < 1")


def free_angle(zeta: Numbers, release: str) -> NDArray | float:
    """Angle by which the damped oscillation turns in a free impact, for ζ < 1.

    In a free impact no weight acts, and the table is at rest.

    - Displacement release: π, half an oscillation.
    - Force release: 2 arccos ζ = π - 2 arcsin ζ. The contact ends earlier by the angle by which its
      force leads its displacement (Schwager and Pöschel, 2007).
    """
    check_ratios(1, zeta)
    check_release(release)
    return 2 * np.arccos(zeta) if release == "force" else np.pi


def free_duration(zeta: Numbers, release: str) -> NDArray:
    """Duration of a free impact multiplied by the natural frequency of the contact, for ζ < 1."""
    return free_angle(zeta, release) / np.sqrt(1 - np.asarray(zeta) ** 2)


def free_restitution(zeta: Numbers, release: str = "displacement") -> NDArray:
    """Restitution coefficient exp(-ζ `free_duration`) of a free impact, for ζ < 1.

    >>> round(float(free_restitution(damping_ratio(0.85))), 12)
    0.85
    """
    zeta = np.asarray(zeta)
    return np.exp(-free_angle(zeta, release) * zeta / np.sqrt(1 - zeta**2))


NO_CONTACT = "with the force release, r must be above e⁻² = 0.1353, up to 1"
"""The reason for which `damping_ratio` is NaN."""


def damping_ratio(r: Numbers, release: str = "displacement") -> NDArray:
    """Damping ratio ζ for which a free impact has the restitution r.

    It is the inverse of `free_restitution`: if you change one of them, change the other, too.

    - Displacement release: ζ = -ln r/√(π² + ln² r) (Eq. 16).
    - Force release: the root of 2ζ arccos ζ/√(1 - ζ²) = -ln r. It is NaN for r <= e⁻² = 0.135,
      because only overdamped contacts, ζ >= 1, have such r.

    >>> round(float(damping_ratio(0.85)), 5), round(float(damping_ratio(0.85, "force")), 5)
    (0.05166, 0.05348)
    """
    logarithm = np.log(coefficient(r))
    check_release(release)
    if release == "force":
        root = find_root(
            lambda zeta, logarithm: zeta * free_duration(zeta, release) + logarithm,
            (0.0, np.nextafter(1.0, 0.0)),
            args=(logarithm,),
            tolerances={"xatol": 1e-15},
        )
        return np.where(root.success, root.x, np.nan)[()]
    # Subtract from 0.0, because a minus sign would give -0.0 for r = 1.
    return 0.0 - logarithm / np.hypot(np.pi, logarithm)


class Responses(NamedTuple):
    """Responses of a contact, initially at rest, at a time s.

    Attributes
    ----------
    impulse, impulse_rate
        Displacement I and velocity I′ after a unit impulse.
    constant, sine, cosine
        Displacements J, P and Q under the forces 1, sin s and cos s.
    """

    impulse: NDArray
    impulse_rate: NDArray
    constant: NDArray
    sine: NDArray
    cosine: NDArray


class Motion(NamedTuple):
    """Displacement δ, velocity δ′ and acceleration δ″ of the ball relative to the table."""

    displacement: NDArray
    velocity: NDArray
    acceleration: NDArray


@dataclass(frozen=True)
class Contact:
    """A linear contact, or an array of linear contacts.

    Parameters
    ----------
    frequency_ratio : array_like
        Frequency ratio ϖ = ω/Ω > 0: natural frequency of the contact divided by the frequency of
        the table. It is finite, or NaN if no contact exists.
    damping_ratio : array_like
        Damping ratio ζ, 0 <= ζ < 1, or NaN if no contact exists.
    release : str
        Condition that ends a contact. ``displacement``: δ = 0 (Eq. 23). ``force``: the force of the
        contact vanishes, δ + (2ζ/ϖ) δ′ = 0.
    weight : array_like
        Weight of the ball in contact, divided by its weight in flight. It is 1 in the model, and 0
        in the reading of Table 1 without gravity in contact.

    Raises
    ------
    ValueError
        If the release is unknown, or a ratio is outside its range.
    """

    frequency_ratio: float | NDArray
    damping_ratio: float | NDArray
    release: str = "displacement"
    weight: float | NDArray = 1.0

    @classmethod
    def of_restitution(
        cls, frequency_ratio: Numbers, r: Numbers, release: str = "displacement"
    ) -> "Contact":
        """Return the contact with whose damping a free impact has the restitution r.

        >>> round(float(Contact.of_restitution(82.0, 0.65).damping_ratio), 4)
        0.1359
        """
        return cls(frequency_ratio, damping_ratio(r, release), release)

    def __post_init__(self):
        check_release(self.release)
        for name in ("frequency_ratio", "damping_ratio", "weight"):
            object.__setattr__(self, name, np.asarray(getattr(self, name))[()])
        check_ratios(self.frequency_ratio, self.damping_ratio)
        required("ϖ", self.frequency_ratio, np.isinf(self.frequency_ratio), "finite ϖ > 0")

    @property
    def lag(self) -> NDArray:
        """Coefficient κ of the release condition δ + κδ′ = 0.

        It is 0 for the displacement release and 2ζ/ϖ for the force release.
        """
        if self.release == "displacement":
            return np.zeros_like(self.frequency_ratio, dtype=float)
        return 2 * np.asarray(self.damping_ratio) / self.frequency_ratio

    @property
    def restitution(self) -> NDArray:
        """Restitution coefficient of a free impact, the limit of r_a as ϖ tends to infinity."""
        return free_restitution(self.damping_ratio, self.release)

    def responses(self, s: Numbers) -> Responses:
        """Responses I, I′, J, P and Q at times s; `motion` is a linear combination of them.

        The responses are integrals of products of exponentials. They contain the quotient
        (e^{as} - e^{bs})/(a - b). This quotient is evaluated in a form that is finite for a = b.
        The responses are therefore finite at the resonance ζ = 0, ϖ = 1, where Eqs. 12 and 13 are
        singular.
        """
        s = np.asarray(s)
        zeta = np.asarray(self.damping_ratio)
        root = self.frequency_ratio * (-zeta + 1j * np.sqrt(1 - zeta**2))
        free = np.exp(root * s)
        # The force 1 is real, so one root gives its response. The force e^{is} is complex, so both
        # roots are needed: P is the imaginary part of its response, and Q is the real part.
        unit = _quotient(0, root, s).imag / root.imag
        both = _quotient(1j, root, s) - _quotient(1j, np.conj(root), s)
        # Complex arithmetic warns of NaN, which marks elements for which no contact exists.
        with np.errstate(invalid="ignore"):
            wave = both / (root - np.conj(root))
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
        """Motion in contact from δ = 0 and δ′ = u (Eqs. 12 and 13).

        Parameters
        ----------
        s : array_like
            Times since the start of the contact.
        u : array_like
            Relative velocity δ′ at the start.
        x, impact_height : array_like
            X = Λ cos φ and Y = Λ sin φ at the start.
        response : Responses, optional
            Responses at the times s. Pass them to avoid computing them again.
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


def contact_of_duration(duration: Numbers, r: Numbers, release: str) -> Contact:
    """Contact whose free impact has a duration and the restitution r.

    Weight and motion of the table change the duration of an impact; the relative change is of the
    order of 1/ϖ.

    Parameters
    ----------
    duration : array_like
        Duration of the contact in units of 1/Ω: its time multiplied by 2π times the frequency of
        the table.
    r : array_like
        Restitution coefficient. With the force release, e⁻² < r <= 1; ϖ and ζ are NaN otherwise.
        If no r has a contact, ValueError.
    release : str
        Condition that ends the contact, ``displacement`` or ``force``. The contact of a real ball
        cannot pull, and its measured duration ends with its force: ``force``.

    >>> contact = contact_of_duration(0.03, [0.85, 0.3], "force")
    >>> contact.frequency_ratio.round(1).tolist(), contact.damping_ratio.round(3).tolist()
    ([101.3, 80.7], [0.053, 0.497])
    """
    positive = np.greater(duration, 0) & np.isfinite(duration)
    duration = required("duration", duration, ~positive, "a finite duration > 0")
    zeta = damping_ratio(r, release)
    if np.isnan(zeta).all():
        raise ValueError(f"r is {np.max(r):g}: {NO_CONTACT}")
    return Contact(free_duration(zeta, release) / duration, zeta, release)


def _quotient(a, b, s):
    """(e^{as} - e^{bs})/(a - b) for complex a and b, or the limit s e^{as} for a = b."""
    half = (a - b) * s / 2
    small = np.abs(half) < 1e-4
    # The hyperbolic sine of a long contact would overflow.
    long = np.abs(half.real) > 300
    # Complex arithmetic warns of NaN, but here NaN only marks elements without an orbit.
    with np.errstate(invalid="ignore"):
        part = np.where(small | long, 1, half)
        # For small x, use the series of sinh(x)/x. The first omitted term is x⁴/120 < 1e-18.
        ratio = np.where(small, 1 + half**2 / 6, np.sinh(part) / part)
        quotient = s * np.exp((a + b) * s / 2) * ratio
        return np.where(long, (np.exp(a * s) - np.exp(b * s)) / np.where(long, a - b, 1), quotient)


def permanent_contact(ratio: Numbers, zeta: Numbers, release: str = "displacement") -> NDArray:
    """Largest amplitude Λ_SD at which the steady motion stays in contact (Eq. 33).

    With the displacement release, the condition is δ <= 0 at all times. With the force release, the
    condition is that the contact never pulls, δ + (2ζ/ϖ) δ′ <= 0.

    >>> float(permanent_contact(1.0, 0.1))
    0.2
    """
    check_ratios(ratio, zeta)
    check_release(release)
    # Divided by ϖ², so that Λ_SD = 1 for ϖ = ∞.
    inverse = 1 / np.asarray(ratio, dtype=float)
    damping = 2 * zeta * inverse
    resistance = np.hypot(1 - inverse**2, damping)
    if release == "displacement":
        return resistance
    return resistance / np.hypot(1, damping)


def lowest_permanent_contact(zeta: float, release: str = "displacement") -> tuple[float, float]:
    """Frequency ratio that minimises Λ_SD, and the minimum of Λ_SD (Eq. 36).

    - Displacement release, ζ < 1/√2: ϖ = 1/√(1 - 2ζ²) and Λ_SD = 2ζ√(1 - ζ²).
    - Displacement release, ζ >= 1/√2: Λ_SD decreases towards 1 as ϖ grows. The function returns
      ϖ = inf and Λ_SD = 1.
    - Force release: ϖ² = (1 + √(1 + 8ζ²))/2, where the derivative of Λ_SD² with respect to ϖ²
      vanishes.

    >>> [round(x, 4) for x in lowest_permanent_contact(0.1)]
    [1.0102, 0.199]
    """
    check_ratios(1, zeta)
    check_release(release)
    if release == "force":
        ratio = np.sqrt((1 + np.sqrt(1 + 8 * zeta**2)) / 2)
        return float(ratio), float(permanent_contact(ratio, zeta, release))
    if 2 * zeta**2 >= 1:
        return np.inf, 1.0
    return float(1 / np.sqrt(1 - 2 * zeta**2)), float(2 * zeta * np.sqrt(1 - zeta**2))


def permanent_contact_ratios(amplitude: float, zeta: float) -> tuple[float, float]:
    """Two frequency ratios at which Λ_SD equals an amplitude below 1 (Eqs. 34 and 35).

    The smaller frequency ratio comes first. Both are NaN if the amplitude is below the minimum of
    Λ_SD. The equations assume the displacement release.

    >>> [round(ratio, 4) for ratio in permanent_contact_ratios(0.99, 0.1359)]
    [0.7225, 9.8116]
    """
    check_ratios(1, zeta)
    outside = np.less(amplitude, 0) | np.greater_equal(amplitude, 1)
    required("Λ", amplitude, outside, "0 <= Λ < 1")
    middle = 1 - 2 * zeta**2
    with np.errstate(invalid="ignore"):
        root = np.sqrt(middle**2 + amplitude**2 - 1)
        squares = (middle + np.array([-root, root])) / (1 - amplitude**2)
        return tuple(np.sqrt(squares).tolist())
