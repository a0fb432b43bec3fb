"""A ball on a contact of any law, and its n-T orbits without a closed form."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

import numpy as np
from numpy.typing import ArrayLike

from bouncing_ball.contacts.contact_law import ContactLaw
from bouncing_ball.contacts.law_choice import law_of_impact
from bouncing_ball.contacts.law_permanent_contact import permanent_contact
from bouncing_ball.contacts.law_signature import free_impact
from bouncing_ball.contacts.signature import Instant
from bouncing_ball.errors import NoOrbitError
from bouncing_ball.motion.contact import simulate
from bouncing_ball.motion.sequence import ImpactSequence
from bouncing_ball.orbits.law_orbit import LawOrbit
from bouncing_ball.orbits.model import ImpactModel
from bouncing_ball.orbits.orbit import Orbit
from bouncing_ball.orbits.restitution_orbit import rigid_speed
from bouncing_ball.orbits.stability import Side

# Law and orbit in turn: the speed hardly depends on a law with the same r and D, and the
# secant through two rounds leaves little of that.
_ROUNDS = 20
_SETTLED = 1e-13


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


def law_at_orbit(
    kind: type[ContactLaw],
    restitution: float,
    duration: ArrayLike,
    n: int,
    amplitude: float,
    side: Side = Side.STABLE,
) -> ContactLaw:
    """The contact laws with r and D at the impact speeds of their own n-T orbits at Λ.

    A law whose restitution falls with the speed has *one* r and *one* D only at a speed. To
    compare models, it is given by both at the impact speed of the orbit in question.

    Raises
    ------
    NoOrbitError
        If there is no such orbit.
    ModelError
        If no law of this kind has these r and D.

    Examples
    --------
    >>> from bouncing_ball.contacts.law_signature import free_impact
    >>> from bouncing_ball.contacts.laws.tsuji import Tsuji
    >>> law = law_at_orbit(Tsuji, 0.65, 0.1, 1, 1.0)
    >>> speed = -LawModel(law).orbit(1, 1.0).relative_impact_velocity
    >>> round(float(free_impact(law, speed).duration), 12)
    0.1
    """
    taken = np.asarray(duration, dtype=float)
    speed = np.full_like(taken, rigid_speed(n, restitution))
    before = missed_before = np.full_like(taken, np.nan)
    for _ in range(_ROUNDS):
        law = law_of_impact(kind, restitution, taken, speed)
        model = LawModel(law)
        orbit = model.orbit(n, amplitude, side)
        lost = np.flatnonzero(~np.atleast_1d(orbit.exists))
        if lost.size:
            LawModel(law.take(lost[0])).require_orbit(n, amplitude, side)
        missed = -orbit.relative_impact_velocity - speed
        if np.all(np.abs(missed) <= _SETTLED * speed):
            return law
        slope = np.full_like(taken, -1.0)
        np.divide(missed - missed_before, speed - before, out=slope, where=speed != before)
        before, missed_before = speed, missed
        speed = speed - missed / np.where(np.abs(slope + 1) < 0.5, slope, -1.0)
    raise NoOrbitError(
        f"no {n}-T orbit at Λ = {amplitude:g} whose own impact has r = {restitution:g} and "
        f"D = {float(taken.flat[0]):g} was found for {kind.name}"
    )
