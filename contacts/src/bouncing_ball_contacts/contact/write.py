"""The third question: what does one write into an engine for a contact?

The time step follows from the contact, or is given. A given step is too long for stiff contacts.
The settings are those of the contact that was asked for, with the r that it has at this step.
Beside them are those with a retuned damping, and those of a softer contact with its own numbers.
"""

import math
from dataclasses import dataclass, replace

from bouncing_ball.errors import ModelError, ParameterError, suggesting
from bouncing_ball_beyond.models.laws.hertzian import LinearHuntCrossley
from bouncing_ball_beyond.models.spring_damper import SpringDamper
from bouncing_ball_contacts.contact.assess import Assessment, assess
from bouncing_ball_contacts.contact.contact import Contact
from bouncing_ball_contacts.contact.describe import LONGEST, Description, description_of
from bouncing_ball_contacts.contact.drops import Dropped, drop_at_rest
from bouncing_ball_contacts.contact.loss import of_loss
from bouncing_ball_contacts.contact.quantities import check_kinds
from bouncing_ball_contacts.contact.question import EngineSetup, Question
from bouncing_ball_contacts.contact.resolve import resolve
from bouncing_ball_contacts.contact.resolved import ResolvedContact
from bouncing_ball_contacts.contact.table import Table, TableMotion
from bouncing_ball_contacts.contact.texts import shown
from bouncing_ball_contacts.engines.choice import engine_named
from bouncing_ball_contacts.engines.drop_in_steps import MOST_STEPS, ReboundHeights, drop_in_steps
from bouncing_ball_contacts.engines.engine import Engine, EngineSettings
from bouncing_ball_contacts.engines.given_step import AtStep, stiffest_contact
from bouncing_ball_contacts.engines.hunt_crossley_steps import fewest_steps_of_law

_STEP = "time_step"
_OF_A_LAW = (
    "{time_step} is given for a spring and a damper, or for drake with {law} hunt-crossley: "
    "what other engines and laws do at a step is not known"
)


@suggesting
def write_contact(
    contact: Contact,
    setup: EngineSetup,
    table: Table | None = None,
    question: Question | None = None,
) -> EngineSettings:
    """What to write into an engine for a contact, and what it does there.

    Parameters
    ----------
    contact : Contact
        Its restitution is the measured one, under the release of the engine. With a time step it
        needs no stiffness: the answer is then the stiffest contact that this step resolves.
    setup : EngineSetup
        The engine and, if it is given, its time step.
    table : Table, optional
        With a vibrating table the answer also has the orbit that the engine will show.
    question : Question, optional
        The family of this orbit.

    Raises
    ------
    ModelError
        If a parameter is missing, out of range or contradicts another, or the engine has no such
        contact.
    NoOrbitError
        If no model has the orbit.

    Examples
    --------
    >>> contact = Contact(mass=0.5, stiffness="50 kN/m", restitution=0.75)
    >>> found = write_contact(contact, EngineSetup(engine="mujoco"))
    >>> found.parameters["solref"][0], round(found.restitution, 6), found.release
    (-100000.0, 0.75, 'force')

    A step of a millisecond is too long for it, but the mean r can be restored:

    >>> found = write_contact(contact, EngineSetup(engine="mujoco", time_step="1 ms"))
    >>> found.at_step.is_within, found.parameters["solref"][0]
    (False, -100000.0)
    >>> round(found.retuned.at_step.mean, 6), f"{found.at_step.stiffest:.3g} N/m"
    (0.75, '74.6 N/m')
    """
    asked = Question() if question is None else question
    # Without a table its place is held by its class.
    on = (table, Table) if table is not None else (None, type(None))
    of = {"contact": (contact, Contact), "setup": (setup, EngineSetup), "table": on}
    check_kinds("write_contact", **of, question=(asked, Question))
    if table is None:
        return settings_for(describe_for(contact, setup), setup)
    case = resolve(contact, table.motion, asked.families, setup.engine)
    return settings_for(assess(case, asked), setup)


