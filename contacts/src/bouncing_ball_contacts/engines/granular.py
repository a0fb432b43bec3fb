"""Granular engines, whose walls have Hooke's law with a damper.

* *LAMMPS* and *LIGGGHTS*: the damper is per unit of mass. The
  force of ``fix wall/gran hooke`` on a sphere is ``kn p - m gamman v``. On a wall the effective
  mass m is that of the sphere; between two equal spheres it is half of that. By default the damper
  pulls until the ball has left the wall; ``limit_damping`` in LAMMPS and ``limitForce`` in LIGGGHTS
  prevent that.
* *MercuryDPM*: a linear viscoelastic species, whose damper pulls until the ball has left.
"""

from collections.abc import Mapping
from typing import Any, ClassVar

from bouncing_ball_beyond.models.damping import Release
from bouncing_ball_contacts.engines.engine import Engine
from bouncing_ball_contacts.engines.hertz_granular import LAWS, HertzLammps, HertzLiggghts
from bouncing_ball_contacts.engines.proportional import Proportional
from bouncing_ball_contacts.engines.scheme import Scheme


class Lammps(Proportional):
    """``fix wall/gran hooke``: kn = k in N/m, gamma_n = c/m in 1/s.

    Examples
    --------
    >>> from bouncing_ball_contacts.engines.engine import Physical
    >>> found = Lammps().settings(Physical(mass=2.0, stiffness=200.0, damping=4.0))
    >>> found.parameters, found.release
    ({'kn': 200.0, 'gamma_n': 2.0}, 'displacement')
    >>> Lammps().read(found.parameters, 2.0)
    Physical(mass=2.0, stiffness=200.0, damping=4.0)
    """

    name = "lammps"
    names = ("kn", "gamma_n")
    releases = (Release.DISPLACEMENT, Release.FORCE)
    scheme = Scheme.SEMI_IMPLICIT
    half_steps = True
    laws: ClassVar[dict[str, str]] = LAWS

    def with_law(self, law_in_si: Mapping[str, Any]) -> Engine:
        return HertzLammps(law_in_si)

    def factors(self, mass: float) -> tuple[float, float]:
        return 1.0, 1 / mass


class Liggghts(Lammps):
    """``model hooke/stiffness``: kn = k in N/m and gamman = c/m in 1/s, for one type of atom.

    Examples
    --------
    >>> from bouncing_ball_contacts.engines.engine import Physical
    >>> Liggghts().parameters(Physical(mass=2.0, stiffness=200.0, damping=4.0))
    {'kn': 200.0, 'gamman': 2.0}
    """

    name = "liggghts"
    was_run = False
    names = ("kn", "gamman")

    def with_law(self, law_in_si: Mapping[str, Any]) -> Engine:
        return HertzLiggghts(law_in_si)


class MercuryDPM(Proportional):
    """``LinearViscoelasticSpecies``: stiffness k in N/m and dissipation c in N s/m.

    Examples
    --------
    >>> from bouncing_ball_contacts.engines.engine import Physical
    >>> MercuryDPM().parameters(Physical(mass=2.0, stiffness=200.0, damping=4.0))
    {'stiffness': 200.0, 'dissipation': 4.0}
    """

    name = "mercurydpm"
    was_run = False
    names = ("stiffness", "dissipation")
    releases = (Release.DISPLACEMENT,)
    scheme = Scheme.SEMI_IMPLICIT
    half_steps = True
