"""How the settings for an engine are written as text, and what it does at a given time step."""

from bouncing_ball_contacts.cli.design_answer import DesignAnswer
from bouncing_ball_contacts.cli.options import option
from bouncing_ball_contacts.contact.assess import Assessment
from bouncing_ball_contacts.contact.describe import Description
from bouncing_ball_contacts.contact.drops import Dropped
from bouncing_ball_contacts.contact.hertz import rayleigh_time
from bouncing_ball_contacts.contact.texts import shown
from bouncing_ball_contacts.engines.choice import engine_named
from bouncing_ball_contacts.engines.drop_in_steps import DropInSteps, Range
from bouncing_ball_contacts.engines.engine import ERROR, EngineSettings, Written, without_step
from bouncing_ball_contacts.engines.given_step import AtStep


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
    """What is written into an engine, if one is named, and what it does; or what parameters of an
    engine do at a time step.
    """
    at = given.at_step
    engine = given.engine
    if engine is None:
        why = [f"Note: {text}." for text in given.diagnosis]
        if at is None:
            return why
        alternatives = [] if why else _alternatives(given, at)
        return [*_step_lines(at), *drop_lines(given.dropped_at_step), *why, *alternatives]
    expected = [
        ("orbit, greatest height", engine.max_height, "m"),
        ("orbit, duration of contact", engine.contact_duration, "s"),
        ("orbit, penetration", engine.penetration, "m"),
    ]
    return [
        f"For {engine.name}, at a time step of {shown(engine.time_step, 's')}:",
        *_pasted(engine),
        *drop_lines(engine.drop, engine.wanted),
        *([] if engine.drop is not None else _without_steps(given.dropped)),
        *_errors(engine),
        *_gravity(engine),
        *_changed(engine),
        *_instant(engine),
        *_rayleigh(given, engine),
        *_never_run(engine),
        *_many(engine),
        *(line(words, shown(x, unit)) for words, x, unit in expected if x is not None),
    ]


def _ends(ends: Range, unit: str) -> str:
    """A range in words; one number if its ends are alike in three digits."""
    least, most = (shown(float(f"{end:.3g}"), unit) for end in ends)
    if least == most:
        return most
    number, _, of = least.partition(" ")
    return f"{number if most.endswith(f' {of}') else least} to {most}"


def drop_lines(drop: DropInSteps | None, asked: float | None = None) -> list[str]:
    """What a ball does that is dropped in an engine, and lies at rest."""
    if drop is None:
        return []
    rises = f"it rises {_ends(drop.rise, 'm')}" if drop.rise.most > 0 else "it does not rebound"
    ideal = ""
    if asked is not None:
        ideal = f"; {shown(asked**2 * drop.height, 'm', digits=3)} is r = {asked:.4g}"
    lies = ", and does not come to rest"
    if drop.depth_at_rest is not None:
        lies = f", and lies {shown(drop.depth_at_rest, 'm')} deep at rest"
    return [
        f"Dropped from {shown(drop.height, 'm', digits=3)} {rises}{ideal}.",
        f"It sinks in {_ends(drop.compression, 'm')}, under {_ends(drop.peak_force, 'N')}{lies}.",
    ]


def _without_steps(drop: Dropped | None) -> list[str]:
    """A drop onto a contact of which steps are not known, or too many."""
    if drop is None:
        return []
    return [
        f"With small steps, dropped from {shown(drop.drop_height, 'm', digits=3)} it rises "
        f"{shown(drop.rebound_height, 'm', digits=3)}, sinks in "
        f"{shown(drop.greatest_compression, 'm', digits=3)}, under "
        f"{shown(drop.peak_force, 'N', digits=3)}."
    ]


def _errors(engine: EngineSettings) -> list[str]:
    """The error of the drop, and that of a free impact."""
    if engine.drop is None:
        return [_free(engine)]
    found = f"√(h′/h) is within {engine.drop.error:.2g} of r"
    return [f"{found}; {_free(engine)}"]


