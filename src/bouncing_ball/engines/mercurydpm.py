"""MercuryDPM: a linear viscoelastic species, whose damper pulls until the ball has left."""

from bouncing_ball.contacts.release import Release
from bouncing_ball.engines.engine import Proportional
from bouncing_ball.engines.scheme import Scheme


class MercuryDPM(Proportional):
    """``LinearViscoelasticSpecies``: stiffness k in N/m and dissipation c in N s/m.

    Examples
    --------
    >>> from bouncing_ball.engines.engine import Physical
    >>> MercuryDPM().parameters(Physical(mass=2.0, stiffness=200.0, damping=4.0))
    {'stiffness': 200.0, 'dissipation': 4.0}
    """

    name = "mercurydpm"
    names = ("stiffness", "dissipation")
    releases = (Release.DISPLACEMENT,)
    scheme = Scheme.SEMI_IMPLICIT
