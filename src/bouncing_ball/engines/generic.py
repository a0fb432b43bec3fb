"""Any engine or script: a spring, a damper and a rule that ends the contact."""

from collections.abc import Mapping
from typing import Any

from bouncing_ball.contacts.release import Release
from bouncing_ball.engines.engine import Parameters, Physical, Proportional
from bouncing_ball.engines.scheme import Scheme

_ENDS = {Release.DISPLACEMENT: "at p = 0", Release.FORCE: "where the force vanishes"}


class Generic(Proportional):
    """m, k and c unchanged, with semi-implicit Euler steps, as in a simple script.

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

    def snippet(self, contact: Physical, release: Release, time_step: float) -> str:
        load = "k * p + c * rate"
        load = f"max(0.0, {load})" if release is Release.FORCE else load
        found = self.restitutions(contact, release)
        about = (
            f"# The contact ends {_ENDS[release]}: a free impact has r = {found.pop(release):.4f}."
        )
        for rule, r in found.items():
            about += f"\n# If it ended {_ENDS[rule]}, it would have r = {r:.4f}."
        return f"""\
m = {contact.mass!r}  # kg
k = {contact.stiffness!r}  # N/m
c = {contact.damping!r}  # N s/m
h = {time_step!r}  # s
{about}

def force(p, rate):
    # p is the penetration in m, rate its derivative.
    return {load} if p > 0 else 0.0"""
