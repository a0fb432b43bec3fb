"""All questions in one call: :func:`design`, parameters with units in, a :class:`Design` out."""

from collections.abc import Mapping, Sequence
from dataclasses import fields, replace
from typing import Annotated, Any

from bouncing_ball.accuracy.errors import Quantity
from bouncing_ball.contacts import given as data
from bouncing_ball.contacts.assess import of_case, of_contact
from bouncing_ball.contacts.choose import of_loss
from bouncing_ball.contacts.engine_data import Ready, ready
from bouncing_ball.contacts.engines.engine import ERROR
from bouncing_ball.contacts.engines.physical import Physical
from bouncing_ball.contacts.given import Contact, Question, Simulation, Table
from bouncing_ball.contacts.lone_contact import dropped, lone_contact, physical
from bouncing_ball.contacts.recipe import (
    at_given_step,
    resolved,
    settings_of,
    settings_on_table,
)
from bouncing_ball.contacts.results import Design, LoneContact, TimeStep
from bouncing_ball.errors import NoOrbitError, ParameterError
from bouncing_ball.models.damping import Release

# Parameters of which each implies that there is a table.
_TABLE = ("frequency", "angular_frequency", "period", "table_amplitude", "acceleration")


def design(
    *,
    mass: data.Mass = None,
    frequency: data.Frequency = None,
    angular_frequency: data.AngularFrequency = None,
    period: data.Period = None,
    table_amplitude: data.TableAmplitude = None,
    acceleration: data.Acceleration = None,
    gravity: data.Gravity = None,
    stiffness: data.Stiffness = None,
    contact_time: data.ContactTime = None,
    reduced_modulus: data.ReducedModulus = None,
    youngs_modulus: data.YoungsModulus = None,
    poissons_ratio: data.PoissonsRatio = None,
    table_youngs_modulus: data.YoungsModulus = None,
    table_poissons_ratio: data.PoissonsRatio = None,
    radius: data.Radius = None,
    damping: data.Damping = None,
    damping_ratio: data.DampingRatio = None,
    restitution: data.Loss = None,
    measured_restitution: data.Loss = None,
    drop_height: data.DropHeight = None,
    rebound_height: data.ReboundHeight = None,
    speed: data.Speed = None,
    n: data.Index | None = None,
    release: data.Rule | None = None,
    law: str | None = None,
    quantity: Annotated[str, Quantity] = "max_height",
    tolerance: data.Tolerance = 0.01,
    balls: data.Balls | None = None,
    engine: str | None = None,
    restitution_error: data.RestitutionError = ERROR,
    time_step: data.TimeStep = None,
    from_engine: str | None = None,
    solref: str | Sequence[float] | None = None,
    solimp: str | Sequence[float] | None = None,
    parameters: Mapping[str, float] | None = None,
) -> Design | LoneContact:
    """Assess a contact or choose one, or write it for an engine; without a table, describe it.

    This is :func:`~.assess.assess_contact`, :func:`~.choose.choose_contact` and
    :func:`~.recipe.write_contact` in one call, whose parameters say which of them is asked.

    Parameters are plain numbers in SI units, texts such as ``"50 Hz"``, or pint
    quantities. With a stiffness (or a contact time, or E* and R of a Hertz contact)
    the answer says whether the restitution model is good enough for this contact;
    without one, it gives the contact that a simulation needs for the tolerance. A contact without
    a table has no orbit, but can be written for an engine.

    Parameters
    ----------
    mass
        Mass m of the ball.
    frequency
        Frequency of the table in Hz; or give the angular frequency or the period.
    angular_frequency
        Angular frequency Ω of the table in rad/s, in place of the frequency.
    period
        Period of the table, in place of the frequency.
    table_amplitude
        Amplitude A of the table's motion, in m; or give the acceleration.
    acceleration
        Greatest acceleration AΩ² of the table, in m/s²; "2 g" is twice standard gravity.
    gravity
        Acceleration of gravity, by default 9.80665 m/s². For a gear pair, the deceleration that the
        drag torque causes.
    stiffness
        Stiffness k of the contact. If no parameter gives a stiffness, a contact is chosen.
    contact_time
        Duration of a free impact, in place of the stiffness.
    reduced_modulus
        Reduced modulus E* of a Hertz contact with the damping of Tsuji; needs the radius.
    youngs_modulus
        Young's modulus E of the ball, in place of E*, where 1/E* is the sum of (1 - ν²)/E of the
        ball and of the table.
    poissons_ratio
        Poisson's ratio ν of the ball.
    table_youngs_modulus
        Young's modulus of the table.
    table_poissons_ratio
        Poisson's ratio of the table.
    radius
        Radius of curvature R of a Hertz contact; for a ball on a plane, the radius of the ball.
    damping
        Damping c of the contact; needs the stiffness.
    damping_ratio
        Damping ratio ζ = c/(2√(km)) of the contact.
    restitution
        Restitution coefficient of a free impact that ends at the table's level,
        r = exp(-πζ/√(1 - ζ²)), Eq. 16 of the paper. With an engine or a law, r under its release.
    measured_restitution
        Restitution coefficient of a free impact, without gravity, under the given release.
    drop_height
        Height of the drop in a drop test, with gravity, onto a table at rest; needs the height of
        the rebound.
    rebound_height
        Height of the rebound in a drop test, above the table at rest.
    speed
        Speed of an impact on a table at rest: the answer then has the heights of this drop and its
        restitution with gravity, also at half and at a tenth of the speed.
    n
        Index n of the family. By default n = 1 to 8, with a verdict on the first stable orbit.
    release
        Where a contact ends: "displacement" at the table's level, the default without an engine,
        or "force" where the contact force vanishes.
    law
        Name of a contact law, such as hunt-crossley, in place of the linear one. It has the given
        restitution coefficient and contact time at the impact speed of the orbit.
    quantity
        Name of the quantity that must be accurate.
    tolerance
        Largest relative error of the restitution model's quantity against the contact's, such as
        "5 %" or 0.05.
    balls
        Largest number of balls whose means over time are compared if the motion does not repeat.
        By default it takes about a second.
    engine
        Physics engine for which the contact is written: generic, mujoco, lammps, liggghts,
        pybullet, drake or mercurydpm. The contact then ends as in this engine.
    restitution_error
        Largest error of the restitution coefficient that the engine's time step may cause.
    time_step
        The engine's time step, if it is given. The answer then says what the contact does at this
        step, and which is the stiffest contact with the same r within the error.
    from_engine
        Physics engine whose parameters are given, in place of stiffness and loss.
    solref
        For MuJoCo: "-K -B" per unit of mass, or "TIMECONST DAMPRATIO".
    solimp
        For MuJoCo: "DMIN DMAX WIDTH MIDPOINT POWER", or the first of these numbers.
    parameters
        For the other engines: a parameter by its name, such as kn=1e5; for PyBullet and Drake also
        time_step, in s.

    Returns
    -------
    Design or LoneContact
        The assessed or chosen contact, its orbits and the motion of the ball on a table; without a
        table, the contact alone. Numbers with a unit are in SI units.

    Raises
    ------
    ModelError
        If a parameter is missing, out of range or contradicts another.
    NoOrbitError
        If no model has the orbit.

    Examples
    --------
    >>> found = design(mass="20 g", frequency="50 Hz", acceleration="0.8 g",
    ...                stiffness="1e7 N/m", restitution=0.85)
    >>> round(found.frequency_ratio, 3), found.orbits[0].is_stable, found.is_good_enough
    (71.176, True, False)

    A contact written for an engine:

    >>> found = design(mass=0.5, stiffness="50 kN/m", restitution=0.75, engine="mujoco")
    >>> round(found.engine.restitution, 6), found.engine.release
    (0.75, 'force')
    """
    call = locals()
    si = in_si(call)
    contact = Contact(**_of(Contact, call))
    question = Question(n=n, quantity=quantity, tolerance=tolerance, balls=balls)
    found = ready(contact, engine)
    allowed = si["restitution_error"]
    simulation = None
    if engine is not None:
        simulation = Simulation(engine=engine, restitution_error=allowed, time_step=time_step)
    on_table = n is not None or any(call[name] is not None for name in _TABLE)
    has_stiffness = found.contact.stiffness is not None or contact_time is not None
    answer: Design | LoneContact
    if on_table or not (engine or has_stiffness):
        table = Table(**_of(Table, call))
        # An acceleration in m/s², with or without its unit, may have been meant in g.
        hint = _meant_in_g(acceleration, table) if gravity is None else ""
        answer = _on_table(found, table, question, hint)
        if simulation is not None:
            answer = _written(answer, simulation)
        of_drop = Physical(answer.case.mass, answer.stiffness, answer.damping)
        rule = answer.case.contact.release
        is_linear = answer.law is None
    else:
        if simulation is not None:
            found = resolved(found, simulation, si.get("gravity"))
        answer = lone_contact(found, si.get("gravity"))
        if simulation is not None:
            answer = replace(answer, engine=settings_of(answer, simulation))
        of_drop = physical(answer)
        rule = Release.of(answer.release)
        is_linear = answer.damping is not None
    if speed is not None:
        if not is_linear:
            raise ParameterError("{speed} needs a spring and a damper: this r depends on the law")
        answer = replace(answer, dropped=dropped(of_drop, rule, si.get("gravity"), si["speed"]))
    if time_step is None:
        return answer
    if answer.engine is not None:
        return replace(answer, at_step=answer.engine.at_step)
    return replace(answer, at_step=at_given_step(found, si["time_step"], allowed))


