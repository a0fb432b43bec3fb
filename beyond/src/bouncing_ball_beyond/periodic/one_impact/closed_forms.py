"""The n-T orbits of the models of which a closed form is known.

The branch of each of these models is a curve that is known as a formula: Λ cos φ = Λ_SN for the
restitution model, a line as well for the corrected model of a linear contact, and the explicit
branch of the spring-damper model. They are a second route beside the equations of
:mod:`~bouncing_ball_beyond.periodic.orbits.problem`, and they are the starts of branches.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import ClassVar, cast

import numpy as np
from numpy.typing import ArrayLike

from bouncing_ball_beyond.inherited.periodic.orbit import Side, check_index
from bouncing_ball_beyond.inherited.periodic.restitution_branch import (
    restitution_period_doubling,
    restitution_saddle_node,
)
from bouncing_ball_beyond.models.contact_model import ContactModel
from bouncing_ball_beyond.models.corrected.impact import impact
from bouncing_ball_beyond.models.corrected.model import CorrectedModel
from bouncing_ball_beyond.models.instant import Instant
from bouncing_ball_beyond.models.rigid import RestitutionModel
from bouncing_ball_beyond.models.spring_damper import SpringDamper
from bouncing_ball_beyond.periodic.one_impact import corrected_branch as line
from bouncing_ball_beyond.periodic.one_impact import spring_damper_bifurcations as bifurcations
from bouncing_ball_beyond.periodic.one_impact.orbits_of_model import OrbitsOfModel
from bouncing_ball_beyond.periodic.one_impact.restitution_branch import phase
from bouncing_ball_beyond.periodic.one_impact.spring_damper_branch import orbits_on_branch
from bouncing_ball_beyond.periodic.orbits.orbit import Orbit

# Bound of the rounding error of a Λ that is exactly 0, in units in the last place of z′_i; the
# largest error found for ϖ = 0.6…10⁶ and n = 1…100, under both rules, was 3.9 units.
_UNITS = 8


@dataclass(frozen=True)
class RestitutionLine(OrbitsOfModel):
    """The line Λ cos φ = nπ (1 - r)/(1 + r) of the restitution model (Eq. 6)."""

    model: RestitutionModel

    is_complete: ClassVar[bool] = True

    def orbit(self, n: ArrayLike, amplitude: ArrayLike, side: Side) -> Orbit:
        """The n-T orbits at Λ on one side of the saddle-node; NaN below the saddle-node."""
        r = self.model.restitution
        lam = np.asarray(amplitude, dtype=float)
        fold = restitution_saddle_node(n, r)
        exists = lam >= fold
        found = phase(n, r, np.where(exists, lam, fold), side)
        return Orbit.of(self.model, n, lam, np.where(exists, found, np.nan))

    def saddle_node(self, n: ArrayLike) -> Orbit:
        """The orbits at the saddle-node (Eq. 7), where φ = 0."""
        return Orbit.of(self.model, n, restitution_saddle_node(n, self.model.restitution), 0.0)

    def period_doubling(self, n: ArrayLike) -> Orbit:
        """The orbits at the period doubling of the exact map; Eq. 8 is that of Holmes' map."""
        r = self.model.restitution
        lam = restitution_period_doubling(n, r)
        return Orbit.of(self.model, n, lam, phase(n, r, lam))


@dataclass(frozen=True)
class SpringDamperBranch(OrbitsOfModel):
    """The explicit branch of :mod:`.spring_damper_branch`."""

    model: ContactModel

    is_complete: ClassVar[bool] = True

    @property
    def _contact(self) -> SpringDamper:
        """The law, which is that of a spring and a damper where it has this branch."""
        return cast(SpringDamper, self.model.law)

    def orbit(self, n: ArrayLike, amplitude: ArrayLike, side: Side) -> Orbit:
        """The n-T orbits at Λ on one side of the saddle-node."""
        return bifurcations.orbit_at(self._contact, n, amplitude, side)

    def orbits(self, n: int, amplitude: float) -> Orbit:
        """All n-T orbits of one contact at one Λ: see :func:`.orbits_at`."""
        return bifurcations.orbits_at(self._contact, n, amplitude)

    def saddle_node(self, n: ArrayLike) -> Orbit:
        """The orbits at the saddle-node.

        Without dissipation it is at Λ = 0. There Λ is the difference of terms as large as z′_i, and
        a Λ of the order of their rounding error is set to 0.

        Examples
        --------
        >>> from bouncing_ball_beyond.models.spring_damper import SpringDamper
        >>> model = ContactModel(SpringDamper(10.0, 0.0))
        >>> SpringDamperBranch(model).saddle_node([1, 2]).amplitude.tolist()
        [0.0, 0.0]
        """
        contact = self._contact
        found = orbits_on_branch(bifurcations.saddle_node(contact, n), contact, n)
        rounding = _UNITS * np.spacing(np.abs(found.impact_velocity))
        lam = np.where(found.amplitude <= rounding, 0.0, found.amplitude)
        return replace(found, amplitude=lam if lam.ndim else float(lam))

    def period_doubling(self, n: ArrayLike) -> Orbit:
        """The orbits at the period doubling nearest to the saddle-node."""
        contact = self._contact
        doubling = bifurcations.period_doubling(contact, n)
        return orbits_on_branch(doubling, contact, n)


@dataclass(frozen=True)
class CorrectedLine(OrbitsOfModel):
    """The line of :mod:`.corrected_branch`, for a signature that does not depend on the speed."""

    model: CorrectedModel

    is_complete: ClassVar[bool] = True

    @property
    def _instant(self) -> Instant:
        return self.model.law(np.ones(self.model.shape))

    def orbit(self, n: ArrayLike, amplitude: ArrayLike, side: Side) -> Orbit:
        """The n-T orbits at Λ on one side of the saddle-node."""
        check_index(n)
        lam = np.asarray(amplitude, dtype=float)
        psi = line.instant_phase(n, self._instant, lam, side is Side.STABLE)
        return corrected_orbits(self.model, n, lam, psi)

    def saddle_node(self, n: ArrayLike) -> Orbit:
        """The orbits at the saddle-node, ψ = -χ."""
        check_index(n)
        lam = line.saddle_node(n, self._instant)
        psi = line.saddle_node_phase(self._instant)
        return corrected_orbits(self.model, n, lam, np.where(np.isnan(lam), np.nan, psi))

    def period_doubling(self, n: ArrayLike) -> Orbit:
        """The orbits at the period doubling."""
        check_index(n)
        lam, psi = line.period_doubling(n, self._instant)
        return corrected_orbits(self.model, n, lam, psi)


def corrected_orbits(
    model: CorrectedModel, n: ArrayLike, amplitude: ArrayLike, psi: ArrayLike
) -> Orbit:
    """The orbits with instants at the phase ψ, before which the velocity is -nπ.

    Examples
    --------
    >>> from bouncing_ball_beyond.models.spring_damper import SpringDamper
    >>> model = CorrectedModel.of_contact(SpringDamper(np.pi, 0.0))
    >>> orbit = corrected_orbits(model, 1, 0.8, np.pi / 2)
    >>> orbit.bounce_velocity == np.pi - 0.5, round(orbit.phase - np.pi / 2, 12)
    (True, -0.5)
    """
    launch = np.asarray(n) * np.pi
    hit = impact(model.law, amplitude, psi, -launch)
    delay = hit.instant.delay
    return Orbit.of(model, n, amplitude, hit.phase - delay, hit.instant.duration, delay - launch)
