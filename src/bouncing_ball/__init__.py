"""Two models of a ball bouncing on a vibrating table, and their periodic orbits.

A replication of Carbonelli, Perret-Liaudet, Rigaud and Feki, "Investigation
of restitution coefficient and spring-damper models for the bouncing ball
problem", ASME IDETC/CIE 2011, DETC2011-47870.

A ball is made once and handed to functions. The impacts of a rigid ball are instants; a ball on a
spring and a damper has contacts of finite duration::

    simple = bouncing_ball.rigid(restitution=0.85)
    ball = bouncing_ball.spring_damper(restitution=0.85, frequency_ratio=10.0)
    bouncing_ball.orbit(ball, n=1, amplitude=1.0)
    bouncing_ball.limits(ball, n=1)
    bouncing_ball.simulate(ball, amplitude=1.0)

A list or an array in place of a number becomes an axis of the result, which is then a labelled
dataset. Its ``plot()`` draws its figure: a ball over time, a ball that is dropped from a height,
the branch of orbits over Λ, the motion on which a ball ends::

    bouncing_ball.history(ball, amplitude=[0.5, 1.0]).plot()
    bouncing_ball.drop(simple, height=10.0).plot()
    bouncing_ball.branch(ball, n=[1, 2]).plot()
    bouncing_ball.motion_of(simple, amplitude=1.1)

Any periodic orbit is followed along any parameter, with its bifurcations and its doubled orbits::

    one = bouncing_ball.orbit(ball, n=1, amplitude=1.0)
    bouncing_ball.follow(one, along="frequency_ratio", to=2.0).plot()

An engineer's contact has units. Whether a restitution coefficient is good enough for it, how stiff
it must be, and what one writes into a physics engine are three questions::

    table = bouncing_ball.Table(frequency="50 Hz", acceleration="0.8 g")
    contact = bouncing_ball.Contact(mass="20 g", stiffness="1e7 N/m", restitution=0.85)
    bouncing_ball.assess_contact(table, contact)

Everything else is dimensionless: times Ωt, lengths Ω²y/g, velocities Ωẏ/g, and phases and angles
are in radians. NaN stands for a number that does not exist, such as the phase of an orbit below its
saddle-node.

Measured restitution coefficients and contact times determine a contact::

    fit = bouncing_ball.fit_contact([0.5, 2.0, 6.0], [0.857, 0.825, 0.795], 0.75e-3, mass="454 g")
    bouncing_ball.assess_contact(table, fit.best.contact_on(table))

The package is a library, from ``models`` to ``measured``, and two sets of studies on it, ``paper``,
the replication, and ``beyond``, which goes past it. The docstring of each room says what is in it;
``CONTRIBUTING.md`` describes the rooms, and ``pyproject.toml`` states which imports from which.
"""

from importlib import import_module
from typing import TYPE_CHECKING, Any

