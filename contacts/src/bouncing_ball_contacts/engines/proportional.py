"""Engines whose contact has two parameters, proportional to the stiffness and to the damping.

* *generic*: any script with a spring, a damper and a rule that ends the contact.
* *PyBullet*: a spring and a damper on each of the two bodies, which form one constraint.

Granular engines are in :mod:`bouncing_ball_contacts.engines.granular`.
"""

import math
from collections.abc import Mapping
from typing import Any

from bouncing_ball.errors import ModelError
from bouncing_ball_beyond.models.damping import Release
from bouncing_ball_contacts.engines.engine import Engine, EngineParameters, Physical
from bouncing_ball_contacts.engines.scheme import Scheme
from bouncing_ball_contacts.engines.steps import InstantStep, Step


class Proportional(Engine):
    """An engine with two parameters a·k and b·c, whose factors a and b depend on the mass alone.

    Both factors are 1 unless a subclass defines them.
    """

    def factors(self, mass: float) -> tuple[float, float]:
        """The factors a and b for k and c, for a ball of this mass in kg."""
        return 1.0, 1.0

    def parameters(self, contact: Physical) -> EngineParameters:
        stiff, lossy = self.factors(contact.mass)
        values = (stiff * contact.stiffness, lossy * contact.damping)
        return dict(zip(self.names, values, strict=True))

    def read(self, parameters: Mapping[str, Any], mass: float | None) -> Physical:
        m, stiffness, loss = self._two(parameters, mass)
        stiff, lossy = self.factors(m)
        return Physical(m, stiffness / stiff, loss / lossy)


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


class PyBullet(Proportional):
    """``changeDynamics`` of both bodies, whose springs are in series and whose dampings are added.

    If ball and table have the same parameters, these are 2k in N/m and c/2 in N s/m. By default,
    Bullet also has contacts of bodies that do not touch yet, at distances that depend on their
    sizes: the damper then acts from the surface on, so that r is ``exp(-ζωh)`` times the value
    without such contacts. The text to paste allows none, and no slop.

    ``restitution`` is another kind of contact: an instant with the product r of both bodies'
    values, of the speed that a ball inside has after gravity: in a step Δt it rebounds with
    ``r (v + gΔt)``, so that slow impacts bounce too high.
    With contacts ahead the ball is stopped at the surface instead, so that r is 0; below
    ``restitutionVelocityThreshold`` it is 0 as well; and ``contactERP`` adds up to its own value
    to r, as it pushes the ball out of the table.

    Examples
    --------
    >>> from bouncing_ball_contacts.engines.engine import Physical
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
                f"r = {both:.4g} with small steps, and {both:.4g} (1 + gΔt/v) at a step Δt and an "
                "impact speed v, with contactProcessingThreshold=0, contactERP=0 and "
                "restitutionVelocityThreshold=0, and 0 without the first of these"
            )
        return self

    def instant(self, restitution: float, time_step: float) -> Step | None:
        return InstantStep(restitution, time_step)

    def instant_in_words(self, restitution: float) -> str:
        return (
            f"restitution={math.sqrt(restitution):.6g} of ball and table alike, without a spring, "
            "with contactProcessingThreshold=0, contactERP=0 and restitutionVelocityThreshold=0"
        )

    def factors(self, mass: float) -> tuple[float, float]:
        return 2.0, 0.5
