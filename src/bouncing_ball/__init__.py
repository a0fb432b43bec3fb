"""Two models of a ball bouncing on a vibrating table, and their periodic orbits.

A replication of Carbonelli, Perret-Liaudet, Rigaud and Feki, "Investigation
of restitution coefficient and spring-damper models for the bouncing ball
problem", ASME IDETC/CIE 2011, DETC2011-47870.

Three calls answer most questions. With ``restitution`` alone the model is the restitution model,
and with ``frequency_ratio`` as well it is a spring-damper contact::

    bouncing_ball.orbit(n=1, amplitude=1.0, restitution=0.85, frequency_ratio=10.0)
    bouncing_ball.limits(n=1, restitution=0.85, frequency_ratio=10.0)
    bouncing_ball.simulate(amplitude=1.0, restitution=0.85, frequency_ratio=10.0)

Other calls return labelled datasets, whose ``plot()`` draws their figure: a ball over time, a ball
that is dropped from a height, the branch of orbits over Λ, the motion on which a ball ends::

    bouncing_ball.history(amplitude=1.0, restitution=0.85, frequency_ratio=10.0).plot()
    bouncing_ball.drop(height=10.0, restitution=0.85).plot()
    bouncing_ball.branch(n=1, restitution=0.85, frequency_ratio=[10.0, 2.0]).plot()
    bouncing_ball.motion_of(amplitude=1.1, restitution=0.85)

These calls use the models :class:`RestitutionModel` and :class:`SpringDamperModel`, the latter with
a contact :class:`SpringDamper`. All models have one interface (:mod:`bouncing_ball.orbits.model`).

Everything is dimensionless: times Ωt, lengths Ω²y/g, velocities Ωẏ/g, and phases and angles are
in radians. Functions take arrays, which broadcast as in numpy. If the shape of a result is not the
one to which the arguments broadcast, the docstring gives it. NaN stands for a number that does not
exist, such as the phase of an orbit below its saddle-node.

The package consists of layers, each of which imports only from the layers above it in this list,
and from ``errors``, ``parameters`` and ``call_signatures``:

``datasets``      names, symbols, units and netCDF files
``contacts``      the impact: restitution map, spring-damper contact, permanent contact
``continuation``  pseudo-arclength continuation; knows nothing of balls
``motion``        event-driven simulation, from any initial state
``orbits``        n-T orbits, their stability and bifurcations
``attractors``    the motions on which balls end: repeating, locked, chaotic
``calls``         the calls that most people need: orbits, balls over time, their long run
``accuracy``      errors of one model against another, their thresholds, the error law
``engines``       the contacts of physics engines: their parameters, their time stepping
``studies``       the stages of the pipeline: parameters in, datasets out
``calculator``    units, cases and verdicts for an engineer's contact
``atlas``         how stiff is stiff enough, for all orbits: tiles, shards, one file
``configuration`` the parameters of a run, read and checked
``claims``        the claims and formulas of the paper, with a verdict on each
``figures``       figures, tables and the article; they compute nothing
``provenance``    the commit, the parameters and the versions from which an artifact is made
``compare``       the comparison of datasets, texts and pictures of two runs
``pipeline``      the Python side of the Snakefile: source files of a stage, jobs, progress
``cli``           the command line, ``bouncing-ball``

Two layers also use a lower layer, whose modules they import when a method is first called: models
have the methods ``history``, ``branch`` and so on of ``calls``, and labelled datasets the method
``plot`` of ``figures``. Results can therefore be plotted, and models simulated, without another
import, and code that only computes imports neither package.
"""

from importlib import import_module
from typing import Any

__version__ = "0.1.0"

# The modules of the names that users import from here. Each module is imported on first use,
# because --help of the command line needs no numpy.
_MODULES = {
    "calls.balls": ("model",),
    "calls.periodic": ("orbit", "limits", "branch"),
    "calls.over_time": ("simulate", "history", "drop"),
    "calls.long_run": ("motion_of", "lyapunov_exponent", "orbit_diagram", "basins"),
    "beyond.calculator.design": ("design",),
    "paper.contact.spring_damper": ("SpringDamper",),
    "paper.orbits.spring_damper_model": ("SpringDamperModel",),
    "paper.orbits.restitution_model": ("RestitutionModel",),
    "errors": ("ModelError", "NoOrbitError"),
}
_PUBLIC = {name: module for module, names in _MODULES.items() for name in names}
__all__ = [*_PUBLIC]


def __getattr__(name: str) -> Any:
    if name not in _PUBLIC:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(import_module(f"{__name__}.{_PUBLIC[name]}"), name)


def __dir__() -> list[str]:
    return sorted([*globals(), *_PUBLIC])
