"""A ball on a contact of any law, and its n-T orbits without a closed form.

:mod:`bouncing_ball.models.laws.collocation` computes the contact of an orbit and its derivatives.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any, ClassVar, Self

import numpy as np
from numpy.typing import ArrayLike

from bouncing_ball.errors import NoOrbitError
from bouncing_ball.models.instant import Instant
from bouncing_ball.models.laws.collocation import contacts, path
from bouncing_ball.models.laws.contact_law import ContactLaw
from bouncing_ball.models.laws.law_of_impact import law_of_impact
from bouncing_ball.models.laws.march import ContactEnds
from bouncing_ball.models.laws.permanent_contact import permanent_contact
from bouncing_ball.models.laws.signature import Signature
from bouncing_ball.numerics.corrector import NewtonSettings, newton, plane
from bouncing_ball.periodic.continued_orbits import ContinuedModel, orbit_at, orbits_at
from bouncing_ball.periodic.orbit import Orbit
from bouncing_ball.periodic.restitution_branch import rigid_speed
from bouncing_ball.periodic.stability import Side

# The largest number of rounds that compute the law and the orbit in turn. At given r and D the
# speed hardly depends on the law, and after a secant step less than a hundredth of the last step
# is left.
_ROUNDS = 20
_SETTLED = 1e-10
# From the orbits of the round before, the error after a step of this length is its square.
_CLOSE = NewtonSettings(tolerance=1e-7)


class LawOrbit(Orbit):
    """n-T orbits of a contact law; ``law`` is the :class:`ContactLaw`.

    Examples
    --------
    >>> from bouncing_ball.models.laws.hertzian import HuntCrossley
    >>> orbit = LawModel(HuntCrossley(1e3, 0.0)).orbit(1, 0.5)
    >>> float(orbit.determinant())
    1.0
    """

    dynamics = staticmethod(ContactLaw.dynamics)

    @classmethod
    def at(cls, n: ArrayLike, law: ContactLaw, amplitude: ArrayLike, *start: ArrayLike) -> Self:
        """The orbits whose contacts start with (φ, z′_i); their duration follows from the law."""
        columns = (np.asarray(x, dtype=float) for x in (amplitude, *start))
        lam, phi, velocity = np.broadcast_arrays(*columns, np.zeros(law.shape))[:3]
        found = contacts(law, lam * np.cos(phi) - velocity, phi, lam)
        orbit = cls(n, law, lam, phi, found.duration, velocity)
        # The cached property below would compute the same contact again.
        orbit.__dict__["contact"] = found
        return orbit

    @cached_property
    def contact(self) -> ContactEnds:
        """The contact that starts at the orbit's impact: its end, its derivatives and its path."""
        return contacts(self.law, -self.relative_impact_velocity, self.phase, self.amplitude)

    @property
    def clock(self) -> ArrayLike:
        """π/D, which corresponds to ϖ of the linear contact."""
        return np.pi / np.asarray(self.contact_duration)

    def contact_motion(self, time: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """δ and δ′ at times 0 ≤ τ ≤ τ_b in contact, of the shape of the times."""
        speed = -self.relative_impact_velocity
        depth, rate = path(self.law, self.contact, time, speed, self.phase, self.amplitude)
        return -depth, -rate

    def residual(self) -> np.ndarray:
        """Duration, velocity and landing defects, shape (..., 3).

        The first defect is π times the relative error of the duration; the others are Eqs. 24-25.
        """
        found = self.contact
        late = (found.duration - self.contact_duration) * self.clock
        return np.stack([late, *self.flight_defects(-found.penetration, -found.rate)], axis=-1)

    def contact_jacobian(self) -> np.ndarray:
        """Jacobian of (τ_b, δ_b, δ′_b) in (τ, δ′, Λ) at the impact, shape (..., 3, 3)."""
        sign = np.array([[1.0, -1.0, 1.0], [-1.0, 1.0, -1.0], [-1.0, 1.0, -1.0]])
        return self.contact.jacobian[..., :3] * sign

    def determinant(self) -> np.ndarray:
        """exp(-∫ ∂f/∂p′ dτ) over the contact, because only the contact contracts areas."""
        return self.contact.contraction


@dataclass(frozen=True, repr=False)
class LawModel(ContinuedModel):
    """A ball on a contact of any law.

    Parameters
    ----------
    law : ContactLaw
        One law, or an array of laws.

    Examples
    --------
    >>> from bouncing_ball.models.laws.hertzian import Tsuji, tsuji_damping
    >>> model = LawModel(Tsuji(500.0, tsuji_damping(0.85)))
    >>> limits = model.saddle_node(1).amplitude, model.period_doubling(1).amplitude
    >>> [round(float(x), 3) for x in limits]
    [0.246, 1.037]
    """

    law: ContactLaw

    name: ClassVar[str] = "contact-law"
    orbit_type: ClassVar[type[Orbit]] = LawOrbit

    def signature(self, speed: ArrayLike) -> Instant:
        """The signature of free impacts with speeds v > 0.

        Raises
        ------
        ModelError
            If the law does not release the ball.
        """
        law = self.law
        # One table serves all laws of such a kind; otherwise a few speeds cost less than a table.
        at = law.signature if law.scaled(np.ones(1)) is None else Signature(law)
        return at(speed)

    def orbits(self, n: int, amplitude: float) -> LawOrbit:
        """The n-T orbits of one law at one Λ, in order of contact duration, shape (count,).

        These are the orbits on the branch that comes from large Λ. Where this branch cannot be
        followed, they are the orbits on both sides of the saddle-node.
        """
        return orbits_at(self, n, amplitude)

    def permanent_contact_threshold(self) -> np.ndarray:
        """Λ up to which a steady contact never releases the ball, of the shape of the laws."""
        laws = self.law.flat(self.law.shape)
        found = [permanent_contact(laws.take(k)) for k in range(self.law.size)]
        return np.array(found).reshape(self.law.shape)


def _next_to(model: LawModel, orbit: LawOrbit) -> LawOrbit:
    """The orbits of laws with the n and Λ of given orbits of similar laws; NaN where Newton's
    method does not converge from these.
    """
    system = model.system(orbit.n)
    guess = system.point(orbit)
    found = newton(system, guess, plane(np.eye(guess.shape[-1])[-1], guess), _CLOSE)
    return system.orbit(np.where(found.converged[..., np.newaxis], found.point, np.nan))


def law_at_orbit(
    kind: type[ContactLaw],
    restitution: float,
    duration: ArrayLike,
    n: int,
    amplitude: float,
    side: Side = Side.STABLE,
) -> ContactLaw:
    """The contact laws whose free impacts have r and D at the impact speed of their n-T orbit at Λ.

    The restitution and the duration of a law may depend on the speed. To compare models, r and D
    are therefore prescribed at the impact speed of the orbit in question. A secant iteration finds
    this speed.

    Parameters
    ----------
    kind : type of ContactLaw
    restitution : float
        r in (0, 1].
    duration : array_like
        D; there is one law for each D.
    n : int
        Index of the family.
    amplitude : float
        Λ.
    side : Side

    Returns
    -------
    ContactLaw
        Has the shape of ``duration``.

    Raises
    ------
    NoOrbitError
        If there is no such orbit.
    ModelError
        If no law of this kind has these r and D.

    Examples
    --------
    >>> from bouncing_ball.models.laws.hertzian import Tsuji
    >>> law = law_at_orbit(Tsuji, 0.65, 0.1, 1, 1.0)
    >>> speed = -LawModel(law).orbit(1, 1.0).relative_impact_velocity
    >>> round(float(law.signature(speed).duration), 12)
    0.1
    """
    side = Side(side)
    taken = np.asarray(duration, dtype=float)
    speed = np.full_like(taken, rigid_speed(n, restitution))
    before = missed_before = np.full_like(taken, np.nan)
    orbit: Any = None
    for tried in range(_ROUNDS):
        law = law_of_impact(kind, restitution, taken, speed)
        model = LawModel(law)
        orbit = _next_to(model, orbit) if tried else orbit_at(model, n, amplitude, side)
        lost = np.flatnonzero(~np.atleast_1d(orbit.exists))
        if lost.size:
            LawModel(law.take(lost[0])).require_orbit(n, amplitude, side)
        missed = -orbit.relative_impact_velocity - speed
        slope = np.full_like(taken, -1.0)
        np.divide(missed - missed_before, speed - before, out=slope, where=speed != before)
        before = speed
        missed_before = missed
        speed = speed - missed / np.where(np.abs(slope + 1) < 0.5, slope, -1.0)
        if np.all(np.abs(missed) <= _SETTLED * speed):
            return law_of_impact(kind, restitution, taken, speed)
    raise NoOrbitError(
        f"no {n}-T orbit at Λ = {amplitude:g} whose impact has r = {restitution:g} and "
        f"D = {float(taken.flat[0]):g} was found for {kind.name}"
    )
