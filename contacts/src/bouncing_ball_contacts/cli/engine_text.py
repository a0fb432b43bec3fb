"""How the settings for an engine are written as text, and what it does at a given time step."""

from bouncing_ball_contacts.cli.design_answer import DesignAnswer
from bouncing_ball_contacts.cli.options import option
from bouncing_ball_contacts.contact import rows
from bouncing_ball_contacts.contact.assess import Assessment
from bouncing_ball_contacts.contact.describe import Description
from bouncing_ball_contacts.contact.texts import shown
from bouncing_ball_contacts.contact.write import Looser
from bouncing_ball_contacts.engines.drop_in_steps import ReboundHeights
from bouncing_ball_contacts.engines.engine import ERROR, EngineSettings
from bouncing_ball_contacts.engines.given_step import AtStep
from bouncing_ball_contacts.engines.physical import Physical
from bouncing_ball_contacts.engines.scheme import Scheme


def line(name: str, *columns: str) -> str:
    """A name with what stands in the columns beside it."""
    return f"{name:<38}" + "".join(f"{column + ' ':<18}" for column in columns).rstrip()


def law_lines(found: Assessment | Description) -> list[str]:
    """The parameters of a contact law, with their units."""
    values = dict(found.law or {})
    name = values.pop("name", "")
    units = found.case.law.units
    # With units, ϖ is the natural frequency ϖΩ.
    words = {"frequency_ratio": "natural frequency"}
    return [
        line(
            f"{name}, {words.get(key, key.replace('_', ' '))}",
            shown(x, units[key].name),
        )
        for key, x in values.items()
    ]


def engine_lines(given: DesignAnswer) -> list[str]:
    """The settings of an engine, if one is named, and what it does at the time step given."""
    at = given.at_step
    engine = given.engine
    if engine is None:
        if at is None:
            return []
        return [*_step_lines(at), *_alternatives_at(given, at), *_looser(given.looser)]
    speed = given.found.slowed_speed
    slowed = "" if speed is None else f" of a fast impact, 1 % less at {shown(speed, 'm/s')}"
    expected = [
        ("depth at rest", given.found.case.static_deflection, "m"),
        ("orbit, greatest height", engine.max_height, "m"),
        ("orbit, duration of contact", engine.contact_duration, "s"),
        ("orbit, penetration", engine.penetration, "m"),
    ]
    met = (
        f"r = {engine.restitution:.4g}{slowed}, within {engine.error:g} in {engine.steps} steps "
        f"of {engine.scheme} in a contact"
    )
    if at is not None and not at.is_within:
        met = f"r = {at.span} at this step, {at.mean:.4g} in the mean"
    return [
        *([] if at is None else _step_lines(at)),
        "",
        f"For {engine.name}, with the {engine.release} release ({met}):",
        *_pasted(engine),
        line("time step", shown(engine.time_step, "s")),
        *_many(engine),
        *(line(words, shown(x, unit)) for words, x, unit in expected if x is not None),
        *_rise(given.dropped_at_step),
        *_alternatives(given, engine),
    ]


# More time steps in a contact than simulations have.
_MANY = 100_000


def _many(engine: EngineSettings) -> list[str]:
    if engine.steps < _MANY:
        return []
    instead = f"{option('restitution_error')} {ERROR:g} takes fewer"
    if engine.at_step is not None:
        instead = f"a longer {option('time_step')} takes fewer"
    return [f"Note: {engine.steps} steps in a contact are more than simulations have: {instead}."]


def _pasted(engine: EngineSettings) -> list[str]:
    return ["", *(f"    {line}".rstrip() for line in engine.snippet.splitlines()), ""]


def _rise(found: ReboundHeights | None) -> list[str]:
    if found is None:
        return []
    ends = [shown(height, "m") for height in (found.least, found.most)]
    return [line("the drop rises at this step to", " to ".join(dict.fromkeys(ends)))]


def _step_lines(at: AtStep) -> list[str]:
    return [
        "",
        f"At a time step of {shown(at.time_step, 's')} the given contact, of {at.steps:.4g} steps, "
        f"is {at.verdict}.",
        *(f"Note: {remark}." for remark in at.remarks),
    ]