def _free(engine: EngineSettings) -> str:
    at = engine.at_step
    if at is None:
        return (
            f"r = {engine.restitution:.4g} without gravity is met within {engine.error:g}, in "
            f"{engine.steps} steps of {engine.scheme} in a contact."
        )
    speed = "" if at.speed is None else f" at {at.speed:.4g} m/s"
    return f"without gravity r is {at.span}{speed}, in {at.steps:.3g} steps in a contact."


def _gravity(engine: EngineSettings) -> list[str]:
    """A note on what gravity takes, if it is more than the error that is allowed."""
    taken = engine.taken_by_gravity
    if taken <= engine.error:
        return []
    instead = "a stiffer contact loses less"
    if engine.at_step is not None and not engine.at_step.is_within:
        instead = "a shorter step allows a stiffer contact"
    return [
        f"Note: gravity takes {taken:.2g} of r in this drop, and more in slower impacts; {instead}."
    ]


def _changed(engine: EngineSettings) -> list[str]:
    """What of the contact asked for is not written, and why."""
    at = engine.asked
    if at is None:
        return []
    what = f"{engine.changed} were" if " and " in engine.changed else f"{engine.changed} was"
    now = ""
    if at.speed is None:
        _, k, c = engine.contact
        now = f", to {shown(k, 'N/m')} and {shown(c, 'N s/m')}"
    return [
        f"Note: the {what} changed{now}, because the given contact, of {at.steps:.4g} steps, is "
        f"{at.verdict}.",
        *(f"Note: {remark}." for remark in at.remarks),
    ]


def _instant(engine: EngineSettings) -> list[str]:
    """The number r of an engine, if it comes closer than a contact."""
    drop = engine.instant_drop
    if drop is None:
        return []
    return [
        f"Better: {engine.instant}. It rises {_ends(drop.rise, 'm')}, within {drop.error:.2g} of r."
    ]


def _never_run(engine: EngineSettings) -> list[str]:
    if engine_named(engine.name).was_run:
        return []
    return [f"Note: this text was never run, because no wheel of {engine.name} was found."]


def _rayleigh(given: DesignAnswer, engine: EngineSettings) -> list[str]:
    """The time step beside the other measure of it, which codes for granular matter have."""
    time = rayleigh_time(given.found.case.given)
    if time is None:
        return []
    share = shown(engine.time_step / time, "%")
    return [f"The step is {share} of the Rayleigh time of the ball, {shown(time, 's')}."]


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


def _step_lines(at: AtStep) -> list[str]:
    return [
        "",
        f"At a time step of {shown(at.time_step, 's')} the given contact, of {at.steps:.4g} steps, "
        f"is {at.verdict}.",
        *(f"Note: {remark}." for remark in at.remarks),
    ]


def _alternatives(given: DesignAnswer, at: AtStep) -> list[str]:
    """What else a step allows, for parameters that were given."""
    if at.is_within:
        return []
    if at.retuned is None:
        tuned = f"No damping of this stiffness has a mean r of {at.restitution:.4g} at this step."
    else:
        tuned = (
            f"With a damping of {shown(at.retuned, at.unit_of_damping)} in place of the given one "
            f"the mean r is {at.restitution:.4g} at this step{_retuned_as(given, at)}."
        )
    suited = (
        f"{option('engine')} {at.engine} {option('mass')} {given.found.mass:g} "
        f"{option('restitution')} {at.restitution:.4g} {option('time_step')} {at.time_step:g}"
    )
    return [tuned] if at.speed is not None else [tuned, f"What suits this step: {suited}."]


def _retuned_as(given: DesignAnswer, at: AtStep) -> str:
    """The parameters with the retuned damping, of an engine whose steps damp."""
    case = given.found.case
    engine = case.given.engine
    if engine is None or at.retuned is None or not engine.scheme.is_compensated:
        return ""
    if at.speed is not None:
        return ""
    written = Written(
        engine,
        engine.read(without_step(case.given.engine_parameters), case.mass),
        case.equivalent.release,
    )
    values = written.with_damping(at.retuned).parameters(at.time_step)
    said = " and ".join(f"{name} = {value:.6g}" for name, value in values.items())
    return f", written as {said}"
