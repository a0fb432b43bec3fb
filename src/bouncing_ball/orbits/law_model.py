"""A ball on a contact of any law, and its n-T orbits without a closed form."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

import numpy as np
from numpy.typing import ArrayLike

from bouncing_ball.contacts.law_permanent_contact import permanent_contact
from bouncing_ball.contacts.law_signature import free_impact
from bouncing_ball.contacts.laws.contact_law import ContactLaw
from bouncing_ball.contacts.signature import Instant
from bouncing_ball.motion.law_impacts import simulate
from bouncing_ball.motion.sequence import ImpactSequence
from bouncing_ball.orbits.law_orbit import LawOrbit
from bouncing_ball.orbits.model import ImpactModel
from bouncing_ball.orbits.orbit import Orbit


@dataclass(frozen=True, repr=False)
class LawModel(ImpactModel):
    """A ball on a contact of any law.

    Parameters
    ----------
    law : ContactLaw
        One law, or an array of laws.

    Examples
    --------
    >>> from bouncing_ball.contacts.laws.tsuji import Tsuji, tsuji_damping
    >>> model = LawModel(Tsuji(500.0, tsuji_damping(0.85)))
    >>> limits = model.saddle_node(1).amplitude, model.period_doubling(1).amplitude
    >>> [round(float(x), 3) for x in limits]
    [0.246, 1.037]
    """

    law: ContactLaw

    name: ClassVar[str] = "contact-law"
    orbit_type: ClassVar[type[Orbit]] = LawOrbit

    @property
    def label(self) -> str:
        """The law and its parameters."""
        return self.law.label

    def signature(self, speed: ArrayLike) -> Instant:
        """That of a free impact."""
        return free_impact(self.law, speed)

    def simulate(
        self, amplitude: ArrayLike, phase: ArrayLike, velocity: ArrayLike, impacts: int
    ) -> ImpactSequence:
        """Impacts from a first one at phase φ, with absolute velocity z′_i before it."""
        return simulate(self.law, amplitude, phase, velocity, impacts)

    def permanent_contact_threshold(self) -> np.ndarray:
        """Λ up to which a steady contact is held all the time."""
        laws = self.law.flat(self.law.shape)
        found = [permanent_contact(laws.take(k)).amplitude for k in range(self.law.size)]
        return np.array(found).reshape(self.law.shape)