def _retuned(at: AtStep) -> str:
    if at.retuned is None:
        return f"No damping of this stiffness has a mean r of {at.restitution:.4g} at this step."
    return (
        f"With a damping of {shown(at.retuned, at.unit_of_damping)} in place of the given one the "
        f"mean r is {at.restitution:.4g} at this step"
    )


def _alternatives_at(given: DesignAnswer, at: AtStep) -> list[str]:
    """What else a given step allows, for parameters that were given."""
    tuned = [] if at.is_within else [f"{_retuned(at).rstrip('.')}{_retuned_as(given, at)}."]
    if at.stiffest is None:
        return tuned
    damping = shown(at.stiffest_damping, at.unit_of_damping)
    case = given.found.case
    deep = ""
    if case.is_linear or at.speed is not None:
        # A linear spring carries the whole weight.
        rest = shown(case.mass * case.table.gravity / at.stiffest, "m")
        deep = f", in which the ball rests {rest} deep"
    return [
        *tuned,
        f"The stiffest contact with the same r within {at.allowed:g} has "
        f"{shown(at.stiffest, 'N/m')}, with a damping of {damping} and "
        f"a contact time of {shown(at.stiffest_contact_time, 's')} ({at.stiffest_steps:.4g} "
        f"steps){_written_as(given, at, at.stiffest, at.stiffest_damping)}{deep}.",
    ]


def _retuned_as(given: DesignAnswer, at: AtStep) -> str:
    """The parameters with the retuned damping, of the stiffness that was asked for."""
    case = given.found.case
    engine = case.given.engine
    if engine is None or at.retuned is None:
        return ""
    parameters = dict(case.given.engine_parameters)
    parameters.pop("time_step", None)
    asked = engine.read(parameters, case.mass)
    return _written_as(given, at, asked.stiffness, at.retuned)


def _written_as(given: DesignAnswer, at: AtStep, stiffness: float, damping: float | None) -> str:
    """The parameters of a contact in an engine whose steps damp it, which are less than that."""
    case = given.found.case
    engine = case.given.engine
    if engine is None or damping is None or engine.scheme is not Scheme.COMPENSATED:
        return ""
    if at.speed is not None:
        return ""
    contact = Physical(case.mass, stiffness, damping)
    values = engine.parameters(engine.for_step(contact, at.time_step))
    said = " and ".join(f"{name} = {value:.6g}" for name, value in values.items())
    return f", written as {said}"


def _looser(found: Looser | None) -> list[str]:
    """The stiffest contact for a larger error."""
    if found is None:
        return []
    damping = shown(found.damping, found.unit_of_damping)
    return [
        f"Within {found.error:g} of r it may have {shown(found.stiffness, 'N/m')}, with a damping "
        f"of {damping}: {option('restitution_error')} {found.error:g}."
    ]


def _alternatives(given: DesignAnswer, engine: EngineSettings) -> list[str]:
    """The retuned and the softer contact, if the given step does not resolve the one asked for."""
    at = engine.at_step
    other = given.softer
    if at is None or other is None or engine.softer is None:
        return [] if at is None else ["", *_alternatives_at(given, at)]
    found = ["", _retuned(at)]
    if engine.retuned is not None and engine.retuned.at_step is not None:
        found[-1] += f", and any is r = {engine.retuned.at_step.span}:"
        found += _pasted(engine.retuned)
    return [
        *found,
        *filter(None, [engine.instant]),
        f"A softer contact has this r within {at.allowed:g} at this step. Its numbers are:",
        "",
        *(line(*row) for row in rows.texts(other.contact)),
        *law_lines(other.contact),
        *([] if other.dropped is None else (line(*row) for row in rows.texts(other.dropped))),
        *_rise(other.dropped_at_step),
        *([] if other.dropped is None else (f"Note: {one}." for one in other.dropped.remarks)),
        *([other.verdict] if other.verdict else []),
        *_pasted(engine.softer),
        *_looser(given.looser),
    ]
