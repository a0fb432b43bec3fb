r"""Gazebo Classic with ODE: ``kp`` and ``kd`` of both surfaces, which are one constraint.

ODE's constraints have ``erp`` and ``cfm``, which Gazebo finds from the step h and the springs in
series and dampers in parallel of both surfaces ::

    erp = h kp/(h kp + kd),   cfm = 1/(h kp + kd)

The constraint ``v⁺ = (erp/h) p - cfm f`` at the penetration p is then the force
``f = kp (p - h v⁺) - kd v⁺``, the implicit Euler step of a spring and a damper.

Sources: ODE's manual, *Soft constraint: constraint force mixing*; the threads 2273 and 1162 of
gazebo-classic. Gazebo itself was not run.
"""

from bouncing_ball.contacts.engines.proportional import Proportional
from bouncing_ball.contacts.engines.scheme import Scheme
from bouncing_ball.models.damping import Release


class Gazebo(Proportional):
    """``kp`` and ``kd`` of both surfaces alike: 2k in N/m and c/2 in N s/m.

    Examples
    --------
    >>> from bouncing_ball.contacts.engines.engine import Physical
    >>> Gazebo().parameters(Physical(mass=2.0, stiffness=200.0, damping=4.0))
    {'kp': 400.0, 'kd': 2.0}
    """

    name = "gazebo"
    names = ("kp", "kd")
    releases = (Release.FORCE,)
    scheme = Scheme.COMPENSATED

    def factors(self, mass: float) -> tuple[float, float]:
        return 2.0, 0.5
