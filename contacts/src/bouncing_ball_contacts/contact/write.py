"""The third question: what does one write into an engine for a contact?

The time step follows from the contact, or is given. A given step is too long for stiff contacts:
what is written is then the contact whose rebound in a drop is nearest to the r that was asked for,
with another damping or another stiffness. Without a stiffness it is the contact with the least
error, or the stiffest one within an error that is given.
"""

import math
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from bouncing_ball_beyond.inherited.errors import ModelError, ParameterError, suggesting
from bouncing_ball_beyond.models.laws.contact_law import ContactLaw
from bouncing_ball_beyond.models.spring_damper import SpringDamper
from bouncing_ball_contacts.contact.contact import Contact
from bouncing_ball_contacts.contact.describe import LONGEST, Description, description_of
from bouncing_ball_contacts.contact.hertz import MATERIALS
from bouncing_ball_contacts.contact.loss import loss, of_loss
from bouncing_ball_contacts.contact.quantities import check_kinds, given
from bouncing_ball_contacts.contact.question import EngineSetup, Question
from bouncing_ball_contacts.contact.rebounds import rises
from bouncing_ball_contacts.contact.resolve import resolve
from bouncing_ball_contacts.contact.resolved import ResolvedContact
from bouncing_ball_contacts.contact.table import Table, TableMotion
from bouncing_ball_contacts.engines.choice import engine_named
from bouncing_ball_contacts.engines.drop_in_steps import DropInSteps, drop_in_steps
from bouncing_ball_contacts.engines.engine import (
    Engine,
    EngineSettings,
    LawInSI,
    Written,
    without_step,
)
from bouncing_ball_contacts.engines.given_step import AtStep, stiffest_contact
from bouncing_ball_contacts.engines.physical import Physical
from bouncing_ball_contacts.engines.steps import InstantStep

# It imports orbits, for longer than most recipes are computed.
if TYPE_CHECKING:
    from bouncing_ball_contacts.contact.assess import Assessment

