"""The physics engines that a user can name."""

from bouncing_ball.errors import ModelError, one_of
from bouncing_ball_contacts.engines.drake import Drake
from bouncing_ball_contacts.engines.engine import Engine
from bouncing_ball_contacts.engines.genesis import Genesis
from bouncing_ball_contacts.engines.granular import Lammps, Liggghts, MercuryDPM
from bouncing_ball_contacts.engines.mujoco import MuJoCo
from bouncing_ball_contacts.engines.newton import NewtonMuJoCo, NewtonSemiImplicit
from bouncing_ball_contacts.engines.proportional import Generic, PyBullet

ENGINES: dict[str, Engine] = {
    engine.name: engine
    for engine in (
        Generic(),
        MuJoCo(),
        Lammps(),
        Liggghts(),
        PyBullet(),
        Drake(),
        MercuryDPM(),
        NewtonSemiImplicit(),
        NewtonMuJoCo(),
        Genesis(),
    )
}
"""The engines by name."""


_OF_PHYSX = (
    "restitution is a number, and nothing bounces below bounceThresholdVelocity, by default 2 m/s, "
    "a drop of 0.2 m: docs/bounces.md has its bounces"
)
# Names that users give, and what is known of these engines, for which nothing is written.
_KNOWN = {"physx": f"no contact is written for physx, whose {_OF_PHYSX}"} | {
    name: f"no contact is written for {name}, which has the contacts of PhysX: its {_OF_PHYSX}"
    for name in ("isaac", "isaac-sim", "isaaclab", "unity")
}


def engine_named(name: str) -> Engine:
    """The engine with this name.

    Raises
    ------
    ModelError
        If no engine has this name; the message lists the engines, or has what is known of it.

    Examples
    --------
    >>> engine_named("mujoco").releases
    (<Release.FORCE: 'force'>,)
    """
    if known := _KNOWN.get(str(name).casefold()):
        raise ModelError(f"{known}; contacts are written for {', '.join(ENGINES)}")
    return one_of("engine", name, ENGINES)
