r"""n-T orbits of a ball on a contact of any law: path, equations and stability.

The contact of an orbit is that of :mod:`bouncing_ball.contacts.collocation`, and so are
its derivatives. All quantities are dimensionless.
"""

from functools import cached_property
from typing import Self

import numpy as np
from numpy.typing import ArrayLike

from bouncing_ball.contacts.collocation import Contacts, contacts, path
from bouncing_ball.contacts.contact_law import ContactLaw
from bouncing_ball.motion.contact import contact_cycle
from bouncing_ball.motion.sequence import Cycle
from bouncing_ball.orbits.highest import highest
from bouncing_ball.orbits.orbit import Orbit


class LawOrbit(Orbit):
    """n-T orbits; ``law`` is the :class:`ContactLaw`.

    Examples
    --------
    >>> from bouncing_ball.contacts.laws.hunt_crossley import HuntCrossley
    >>> from bouncing_ball.orbits.law_model import LawModel
    >>> orbit = LawModel(HuntCrossley(1e3, 0.0)).orbit(1, 0.5)
    >>> float(orbit.determinant())
    1.0
    """

    @classmethod
    def at(
        cls,
        n: ArrayLike,
        law: ContactLaw,
        amplitude: ArrayLike,
        phase: ArrayLike,
        impact_velocity: ArrayLike,
    ) -> Self:
        """The orbits whose contacts start so, with the duration they then have."""
        columns = (np.asarray(x, dtype=float) for x in (amplitude, phase, impact_velocity))
        lam, phi, velocity = np.broadcast_arrays(*columns, np.zeros(law.shape))[:3]
        found = contacts(law, lam * np.cos(phi) - velocity, phi, lam)
        orbit = cls(n, law, lam, phi, found.duration, velocity)
        # What it would compute itself when it is asked for its contact.
        orbit.__dict__["contact"] = found
        return orbit

    @cached_property
    def contact(self) -> Contacts:
        """The contact from the orbit's impact on, its derivatives and its path."""
        return contacts(self.law, -self.relative_impact_velocity, self.phase, self.amplitude)

    @property
    def clock(self) -> ArrayLike:
        """π/D, what ϖ is for the linear contact."""
        return np.pi / np.asarray(self.contact_duration)

    @property
    def release_displacement(self) -> np.ndarray:
        """δ_b at release."""
        return -self.contact.penetration

    @property
    def max_height(self) -> np.ndarray:
        """Greatest absolute height over the cycle, in flight or in contact."""
        return highest(self)

    def contact_motion(self, time: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """δ and δ′ at times 0 ≤ τ ≤ τ_b in contact."""
        speed = -self.relative_impact_velocity
        depth, rate = path(self.law, self.contact, time, speed, self.phase, self.amplitude)
        return -depth, -rate

    def contact_acceleration(self, time: np.ndarray) -> np.ndarray:
        """Absolute acceleration in contact, f - 1."""
        displacement, velocity = self.contact_motion(time)
        return self.law.force(np.maximum(-displacement, np.finfo(float).tiny), -velocity) - 1

    def residual(self) -> np.ndarray:
        """Duration, velocity and landing defects, shape (..., 3).

        The first is π times the relative error of the duration.
        """
        found = self.contact
        late = (found.duration - self.contact_duration) * self.clock
        return np.stack([late, *self.flight_defects(-found.penetration, -found.rate)], axis=-1)

    def holding(self, time: np.ndarray) -> np.ndarray:
        """Minus the grip of the law."""
        displacement, velocity = self.contact_motion(time)
        return -self.law.grip(-displacement, -velocity)

    def contact_jacobian(self) -> np.ndarray:
        """Jacobian of (τ_b, δ_b, δ′_b) in (τ, δ′, Λ) at the impact, shape (..., 3, 3)."""
        sign = np.array([[1.0, -1.0, 1.0], [-1.0, 1.0, -1.0], [-1.0, 1.0, -1.0]])
        return self.contact.jacobian[..., :3] * sign

    def determinant(self) -> np.ndarray:
        """exp(-∫ ∂f/∂p′ dt) over the contact: the flight keeps areas."""
        return self.contact.contraction

    def cycle(self, phase: ArrayLike, relative_velocity: ArrayLike) -> Cycle:
        """From impacts (φ, δ′) to the next, simulated."""
        return contact_cycle(self.law, self.amplitude, phase, relative_velocity)
