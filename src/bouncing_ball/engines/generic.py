"""Any engine or script: a spring, a damper and a rule that ends the contact."""

from collections.abc import Mapping
from typing import Any

from bouncing_ball.contacts.release import Release
from bouncing_ball.engines.engine import Parameters, Physical, Proportional
from bouncing_ball.engines.scheme import Scheme


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

    def parameters(self, contact: Physical) -> Parameters:
        return {"mass": contact.mass, **super().parameters(contact)}

    def read(self, parameters: Mapping[str, Any], mass: float | None) -> Physical:
        given = {"mass": mass, **parameters}
        return super().read({name: given[name] for name in given if name != "mass"}, given["mass"])
