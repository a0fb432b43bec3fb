"""The corrected restitution model and its n-T orbits.

Its equations are derived in :mod:`bouncing_ball.orbits.corrected_branch`.
"""

from dataclasses import dataclass
from typing import ClassVar

import numpy as np
from numpy.typing import ArrayLike

from bouncing_ball.contacts.signature import Instant, Signature
from bouncing_ball.contacts.spring_damper import SpringDamper
from bouncing_ball.orbits import corrected_branch as formulas
from bouncing_ball.orbits.continued import ContinuedModel
from bouncing_ball.orbits.corrected_orbit import CorrectedOrbit
from bouncing_ball.orbits.orbit import Orbit, check_index
from bouncing_ball.orbits.stability import Side


@dataclass(frozen=True, repr=False)
class CorrectedModel(ContinuedModel):
    """A ball whose impacts are instants at the centroid of the contact force.

    Parameters
    ----------
    law : Signature
        Delay, restitution, load sensitivity and duration of the impact as functions of its speed.

    Examples
    --------
    >>> model = CorrectedModel.of_contact(SpringDamper.from_restitution(0.65, 10.0))
    >>> round(float(model.orbit(1, 1.0).max_height), 3)
    5.215
    """

    law: Signature

    name: ClassVar[str] = "corrected"
    orbit_type: ClassVar[type[Orbit]] = CorrectedOrbit

    @classmethod
    def of_contact(cls, contact: SpringDamper) -> "ConstantCorrectedModel":
        """The corrected model of a spring-damper contact, whose orbits have a closed form.

        Raises
        ------
        ModelError
            If ζ ≥ 1.
        """
        return ConstantCorrectedModel(Signature(contact))

    def signature(self, speed: ArrayLike) -> Instant:
        """The signature at impact speeds v > 0."""
        return self.law(speed)


class ConstantCorrectedModel(CorrectedModel):
    """The corrected model with a signature that does not depend on the speed, in closed form."""

    has_closed_form: ClassVar[bool] = True

    @property
    def _instant(self) -> Instant:
        return self.law(np.ones(self.shape))

    def orbit(self, n: ArrayLike, amplitude: ArrayLike, side: Side = Side.STABLE) -> CorrectedOrbit:
        """The n-T orbits at Λ on one side of the saddle-node; NaN where there is no orbit."""
        check_index(n)
        lam = np.asarray(amplitude, dtype=float)
        psi = formulas.instant_phase(n, self._instant, lam, side == Side.STABLE)
        return CorrectedOrbit.at(n, self.law, lam, psi)

    def saddle_node(self, n: ArrayLike) -> CorrectedOrbit:
        """The orbits at the saddle-node, ψ = -χ; NaN where the branch has no saddle-node."""
        check_index(n)
        lam, psi = formulas.saddle_node(n, self._instant), formulas.saddle_node_phase(self._instant)
        return CorrectedOrbit.at(n, self.law, lam, np.where(np.isnan(lam), np.nan, psi))

    def period_doubling(self, n: ArrayLike) -> CorrectedOrbit:
        """The orbits at the period doubling; NaN where there is no period doubling."""
        check_index(n)
        return CorrectedOrbit.at(n, self.law, *formulas.period_doubling(n, self._instant))
