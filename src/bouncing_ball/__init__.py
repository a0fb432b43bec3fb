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

The package is a library, from ``models`` to ``contacts``, and two sets of studies on it. Each floor
imports only from those below it in this list:

``cli``         the command line, ``bouncing-ball``
``explorer``    the page with sliders
``pipeline``    the configuration, jobs, the record and its comparison; knows no balls
``beyond``      the studies that go past the paper: exhibits, atlas, proofs
``paper``       the replication: the formulas as printed, exhibits, claims
``contacts``    an engineer's contact with units, and those of physics engines
``accuracy``    errors of one model against another, their thresholds
``long_run``    the motions on which balls end
``periodic``    periodic orbits of any model, followed along any parameter
``models``      every law of the impact, flight, sticking, permanent contact
``drawing``     what all pictures share: style, canvas, labels, tables
``datasets``    variables with units and budgets, labelled results, netCDF files
``numerics``    independent of the ball: continuation, certified first zeros, rows of an array
``errors``      what a user reads, ranges of numbers
"""

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from bouncing_ball.accuracy.error_thresholds import error_thresholds
    from bouncing_ball.contacts.assess import assess_contact
    from bouncing_ball.contacts.choose import choose_contact
    from bouncing_ball.contacts.contact import Contact
    from bouncing_ball.contacts.describe import describe_contact
    from bouncing_ball.contacts.law_balls import contact_law
    from bouncing_ball.contacts.question import EngineSetup, Question
    from bouncing_ball.contacts.table import Table
    from bouncing_ball.contacts.write import write_contact
    from bouncing_ball.drawing.result import open
    from bouncing_ball.errors import ModelError, NoOrbitError
    from bouncing_ball.long_run.motion_of import basins, lyapunov_exponent, motion_of, orbit_diagram
    from bouncing_ball.long_run.orbit_of_motion import orbit_of_motion
    from bouncing_ball.models.makers import corrected, rigid, spring_damper
    from bouncing_ball.models.over_time import drop, history, simulate
    from bouncing_ball.models.rigid import RestitutionModel
    from bouncing_ball.models.spring_damper import SpringDamper
    from bouncing_ball.models.spring_damper_model import SpringDamperModel
    from bouncing_ball.periodic.branches_of_ball import branch
    from bouncing_ball.periodic.follow import curve, follow, switch
    from bouncing_ball.periodic.orbits_of_ball import limits, orbit, orbits, permanent_contact

__version__ = "0.1.0"

__all__ = [
    "Contact",
    "EngineSetup",
    "ModelError",
    "NoOrbitError",
    "Question",
    "RestitutionModel",
    "SpringDamper",
    "SpringDamperModel",
    "Table",
    "assess_contact",
    "basins",
    "branch",
    "choose_contact",
    "contact_law",
    "corrected",
    "curve",
    "describe_contact",
    "drop",
    "error_thresholds",
    "follow",
    "history",
    "limits",
    "lyapunov_exponent",
    "motion_of",
    "open",
    "orbit",
    "orbit_diagram",
    "orbit_of_motion",
    "orbits",
    "permanent_contact",
    "rigid",
    "simulate",
    "spring_damper",
    "switch",
    "write_contact",
]


def __getattr__(name: str) -> Any:
    """A public name, imported on first use.

    ``--help`` of the command line needs no numpy, a single orbit no xarray, and no call the
    packages of another.
    """
    module: Any
    match name:
        case "corrected" | "rigid" | "spring_damper":
            from bouncing_ball.models import makers as module
        case "curve" | "follow" | "switch":
            from bouncing_ball.periodic import follow as module
        case "orbit_of_motion":
            from bouncing_ball.long_run import orbit_of_motion as module
        case "contact_law":
            from bouncing_ball.contacts import law_balls as module
        case "branch":
            from bouncing_ball.periodic import branches_of_ball as module
        case "limits" | "orbit" | "orbits" | "permanent_contact":
            from bouncing_ball.periodic import orbits_of_ball as module
        case "drop" | "history" | "simulate":
            from bouncing_ball.models import over_time as module
        case "basins" | "lyapunov_exponent" | "motion_of" | "orbit_diagram":
            from bouncing_ball.long_run import motion_of as module
        case "open":
            from bouncing_ball.drawing import result as module
        case "error_thresholds":
            from bouncing_ball.accuracy import error_thresholds as module
        case "describe_contact":
            from bouncing_ball.contacts import describe as module
        case "assess_contact":
            from bouncing_ball.contacts import assess as module
        case "choose_contact":
            from bouncing_ball.contacts import choose as module
        case "write_contact":
            from bouncing_ball.contacts import write as module
        case "Contact":
            from bouncing_ball.contacts import contact as module
        case "EngineSetup" | "Question":
            from bouncing_ball.contacts import question as module
        case "Table":
            from bouncing_ball.contacts import table as module
        case "SpringDamper":
            from bouncing_ball.models import spring_damper as module
        case "SpringDamperModel":
            from bouncing_ball.models import spring_damper_model as module
        case "RestitutionModel":
            from bouncing_ball.models import rigid as module
        case "ModelError" | "NoOrbitError":
            from bouncing_ball import errors as module
        case _:
            raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(module, name)


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})
