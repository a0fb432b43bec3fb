"""Contact laws: a force, and the motion of balls that follows from it.

A user's law is a subclass of :class:`ContactLaw`. The paper's contact is
:class:`~bouncing_ball.models.spring_damper.SpringDamper`; as a contact law among others it
is :class:`~bouncing_ball.models.laws.linear.LinearLaw`.
"""

from dataclasses import dataclass
from typing import ClassVar, Self

import numpy as np
from numpy.typing import ArrayLike

from bouncing_ball.models.contact import Span
from bouncing_ball.models.damping import check_damping, check_positive
from bouncing_ball.models.dynamics import Dynamics
from bouncing_ball.models.laws.collocation import states
from bouncing_ball.models.laws.force_law import ForceLaw, Unit
from bouncing_ball.models.laws.motion import ContactDynamics
from bouncing_ball.models.laws.panel import Start


@dataclass(frozen=True, repr=False)
class ContactLaw(ForceLaw):
    """A contact law: a frozen dataclass of its dimensionless parameters.

    A subclass defines ``name`` and :meth:`~.ForceLaw.force`; the other members have defaults, most
    of them in :class:`~.force_law.ForceLaw`. The motion of balls on the contact is computed by
    collocation, unless the subclass knows it in closed form.
    """

    def dynamics(self, amplitude: ArrayLike) -> Dynamics:
        """The contacts and flights of balls with this law on a table of amplitude Λ.

        Raises
        ------
        ModelError
            If Λ is outside its range.
        """
        return ContactDynamics.of(self, amplitude)

    def during(self, span: Span, time: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
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
    units: ClassVar[dict[str, Unit]] = {"frequency_ratio": Unit("rad/s", 0, 0, -1)}

    def __post_init__(self):
        super().__post_init__()
        check_positive(self.frequency_ratio, "frequency ratio ϖ")
        check_damping(self.damping_ratio, "damping ratio ζ")

    @classmethod
    def of_scales(cls, group: ArrayLike, length: ArrayLike, speed: ArrayLike) -> Self:
        """The law with ϖ = v/P and ζ = group, and the defaults of all other parameters."""
        ratio = np.asarray(speed, dtype=float) / np.asarray(length, dtype=float)
        return cls(ratio, group + 0 * ratio)
