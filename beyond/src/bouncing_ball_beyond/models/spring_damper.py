"""The paper's contact: a linear spring and a damper (Eqs. 10-16).

Its force, its release and its motion have closed forms. For ζ ≥ 1, where that of the motion does
not hold, its contacts are computed by collocation, as those of any other law. The impact seen from
outside (:mod:`bouncing_ball_beyond.models.instant`) is the same at every speed, with κ as in
:mod:`bouncing_ball_beyond.models.damping`::

    t_c = r (D + κ)/(1 + r),    σ = (1 - r)(D + κ) - 2ζ (1 + r)/ϖ

If the damper acts on approach only, the force has a kink where p′ = 0, and the contacts are also
computed by collocation, which ends a panel there. A load a adds ``a (1 - 2ζr)/ϖ²`` to the greatest
penetration P, because ``P = r v/ϖ`` and the load is balanced at a/ϖ², and takes a/ϖ from the speed
ϖP on the way up. Together the ball leaves with 2ζ r a/ϖ less, so that ::

    t_c = r D/(1 + r),    σ = (1 - r) D - 2ζ r/ϖ
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any, ClassVar

import numpy as np
from numpy.typing import ArrayLike

from bouncing_ball_beyond.inherited.models.damping import check_positive
from bouncing_ball_beyond.inherited.models.spring_damper import ContactState
from bouncing_ball_beyond.models.approach_threshold import approach_threshold
from bouncing_ball_beyond.models.contact import ContactSpan
from bouncing_ball_beyond.models.damping import Release, damping_ratio, restitution_coefficient
from bouncing_ball_beyond.models.dynamics import Dynamics
from bouncing_ball_beyond.models.instant import Instant
from bouncing_ball_beyond.models.laws.contact_law import OscillatorLaw
from bouncing_ball_beyond.models.linear_contact import LinearContactDynamics
from bouncing_ball_beyond.models.oscillator import responses
from bouncing_ball_beyond.models.permanent_contact import permanent_contact_threshold


@dataclass(frozen=True, repr=False)
class SpringDamper(OscillatorLaw):
    """The inherited contact of the same name as a law, for every ζ ≥ 0 and every :class:`.Release`.

    Examples
    --------
    >>> SpringDamper(10.0, 2.0, "force").label
    'ϖ = 10, ζ = 2'
    """

    release: Release = Release.DISPLACEMENT

    name: ClassVar[str] = "linear"

    def __post_init__(self):
        object.__setattr__(self, "release", Release.of(self.release))
        super().__post_init__()

    def force(self, penetration: np.ndarray, rate: np.ndarray) -> np.ndarray:
        """The force over the weight, ϖ² p + 2ζϖ p′; without p′ < 0 if the damper acts on approach.

        The penetration is p = w - z, and z″ = f - 1 with this force f. In the paper ::

            m ÿ + c (ẏ - ẇ) + k (y - w) = -m g              (10)
            z″ + 2ζϖ (z′ - w′) + ϖ² (z - w) = -1            (11)

        Examples
        --------
        >>> [float(SpringDamper(2.0, 0.25, rule).force(1.0, -3.0)) for rule in Release]
        [1.0, 1.0, 4.0]
        """
        omega = self.frequency_ratio
        if not self.release.is_linear:
            rate = np.where(np.real(rate) > 0, rate, 0.0)
        return omega * (omega * penetration + 2 * self.damping_ratio * rate)

    @property
    def label(self) -> str:
        """The parameters of a single contact as text."""
        return f"ϖ = {float(self.frequency_ratio):g}, ζ = {float(self.damping_ratio):.4g}"

    @property
    def has_kink(self) -> bool:
        """Whether the damper acts on approach only, so that the force has a kink at p′ = 0."""
        return not self.release.is_linear

    def kink(self, penetration: np.ndarray, rate: np.ndarray) -> np.ndarray:
        """p′, or 1 without damping, because the force is then smooth."""
        return np.where(np.equal(self.damping_ratio, 0), 1.0, rate)

    @cached_property
    def has_closed_form(self) -> bool:
        """Whether the motion in contact has a closed form: see :class:`.OscillatorLaw`; a damper
        that acts on approach only has none for the whole contact.
        """
        return self.release.is_linear and super().has_closed_form

    @cached_property
    def is_linear_and_underdamped(self) -> bool:
        """Whether all contacts have a linear release and ζ < 1: their motion has a closed form."""
        return self.release.is_linear and bool(np.all(np.asarray(self.damping_ratio) < 1))

    @property
    def linear(self) -> SpringDamper:
        """A linear contact with the r and the duration of this one's free impact: itself, unless
        its damper acts on approach only.

        Raises
        ------
        ModelError
            If ζ ≥ 1.

        Examples
        --------
        >>> contact = SpringDamper(2.0, 0.1, "approach").linear
        >>> contact.release, round(float(contact.restitution), 4)
        (<Release.DISPLACEMENT: 'displacement'>, 0.8626)
        """
        if self.release.is_linear:
            return self
        return SpringDamper.of_impact(self.restitution, self.free_duration)

    @classmethod
    def from_restitution(
        cls,
        restitution: ArrayLike,
        frequency_ratio: ArrayLike,
        release: str = Release.DISPLACEMENT,
    ) -> SpringDamper:
        """The contact of the inherited method of the same name."""
        omega = check_positive(frequency_ratio, "frequency ratio ϖ")
        return cls(omega, damping_ratio(restitution), Release.of(release))

    @classmethod
    def of_impact(
        cls,
        restitution: ArrayLike,
        duration: ArrayLike,
        release: str = Release.DISPLACEMENT,
    ) -> SpringDamper:
        """The contact whose free impacts, with this release, have r and the duration D.

        Raises
        ------
        ModelError
            If r or D is outside its range, or the release is unknown.

        Examples
        --------
        >>> contact = SpringDamper.of_impact(1.0, np.pi)
        >>> float(contact.frequency_ratio), float(contact.damping_ratio)
        (1.0, 0.0)
        """
        rule = Release.of(release)
        return cls.of_duration(duration, damping_ratio(restitution, rule), rule)

    @classmethod
    def of_duration(
        cls,
        duration: ArrayLike,
        damping_ratio: float | np.ndarray,
        release: str = Release.DISPLACEMENT,
    ) -> SpringDamper:
        """The contact with this ζ whose free impacts last D: their angle ϖD is that for ϖ = 1.

        Raises
        ------
        ModelError
            If D or ζ is outside its range, ζ ≥ 1 with the displacement release, or the release is
            unknown.

        Examples
        --------
        >>> float(SpringDamper.of_duration(0.5, 1.0, "force").frequency_ratio)
        4.0
        """
        unit = cls(1.0, damping_ratio, Release.of(release))
        time = check_positive(duration, "duration D")
        return replace(unit, frequency_ratio=unit.free_duration / time)

    def implied(self, values: Mapping[str, Any]) -> dict[str, Any]:
        """ζ of a given r, or r of a given ζ (Eq. 16); nothing if neither is given, or for ζ ≥ 1.

        Examples
        --------
        >>> contact = SpringDamper(2.0, 0.1)
        >>> float(contact.implied({"restitution": 1.0})["damping_ratio"])
        0.0
        """
        if "restitution" in values:
            return {"damping_ratio": damping_ratio(values["restitution"])}
        if "damping_ratio" in values:
            zeta = values["damping_ratio"]
            if np.all(np.asarray(zeta) < 1):
                return {"restitution": restitution_coefficient(zeta, Release.DISPLACEMENT)}
        return {}

    @cached_property
    def release_sine(self) -> np.ndarray:
        """sin α = κϖ/2: ζ for the force release, 0 at the table's level."""
        return self.release.sine(self.damping_ratio)[()]

    @cached_property
    def lag(self) -> np.ndarray:
        """κ: the contact ends where δ + κ δ′ = 0."""
        return 2 * self.release_sine / self.frequency_ratio

    @property
    def restitution(self) -> np.ndarray:
        """Restitution coefficient of a free impact with this release.

        Raises
        ------
        ModelError
            If ζ ≥ 1 with the displacement release.
        """
        return restitution_coefficient(self.damping_ratio, self.release)

    @property
    def free_angle(self) -> np.ndarray:
        """The angle ϖ_d s at which a free contact, without load, ends: π - 2α if it is linear.

        Raises
        ------
        ModelError
            If ζ ≥ 1: an overdamped contact does not oscillate.
        """
        self.require_underdamped()
        return self.release.free_angle(self.damping_ratio)

    @property
    def free_duration(self) -> np.ndarray:
        """Duration of the free contact: (π - 2α)/ϖ_d if it is linear and ζ < 1; for ζ ≥ 1 see
        ``Release.overdamped_duration``.

        Raises
        ------
        ModelError
            If ζ ≥ 1 with the displacement release.

        Examples
        --------
        >>> float(SpringDamper(2.0, 1.0, "force").free_duration)
        1.0
        """
        zeta = self.release.require_rebound(self.damping_ratio)
        over = zeta >= 1
        under = np.where(over, 0.0, zeta)
        root = np.sqrt((1 - under) * (1 + under))
        found = self.release.free_angle(under) / (self.frequency_ratio * root)
        if not over.any():
            return found
        alone = 0.0 if self.release.is_linear else np.pi / 2
        large = self.release.overdamped_duration(np.where(over, zeta, 1.0)) + alone
        return np.where(over, large / self.frequency_ratio, found)[()]

    def flow(
        self,
        time: ArrayLike,
        displacement: ArrayLike,
        velocity: ArrayLike,
        phase: ArrayLike,
        amplitude: ArrayLike,
    ) -> ContactState:
        """The relative state of the ball a time s after (δ₀, δ′₀), in contact (Eqs. 12-13).

        If the damper acts on approach only, this is the motion up to the greatest penetration. The
        paper has the absolute height and its derivative, from the start of the contact at τ = 0::

            z = e^{-ζϖτ} (A cos ϖ_d τ + B sin ϖ_d τ) - 1/ϖ² + βΛ cos(τ + φ) + χΛ sin(τ + φ)    (12)
            z′ = e^{-ζϖτ} [(ϖ_d B - ζϖA) cos ϖ_d τ - (ϖ_d A + ζϖB) sin ϖ_d τ]
                 - βΛ sin(τ + φ) + χΛ cos(τ + φ)                                               (13)
            ϖ_d = ϖ √(1 - ζ²),                    γ = (ϖ² - 1)² + (2ζϖ)²
            χ = [(2ζϖ)² + ϖ²(ϖ² - 1)]/γ,          β = -2ζϖ/γ

        Here τ = s and δ = z - Λ sin(s + φ); δ₀ and δ′₀ at s = 0 determine A and B, which do not
        appear: as in :mod:`bouncing_ball_beyond.inherited.models.spring_damper` the flow is a sum
        of responses, here those of every damping (:mod:`.oscillator`). The class
        ``ClosedFormMotion`` in :mod:`bouncing_ball_beyond.models.linear_contact` has them.

        Parameters
        ----------
        time, displacement, velocity, phase, amplitude : array_like
            s, δ₀, δ′₀, the table's phase φ at the start, and Λ.

        Returns
        -------
        ContactState
            Its fields have the shape to which the arguments and the contact broadcast.

        Examples
        --------
        On a table at rest and without damping, gravity and spring balance at δ = -1/ϖ²:

        >>> flow = SpringDamper(2.0, 0.0).flow(3.0, -0.25, 0.0, 0.0, 0.0)
        >>> round(float(flow.displacement), 14), abs(round(float(flow.velocity), 14))
        (-0.25, 0.0)
        """
        state = time, displacement, velocity, phase, amplitude
        columns = (*state, self.frequency_ratio, self.damping_ratio)
        rows = np.broadcast_arrays(*(np.asarray(x, dtype=float) for x in columns))
        s, d0, v0, phi, lam, omega, zeta = rows
        loss = 2 * zeta * omega
        stiffness = omega * omega
        g, G, h = responses(s, omega, zeta)
        drive = lam * np.exp(1j * phi)
        d = d0 * (g.rate + loss * g.value) + v0 * g.value - G.value + np.imag(drive * h.value)
        v = v0 * g.rate - d0 * stiffness * g.value - G.rate + np.imag(drive * h.rate)
        acc = lam * np.sin(s + phi) - 1 - loss * v - stiffness * d
        return ContactState(d, v, acc)

    def during(self, span: ContactSpan, time: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """δ and δ′ at times 0 ≤ s ≤ D after the starts of contacts, one time for each contact."""
        if not self.release.is_linear:
            return super().during(span, time)
        start = span.displacement, span.velocity, span.phase
        flow = self.flow(time, *start, span.amplitude)
        return flow.displacement, flow.velocity

    def dynamics(self, amplitude: ArrayLike) -> Dynamics:
        """Contacts in closed form if all of them are linear and underdamped, otherwise by
        collocation.
        """
        if not self.is_linear_and_underdamped:
            return super().dynamics(amplitude)
        return LinearContactDynamics.of(self, amplitude)

    @property
    def constant_signature(self) -> Instant | None:
        """The signature in closed form; None for overdamped contacts, for which it does not hold.

        Examples
        --------
        The force of an elastic contact is symmetric in time, so that its centroid is in the middle:

        >>> instant = SpringDamper(2.0, 0.0).signature(1.0)
        >>> float(instant.delay) == np.pi / 4, float(instant.restitution), float(instant.load)
        (True, 1.0, 0.0)
        """
        if np.any(np.asarray(self.damping_ratio) >= 1):
            return None
        duration = self.free_duration
        r = self.restitution
        # The time at which the flight after the contact rises through δ = 0.
        through = duration + self.lag
        loss = 2 * np.asarray(self.damping_ratio) / self.frequency_ratio
        slowed = (1 + r) if self.release.is_linear else r
        return Instant(
            delay=r * through / (1 + r),
            restitution=r + 0 * duration,
            load=(1 - r) * through - loss * slowed,
            duration=duration,
        )

    @property
    def permanent_contact(self) -> np.ndarray | None:
        """Λ_SD or Λ_F, depending on the release (Eq. 33); for a damper that acts on approach only
        see :mod:`.approach_threshold`, and None where that finds none.
        """
        if not self.release.is_linear:
            each = np.vectorize(approach_threshold, otypes=[float])
            found = each(self.frequency_ratio, self.damping_ratio)
            return found[()] if np.all(np.isfinite(found)) else None
        return permanent_contact_threshold(self.frequency_ratio, self.damping_ratio, self.release)

    @classmethod
    def group_of(cls, restitution: float) -> float:
        """ζ that gives r with the displacement release (Eq. 16).

        Raises
        ------
        ModelError
            If r is not in (0, 1].
        """
        return float(damping_ratio(restitution))
