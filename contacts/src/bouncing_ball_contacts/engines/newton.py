"""Newton: a contact of shapes with ``ke`` and ``kd``, which mean different things in its solvers.

* *SolverSemiImplicit* and *SolverFeatherstone*: ke = k in N/m and kd = c in N s/m, averaged over
  both shapes. The damper acts while the ball approaches only, and a step is one of semi-implicit
  Euler.
* *SolverMuJoCo*: MuJoCo's contact with ``timeconst = 2/kd`` and ``dampratio = kd/(2√ke)``, so that
  ke = k/m in 1/s² and kd = c/m in 1/s, as in the direct form of ``solref``. Its impedance is the
  attribute ``mujoco:geom_solimp``, which exists after ``SolverMuJoCo.register_custom_attributes``.
  Contacts with friction are pyramids of several rows, which with a small impedance add up to
  another contact: ``mujoco:condim`` must be 1.
  Without friction, or with very little, these pyramids are singular: in Newton 1.8.0 the ball's
  state is not a number after one step, or with a small impedance the ball is thrown out. With
  ``mujoco:condim`` = 1 a friction of 0 is right.
  A kd of 0 is not a contact without damping, but MuJoCo's default.

All of them compute with single precision.

Source: the kernels of Newton 1.8, read with the engine itself.
"""

from collections.abc import Mapping
from typing import Any

from bouncing_ball.errors import ModelError
from bouncing_ball_beyond.models.damping import Release
from bouncing_ball_contacts.engines.engine import EngineParameters, Physical
from bouncing_ball_contacts.engines.mujoco import time_constant
from bouncing_ball_contacts.engines.proportional import Proportional
from bouncing_ball_contacts.engines.scheme import Scheme


class NewtonSemiImplicit(Proportional):
    """SolverSemiImplicit or SolverFeatherstone: ke = k, kd = c, and no damper on the way back.

    Examples
    --------
    >>> found = NewtonSemiImplicit().settings(Physical(mass=2.0, stiffness=200.0, damping=4.0))
    >>> found.parameters, found.release, round(found.restitution, 4)
    ({'ke': 200.0, 'kd': 4.0}, 'approach', 0.8626)
    """

    name = "newton-semi-implicit"
    names = ("ke", "kd")
    releases = (Release.APPROACH,)
    scheme = Scheme.SEMI_IMPLICIT


class NewtonMuJoCo(Proportional):
    """SolverMuJoCo: ke = k/m and kd = c/m of contacts that end where their force vanishes.

    Examples
    --------
    >>> contact = Physical(mass=2.0, stiffness=200.0, damping=4.0)
    >>> NewtonMuJoCo().parameters(contact)
    {'ke': 100.0, 'kd': 2.0}
    >>> NewtonMuJoCo().read({"ke": 100.0, "kd": 2.0}, 2.0)
    Physical(mass=2.0, stiffness=200.0, damping=4.0)
    """

    name = "newton-mujoco"
    names = ("ke", "kd")
    releases = (Release.FORCE,)
    scheme = Scheme.SEMI_IMPLICIT

    def factors(self, mass: float) -> tuple[float, float]:
        return 1 / mass, 1 / mass

    def parameters(self, contact: Physical) -> EngineParameters:
        time_constant(self.name, contact)
        return super().parameters(contact)

    def read(self, parameters: Mapping[str, Any], mass: float | None) -> Physical:
        found = super().read(parameters, mass)
        if found.damping == 0:
            raise ModelError(
                "kd = 0 of newton-mujoco is no contact without damping, but the default of MuJoCo: "
                "kd is c/m in 1/s"
            )
        return found

    def remarks(self, parameters: Mapping[str, Any]) -> tuple[str, ...]:
        return (
            "ke and kd are per unit of mass in SolverMuJoCo: k/m in 1/s^2 and c/m in 1/s",
            "without mujoco:condim = 1 a friction mu of 0 gives no numbers in Newton 1.8.0",
        )