def describe_for(
    contact: Contact,
    setup: EngineSetup,
    gravity: float | None = None,
    speed: float | None = None,
) -> Description:
    """The numbers of a contact as it ends in the engine, or without a stiffness those of the
    stiffest one that the time step of the engine resolves.

    Raises
    ------
    ModelError
        If parameters do not suffice or contradict each other, or no contact has its r within the
        error at this step.
    """
    at_rest = TableMotion.at_rest(gravity)
    step = setup.time_step
    if contact.is_stiff or step is None:
        return description_of(resolve(contact, at_rest, written=setup.engine, speed=speed))
    plain = contact.by_stiffness_and_loss(setup.engine)
    scheme = engine_named(setup.engine).scheme
    allowed = setup.restitution_error

    def stiffness(zeta: float) -> tuple[float, float]:
        found, steps = stiffest_contact(scheme, plain.mass, zeta, plain.rule, step, allowed)
        if steps * step > LONGEST:
            raise ParameterError(
                f"no contact shorter than {LONGEST:g} s has its r within {{restitution_error}} "
                f"{allowed:g} at {{time_step}} {step:g} s: allow a larger error"
            )
        return found.angular_frequency, found.stiffness

    stiff = replace(contact, stiffness=of_loss(plain, at_rest.gravity, stiffness))
    return description_of(resolve(stiff, at_rest, written=setup.engine))


def settings_for(found: Assessment | Description, setup: EngineSetup) -> EngineSettings:
    """The settings for a contact, and on a table the orbit that the engine will show.

    At a given time step they have the r of a law at the impact speed of this orbit, or else at that
    at which the law has the r of the contact.

    Raises
    ------
    ModelError
        If the engine has no such contact, or if a time step is given for a contact law, and it is
        not known what the engine does there.
    """
    case = found.case
    judged = found.judged if isinstance(found, Assessment) else None
    engine = _engine_of(case, setup.engine, None if judged is None else judged.impact_speed)
    given_step = setup.time_step is not None
    if given_step and not case.is_spring_damper and not engine.has_steps_of_law:
        raise ParameterError(_OF_A_LAW)
    release = str(case.equivalent.release)
    error = setup.restitution_error
    settings = engine.settings(case.physical, release, error, setup.time_step)
    # At a step that is too long the contact has another r, and so another orbit.
    if judged is None or (settings.at_step is not None and not settings.at_step.is_within):
        return settings
    return replace(
        settings,
        max_height=judged.max_height,
        contact_duration=judged.contact_duration,
        penetration=judged.greatest_compression,
    )


def _engine_of(case: ResolvedContact, name: str, speed: float | None = None) -> Engine:
    """The engine with this name, for the law of a contact and for impacts with a speed in m/s."""
    engine = engine_named(name)
    law = case.law_in_si
    if law is None:
        return engine
    at = case.law_speed if speed is None else speed
    return engine.with_law({**law, "radius": case.given.radius, "speed": at})


@dataclass(frozen=True)
class Softer:
    """The stiffest contact with the same ζ that a given time step resolves, with its own numbers.

    It is the answer about the contact whose settings are ``EngineSettings.softer``, and keeps the
    error of r that was allowed, unlike :class:`Looser`. ``dropped`` is a drop with the speed that
    was asked about, and ``dropped_at_step`` the least and the greatest rise at this step.
    ``verdict`` is that on a vibrating table, otherwise empty.
    """

    contact: Description
    dropped: Dropped | None = None
    dropped_at_step: ReboundHeights | None = None
    verdict: str = ""


def softer_contact(
    case: ResolvedContact, settings: EngineSettings, question: Question, speed: float | None
) -> Softer | None:
    """The softer contact of settings for a given time step; None if the step resolves the contact.

    ``speed`` is the impact speed of a drop in m/s.
    """
    if settings.softer is None or settings.softer.at_step is None:
        return None
    at = settings.softer.at_step
    if not case.is_spring_damper:
        own = _longer(case, at.steps * at.time_step)
    else:
        ball = at.stiffest_spring(case.mass)
        if ball is None:
            return None
        ratio = ball.angular_frequency * case.table.time
        spring = SpringDamper(ratio, ball.damping_ratio, case.equivalent.release)
        plain = Contact(mass=case.mass, stiffness=ball.stiffness, damping=ball.damping)
        own = replace(case, plain=plain, law=spring, equivalent=spring)
    return Softer(
        contact=description_of(own),
        dropped=None if speed is None else drop_at_rest(own, speed),
        dropped_at_step=dropped_at_step(own, settings.softer, speed),
        verdict="" if case.table.is_at_rest else _verdict(own, question),
    )


def _longer(case: ResolvedContact, contact_time: float) -> ResolvedContact:
    """The contact whose impacts take so many seconds, of a law of which steps are known: that of a
    linear spring, so that r is the same at each speed whatever its stiffness is.
    """
    law = case.law
    factor = contact_time / (
        float(law.signature(case.law_speed / case.unit_speed).duration) * case.table.time
    )
    slower = replace(case.equivalent, frequency_ratio=case.equivalent.frequency_ratio / factor)
    return replace(case, law=law.stiffened(1 / factor**2), equivalent=slower)


