"""The third question: what does one write into an engine for a contact?

The time step follows from the contact, or is given. A given step is too long for stiff contacts;
the settings are then those of the stiffest contact with the same r that it resolves.
"""

import math
from dataclasses import replace

from bouncing_ball.contacts.assess import of_contact
from bouncing_ball.contacts.contact_data import loss, require_pairs, rule_of, same_omega
from bouncing_ball.contacts.engine_data import Ready, ready
from bouncing_ball.contacts.engines.choice import engine_named
from bouncing_ball.contacts.engines.engine import EngineSettings
from bouncing_ball.contacts.engines.given_step import AtStep, stiffest_contact
from bouncing_ball.contacts.engines.physical import Physical
from bouncing_ball.contacts.given import (
    STANDARD_GRAVITY,
    Contact,
    Question,
    Simulation,
    Table,
    given,
)
from bouncing_ball.contacts.lone_contact import LONGEST, lone_contact, physical
from bouncing_ball.contacts.results import Assessment, LoneContact
from bouncing_ball.errors import ParameterError

# Largest number of times that the damping of a drop test is fitted to the stiffest contact.
_REFITS = 12
_OF_A_LAW = (
    "{time_step} is given for a spring and a damper: the r of this contact depends on the speed"
)


def write_contact(
    contact: Contact,
    simulation: Simulation,
    table: Table | None = None,
    question: Question | None = None,
) -> EngineSettings:
    """What to write into an engine for a contact, and what it does there.

    Parameters
    ----------
    contact : Contact
        Its restitution is the measured one, under the release of the engine. With a time step it
        needs no stiffness: the answer is then the stiffest contact that this step resolves.
    simulation : Simulation
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
    >>> found = write_contact(contact, Simulation(engine="mujoco"))
    >>> found.parameters["solref"][0], round(found.restitution, 6), found.release
    (-100000.0, 0.75, 'force')

    A step of a millisecond is too long for it:

    >>> found = write_contact(contact, Simulation(engine="mujoco", time_step="1 ms"))
    >>> found.at_step.is_within, f"{found.at_step.stiffest:.3g} N/m"
    (False, '74.1 N/m')
    """
    found = ready(contact, simulation.engine)
    if table is None:
        found = resolved(found, simulation, None)
        return settings_of(lone_contact(found, None), simulation)
    answer = of_contact(table.motion, found, question or Question())
    return settings_on_table(answer, simulation)


def resolved(ready: Ready, simulation: Simulation, gravity: float | None) -> Ready:
    """The contact itself, or without a stiffness the stiffest one that the time step resolves."""
    contact = ready.contact
    if contact.is_stiff or simulation.time_step is None:
        return ready
    data = given(contact)
    require_pairs(data)
    rule = rule_of(contact)
    engine = engine_named(simulation.engine)
    zeta = loss(data, rule)
    stiffness = 0.0
    for _ in range(_REFITS):
        before = stiffness
        step = simulation.time_step
        allowed = simulation.restitution_error
        found, steps = stiffest_contact(engine.scheme, contact.mass, zeta, rule, step, allowed)
        if steps * step > LONGEST:
            raise ParameterError(
                f"no contact shorter than {LONGEST:g} s has its r within {{restitution_error}} "
                f"{allowed:g} at {{time_step}} {step:g} s: allow a larger error"
            )
        stiffness = found.stiffness
        if contact.rebound_height is None or math.isclose(stiffness, before, rel_tol=1e-12):
            break
        # By gravity the ζ of a drop test depends on the stiffness.
        omega = math.sqrt(stiffness / contact.mass)
        zeta = loss(data, rule, same_omega(omega), gravity or STANDARD_GRAVITY)
    return ready._replace(contact=replace(contact, stiffness=stiffness))


def settings_of(found: LoneContact, simulation: Simulation) -> EngineSettings:
    """The settings for a contact without a table."""
    return engine_named(simulation.engine).settings(
        physical(found), found.release, simulation.restitution_error, simulation.time_step
    )


def settings_on_table(found: Assessment, simulation: Simulation) -> EngineSettings:
    """The settings for a contact on a table, and the orbit that the engine will show."""
    engine = engine_named(simulation.engine)
    if found.law is not None:
        if simulation.time_step is not None:
            raise ParameterError(_OF_A_LAW)
        engine = engine.with_law(found.law)
    contact = Physical(found.case.mass, found.stiffness, found.damping)
    release = str(found.case.contact.release)
    settings = engine.settings(contact, release, simulation.restitution_error, simulation.time_step)
    if settings.at_step is not None and not settings.at_step.is_within:
        # The settings are those of another contact, with another orbit.
        return settings
    return replace(
        settings,
        max_height=found.judged.max_height,
        contact_duration=found.judged.contact_duration,
        penetration=found.judged.greatest_compression,
    )


def at_given_step(found: Ready, time_step: float, error: float) -> AtStep:
    """What the engine whose parameters are given does with them and a time step in s.

    Raises
    ------
    ModelError
        If no engine is named, or r depends on the speed.
    """
    if found.source is None:
        raise ParameterError(
            "{time_step} needs {engine} or {from_engine}, such as generic: "
            "engines step in different ways"
        )
    source = found.source
    if found.needs_speed:
        raise ParameterError(_OF_A_LAW)
    if "time_step" in source.parameters:
        raise ParameterError("{time_step} and {parameters} time_step give the same: give one")
    release = found.contact.release
    return source.engine.at_step_of(
        source.parameters, source.contact.mass, time_step, error, release
    )
