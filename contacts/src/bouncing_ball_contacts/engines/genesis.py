"""Genesis: ``sol_params`` of a geometry, the positive form of MuJoCo's ``solref`` and ``solimp``.

They are the time constant T, the damping ratio ζ, and the five numbers of the impedance. As in
:mod:`bouncing_ball_contacts.engines.mujoco`, k/m = 1/(Tζ)² and c/m = 2/T. The option
``constraint_timeconst`` of the rigid solver sets T only, with ζ = 1, where a free impact has
r = e⁻² for every T: it cannot set the bounce. Genesis raises T to two time steps. Its scheme is
MuJoCo's, and so are its bounces at every time step. A ball that sinks in deeper than its radius
falls through the plane.

Source: the rigid solver of Genesis 1.4.5, and runs of it.
"""

from collections.abc import Mapping
from typing import Any

from bouncing_ball.errors import ModelError
from bouncing_ball_beyond.models.damping import Release
from bouncing_ball_contacts.engines.engine import Engine, EngineParameters, Physical
from bouncing_ball_contacts.engines.mujoco import time_constant
from bouncing_ball_contacts.engines.scheme import Scheme


class Genesis(Engine):
    """Contacts by ``set_sol_params``, with the smallest impedance.

    Examples
    --------
    >>> contact = Physical(mass=2.0, stiffness=8.0, damping=4.0)
    >>> Genesis().parameters(contact)
    {'timeconst': 1.0, 'dampratio': 0.5}
    >>> Genesis().read(Genesis().parameters(contact), 2.0)
    Physical(mass=2.0, stiffness=8.0, damping=4.0)
    """

    name = "genesis"
    names = ("timeconst", "dampratio")
    releases = (Release.FORCE,)
    scheme = Scheme.SEMI_IMPLICIT

    def parameters(self, contact: Physical) -> EngineParameters:
        values = (time_constant(self.name, contact), contact.damping_ratio)
        return dict(zip(self.names, values, strict=True))

    def read(self, parameters: Mapping[str, Any], mass: float | None) -> Physical:
        m, constant, zeta = self._two(parameters, mass)
        if zeta == 0:
            raise ModelError("dampratio = 0 is no contact of genesis: its time constant is 2 m/c")
        return Physical(m, m / (constant * zeta) ** 2, 2 * m / constant)
