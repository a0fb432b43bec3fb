"""Two models of a ball bouncing on a vibrating table, and their periodic orbits.

A replication of Carbonelli, Perret-Liaudet, Rigaud and Feki, "Investigation
of restitution coefficient and spring-damper models for the bouncing ball
problem", ASME IDETC/CIE 2011, DETC2011-47870.

A ball is made once and handed to functions. The impacts of a rigid ball are instants; a ball on a
spring and a damper has contacts of finite duration::

    simple = bouncing_ball_beyond.inherited.rigid(restitution=0.85)
    ball = bouncing_ball_beyond.inherited.spring_damper(restitution=0.85, frequency_ratio=10.0)
    bouncing_ball_beyond.inherited.orbit(ball, n=1, amplitude=1.0)
    bouncing_ball_beyond.inherited.limits(ball, n=1)
    bouncing_ball_beyond.inherited.simulate(ball, amplitude=1.0)

A list or an array in place of a number becomes an axis of the result, which is then a labelled
dataset. Its ``plot()`` draws its figure: a ball over time, a ball that is dropped from a height,
the branch of orbits over Λ::

    bouncing_ball_beyond.inherited.history(ball, amplitude=[0.5, 1.0]).plot()
    bouncing_ball_beyond.inherited.drop(simple, height=10.0).plot()
    bouncing_ball_beyond.inherited.branch(ball, n=[1, 2]).plot()

Everything is dimensionless: times Ωt, lengths Ω²y/g, velocities Ωẏ/g, and phases and angles are in
radians. NaN stands for a number that does not exist, such as the phase of an orbit below its
saddle-node.

The package is a library, from ``numerics`` to ``accuracy``, and the replication on it, ``paper``.
The docstring of each subpackage says what is in it; ``CONTRIBUTING.md`` describes them, and
``pyproject.toml`` states which imports from which.
"""

from typing import TYPE_CHECKING

from bouncing_ball_beyond.inherited.first_use import first_use

# What type checkers, editors and the linter of imports see.
if TYPE_CHECKING:
    from bouncing_ball_beyond.inherited.accuracy.thresholds import (
        error_thresholds as error_thresholds,
    )
    from bouncing_ball_beyond.inherited.drawing.result import open as open
    from bouncing_ball_beyond.inherited.errors import ModelError as ModelError
    from bouncing_ball_beyond.inherited.errors import NoOrbitError as NoOrbitError
    from bouncing_ball_beyond.inherited.models.history import drop as drop
    from bouncing_ball_beyond.inherited.models.history import history as history
    from bouncing_ball_beyond.inherited.models.history import simulate as simulate
    from bouncing_ball_beyond.inherited.models.permanent_contact import (
        permanent_contact as permanent_contact,
    )
    from bouncing_ball_beyond.inherited.models.restitution import (
        RestitutionModel as RestitutionModel,
    )
    from bouncing_ball_beyond.inherited.models.restitution import rigid as rigid
    from bouncing_ball_beyond.inherited.models.spring_damper import SpringDamper as SpringDamper
    from bouncing_ball_beyond.inherited.models.spring_damper import spring_damper as spring_damper
    from bouncing_ball_beyond.inherited.periodic.branches import branch as branch
    from bouncing_ball_beyond.inherited.periodic.calls import limits as limits
    from bouncing_ball_beyond.inherited.periodic.calls import orbit as orbit
    from bouncing_ball_beyond.inherited.periodic.calls import orbits as orbits

__version__ = "0.1.0"

# The public names and the modules in which they are defined.
_MODULES = {
    "ModelError": "errors",
    "NoOrbitError": "errors",
    "RestitutionModel": "models.restitution",
    "SpringDamper": "models.spring_damper",
    "branch": "periodic.branches",
    "drop": "models.history",
    "error_thresholds": "accuracy.thresholds",
    "history": "models.history",
    "limits": "periodic.calls",
    "open": "drawing.result",
    "orbit": "periodic.calls",
    "orbits": "periodic.calls",
    "permanent_contact": "models.permanent_contact",
    "rigid": "models.restitution",
    "simulate": "models.history",
    "spring_damper": "models.spring_damper",
}

__all__ = list(_MODULES)

__getattr__, __dir__ = first_use(__name__, _MODULES, globals())
