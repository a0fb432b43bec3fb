r"""Granular engines: walls with Hooke's law and a damper, or with Hertz' law and Tsuji's damper.

* *LAMMPS* and *LIGGGHTS*: the damper is per unit of mass. The
  force of ``fix wall/gran hooke`` on a sphere is ``kn p - m gamman v``. On a wall the effective
  mass m is that of the sphere; between two equal spheres it is half of that. By default the damper
  pulls until the ball has left the wall; ``limit_damping`` in LAMMPS and ``limitForce`` in LIGGGHTS
  prevent that.
* *MercuryDPM*: a linear viscoelastic species, whose damper pulls until the ball has left.

LAMMPS and LIGGGHTS also have the force ``k x^{3/2} + C √(mk) x^{1/4} x′`` of a sphere on a wall,
with k = (4/3) E* √R, and find C from r themselves: its r is the same at every speed
(:mod:`bouncing_ball_beyond.models.laws.hertzian`).

* *LAMMPS*: ``wall/gran granular hertz K r … damping coeff_restitution``, where K = k/√R = (4/3) E*
  belongs to the sphere. Its ``damping tsuji`` computes C by another formula, and r is larger.
* *LIGGGHTS*: ``model hertz`` with E and ν of the types of the ball and of the wall, and r of their
  pair, ``1/E* = (1 - ν₁²)/E₁ + (1 - ν₂²)/E₂``. Tangential forces depend on them by more than E*, so
  that the materials that were given are written. If only E* was given, both have ν = 0.3 and
  E = 2(1 - ν²) E*.
"""

import math
from dataclasses import replace
from typing import Any

from bouncing_ball_beyond.inherited.contacts.engines.engine import (
    EngineParameters,
    LawInSI,
    proportional,
    twelve_digits,
)
from bouncing_ball_beyond.inherited.contacts.engines.physical import Physical
from bouncing_ball_beyond.inherited.contacts.engines.scheme import Scheme
from bouncing_ball_beyond.inherited.errors import ParameterError
from bouncing_ball_beyond.models.damping import Release
from bouncing_ball_beyond.models.laws.hertzian import Tsuji

# Of the many E and ν that have the same E*, those of two alike bodies of a usual solid.
_POISSON = 0.3
_BOTH = (Release.DISPLACEMENT, Release.FORCE)
_VERLET = Scheme.SEMI_IMPLICIT


def _reduced_modulus(name: str, contact: Physical, law: LawInSI) -> float:
    """E* in Pa."""
    if law.radius is None:
        raise ParameterError(
            f"{{radius}} of the sphere is missing: {name} multiplies the stiffness of Hertz by its "
            "root"
        )
    return law.law.stiffness * contact.mass / math.sqrt(law.radius) * 3 / 4


def _hertz_lammps(contact: Physical, law: LawInSI) -> EngineParameters:
    """K and r.

    Examples
    --------
    >>> law = LawInSI(Tsuji(2e6, 0.0), radius=0.25)
    >>> _hertz_lammps(Physical(mass=1.0, stiffness=1e6, damping=0.0), law)
    {'hertz': 4000000.0, 'coeff_restitution': 1.0}
    """
    modulus = _reduced_modulus("lammps", contact, law)
    return {
        "hertz": twelve_digits(4 / 3 * modulus),
        "coeff_restitution": twelve_digits(contact.restitution(Release.DISPLACEMENT)),
    }


def _hertz_liggghts(contact: Physical, law: LawInSI) -> EngineParameters:
    """E and ν of ball and wall, and r.

    Examples
    --------
    >>> law = LawInSI(Tsuji(2e6, 0.0), radius=0.25)
    >>> _hertz_liggghts(Physical(mass=1.0, stiffness=1e6, damping=0.0), law)
    {'youngsModulus': [5460000.0, 5460000.0], 'poissonsRatio': [0.3, 0.3], \
'coefficientRestitution': 1.0}
    """
    alike = (2 * (1 - _POISSON**2) * _reduced_modulus("liggghts", contact, law), _POISSON)
    ball, ball_ratio, wall, wall_ratio = map(twelve_digits, law.materials or (*alike, *alike))
    return {
        "youngsModulus": [ball, wall],
        "poissonsRatio": [ball_ratio, wall_ratio],
        "coefficientRestitution": twelve_digits(contact.restitution(Release.DISPLACEMENT)),
    }


def _per_mass(mass: float) -> tuple[float, float]:
    """The factors of kn = k in N/m and gamma_n = c/m in 1/s."""
    return 1.0, 1 / mass


_LAMMPS = proportional("lammps", ("kn", "gamma_n"), _BOTH, _VERLET, _per_mass)
_LIGGGHTS = proportional("liggghts", ("kn", "gamman"), _BOTH, _VERLET, _per_mass)
_HERTZ: dict[str, Any] = {"releases": (Release.DISPLACEMENT,), "written_law": Tsuji}
LAMMPS = replace(
    _LAMMPS,
    laws={
        "tsuji": replace(_LAMMPS, parameters=_hertz_lammps, **_HERTZ),
    },
)
"""``fix wall/gran hooke``, and ``granular hertz`` with ``damping coeff_restitution``."""
LIGGGHTS = replace(
    _LIGGGHTS,
    laws={
        "tsuji": replace(_LIGGGHTS, parameters=_hertz_liggghts, **_HERTZ),
    },
)
"""``model hooke/stiffness``, for one type of atom, and ``model hertz``."""
MERCURYDPM = proportional(
    "mercurydpm",
    ("stiffness", "dissipation"),
    (Release.DISPLACEMENT,),
    _VERLET,
)
"""``LinearViscoelasticSpecies``: stiffness k in N/m and dissipation c in N s/m."""
