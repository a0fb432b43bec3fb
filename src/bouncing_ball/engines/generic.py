"""Any engine or script of one's own: a spring, a damper and a rule that ends the contact."""

from bouncing_ball.contacts.release import Release
from bouncing_ball.engines.engine import Physical, Proportional
from bouncing_ball.engines.scheme import Scheme


class Generic(Proportional):
    """k and c as they are, moved by semi-implicit Euler: what a first script has.

    Examples
    --------
    >>> print(Generic().snippet(Physical(2.0, 200.0, 4.0), Release.FORCE, 0.001))
    m = 2.0  # kg
    k = 200.0  # N/m
    c = 4.0  # N s/m
    h = 0.001  # s
    # Free impacts have r = 0.7292 released at p = 0, 0.7441 released without force.
    <BLANKLINE>
    def force(p, rate):
        # p is the penetration in m, rate its derivative.
        return max(0.0, k * p + c * rate) if p > 0 else 0.0
    """

    name = "generic"
    names = ("stiffness", "damping")
    releases = (Release.DISPLACEMENT, Release.FORCE)
    scheme = Scheme.SEMI_IMPLICIT

    def snippet(self, contact: Physical, release: Release, time_step: float) -> str:
        pull, force = (contact.restitution(rule) for rule in Release)
        load = "k * p + c * rate"
        load = f"max(0.0, {load})" if release is Release.FORCE else load
        return f"""\
m = {contact.mass!r}  # kg
k = {contact.stiffness!r}  # N/m
c = {contact.damping!r}  # N s/m
h = {time_step!r}  # s
# Free impacts have r = {pull:.4f} released at p = 0, {force:.4f} released without force.

def force(p, rate):
    # p is the penetration in m, rate its derivative.
    return {load} if p > 0 else 0.0"""