HEIGHT = 1.0
"""The height in m of the drop by which a contact is judged if no speed and no height is given."""
# The steps of the contact from which the search for another one begins.
_BEGIN = 20.0
_AS_GOOD = 1.1
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
        needs no stiffness: the answer is then the contact with the least error in a drop from 1 m,
        or the stiffest one within the error of a free impact that is given.
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

    A step of a millisecond is too long for it, and a softer contact is written:

    >>> found = write_contact(contact, EngineSetup(engine="mujoco", time_step="1 ms"))
    >>> found.changed, found.contact.stiffness < 5e4, found.drop.error < 0.02
    ('stiffness and damping', True, True)
    """
    asked = Question() if question is None else question
    # Without a table its place is held by its class.
    on = (table, Table) if table is not None else (None, type(None))
    of = {"contact": (contact, Contact), "setup": (setup, EngineSetup), "table": on}
    check_kinds("write_contact", **of, question=(asked, Question))
    if table is None:
        return settings_for(describe_for(contact, setup), setup)
    # Imported here, because orbits are imported for longer than most recipes are computed.
    from bouncing_ball_contacts.contact.assess import assess

    case = resolve(contact, table.motion, asked.families, setup.engine)
    return settings_for(assess(case, asked), setup)


def describe_for(
    contact: Contact,
    setup: EngineSetup,
    gravity: float | None = None,
    speed: float | None = None,
) -> Description:
    """The numbers of a contact as it ends in the engine, or without a stiffness those of the one
    that suits the time step of the engine.

    Raises
    ------
    ModelError
        If parameters do not suffice or contradict each other, or no contact has its r within the
        error that is given at this step.
    """
    at_rest = TableMotion.at_rest(gravity)
    step = setup.time_step
    if contact.is_stiff or step is None:
        return description_of(resolve(contact, at_rest, written=setup.engine, speed=speed))
    if setup.restitution_error is None:
        stiffness = _suited_stiffness(contact, setup.engine, step, at_rest.gravity, speed)
    else:
        stiffness = _stiffest(contact, setup.engine, step, at_rest.gravity, setup.error)
    stiff = replace(contact, stiffness=stiffness)
    case = resolve(stiff, at_rest, written=setup.engine, speed=speed)
    return description_of(replace(case, given=contact))


def _suited_stiffness(
    contact: Contact, name: str, step: float, gravity: float, speed: float | None
) -> float:
    """The stiffness in N/m of the contact whose rebound in a drop is nearest to its r."""
    plain = contact.by_stiffness_and_loss(name)
    release = plain.rule
    # The r of a drop test is taken without gravity here, and fitted to the stiffness afterwards.
    zeta = loss(plain)
    of_step = SpringDamper.of_duration(step, zeta, release)
    omega = float(of_step.frequency_ratio) / _BEGIN
    linear = Physical(plain.mass, plain.mass * omega**2, 2 * zeta * plain.mass * omega)
    written = Written(engine_named(name), linear, release)
    at = written.at_step(step, 1.0)
    height = _height(contact, gravity, speed)
    return written.suited(at, at.restitution, height, gravity)[0].contact.stiffness


def _stiffest(contact: Contact, name: str, step: float, gravity: float, error: float) -> float:
    """The stiffness in N/m of the stiffest contact whose free impacts have its r within an error.

    Raises
    ------
    ModelError
        If there is none.
    """
    plain = contact.by_stiffness_and_loss(name)
    scheme = engine_named(name).scheme

    def stiffness(zeta: float) -> tuple[float, float]:
        found, steps = stiffest_contact(scheme, plain.mass, zeta, plain.rule, step, error)
        if steps * step > LONGEST:
            raise ParameterError(
                f"no contact shorter than {LONGEST:g} s has its r within {{restitution_error}} "
                f"{error:g} at {{time_step}} {step:g} s: allow a larger error"
            )
        return found.angular_frequency, found.stiffness

    return of_loss(plain, gravity, stiffness)


def _height(contact: Contact, gravity: float, speed: float | None) -> float:
    """The height in m of the drop in question, from its impact speed in m/s if that is given."""
    if speed is not None:
        return speed**2 / (2 * gravity)
    return HEIGHT if contact.drop_height is None else contact.drop_height


def settings_for(
    found: "Assessment | Description", setup: EngineSetup, speed: float | None = None
) -> EngineSettings:
    """The settings for a contact, what a drop onto it does in the engine, and on a table the orbit
    that the engine will show.

    ``speed`` is the impact speed of the drop in m/s, by default that of the orbit on a table. At a
    given time step the settings have the r of a law at this speed, or else at that at which the law
    has the r of the contact.

    Raises
    ------
    ModelError
        If the engine has no such contact, or if a time step is given for a contact law, and it is
        not known what the engine does there.
    """
    case = found.case
    judged = None if isinstance(found, Description) else found.judged
    engine, law = _of_law(case, setup.engine, None if judged is None else judged.impact_speed)
    steps_known = law is None or engine.needs_speed
    if setup.time_step is not None and not steps_known:
        raise ParameterError(_OF_A_LAW)
    release = str(case.equivalent.release)
    settings = engine.settings(case.physical, release, setup.error, setup.time_step, law)
    if steps_known:
        if speed is None and judged is not None:
            speed = judged.impact_speed
        written = Written(engine, settings.contact, case.equivalent.release, law)
        height = _height(case.given, case.table.gravity, speed)
        is_suited = judged is None and not case.given.is_stiff
        settings = _dropped(written, settings, case, height, is_suited)
    # At a step that is too long the contact has another r, and so another orbit.
    if judged is None or (settings.at_step is not None and not settings.at_step.is_within):
        return settings
    if settings.changed:
        return settings
    return replace(
        settings,
        max_height=judged.max_height,
        contact_duration=judged.contact_duration,
        penetration=judged.greatest_compression,
    )


def _dropped(
    asked: Written,
    settings: EngineSettings,
    case: ResolvedContact,
    height: float,
    is_suited: bool,
) -> EngineSettings:
    """The settings with their drop, or at a step that is too long those with the least error.

    ``is_suited`` tells whether the stiffness was chosen for the step.
    """
    gravity = case.table.gravity
    at = settings.at_step
    r = settings.restitution if at is None else at.restitution
    measured = case.given
    if measured.rebound_height is not None:
        r = math.sqrt(measured.rebound_height / measured.drop_height)
    tried = [("", asked, settings)]
    if at is not None and not at.is_within:
        candidates = {"damping": asked.tuned(at, r, height, gravity)}
        if not is_suited:
            other, there = asked.suited(at, r, height, gravity)
            candidates["stiffness"] = other, there
            candidates["stiffness and damping"] = other.tuned(there, r, height, gravity)
        tried += [(what, one, one.settings(there)) for what, (one, there) in candidates.items()]
    drops = [
        written.drop(
            one.time_step,
            one.steps,
            height,
            gravity,
            r,
            is_stable=one.at_step is None or one.at_step.is_stable,
        )
        for _, written, one in tried
    ]
    errors = np.array([math.inf if drop is None else drop.error for drop in drops])
    # The fewest changes that are about as good as the best ones.
    best = int(np.argmax(errors <= _AS_GOOD * errors.min()))
    what, written, settings = tried[best]
    changed = "" if is_suited else what
    settings = replace(
        settings,
        changed=changed,
        asked=at if changed else None,
        wanted=r,
        drop=drops[best],
        taken_by_gravity=_taken_by_gravity(case, written, settings, height),
    )
    return _with_instant(written.engine, settings, r, height, gravity)


def _taken_by_gravity(
    case: ResolvedContact, written: Written, settings: EngineSettings, height: float
) -> float:
    """How much less √(h′/h) is than the r of a free impact, in a drop without steps."""
    unit = case.table
    law: ContactLaw | None = None
    if not case.is_spring_damper:
        law = written.engine.law(settings.parameters, case.mass, unit.time, unit.length)
    if law is None:
        ratio = settings.contact.angular_frequency * unit.time
        law = SpringDamper(ratio, settings.contact.damping_ratio, written.release)
    speed = np.array([math.sqrt(2 * height / unit.length)])
    free = float(law.signature(speed[0]).restitution)
    return free - float(np.sqrt(2 * rises(law, speed))[0] / speed[0])


def _with_instant(
    engine: Engine, settings: EngineSettings, r: float, height: float, gravity: float
) -> EngineSettings:
    """The settings, with the number r of the engine beside them if it comes closer."""
    if engine.instant is None or settings.at_step is None or settings.drop is None:
        return settings
    mass = settings.contact.mass
    half = engine.half_steps
    step = InstantStep(r, settings.time_step)
    drop = drop_in_steps(step, mass, height, gravity, 1.0, r, half_steps=half)
    if drop.error >= settings.drop.error:
        return settings
    return replace(settings, instant=engine.instant(r), instant_drop=drop)


def _of_law(case: ResolvedContact, name: str, speed: float | None) -> tuple[Engine, LawInSI | None]:
    """The row of an engine for the law of a contact, and this law for impacts with a speed in m/s;
    None for a spring and a damper.

    Raises
    ------
    ModelError
        If the engine has no such law.
    """
    engine = engine_named(name)
    if case.is_spring_damper:
        return engine, None
    kind = type(case.law)
    row = next((row for row in engine.laws.values() if row.written_law is kind), None)
    if row is None:
        raise ModelError(f"{case.law.name} is not written for {name}")
    data = given(case.given)
    return row, LawInSI(
        law=kind(**case.law.in_si(1.0, case.table.length, case.table.time)),
        speed=case.law_speed if speed is None else speed,
        radius=case.given.radius,
        materials=tuple(data[name] for name in MATERIALS) if MATERIALS[0] in data else None,
    )


def at_step_of_parameters(
    found: "Assessment | Description",
    time_step: float | None,
    error: float,
    speed: float | None = None,
) -> tuple[AtStep, DropInSteps | None] | None:
    """What the engine whose parameters are given does with them at a time step in s, which may be
    one of the parameters, and a drop there; None without a step.

    ``speed`` is the impact speed of the drop in m/s, on which r may depend; on a table r is that at
    the impact speed of the orbit.

    Raises
    ------
    ModelError
        If no engine is named, the step is given twice, the parameters of this engine contain none,
        or r depends on the speed and none is given.
    """
    case = found.case
    contact = case.given
    engine = contact.engine
    if engine is None:
        if time_step is None:
            return None
        raise ParameterError(
            "{time_step} needs {engine} or {from_engine}, such as generic: "
            "engines step in different ways"
        )
    own = contact.engine_parameters.get(_STEP)
    if own is not None and time_step is not None:
        raise ParameterError("{time_step} and {parameters} time_step give the same: give one")
    step = own if time_step is None else time_step
    # A ball that the damper holds has no impact whose r a step could change.
    if step is None or case.holds:
        return None
    parameters = without_step(contact.engine_parameters)
    at_speed = speed if isinstance(found, Description) else found.judged.impact_speed
    written, at = engine.at_step_of(parameters, case.mass, step, error, contact.release, at_speed)
    gravity = case.table.gravity
    drop = written.drop(
        step,
        at.steps,
        _height(contact, gravity, speed),
        gravity,
        at.restitution,
        is_stable=at.is_stable,
    )
    return replace(at, is_of_parameters=own is not None), drop
