"""PyBullet: a spring and a damper on each of the two bodies, which form one constraint."""

from bouncing_ball.contacts.release import Release
from bouncing_ball.engines.engine import Proportional
from bouncing_ball.engines.scheme import Scheme


class PyBullet(Proportional):
    """``changeDynamics`` of both bodies, whose springs are in series and whose dampings are added.

    If ball and table have the same parameters, these are 2k in N/m and c/2 in N s/m. By default,
    Bullet also has contacts of bodies that do not touch yet, at distances that depend on their
    sizes: the damper then acts from the surface on, so that r is ``exp(-ζωh)`` times the value
    without such contacts. The text to paste allows none, and no slop.

    Examples
    --------
    >>> from bouncing_ball.engines.engine import Physical
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

    def factors(self, mass: float) -> tuple[float, float]:
        return 2.0, 0.5