def _verdict(case: ResolvedContact, question: Question) -> str:
    """The headline and the verdict on a contact, or the reason why there are none."""
    period = 2 * math.pi * case.table.time
    if not case.is_spring_damper and case.contact_time > period:
        long = f"an impact takes {shown(case.contact_time, 's')}, more than the table's period"
        return f"It is not judged: {long} of {shown(period, 's')}."
    try:
        found = assess(case, question)
    except ModelError as error:
        return f"It is not judged: {error}."
    return f"{found.headline} {found.verdict}"


def dropped_at_step(
    case: ResolvedContact, settings: EngineSettings | None, speed: float | None
) -> ReboundHeights | None:
    """The rises of balls that are dropped, in an engine with a time step that is given."""
    if speed is None or settings is None or settings.at_step is None:
        return None
    if settings.at_step.steps > MOST_STEPS:
        return None
    release = case.equivalent.release
    step = _engine_of(case, settings.name).step(case.physical, release, settings.time_step)
    return drop_in_steps(step, speed, case.table.gravity, case.physical.contact_time(release))


def at_given_step(
    contact: Contact, time_step: float, error: float, speed: float | None = None
) -> AtStep:
    """What the engine whose parameters are given does with them and a time step in s, at an impact
    speed in m/s if r depends on it.

    Raises
    ------
    ModelError
        If no engine is named, or r depends on the speed and none is given.
    """
    engine = contact.engine
    if engine is None:
        raise ParameterError(
            "{time_step} needs {engine} or {from_engine}, such as generic: "
            "engines step in different ways"
        )
    parameters = contact.engine_parameters
    if _STEP in parameters:
        raise ParameterError("{time_step} and {parameters} time_step give the same: give one")
    plain = contact.by_stiffness_and_loss()
    return engine.at_step_of(parameters, plain.mass, time_step, error, plain.release, speed)


def at_own_step(contact: Contact, error: float, speed: float | None = None) -> AtStep | None:
    """What an engine does with parameters that contain its time step; None without such a step.

    ``speed`` is the impact speed in m/s on which r may depend.

    Raises
    ------
    ModelError
        If the parameters of this engine contain no time step.
    """
    engine = contact.engine
    if engine is None or _STEP not in contact.engine_parameters:
        return None
    plain = contact.by_stiffness_and_loss()
    parameters = dict(contact.engine_parameters)
    step = parameters.pop(_STEP)
    found = engine.at_step_of(parameters, plain.mass, step, error, plain.release, speed)
    return replace(found, is_of_parameters=True)


LOOSE = 0.01
"""An error of r with which a contact may be stiffer by one or two orders than with 0.001."""


@dataclass(frozen=True)
class Looser:
    """The stiffest contact whose r is within a larger error at a given time step, in SI units.

    It is stiffer than that of :class:`Softer`, which keeps the error that was allowed.
    """

    error: float
    stiffness: float
    damping: float
    unit_of_damping: str = "N s/m"


def looser(case: ResolvedContact, at: AtStep | None) -> Looser | None:
    """The contact with a larger error; None if the step resolves the given one, or for that error.

    Examples
    --------
    >>> from bouncing_ball_contacts.contact.resolve import resolve
    >>> contact = Contact(mass=1.0, stiffness=1e6, restitution=0.75)
    >>> case = resolve(contact, TableMotion.at_rest(), written="generic")
    >>> setup = EngineSetup(engine="generic", time_step="2 ms")
    >>> at = settings_for(description_of(case), setup).at_step
    >>> looser(case, at).stiffness > 20 * at.stiffest
    True
    """
    if at is None or at.is_within or at.allowed >= LOOSE:
        return None
    if at.speed is not None:
        return _looser_of_law(at, at.speed)
    exact = at.stiffest_spring(case.mass)
    if exact is None:
        return None
    scheme = engine_named(at.engine).scheme
    release = case.equivalent.release
    found, _ = stiffest_contact(
        scheme, case.mass, exact.damping_ratio, release, at.time_step, LOOSE
    )
    return Looser(LOOSE, found.stiffness, found.damping)


def _looser_of_law(at: AtStep, speed: float) -> Looser | None:
    """The contact with a larger error and the damping of Hunt and Crossley."""
    if at.stiffest is None or at.stiffest_steps is None or at.stiffest_damping is None:
        return None
    # The number of steps depends on the damping and the speed alone.
    law = LinearHuntCrossley(at.stiffest, at.stiffest_damping)
    stiffer = at.stiffest * (at.stiffest_steps / fewest_steps_of_law(law, speed, LOOSE)) ** 2
    return Looser(LOOSE, stiffer, at.stiffest_damping, at.unit_of_damping)
