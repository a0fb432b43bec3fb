"""The physics engines that a user can name."""

from bouncing_ball.errors import one_of
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


def engine_named(name: str) -> Engine:
    """The engine with this name.

    Raises
    ------
    ModelError
        If no engine has this name; the message lists the engines.

    Examples
    --------
    >>> engine_named("mujoco").releases
    (<Release.FORCE: 'force'>,)
    """
    return one_of("engine", name, ENGINES)
