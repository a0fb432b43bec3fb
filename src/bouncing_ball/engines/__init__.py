"""Physics engines: their contact parameters from k, c and m, and the impacts that result.

All quantities are in SI units. The engines are not imported and need not be installed.
"""

from bouncing_ball.engines.drake import Drake
from bouncing_ball.engines.engine import Engine
from bouncing_ball.engines.generic import Generic
from bouncing_ball.engines.lammps import Lammps, Liggghts
from bouncing_ball.engines.mercurydpm import MercuryDPM
from bouncing_ball.engines.mujoco import MuJoCo
from bouncing_ball.engines.pybullet import PyBullet
from bouncing_ball.errors import one_of

_ALL = (Generic(), MuJoCo(), Lammps(), Liggghts(), PyBullet(), Drake(), MercuryDPM())

ENGINES: dict[str, Engine] = {engine.name: engine for engine in _ALL}
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
