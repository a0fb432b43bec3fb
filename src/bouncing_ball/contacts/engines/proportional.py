"""Engines whose contact has two parameters, proportional to the stiffness and to the damping.

* *generic*: any script with a spring, a damper and a rule that ends the contact.
* *LAMMPS* and *LIGGGHTS*: granular walls with Hooke's law, whose damper is per unit of mass. The
  force of ``fix wall/gran hooke`` on a sphere is ``kn p - m gamman v``. On a wall the effective
  mass m is that of the sphere; between two equal spheres it is half of that. By default the damper
  pulls until the ball has left the wall; ``limit_damping`` in LAMMPS and ``limitForce`` in LIGGGHTS
  prevent that.
* *MercuryDPM*: a linear viscoelastic species, whose damper pulls until the ball has left.
* *PyBullet*: a spring and a damper on each of the two bodies, which form one constraint.
"""

import math
from collections.abc import Mapping
from typing import Any, ClassVar

from bouncing_ball.contacts.engines.engine import (
    Engine,
    EngineParameters,
    Physical,
    Proportional,
)
from bouncing_ball.contacts.engines.hertz_granular import LAWS, HertzLammps, HertzLiggghts
from bouncing_ball.contacts.engines.scheme import Scheme
from bouncing_ball.errors import ModelError
from bouncing_ball.models.damping import Release


class Generic(Proportional):
    """The parameters m, k and c themselves, with semi-implicit Euler steps as in a simple script.

    Examples
    --------
    >>> print(Generic().snippet(Physical(2.0, 200.0, 4.0), Release.FORCE, 0.001))
    m = 2.0  # kg
    k = 200.0  # N/m
    c = 4.0  # N s/m
    h = 0.001  # s
    # The contact ends where the force vanishes: a free impact has r = 0.7441.
    # If it ended at p = 0, it would have r = 0.7292.
    <BLANKLINE>
    def force(p, rate):
        # p is the penetration in m, rate its derivative.
        return max(0.0, k * p + c * rate) if p > 0 else 0.0
    """

    name = "generic"
    names = ("stiffness", "damping")
    releases = (Release.DISPLACEMENT, Release.FORCE)
    scheme = Scheme.SEMI_IMPLICIT

    def parameters(self, contact: Physical) -> EngineParameters:
        return {"mass": contact.mass, **super().parameters(contact)}

    def read(self, parameters: Mapping[str, Any], mass: float | None) -> Physical:
        values = dict(parameters)
        mass = values.pop("mass", mass)
        return super().read(values, mass)


class Lammps(Proportional):
    """``fix wall/gran hooke``: kn = k in N/m, gamma_n = c/m in 1/s.

    Examples
    --------
    >>> from bouncing_ball.contacts.engines.engine import Physical
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
    laws: ClassVar[dict[str, str]] = LAWS

    def with_law(self, law_in_si: Mapping[str, Any]) -> Engine:
        return HertzLammps(law_in_si)

    def factors(self, mass: float) -> tuple[float, float]:
        return 1.0, 1 / mass


class Liggghts(Lammps):
    """``model hooke/stiffness``: kn = k in N/m and gamman = c/m in 1/s, for one type of atom.

    Examples
    --------
    >>> from bouncing_ball.contacts.engines.engine import Physical
    >>> Liggghts().parameters(Physical(mass=2.0, stiffness=200.0, damping=4.0))
    {'kn': 200.0, 'gamman': 2.0}
    """

    name = "liggghts"
    names = ("kn", "gamman")

    def with_law(self, law_in_si: Mapping[str, Any]) -> Engine:
        return HertzLiggghts(law_in_si)


class MercuryDPM(Proportional):
    """``LinearViscoelasticSpecies``: stiffness k in N/m and dissipation c in N s/m.

    Examples
    --------
    >>> from bouncing_ball.contacts.engines.engine import Physical
    >>> MercuryDPM().parameters(Physical(mass=2.0, stiffness=200.0, damping=4.0))
    {'stiffness': 200.0, 'dissipation': 4.0}
    """

    name = "mercurydpm"
    names = ("stiffness", "dissipation")
    releases = (Release.DISPLACEMENT,)
    scheme = Scheme.SEMI_IMPLICIT


class PyBullet(Proportional):
    """``changeDynamics`` of both bodies, whose springs are in series and whose dampings are added.

    If ball and table have the same parameters, these are 2k in N/m and c/2 in N s/m. By default,
    Bullet also has contacts of bodies that do not touch yet, at distances that depend on their
    sizes: the damper then acts from the surface on, so that r is ``exp(-ζωh)`` times the value
    without such contacts. The text to paste allows none, and no slop.

    ``restitution`` is another kind of contact: an instant with the product of both bodies' values.
    With contacts ahead the ball is stopped at the surface instead, so that r is 0; below
    ``restitutionVelocityThreshold`` it is 0 as well; and ``contactERP`` adds up to its own value
    to r, as it pushes the ball out of the table.

    Examples
    --------
    >>> from bouncing_ball.contacts.engines.engine import Physical
    >>> found = PyBullet().parameters(Physical(mass=2.0, stiffness=200.0, damping=4.0))
    >>> found
    {'contactStiffness': 400.0, 'contactDamping': 2.0}
    >>> PyBullet().read(found, 2.0)
    Physical(mass=2.0, stiffness=200.0, damping=4.0)
    """

    name = "pybullet"
    names = ("contactStiffness", "contactDamping")
    releases = (Release.FORCE,)
    scheme = Scheme.COMPENSATED

    def reader(self, parameters: Mapping[str, Any]) -> Engine:
        if "restitution" in parameters:
            both = float(parameters["restitution"]) ** 2
            raise ModelError(
                "restitution of pybullet has no stiffness: if ball and table have it, "
                f"r = {both:.4g} at any time step, with contactProcessingThreshold=0, contactERP=0 "
                "and "
                "restitutionVelocityThreshold=0, and 0 without the first of these"
            )
        return self

    def instant(self, restitution: float) -> str:
        each = f"restitution={math.sqrt(restitution):.6g}"
        return (
            f"Without a spring, {each} of ball and table alike has r = {restitution:.4g} at any "
            "time step, with contactProcessingThreshold=0, contactERP=0 and "
            "restitutionVelocityThreshold=0."
        )

    def factors(self, mass: float) -> tuple[float, float]:
        return 2.0, 0.5
