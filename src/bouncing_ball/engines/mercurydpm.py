"""MercuryDPM: a linear viscoelastic species, whose damper pulls until the ball has left."""

from bouncing_ball.contacts.release import Release
from bouncing_ball.engines.engine import Physical, Proportional
from bouncing_ball.engines.scheme import Scheme


class MercuryDPM(Proportional):
    """``LinearViscoelasticSpecies``: stiffness k in N/m and dissipation c in N s/m.

    Examples
    --------
    >>> MercuryDPM().parameters(Physical(mass=2.0, stiffness=200.0, damping=4.0))
    {'stiffness': 200.0, 'dissipation': 4.0}
    """

    name = "mercurydpm"
    names = ("stiffness", "dissipation")
    releases = (Release.DISPLACEMENT,)
    scheme = Scheme.SEMI_IMPLICIT

    def snippet(self, contact: Physical, release: Release, time_step: float) -> str:
        stiffness, dissipation = self.parameters(contact).values()
        return f"""\
LinearViscoelasticSpecies species;
species.setStiffness({stiffness!r});  // N/m
species.setDissipation({dissipation!r});  // N s/m, for a ball of {contact.mass!r} kg and a wall
speciesHandler.copyAndAddObject(species);
setTimeStep({time_step!r});  // s"""
