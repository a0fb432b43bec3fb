"""Contact laws: a force, and the motion of balls that follows from it.

A user's law is a subclass of :class:`ContactLaw`. The paper's contact is
:class:`~bouncing_ball_beyond.models.spring_damper.SpringDamper`, a law among others.
"""

import math
from dataclasses import dataclass, replace
from functools import cached_property
from typing import ClassVar, Self

import numpy as np
from numpy.typing import ArrayLike

from bouncing_ball_beyond.inherited.errors import require
from bouncing_ball_beyond.inherited.models.damping import check_positive
from bouncing_ball_beyond.models.contact import ContactSpan
from bouncing_ball_beyond.models.damping import check_damping
from bouncing_ball_beyond.models.dynamics import Dynamics
from bouncing_ball_beyond.models.instant import Instant
from bouncing_ball_beyond.models.laws.collocation import states
from bouncing_ball_beyond.models.laws.force_law import NUMBER, ForceLaw, Unit
from bouncing_ball_beyond.models.laws.motion import ContactDynamics
from bouncing_ball_beyond.models.laws.panel import Start
from bouncing_ball_beyond.models.laws.signature import computed

# The closed form of a motion is used for √γ above this value. Its steady part has the size Λ/√γ, so
# that the motion has errors of some ten roundings over √γ, here 5e-14; the flow has 1e-14 at all γ.
_RESONANCE = 0.03


@dataclass(frozen=True, repr=False)
class ContactLaw(ForceLaw):
    """A contact law: a frozen dataclass of its dimensionless parameters.

    A subclass defines ``name`` and :meth:`~.ForceLaw.force`; the other members have defaults, most
    of them in :class:`~.force_law.ForceLaw`. The motion of balls on the contact is computed by
    collocation, unless the subclass knows it in closed form.
    """

    @property
    def is_linear_and_underdamped(self) -> bool:
        """Whether all contacts are those of a spring and a damper with a linear release and ζ < 1,
        of which the motion and the branch of n-T orbits have a closed form.
        """
        return False

    def dynamics(self, amplitude: ArrayLike) -> Dynamics:
        """The contacts and flights of balls with this law on a table of amplitude Λ.

        Raises
        ------
        ModelError
            If Λ is outside its range.
        """
        return ContactDynamics.of(self, amplitude)

    def during(self, span: ContactSpan, time: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """δ and δ′ at times 0 ≤ s ≤ D after the starts of contacts, one time for each contact."""
        start = Start(
            depth=-span.displacement,
            rate=-span.velocity,
            phase=span.phase,
            amplitude=span.amplitude,
            weight=np.ones_like(time),
        )
        ends = span.duration, -span.release_displacement, -span.release_velocity
        depth, rate = states(self, start, ends, time)
        return -depth, -rate

    def signature(self, speed: ArrayLike) -> Instant:
        """The impacts as instants, at impact speeds v > 0 of any shape.

        A signature that does not depend on the speed has a closed form; otherwise there is one
        collocation for each speed, and of the derivatives with respect to v only that of r is
        computed; the others are left at zero.

        Raises
        ------
        ModelError
            If the law does not release the ball.

        Examples
        --------
        The force of an elastic contact is symmetric in time, so that its centroid is in the middle
        and the effects of the load cancel:

        >>> from bouncing_ball_beyond.models.laws.hertzian import HuntCrossley
        >>> impact = HuntCrossley(100.0, 0.0).signature(2.0)
        >>> bool(abs(impact.delay / impact.duration - 0.5) < 1e-12)
        True
        >>> round(float(impact.restitution), 12), abs(round(float(impact.load), 12))
        (1.0, 0.0)
        """
        known = self.constant_signature
        return computed(self, speed) if known is None else known.at(speed)


@dataclass(frozen=True, repr=False)
class OscillatorLaw(ContactLaw):
    """A law with the parameters of a damped oscillator, ϖ > 0 and ζ ≥ 0.

    Raises
    ------
    ModelError
        If ϖ or ζ is outside its range.
    """

    frequency_ratio: float | np.ndarray
    damping_ratio: float | np.ndarray

    root: ClassVar[int] = 1
    units: ClassVar[dict[str, Unit]] = {
        "frequency_ratio": Unit("rad/s", 0, 0, -1),
        "damping_ratio": NUMBER,
    }

    def __post_init__(self):
        check_positive(self.frequency_ratio, "frequency ratio ϖ")
        check_damping(self.damping_ratio, "damping ratio ζ")
        super().__post_init__()

    @cached_property
    def stiffness(self) -> np.ndarray:
        """ϖ², the stiffness over that of the table's oscillation."""
        return np.square(np.asarray(self.frequency_ratio, dtype=float))

    @cached_property
    def decay_rate(self) -> np.ndarray:
        """ζϖ, the rate at which free oscillations decay."""
        return np.multiply(self.damping_ratio, self.frequency_ratio, dtype=float)

    @cached_property
    def loss(self) -> np.ndarray:
        """2ζϖ, the rate at which areas of the phase plane contract in contact."""
        return 2 * self.decay_rate

    @cached_property
    def detuning(self) -> np.ndarray:
        """ϖ² - 1, without cancellation next to the resonance."""
        omega = np.asarray(self.frequency_ratio, dtype=float)
        return (omega - 1) * (omega + 1)

    @cached_property
    def off_resonance(self) -> np.ndarray:
        """γ = (ϖ² - 1)² + (2ζϖ)², which is 0 at the undamped resonance ζ = 0, ϖ = 1."""
        return self.detuning * self.detuning + self.loss * self.loss

    @cached_property
    def has_closed_form(self) -> bool:
        """Whether all contacts are underdamped and away from the undamped resonance.

        Examples
        --------
        >>> from bouncing_ball_beyond.models.spring_damper import SpringDamper
        >>> SpringDamper(2.0, 0.1).has_closed_form, SpringDamper(1.0, 0.0).has_closed_form
        (True, False)
        """
        underdamped = np.asarray(self.damping_ratio) < 1
        return bool(np.all(underdamped & (self.off_resonance >= _RESONANCE**2)))

    @cached_property
    def damped_frequency(self) -> np.ndarray:
        """ϖ_d = ϖ√(1 - ζ²).

        Raises
        ------
        ModelError
            If ζ ≥ 1.
        """
        self.require_underdamped()
        return self.frequency_ratio * np.sqrt((1 - self.damping_ratio) * (1 + self.damping_ratio))

    def require_underdamped(self) -> None:
        """Raise :class:`~bouncing_ball_beyond.inherited.errors.ModelError` unless all ζ < 1."""
        zeta = np.asarray(self.damping_ratio, dtype=float)
        require(zeta < 1, zeta, "damping ratio ζ", "below 1: the contact does not oscillate")

    @classmethod
    def of_scales(cls, group: ArrayLike, length: ArrayLike, speed: ArrayLike) -> Self:
        """The law with ϖ = v/P and ζ = group, and the defaults of all other parameters."""
        ratio = np.asarray(speed, dtype=float) / np.asarray(length, dtype=float)
        return cls(ratio, group + 0 * ratio)

    def stiffened(self, factor: float) -> Self:
        """The law with ϖ√factor and the same ζ."""
        return replace(self, frequency_ratio=self.frequency_ratio * math.sqrt(factor))
