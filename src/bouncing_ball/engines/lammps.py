"""LAMMPS and LIGGGHTS: granular walls with Hooke's law, whose damper is per unit of mass.

The force of ``fix wall/gran hooke`` on a sphere is ``kn p - m gamman v``. A wall has no mass, so
that the effective mass is that of the sphere; between two equal spheres it is half of it. By
default the damper pulls until the ball has left the wall; ``limit_damping`` in LAMMPS and
``limitForce`` in LIGGGHTS prevent that.
"""

from bouncing_ball.contacts.release import Release
from bouncing_ball.engines.engine import Physical, Proportional
from bouncing_ball.engines.scheme import Scheme


class Lammps(Proportional):
    """``fix wall/gran hooke``: kn = k in N/m, gamma_n = c/m in 1/s.

    Examples
    --------
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

    def factors(self, mass: float) -> tuple[float, float]:
        return 1.0, 1 / mass

    def snippet(self, contact: Physical, release: Release, time_step: float) -> str:
        kn, gamma = self.parameters(contact).values()
        limit = " limit_damping" if release is Release.FORCE else ""
        return f"""\
units si
# s
timestep {time_step!r}
# kn in N/m; gamma_n in 1/s, c/m of a sphere of {contact.mass!r} kg; nothing tangential
fix wall all wall/gran hooke {kn!r} 0 {gamma!r} 0 0 0{limit} zplane 0.0 NULL"""


class Liggghts(Lammps):
    """``model hooke/stiffness``: kn = k in N/m and gamman = c/m in 1/s, for one type of atom.

    Examples
    --------
    >>> Liggghts().parameters(Physical(mass=2.0, stiffness=200.0, damping=4.0))
    {'kn': 200.0, 'gamman': 2.0}
    """

    name = "liggghts"
    names = ("kn", "gamman")

    def snippet(self, contact: Physical, release: Release, time_step: float) -> str:
        kn, gamma = self.parameters(contact).values()
        # LIGGGHTS reads the settings of a model after the wall only.
        limit = " limitForce on" if release is Release.FORCE else ""
        pair = "all property/global"
        return f"""\
units si
# s
timestep {time_step!r}
# N/m
fix kn {pair} kn peratomtypepair 1 {kn!r}
fix kt {pair} kt peratomtypepair 1 0
# 1/s, c/m of a sphere of {contact.mass!r} kg: absolute_damping is off
fix gamman {pair} gamman peratomtypepair 1 {gamma!r}
fix gammat {pair} gammat peratomtypepair 1 0
fix xmu {pair} coefficientFriction peratomtypepair 1 0
fix wall all wall/gran model hooke/stiffness primitive type 1 zplane 0.0{limit}"""