def _of(kind: Any, call: Mapping[str, Any]) -> dict[str, Any]:
    """The arguments of the call that are fields of a class."""
    return {each.name: call[each.name] for each in fields(kind)}


def in_si(call: Mapping[str, Any]) -> dict[str, float]:
    """The quantities of a call of :func:`design` that are given, in SI units.

    Raises
    ------
    ModelError
        If one of them is no number with a unit of the right dimension, or out of range.

    Examples
    --------
    >>> in_si({"mass": "20 g", "n": 1})
    {'mass': 0.02}
    """
    kinds = data.quantities(design)
    return {
        name: data.in_si(name, call[name], kind)
        for name, kind in kinds.items()
        if call.get(name) is not None
    }


def _meant_in_g(acceleration: Any, table: Table) -> str:
    if acceleration is None or str(acceleration).strip().endswith("g"):
        return ""
    return f"perhaps {table.acceleration:g} g was meant"


def _on_table(found: Ready, table: Table, question: Question, hint: str) -> Design:
    """The assessment of a contact that is given, or of the one that is chosen."""
    try:
        if found.contact.is_stiff:
            answer = of_contact(table.motion, found, question)
        else:
            choice = of_loss(table.motion, found, question)
            answer = of_case(choice.case, question, found.remarks + choice.notes, choice)
    except NoOrbitError as error:
        raise NoOrbitError(_both(str(error), hint)) from None
    if hint and not any(each.exists for each in answer.judged.standing.values()):
        answer = replace(answer, reason=_both(answer.reason, hint))
    return Design(**vars(answer))


def _both(reason: str, hint: str) -> str:
    return "; ".join(filter(None, [reason, hint]))


def _written(answer: Design, simulation: Simulation) -> Design:
    """The answer with the settings of an engine, and with its time step as the only one."""
    settings = settings_on_table(answer, simulation)
    rule = f"r of a free impact in {settings.name} is within {settings.error:g}"
    step = TimeStep(settings.time_step, rule)
    return replace(answer, engine=settings, time_step=step)
