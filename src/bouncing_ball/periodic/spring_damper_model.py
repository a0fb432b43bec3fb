"""The spring-damper model: a linear contact together with its n-T orbits."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import ClassVar

import numpy as np
from numpy.typing import ArrayLike

from bouncing_ball.models.instant import Instant
from bouncing_ball.models.permanent_contact import permanent_contact_threshold
from bouncing_ball.models.spring_damper import SpringDamper
from bouncing_ball.periodic import spring_damper_bifurcations as bifurcations
from bouncing_ball.periodic.model import ImpactModel
from bouncing_ball.periodic.orbit import Orbit
from bouncing_ball.periodic.spring_damper_branch import nearest_excess
from bouncing_ball.periodic.spring_damper_orbit import SpringDamperOrbit
from bouncing_ball.periodic.stability import Side

# Bound of the rounding error of a Λ that is exactly 0, in units in the last place of z′_i; the
# largest error found for ϖ = 0.6…10⁶ and n = 1…100, under both rules, was 3.9 units.
_UNITS = 8


@dataclass(frozen=True, repr=False)
class SpringDamperModel(ImpactModel):
    """A ball on a table with a spring-damper contact (Eqs. 10-27).

    Its orbits lie on an explicit curve; see :mod:`bouncing_ball.periodic.spring_damper_branch`.

    Parameters
    ----------
    contact : SpringDamper
        ϖ, ζ < 1 and the release rule.

    Examples
    --------
    >>> model = SpringDamperModel(SpringDamper.from_restitution(0.85, 2.0))
    >>> model.orbits(1, 0.9).contact_duration.round(3).tolist()
    [1.602, 2.249, 5.182]
    """

    contact: SpringDamper

    name: ClassVar[str] = "spring-damper"
    orbit_type: ClassVar[type[Orbit]] = SpringDamperOrbit

    @property
    def label(self) -> str:
        contact = self.contact
        return f"ϖ = {float(contact.frequency_ratio):g}, ζ = {float(contact.damping_ratio):.4g}"

    def signature(self, speed: ArrayLike) -> Instant:
        """The signature of the contact, which is the same at every speed."""
        return self.contact.signature(speed)

    def orbit(
        self, n: ArrayLike, amplitude: ArrayLike, side: Side = Side.STABLE
    ) -> SpringDamperOrbit:
        """The n-T orbits at Λ on one side of the saddle-node; NaN where there is no orbit.

        Arguments, shape and errors are those of :meth:`.ImpactModel.orbit`.
        """
        return bifurcations.orbit_at(self.contact, n, amplitude, side)

    def orbits(self, n: int, amplitude: float) -> SpringDamperOrbit:
        """All n-T orbits of one contact at one Λ, in order of contact duration, shape (count,).

        See :func:`~bouncing_ball.periodic.spring_damper_bifurcations.orbits_at`.
        """
        return bifurcations.orbits_at(self.contact, n, amplitude)

    def saddle_node(self, n: ArrayLike) -> SpringDamperOrbit:
        """The orbits at the saddle-node; NaN where the branch has no saddle-node.

        Arguments, shape and errors are those of :meth:`.ImpactModel.saddle_node`.
        Without dissipation the saddle-node is at Λ = 0. There Λ is the difference of terms as large
        as z′_i, and a Λ of the order of their rounding error is set to 0.

        Examples
        --------
        >>> SpringDamperModel(SpringDamper(10.0, 0.0)).saddle_node([1, 2]).amplitude.tolist()
        [0.0, 0.0]
        """
        excess = bifurcations.saddle_node(self.contact, n)
        found = SpringDamperOrbit.on_branch(excess, self.contact, n)
        rounding = _UNITS * np.spacing(np.abs(found.impact_velocity))
        lam = np.where(found.amplitude <= rounding, 0.0, found.amplitude)
        return replace(found, amplitude=lam)

    def period_doubling(self, n: ArrayLike) -> SpringDamperOrbit:
        """The orbits at the period doubling nearest to the saddle-node; NaN where there is none.

        Arguments, shape and errors are those of :meth:`.ImpactModel.period_doubling`.
        """
        excess = bifurcations.period_doubling(self.contact, n)
        return SpringDamperOrbit.on_branch(excess, self.contact, n)

    def nearest(self, orbit: SpringDamperOrbit) -> SpringDamperOrbit:
        """The points of the branch that are nearest to given orbits in (Λ cos φ, Λ sin φ, ε), of
        the shape of these orbits.
        """
        contact = orbit.law
        excess = orbit.contact_duration * contact.damped_frequency - contact.free_angle
        x = orbit.amplitude * np.cos(orbit.phase)
        y = orbit.amplitude * np.sin(orbit.phase)
        nearest = nearest_excess(contact, orbit.n, x, y, excess)
        return SpringDamperOrbit.on_branch(nearest, contact, orbit.n)

    def permanent_contact_threshold(self) -> np.ndarray:
        """Λ up to which the ball stays on the table, of the model's shape.

        It is Λ_SD(ϖ) for the displacement release and Λ_F(ϖ) for the force release.
        """
        contact = self.contact
        return permanent_contact_threshold(
            contact.frequency_ratio, contact.damping_ratio, contact.release
        )
