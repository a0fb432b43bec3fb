r"""Hertz contacts with Tsuji's damping in LAMMPS and LIGGGHTS.

Both have the force ``k x^{3/2} + C √(mk) x^{1/4} x′`` of a sphere on a wall, with k = (4/3) E* √R,
and find C from r themselves: its r is the same at every speed
(:mod:`bouncing_ball_beyond.models.laws.hertzian`).

* *LAMMPS*: ``wall/gran granular hertz K r … damping coeff_restitution``, where K = k/√R = (4/3) E*
  belongs to the sphere. Its ``damping tsuji`` computes C by another formula, and r is larger.
* *LIGGGHTS*: ``model hertz`` with E and ν of the types of the ball and of the wall, and r of their
  pair, ``1/E* = (1 - ν₁²)/E₁ + (1 - ν₂²)/E₂``. Tangential forces depend on them by more than E*, so
  that the materials that were given are written. If only E* was given, both have ν = 0.3 and
  E = 2(1 - ν²) E*.
"""

import math
from collections.abc import Mapping
from typing import Any, ClassVar

from bouncing_ball.errors import ParameterError
from bouncing_ball_beyond.models.damping import Release
from bouncing_ball_contacts.engines.engine import EngineParameters, Physical, twelve_digits
from bouncing_ball_contacts.engines.proportional import Proportional
from bouncing_ball_contacts.engines.scheme import Scheme

LAWS = {"tsuji": "tsuji"}
"""The law of both engines, by the name that users may give."""
# Of the many E and ν that have the same E*, those of two alike bodies of a usual solid.
_POISSON = 0.3


class _HertzWall(Proportional):
    """A sphere on a wall, from the SI parameters of a law, the sphere's ``radius`` and r."""

    releases = (Release.DISPLACEMENT,)
    scheme = Scheme.SEMI_IMPLICIT
    half_steps = True

    def __init__(self, law_in_si: Mapping[str, Any]):
        self._radius = law_in_si["radius"]
        if self._radius is None:
            raise ParameterError(
                f"{{radius}} of the sphere is missing: {self.name} multiplies the stiffness of "
                "Hertz by its root"
            )
        self._stiffness = law_in_si["stiffness"]

    @property
    def _modulus(self) -> float:
        """E* in Pa."""
        return self._stiffness / math.sqrt(self._radius) * 3 / 4

    def numbers(self, contact: Physical) -> dict[str, float]:
        return {**super().numbers(contact), "radius": twelve_digits(self._radius)}


class HertzLammps(_HertzWall):
    """``fix wall/gran granular hertz`` with ``damping coeff_restitution``.

    Examples
    --------
    >>> law = {"stiffness": 2e6, "radius": 0.25}
    >>> contact = Physical(mass=1.0, stiffness=1e6, damping=0.0)
    >>> HertzLammps(law).parameters(contact)
    {'hertz': 4000000.0, 'coeff_restitution': 1.0}
    """

    name = "lammps"
    names = ("hertz", "coeff_restitution")
    text: ClassVar[str] = "lammps-hertz"

    def parameters(self, contact: Physical) -> EngineParameters:
        values = 4 / 3 * self._modulus, contact.restitution(Release.DISPLACEMENT)
        return dict(zip(self.names, map(twelve_digits, values), strict=True))


class HertzLiggghts(_HertzWall):
    """``model hertz`` of LIGGGHTS.

    The SI parameters may have the ``materials`` of ball and wall: E and ν of each.

    Examples
    --------
    >>> law = {"stiffness": 2e6, "radius": 0.25}
    >>> HertzLiggghts(law).parameters(Physical(mass=1.0, stiffness=1e6, damping=0.0))
    {'youngsModulus': [5460000.0, 5460000.0], 'poissonsRatio': [0.3, 0.3], \
'coefficientRestitution': 1.0}
    """

    name = "liggghts"
    was_run = False
    names = ("youngsModulus", "poissonsRatio", "coefficientRestitution")
    text: ClassVar[str] = "liggghts-hertz"

    def __init__(self, law_in_si: Mapping[str, Any]):
        super().__init__(law_in_si)
        alike = (2 * (1 - _POISSON**2) * self._modulus, _POISSON)
        self._materials = law_in_si.get("materials") or (*alike, *alike)

    def parameters(self, contact: Physical) -> EngineParameters:
        ball, ball_ratio, wall, wall_ratio = map(twelve_digits, self._materials)
        values: tuple[float | list[float], ...] = (
            [ball, wall],
            [ball_ratio, wall_ratio],
            twelve_digits(contact.restitution(Release.DISPLACEMENT)),
        )
        return dict(zip(self.names, values, strict=True))