# What type checkers, editors and the linter of imports see.
if TYPE_CHECKING:
    from bouncing_ball_beyond.accuracy.error_thresholds import error_thresholds as error_thresholds
    from bouncing_ball_beyond.models.contact_model import ContactModel as ContactModel
    from bouncing_ball_beyond.models.law_balls import contact_law as contact_law
    from bouncing_ball_beyond.models.laws.start_speed import Flores as Flores
    from bouncing_ball_beyond.models.laws.start_speed import (
        LankaraniNikravesh as LankaraniNikravesh,
    )
    from bouncing_ball_beyond.models.makers import corrected as corrected
    from bouncing_ball_beyond.models.makers import rigid as rigid
    from bouncing_ball_beyond.models.makers import spring_damper as spring_damper
    from bouncing_ball_beyond.models.rigid import RestitutionModel as RestitutionModel
    from bouncing_ball_beyond.models.spring_damper import SpringDamper as SpringDamper
    from bouncing_ball_beyond.motions.motion_of import basins as basins
    from bouncing_ball_beyond.motions.motion_of import lyapunov_exponent as lyapunov_exponent
    from bouncing_ball_beyond.motions.motion_of import motion_of as motion_of
    from bouncing_ball_beyond.motions.motion_of import orbit_diagram as orbit_diagram
    from bouncing_ball_beyond.motions.orbit_of_motion import orbit_of_motion as orbit_of_motion
    from bouncing_ball_beyond.motions.over_time import drop as drop
    from bouncing_ball_beyond.motions.over_time import history as history
    from bouncing_ball_beyond.motions.over_time import simulate as simulate
    from bouncing_ball_beyond.periodic.branches.follow import follow as follow
    from bouncing_ball_beyond.periodic.branches.grazing import grazing_form as grazing_form
    from bouncing_ball_beyond.periodic.branches_of_ball import branch as branch
    from bouncing_ball_beyond.periodic.orbits.normal_form import normal_form as normal_form
    from bouncing_ball_beyond.periodic.orbits_of_ball import limits as limits
    from bouncing_ball_beyond.periodic.orbits_of_ball import orbit as orbit
    from bouncing_ball_beyond.periodic.orbits_of_ball import orbits as orbits
    from bouncing_ball_beyond.periodic.orbits_of_ball import permanent_contact as permanent_contact
    from bouncing_ball_beyond.periodic.read_orbits import open as open
    from bouncing_ball_beyond.periodic.read_orbits import read_orbits as read_orbits
    from bouncing_ball_contacts.contact.assess import assess_contact as assess_contact
    from bouncing_ball_contacts.contact.choose import choose_contact as choose_contact
    from bouncing_ball_contacts.contact.contact import Contact as Contact
    from bouncing_ball_contacts.contact.describe import describe_contact as describe_contact
    from bouncing_ball_contacts.contact.question import EngineSetup as EngineSetup
    from bouncing_ball_contacts.contact.question import Question as Question
    from bouncing_ball_contacts.contact.table import Table as Table
    from bouncing_ball_contacts.contact.write import write_contact as write_contact
    from bouncing_ball_contacts.measured.fit import fit_contact as fit_contact

    from bouncing_ball.errors import ModelError as ModelError
    from bouncing_ball.errors import NoOrbitError as NoOrbitError

__version__ = "0.1.0"

# The public names and the modules in which they are defined.
_MODULES = {
    "Contact": "contacts.contact",
    "ContactModel": "models.contact_model",
    "EngineSetup": "contacts.question",
    "Flores": "models.laws.start_speed",
    "LankaraniNikravesh": "models.laws.start_speed",
    "ModelError": "errors",
    "NoOrbitError": "errors",
    "Question": "contacts.question",
    "RestitutionModel": "models.rigid",
    "SpringDamper": "models.spring_damper",
    "Table": "contacts.table",
    "assess_contact": "contacts.assess",
    "basins": "long_run.motion_of",
    "branch": "periodic.branches_of_ball",
    "choose_contact": "contacts.choose",
    "contact_law": "contacts.law_balls",
    "corrected": "models.makers",
    "describe_contact": "contacts.describe",
    "drop": "long_run.over_time",
    "error_thresholds": "accuracy.error_thresholds",
    "fit_contact": "measured.fit",
    "follow": "periodic.branches.follow",
    "grazing_form": "periodic.branches.grazing",
    "history": "long_run.over_time",
    "limits": "periodic.orbits_of_ball",
    "lyapunov_exponent": "long_run.motion_of",
    "motion_of": "long_run.motion_of",
    "normal_form": "periodic.orbits.normal_form",
    "open": "periodic.read_orbits",
    "orbit": "periodic.orbits_of_ball",
    "orbit_diagram": "long_run.motion_of",
    "orbit_of_motion": "long_run.orbit_of_motion",
    "orbits": "periodic.orbits_of_ball",
    "permanent_contact": "periodic.orbits_of_ball",
    "read_orbits": "periodic.read_orbits",
    "rigid": "models.makers",
    "simulate": "long_run.over_time",
    "spring_damper": "models.makers",
    "write_contact": "contacts.write",
}

__all__ = list(_MODULES)


def __getattr__(name: str) -> Any:
    """A public name, imported on first use.

    ``--help`` of the command line needs no numpy, a single orbit no xarray, and no call the
    packages of another.
    """
    if name not in _MODULES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(import_module(f"bouncing_ball.{_MODULES[name]}"), name)


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})
