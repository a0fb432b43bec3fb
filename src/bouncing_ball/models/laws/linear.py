"""The paper's contact as one of the contact laws, under the name ``linear``.

The linear contact of the paper knows its force, its release and its motion in closed form. As a
:class:`~bouncing_ball.models.laws.contact_law.ContactLaw` it also has what every law has: a root,
SI units, and parameters that follow from the scales of an impact. For ζ ≥ 1, where the closed form
of the motion does not hold, its contacts are computed by collocation.
"""

from dataclasses import dataclass
from typing import ClassVar, Self

import numpy as np
from numpy.typing import ArrayLike

from bouncing_ball.models.damping import damping_ratio
from bouncing_ball.models.dynamics import Dynamics
from bouncing_ball.models.instant import Instant, linear_instant
from bouncing_ball.models.laws.contact_law import OscillatorLaw
from bouncing_ball.models.linear_contact import LinearContactDynamics
from bouncing_ball.models.permanent_contact import permanent_contact_threshold
from bouncing_ball.models.spring_damper import SpringDamper


@dataclass(frozen=True, repr=False)
class LinearLaw(SpringDamper, OscillatorLaw):
    """The spring-damper contact with the interface of a contact law.

    Parameters
    ----------
    frequency_ratio, damping_ratio : float or array
        ϖ > 0 and ζ ≥ 0, dimensionless.
    release : Release or str
        The condition that ends the contact; the paper's is the default.

    Raises
    ------
    ModelError
        If ϖ or ζ is outside its range, or the release is unknown.

    Examples
    --------
    >>> law = LinearLaw(2.0, 0.1, "force")
    >>> law.label, law.in_si(1.0, 1.0, 0.5)["frequency_ratio"]
    ('linear with frequency ratio 2, damping ratio 0.1', 4.0)
    """

    name: ClassVar[str] = "linear"

    @classmethod
    def of(cls, contact: SpringDamper) -> Self:
        """The law of a contact, or of a row of contacts."""
        return cls(contact.frequency_ratio, contact.damping_ratio, contact.release)

    @classmethod
    def group_of(cls, restitution: float) -> float:
        """ζ that gives r with the displacement release (Eq. 16).

        Raises
        ------
        ModelError
            If r is not in (0, 1].
        """
        return float(damping_ratio(restitution))

    @property
    def signature(self) -> Instant:
        """The signature in closed form.

        Raises
        ------
        ModelError
            If ζ ≥ 1.
        """
        return linear_instant(self)

    @property
    def permanent_contact(self) -> np.ndarray:
        """Λ_SD or Λ_F, depending on the release (Eq. 33)."""
        return permanent_contact_threshold(self.frequency_ratio, self.damping_ratio, self.release)

    def dynamics(self, amplitude: ArrayLike) -> Dynamics:
        """Contacts in closed form if all of them are underdamped, otherwise by collocation."""
        if np.all(np.asarray(self.damping_ratio) < 1):
            return LinearContactDynamics.of(self, amplitude)
        return super().dynamics(amplitude)
