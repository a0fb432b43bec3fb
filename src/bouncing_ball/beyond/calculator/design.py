"""The calculator: :func:`design`, parameters with units in, a :class:`Design` out."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Annotated, Any, get_args

from bouncing_ball.beyond.calculator.case import PhysicalCase, Table
from bouncing_ball.beyond.calculator.contact_data import (
    STANDARD_GRAVITY,
    case_of,
    loss,
    meant,
    read_engine,
    same_omega,
    table_of,
)
from bouncing_ball.beyond.calculator.drop_test import slowed_speed
from bouncing_ball.beyond.calculator.families import RATIOS, families, finite, needed
from bouncing_ball.beyond.calculator.motion import of_family
from bouncing_ball.beyond.calculator.results import Contact, Corrected, Design, Needed, TimeStep
from bouncing_ball.beyond.calculator.units import (
    Index,
    Rule,
    SIParameter,
    number,
    percent,
    shown,
)
from bouncing_ball.beyond.calculator.verdict import (
    aside,
    assessed,
    chosen,
    headline,
    judged_by_motion,
    notes,
)
from bouncing_ball.beyond.engines.choice import engine_named
from bouncing_ball.beyond.engines.engine import ERROR, Physical
from bouncing_ball.beyond.laws.contact_law import ContactLaw
from bouncing_ball.beyond.laws.linear import LinearLaw
from bouncing_ball.beyond.laws.registry import law_named
from bouncing_ball.errors import ModelError, NoOrbitError, ParameterError, Range, one_of, require
from bouncing_ball.paper.comparison.errors import OF_ORBITS, QUANTITIES, Quantity
from bouncing_ball.paper.comparison.thresholds import ThresholdStatus
from bouncing_ball.paper.contact.damping import Release
from bouncing_ball.paper.contact.spring_damper import SpringDamper
from bouncing_ball.paper.orbits.restitution_model import RestitutionModel

STEPS = 50
"""Time steps in one contact, for the rule of the largest time step."""

STEP_RULE = f"a contact takes {STEPS} steps, the default of MFiX-Exa (mfix.tcoll_ratio)"
# The default families: those that the paper shows, and some more.
_FAMILIES = range(1, 9)
# Beyond this limit the squares of ϖ and Λ leave no digits. The other calls have the same limit.
_LARGEST = 1e8
# Largest number of times that the damping of a drop test is fitted to the stiffness chosen.
_REFITS = 12
# The smallest modulus in Pa that is taken for one if it is given without a unit.
_SOFTEST = 1e4
# The longest contact in s that is taken for one: no simulation has a longer one.
_LONGEST = 1000.0
# Parameters of which each implies that there is a table.
_TABLE = {"frequency", "angular_frequency", "period", "table_amplitude", "acceleration"}
_LOSS = SIParameter("", "0.85", Range(0, 1, "(]"))
_POISSON = SIParameter("", "0.3", Range(-1, 0.5, "(]"))
_NONE_TOO = Range(0, 1e40, "[]")


def design(
    *,
    mass: Annotated[Any, SIParameter("kg", "20 g")] = None,
    frequency: Annotated[Any, SIParameter("Hz", "50 Hz")] = None,
    angular_frequency: Annotated[Any, SIParameter("rad/s", "314 rad/s")] = None,
    period: Annotated[Any, SIParameter("s", "20 ms")] = None,
    table_amplitude: Annotated[Any, SIParameter("m", "0.1 mm")] = None,
    acceleration: Annotated[Any, SIParameter("m/s^2", "2 g")] = None,
    gravity: Annotated[Any, SIParameter("m/s^2", "9.81 m/s^2")] = None,
    stiffness: Annotated[Any, SIParameter("N/m", "1e6 N/m")] = None,
    contact_time: Annotated[Any, SIParameter("s", "50 us")] = None,
    reduced_modulus: Annotated[Any, SIParameter("Pa", "115 GPa")] = None,
    youngs_modulus: Annotated[Any, SIParameter("Pa", "210 GPa")] = None,
    poissons_ratio: Annotated[Any, _POISSON] = None,
    table_youngs_modulus: Annotated[Any, SIParameter("Pa", "210 GPa")] = None,
    table_poissons_ratio: Annotated[Any, _POISSON] = None,
    radius: Annotated[Any, SIParameter("m", "5 mm")] = None,
    damping: Annotated[Any, SIParameter("N*s/m", "10 N s/m", _NONE_TOO)] = None,
    damping_ratio: Annotated[Any, SIParameter("", "0.05", _NONE_TOO)] = None,
    restitution: Annotated[Any, _LOSS] = None,
    measured_restitution: Annotated[Any, _LOSS] = None,
    drop_height: Annotated[Any, SIParameter("m", "1 m")] = None,
    rebound_height: Annotated[Any, SIParameter("m", "70 cm")] = None,
    n: Index | None = None,
    release: Rule | None = None,
    law: str | None = None,
    quantity: Annotated[str, Quantity] = "max_height",
    tolerance: Annotated[Any, SIParameter("", "1 %", Range(0, 1))] = 0.01,
    engine: str | None = None,
    restitution_error: Annotated[Any, SIParameter("", "0.001", Range(0, 1))] = ERROR,
    from_engine: str | None = None,
    solref: str | Sequence[float] | None = None,
    solimp: str | Sequence[float] | None = None,
    parameters: Mapping[str, float] | None = None,
) -> Design | Contact:
    """Assess a contact or choose one; without a table, describe the contact.

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
    engine
        Physics engine for which the contact is written: generic, mujoco, lammps, liggghts,
        pybullet, drake or mercurydpm. The contact then ends as in this engine.
    restitution_error
        Largest error of the restitution coefficient that the engine's time step may cause.
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
    Design or Contact
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
    >>> settings = found.engine_settings()
    >>> round(settings.restitution, 6), settings.release
    (0.75, 'force')
    """
    call = locals()
    source, arguments = read_engine(call)
    given = _in_si(arguments)
    question = call | _in_si(call)
    kind = _law_type(law, engine, arguments["release"], given)
    rule = _release_rule(engine, arguments["release"], given)
    one_of("quantity", quantity, {str(each): each for each in QUANTITIES})
    if n is not None and (n != int(n) or n < 1):
        raise ModelError(f"index of the family n = {n} is not a positive integer")
    remarks = source.remarks(engine, rule) if source else ()
    names_stiffness = "stiffness" in given or "contact_time" in given
    if n is None and not given.keys() & _TABLE and (engine or names_stiffness):
        needs_speed = kind is not None or (source is not None and source.engine.needs_speed)
        return _without_table(given, rule, needs_speed, question, remarks)
    table = table_of(given)
    require(table.amplitude < _LARGEST, table.amplitude, "Λ", f"below {_LARGEST:g}")
    asked = _FAMILIES if n is None else [n]
    case = need = None
    try:
        case = case_of(given, table, rule, asked, kind)
        if case is None:
            case, need = _chosen(given, table, rule, asked, question)
        elif source:
            # For another engine the spring and damper is written in place of the law.
            case = source.case(case, asked, engine is not None)
        remarks += _drop_remarks(case, given)
        return _design(case, need, asked, question, remarks)
    except NoOrbitError as error:
        # An acceleration in m/s², with or without its unit, may have been meant in g.
        in_g = str(acceleration).strip().endswith("g") or gravity is not None
        meant = "" if acceleration is None or in_g else f"did you mean {given['acceleration']:g} g?"
        why = "; ".join(filter(None, [str(error), meant]))
        if n is not None or case is None:
            raise NoOrbitError(why) from None
        return _design(case, None, asked, question, remarks, no_orbit=why)


def _chosen(
    given: dict[str, float],
    table: Table,
    rule: Release,
    asked: Sequence[int],
    question: Mapping[str, Any],
) -> tuple[PhysicalCase, Needed]:
    """The case with the most compliant contact within the tolerance, and the ϖ needed for it."""
    # A contact with the ζ of the given loss, whose ϖ is still to be found.
    case, need = _chosen_with(loss(given, rule), given["mass"], table, rule, asked, question)
    if "rebound_height" not in given:
        return case, need
    # By gravity the ζ of a drop test depends on the stiffness, though hardly for a stiff contact.
    for _ in range(_REFITS):
        before = case.contact
        omega = float(before.frequency_ratio) * table.angular_frequency
        zeta = loss(given, rule, same_omega(omega), table.gravity)
        case, need = _chosen_with(zeta, given["mass"], table, rule, asked, question)
        if math.isclose(case.contact.frequency_ratio, before.frequency_ratio, rel_tol=1e-12):
            break
    return case, need


def _chosen_with(
    zeta: float,
    mass: float,
    table: Table,
    rule: Release,
    asked: Sequence[int],
    question: Mapping[str, Any],
) -> tuple[PhysicalCase, Needed]:
    """The case with the most compliant contact of this ζ within the tolerance."""
    quantity = question["quantity"]
    contact = SpringDamper(1.0, zeta, rule)
    r = float(contact.restitution)
    n = meant(asked, r, table.amplitude)
    if quantity in OF_ORBITS:
        RestitutionModel(r).require_orbit(n, table.amplitude)
    need = needed(quantity, question["tolerance"], contact, n, table.amplitude)
    if need.status == ThresholdStatus.NEVER_WITHIN:
        raise NoOrbitError(
            f"no contact up to ϖ = {RATIOS[-1]:g} has its {QUANTITIES[Quantity(quantity)]} "
            f"predicted within {percent(need.tolerance)} by the restitution model with r = {r:.4g}"
        )
    stiff = replace(contact, frequency_ratio=need.frequency_ratio or float(RATIOS[0]))
    return PhysicalCase(mass, table, stiff), need


def _without_table(
    given: dict[str, float],
    rule: Release,
    needs_speed: bool,
    question: dict[str, Any],
    remarks: tuple[str, ...],
) -> Contact:
    """The answer about a contact without a table, by which there is no impact speed."""
    # With a table of 1 rad/s the frequency ratio is the frequency of the contact.
    case = case_of(given, Table(1.0, 1.0, given.get("gravity", STANDARD_GRAVITY)), rule, [1])
    if case is None:
        raise ParameterError("no stiffness: give {stiffness}, or {contact_time}")
    if needs_speed and (question["law"] or question["engine"]):
        what = "law" if question["law"] else "from_engine"
        needs = "a table, such as {frequency} and {acceleration}"
        raise ParameterError(f"{{{what}}} {question[what]} needs {needs}: r depends on the speed")
    zeta = float(case.contact.damping_ratio)
    omega = float(case.contact.frequency_ratio)
    physical = Physical(
        mass=case.mass,
        stiffness=given.get("stiffness", case.mass * omega**2),
        damping=given.get("damping", 2 * zeta * case.mass * omega),
    )
    if not needs_speed:
        _require_short(physical.contact_time(rule))
    return Contact(
        mass=physical.mass,
        stiffness=physical.stiffness,
        damping=None if needs_speed else physical.damping,
        damping_ratio=None if needs_speed else zeta,
        natural_frequency=omega,
        contact_time=None if needs_speed else physical.contact_time(rule),
        release=str(rule),
        measured_restitution=None if needs_speed else physical.restitution(rule),
        slowed_speed=None if needs_speed else _slowed_speed(case),
        notes=remarks + _drop_remarks(case, given),
        question=question,
    )


def _require_short(contact_time: float) -> None:
    """Raise an error for a contact that is too long for any simulation."""
    if contact_time > _LONGEST:
        raise ModelError(
            f"a contact of {shown(contact_time, 's')} is longer than any that is simulated, up to "
            f"{_LONGEST:g} s: check the mass, the stiffness and their units"
        )


def _slowed_speed(case: PhysicalCase) -> float | None:
    """The impact speed in m/s at which gravity lowers the r of a linear contact by 1 %."""
    contact = case.contact
    if case.law is not None or contact.damping_ratio >= 1:
        return None
    omega = float(contact.frequency_ratio) * case.table.angular_frequency
    zeta = float(contact.damping_ratio)
    r = float(contact.restitution)
    return slowed_speed(omega, zeta, r, case.table.gravity, contact.release)


def _drop_remarks(case: PhysicalCase, given: Mapping[str, float]) -> tuple[str, ...]:
    """A sentence on the drop test that was given, if one was, and on its restitution."""
    if "rebound_height" not in given:
        return ()
    drop = given["drop_height"]
    height = given["rebound_height"]
    r = math.sqrt(height / drop)
    if case.law is not None:
        return (f"the drop test is read without gravity, as r = √(h′/h) = {r:.4g}, for this law",)
    arrives = shown(math.sqrt(2 * case.table.gravity * drop), "m/s")
    free = float(case.contact.restitution)
    return (
        f"dropped from {shown(drop, 'm')} onto a table at rest, at {arrives}, the ball rises to "
        f"{shown(height, 'm')}: √(h′/h) = {r:.4g}, and r = {free:.4g} without gravity",
    )


def _law_type(
    name: str | None, engine: str | None, release: str | None, given: dict[str, float]
) -> type[ContactLaw] | None:
    """The type of the contact law that is named; None for the linear contact.

    The parameters of the law follow from a free impact, so that r counts as measured.
    """
    if name is not None and engine is not None and name != LinearLaw.name:
        laws = engine_named(engine).laws
        if name not in {*laws, *laws.values()}:
            raise ParameterError(f"{{law}} {name} is not written for {engine}: leave {{law}} out")
        name = laws.get(name, name)
    if name is not None and name.casefold() in ("hertz", "hertzian"):
        raise ParameterError(
            f"{{law}} {name} has no damper: Hertz's spring with a damper is {{law}} tsuji, or give "
            "{radius} and {reduced_modulus} in place of {law}"
        )
    kind = None if name is None else law_named(name)
    if kind is None or kind is LinearLaw:
        return None
    if release is not None:
        raise ParameterError(f"{{release}} is not allowed with {{law}} {name}, which has its own")
    for other in ("stiffness", "damping", "damping_ratio", "reduced_modulus", "youngs_modulus"):
        if other in given:
            instead = "give {contact_time} and {restitution}"
            raise ParameterError(f"{{{other}}} is not allowed with {{law}} {name}: {instead}")
    if "contact_time" not in given:
        raise ParameterError(
            f"{{law}} {name} needs {{contact_time}}, the duration of a free impact"
        )
    if "restitution" in given:
        given["measured_restitution"] = given.pop("restitution")
    return kind


def _release_rule(engine: str | None, release: str | None, given: dict[str, float]) -> Release:
    """The release rule of a contact.

    With an engine, a given restitution counts as measured under the release of this engine.
    """
    if engine is None:
        return Release.of(release or Release.DISPLACEMENT)
    rule = engine_named(engine).release(release)
    if "reduced_modulus" in given or "youngs_modulus" in given:
        raise ParameterError(f"a Hertz contact is not written for {engine}: give {{stiffness}}")
    if "measured_restitution" not in given and "restitution" in given:
        given["measured_restitution"] = given.pop("restitution")
    return rule


def quantities() -> dict[str, SIParameter]:
    """The parameters of :func:`design` that have a unit, by name."""
    found = {}
    for name, hint in design.__annotations__.items():
        for each in get_args(hint)[1:]:
            if isinstance(each, SIParameter):
                found[name] = each
    return found


def _in_si(parameters: Mapping[str, Any]) -> dict[str, float]:
    """The quantities that are given, in SI units, after a check of their ranges."""
    given = {}
    for name, kind in quantities().items():
        if parameters.get(name) is not None:
            value = number(name, parameters[name], kind)
            if value not in kind.allowed:
                raise _out_of_range(name, parameters[name], value, kind)
            if kind.name == "Pa" and value < _SOFTEST and _is_bare(parameters[name]):
                raise ParameterError(
                    f"{{{name}}} = {value:g} is in Pa, and no solid is so soft: "
                    f"did you mean {value:g} GPa?"
                )
            given[name] = value
    return given


def _is_bare(value: Any) -> bool:
    """Whether a number has no unit."""
    try:
        float(value)
    except (TypeError, ValueError):
        return False
    return True


def _out_of_range(name: str, text: Any, value: float, kind: SIParameter) -> ParameterError:
    said = f"{{{name}}} = {value:g} {kind.name}".rstrip()
    # A share above 1 was probably meant in percent.
    is_share = kind.allowed.high == 1 <= value < 100 and "%" not in str(text)
    meant = f": did you mean {value:g} %?" if is_share else ""
    return ParameterError(f"{said} is not {kind.allowed}{meant}")


def _design(
    case: PhysicalCase,
    need: Needed | None,
    asked: Sequence[int],
    question: dict[str, Any],
    remarks: tuple[str, ...],
    *,
    no_orbit: str = "",
) -> Design:
    """The answer about a contact that is given or, with ``need``, was chosen for a tolerance.

    If no model has an orbit, ``no_orbit`` gives the reason, and the answer is about a ball that is
    laid on the table.
    """
    contact = case.contact
    amplitude = case.table.amplitude
    ratio = float(contact.frequency_ratio)
    only = "below 1: on a vibrating table only underdamped contacts are computed"
    require(contact.damping_ratio < 1, contact.damping_ratio, "damping ratio ζ", only)
    _require_short(case.in_si()["contact_time"])
    found = families(case, asked, bool(no_orbit))
    require(1 / _LARGEST < ratio < _LARGEST, ratio, "ϖ", f"between {1 / _LARGEST:g} and 1e8")
    # The verdict is about the first family whose orbit is stable and admissible, or else exists.
    one = max(found, key=lambda one: (one.exists, one.is_stable and one.is_admissible))
    if need is None:
        need = needed(question["quantity"], question["tolerance"], contact, one.n, amplitude)
        verdict = assessed(one, need, ratio)
        before = ""
    else:
        n = meant(asked, float(contact.restitution), amplitude)
        one = next((each for each in found if each.n == n), one)
        verdict = chosen(case.in_si(), need, n)
        before = f"{verdict.verdict} "
    motion = of_family(case, one, need.tolerance)
    # A threshold, such as that of permanent contact, is not a property of one orbit.
    if need.quantity in OF_ORBITS:
        if motion.restitution_kind is None:
            said = f"{verdict.verdict[:-1]}{aside(motion, amplitude)}."
            verdict = verdict._replace(verdict=said)
        else:
            end = judged_by_motion(motion, need.tolerance, one.n)
            verdict = end._replace(verdict=before + end.verdict, reason=no_orbit or end.reason)
    si = case.in_si()
    signature = case.instant(one.n)
    answer = Design(
        frequency_ratio=ratio,
        damping_ratio=float(contact.damping_ratio),
        amplitude=amplitude,
        stiffness=si["stiffness"],
        damping=si["damping"],
        contact_time=si["contact_time"],
        time_step=TimeStep(si["contact_time"] / STEPS, STEP_RULE),
        static_deflection=si["static_deflection"],
        restitution={
            str(rule): float(replace(contact, release=rule).restitution) for rule in Release
        },
        measured_restitution=float(contact.restitution),
        slowed_speed=_slowed_speed(case),
        permanent_contact=finite(case.permanent_contact),
        law=case.law_in_si,
        corrected=Corrected(
            delay=float(signature.delay) * case.table.time,
            restitution=float(signature.restitution),
            load=float(signature.load) * case.table.time,
        ),
        orbits=found,
        needed=need,
        motion=motion,
        headline=headline(motion, one),
        is_good_enough=verdict.is_good_enough,
        verdict=verdict.verdict,
        reason=verdict.reason,
        notes=remarks + notes(case, one, motion),
        case=case,
        n=one.n,
        question=question,
    )
    return _with_time_step_of_engine(answer) if question["engine"] else answer


def _with_time_step_of_engine(answer: Design) -> Design:
    """The answer with the time step of its engine as the only one."""
    settings = answer.engine_settings()
    rule = f"r of a free impact in {settings.name} is within {settings.error:g}"
    return replace(answer, time_step=TimeStep(settings.time_step, rule))
