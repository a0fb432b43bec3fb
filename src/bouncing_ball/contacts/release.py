"""The condition that ends a contact, and the number that represents it in formulas.

A contact ends where ``δ + κ δ′ = 0``. With κ = 0 the ball is back at the
table's level; with κ = 2ζ/ϖ the contact force vanishes. Formulas
contain the condition as ``sin α = κϖ/2``, which is 0 or ζ, so that both releases have the same
formulas; a free contact ends at the angle π - 2α.
"""

from enum import StrEnum

import numpy as np
from numpy.typing import ArrayLike

from bouncing_ball.contacts.elementary import arctangent
from bouncing_ball.errors import one_of


class Release(StrEnum):
    """The condition that ends a contact."""

    DISPLACEMENT = "displacement"
    """The ball is back at the table's level, δ = 0 (Eq. 23, the paper's)."""
    FORCE = "force"
    """The contact force vanishes, 2ζϖ δ′ + ϖ² δ = 0, so that it never pulls the ball."""

    @classmethod
    def of(cls, rule: str) -> "Release":
        """The release with this name.

        Raises
        ------
        ModelError
            If there is no such release.

        Examples
        --------
        >>> Release.of("force")
        <Release.FORCE: 'force'>
        """
        return one_of("release", rule, {str(each): each for each in cls})

    def sine(self, damping_ratio: ArrayLike) -> np.ndarray:
        """``sin α = κϖ/2``: 0 for the displacement release, ζ for the force release.

        Examples
        --------
        >>> float(Release.DISPLACEMENT.sine(0.3)), float(Release.FORCE.sine(0.3))
        (0.0, 0.3)
        """
        zeta = np.asarray(damping_ratio, dtype=float)
        return zeta if self is Release.FORCE else np.zeros_like(zeta)

    def free_angle(self, damping_ratio: ArrayLike) -> np.ndarray:
        """π - 2α: the angle ϖ_d s at which a free contact with ζ < 1 ends.

        Examples
        --------
        >>> float(Release.DISPLACEMENT.free_angle(0.5)) == np.pi
        True
        """
        # This form, 2 arccos, keeps its digits as ζ → 1, where π - 2 arcsin would lose them.
        sine = self.sine(damping_ratio)
        return 2 * arctangent(np.sqrt((1 - sine) * (1 + sine)), sine)
