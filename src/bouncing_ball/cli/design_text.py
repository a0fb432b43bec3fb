"""The answer of ``bouncing-ball design`` about a contact, and how it is written as text."""

from collections.abc import Mapping
from typing import Any, NamedTuple

from bouncing_ball.accuracy.errors import OF_IMPACTS, OF_ORBITS, QUANTITIES, Quantity
from bouncing_ball.accuracy.thresholds import ThresholdStatus
from bouncing_ball.cli.options import option
from bouncing_ball.contacts import rows
from bouncing_ball.contacts.assess import Assessment
from bouncing_ball.contacts.contact import Contact
from bouncing_ball.contacts.describe import Description
from bouncing_ball.contacts.drops import Dropped, drop_at_rest
from bouncing_ball.contacts.engines.drop_in_steps import Rise
from bouncing_ball.contacts.engines.engine import ERROR, EngineSettings
from bouncing_ball.contacts.engines.given_step import AtStep
from bouncing_ball.contacts.families import ComparedOrbit, ErrorsByQuantity, Needed
from bouncing_ball.contacts.quantities import quantities
from bouncing_ball.contacts.question import EngineSetup, Question
from bouncing_ball.contacts.table import Table
from bouncing_ball.contacts.texts import percent, shown, signed
from bouncing_ball.contacts.write import Looser, Softer

_SIMPLE = "error law", "corrected"
# The row that has a range if parameters contain a time step.
_FREE = "restitution of a free impact"
# The row that an engine's time step takes the place of.
_STEP = "largest time step"
# More digits than a user types.
_TYPED = 12
# What has a default, and is said in the answer.
_NOT_ECHOED = {"quantity", "tolerance", "restitution_error"}
KINDS = (
    quantities(Contact)
    | quantities(Table)
    | quantities(Question)
    | quantities(EngineSetup)
    | quantities(drop_at_rest)
)
"""The options with a unit."""


class DesignAnswer(NamedTuple):
    """The contact with all that was asked about it, and the options with quantities in SI units.

    ``found`` is the assessment of a contact on a table, or the description of one without a table.
    ``dropped``, ``engine`` and ``at_step`` are None if nothing was asked about them, and so are the
    rises of a drop at the engine's time step, and the softer contact that this step resolves if it
    does not resolve the one asked for, also for a larger error. ``doubts`` are sentences on numbers
    that may have been meant in another unit. ``hint`` is what may have been meant if no model has
    an orbit, and ``whole`` tells whether all numbers of
    each family are printed.
    """

    found: Assessment | Description
    dropped: Dropped | None
    engine: EngineSettings | None
    at_step: AtStep | None
    question: dict[str, Any]
    hint: str = ""
    whole: bool = True
    dropped_at_step: Rise | None = None
    softer: Softer | None = None
    looser: Looser | None = None
    doubts: tuple[str, ...] = ()


def both(reason: str, hint: str) -> str:
    """A reason with a hint, which may be empty."""
    return "; ".join(filter(None, [reason, hint]))


def reason(found: Assessment, hint: str) -> str:
    """The reason of the verdict, and what may have been meant if no model has an orbit."""
    exists = any(each.exists for each in found.judged.standing.values())
    return found.reason if exists else both(found.reason, hint)


def numbers(given: DesignAnswer) -> list[tuple[str, str]]:
    """The numbers of the contact and of a drop, by name."""
    dropped = [] if given.dropped is None else rows.texts(given.dropped)
    found = rows.texts(given.found)
    at = given.at_step
    if at is not None and at.is_of_parameters and not at.is_within:
        found = [(name, f"{at.span} at this step" if name == _FREE else x) for name, x in found]
    return found + dropped


def _line(name: str, *columns: str) -> str:
    return f"{name:<38}" + "".join(f"{column + ' ':<18}" for column in columns).rstrip()


def _error(one: ComparedOrbit, quantity: Quantity) -> str:
    """The errors of a quantity in all models, or which of them has no orbit."""
    found = []
    for model, errors in (
        ("restitution", one.errors),
        ("error law", one.law_errors),
        ("corrected", one.corrected_errors),
    ):
        missing = _without(one, quantity, model)
        if errors[quantity] is None and missing:
            found.append("no contact orbit" if missing == "contact" else "no orbit")
        else:
            found.append(signed(errors[quantity]))
    return _line(f"    {QUANTITIES[quantity]}", *found)


def _without(one: ComparedOrbit, quantity: str, model: str) -> str:
    """The first of contact and model that lacks the orbit of a quantity; empty if both have it."""
    if model == "error law":
        # The law starts from an orbit of the restitution model, for the limits of orbits as well.
        return "" if one.standing["restitution"].exists else "restitution"
    if quantity not in OF_ORBITS:
        return ""
    if not one.exists:
        return "contact"
    return "" if one.standing[model].exists else model


def _off(one: ComparedOrbit, need: Needed, model: str, errors: ErrorsByQuantity) -> str:
    """The error of the judged quantity, or the reason why there is none."""
    error = errors[need.quantity]
    missing = _without(one, need.quantity, model)
    if error is None and missing:
        return f"no orbit ({missing})"
    return signed(error, need.tolerance)


def _family_lines(one: ComparedOrbit) -> list[str]:
    lines = ["", f"{one.n}-T orbit", _line("", *one.standing)]
    for columns in zip(*map(rows.texts, one.standing.values()), strict=True):
        lines.append(_line(f"  {columns[0][0]}", *(text for _, text in columns)))
    if one.exists:
        lines += [_line(f"  {name}", text) for name, text in rows.texts(one)]
    holds = "error law" if one.law_holds else "law, out of range"
    lines.append(_line("  relative error", "restitution", holds, "corrected"))
    return lines + [_error(one, quantity) for quantity in OF_IMPACTS]


def _engine_lines(given: DesignAnswer) -> list[str]:
    """The settings of an engine, if one is named, and what it does at the time step given."""
    at = given.at_step
    engine = given.engine
    if engine is None:
        if at is None:
            return []
        return [*_step_lines(at), *_alternatives_at(at), *_looser(given.looser)]
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
        _line("time step", shown(engine.time_step, "s")),
        *_many(engine),
        *(_line(words, shown(x, unit)) for words, x, unit in expected if x is not None),
        *_rise(given.dropped_at_step),
        *_alternatives(engine, given.softer, given.looser),
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


def _rise(found: Rise | None) -> list[str]:
    if found is None:
        return []
    ends = [shown(height, "m") for height in (found.least, found.most)]
    return [_line("the drop rises at this step to", " to ".join(dict.fromkeys(ends)))]


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


def _alternatives_at(at: AtStep) -> list[str]:
    """What else a given step allows, for parameters that were given."""
    tuned = [] if at.is_within else [_retuned(at).rstrip(".") + "."]
    if at.stiffest is None:
        return tuned
    return [
        *tuned,
        f"The stiffest contact with the same r within {at.allowed:g} has "
        f"{shown(at.stiffest, 'N/m')}, with a damping of {shown(at.stiffest_damping, 'N s/m')} and "
        f"a contact time of {shown(at.stiffest_contact_time, 's')} ({at.stiffest_steps:.4g} "
        "steps).",
    ]


def _looser(found: Looser | None) -> list[str]:
    """The stiffest contact for a larger error."""
    if found is None:
        return []
    return [
        f"Within {found.error:g} of r it may have {shown(found.stiffness, 'N/m')}, with a damping "
        f"of {shown(found.damping, 'N s/m')}: {option('restitution_error')} {found.error:g}."
    ]


def _alternatives(engine: EngineSettings, other: Softer | None, wider: Looser | None) -> list[str]:
    """The retuned and the softer contact, if the given step does not resolve the one asked for."""
    at = engine.at_step
    if at is None or other is None or engine.softer is None:
        return [] if at is None else ["", *_alternatives_at(at)]
    found = ["", _retuned(at)]
    if engine.retuned is not None and engine.retuned.at_step is not None:
        found[-1] += f", and any is r = {engine.retuned.at_step.span}:"
        found += _pasted(engine.retuned)
    return [
        *found,
        *filter(None, [engine.instant]),
        f"A softer contact has this r within {at.allowed:g} at this step. Its numbers are:",
        "",
        *(_line(*row) for row in rows.texts(other.contact)),
        *([] if other.dropped is None else (_line(*row) for row in rows.texts(other.dropped))),
        *_rise(other.dropped_at_step),
        *([] if other.dropped is None else (f"Note: {one}." for one in other.dropped.remarks)),
        *([other.verdict] if other.verdict else []),
        *_pasted(engine.softer),
        *_looser(wider),
    ]


def _short(found: Assessment) -> list[str]:
    """One line for each family, and a line on the options that print the other results."""
    need = found.needed
    error = f"{QUANTITIES[Quantity(need.quantity)]} off by"
    head = (
        f"{'orbit':<9}{'stable':<9}{'greatest height':<18}{'peak force':<13}{error:<40}corrected by"
    )
    about = f"{option('n')} {found.n} prints all results for one, {option('all_families')} for all"
    return ["", head, *(_one_line(one, need) for one in found.orbits), f"({about}.)"]


def _one_line(one: ComparedOrbit, need: Needed) -> str:
    of_contact = {row.key: row.text for row in rows.rows(one) if row.words}
    height, force = (
        of_contact[name,] if one.exists else "no orbit" for name in ("max_height", "peak_force")
    )
    return (
        f"{f'{one.n}-T':<9}{('no', 'yes')[one.is_stable]:<9}{height:<18}{force:<13}"
        f"{_off(one, need, 'restitution', one.errors):<40}"
        f"{_off(one, need, 'corrected', one.corrected_errors)}"
    )


def _whole(found: Assessment) -> list[str]:
    """All results for each family."""
    return [
        *(line for one in found.orbits for line in _family_lines(one)),
        "",
        # The error of the permanent contact is the same in all families.
        _line("relative error", "restitution", *_SIMPLE),
        _error(found.orbits[0], Quantity.PERMANENT_CONTACT),
    ]


def _at_small_steps(at: AtStep | None) -> list[str]:
    """What the verdict on a table is about, if the engine's time step changes the contact."""
    if at is None or at.is_within:
        return []
    what = "whose positions these steps have" if at.is_of_parameters else "with small time steps"
    if at.speed is not None:
        what = "with small time steps"
    about = f"the contact {what}, and at {shown(at.time_step, 's')} its r is {at.span}"
    return [f"Note: motion, verdict and orbits are those of {about}."]


def _drop_remarks(given: DesignAnswer) -> list[str]:
    return [] if given.dropped is None else [f"Note: {one}." for one in given.dropped.remarks]


def _law_lines(found: Assessment | Description) -> list[str]:
    """The parameters of a contact law, with their units."""
    law = found.case.law
    values = dict(found.law or {})
    name = values.pop("name", "")
    units = {} if law is None else law.units
    # With units, ϖ is the natural frequency ϖΩ.
    words = {"frequency_ratio": "natural frequency"}
    return [
        _line(
            f"{name}, {words.get(key, key.replace('_', ' '))}",
            shown(x, units[key].name),
        )
        for key, x in values.items()
    ]


def _echo(question: Mapping[str, Any]) -> str:
    """The parameters that were given, with their units."""
    said = []
    for name, value in question.items():
        if value is None or name in _NOT_ECHOED:
            continue
        words = name.replace("_", " ")
        if name not in KINDS:
            said.append(f"{words} {_plain(value)}")
        elif name == "mass":
            said.append(f"{words} {shown(1000 * value, 'g', digits=_TYPED)}")
        else:
            unit = KINDS[name].name.replace("*", " ")
            said.append(f"{words} {shown(value, unit, digits=_TYPED)}")
    return f"Given: {', '.join(said)}."


def _plain(value: Any) -> str:
    """A name, a number, or the parameters of an engine."""
    if isinstance(value, dict):
        return " ".join(f"{name}={number:g}" for name, number in value.items())
    return str(value)


def _ratio(value: float | None, status: str) -> str:
    """The ϖ that is needed, or the reason why there is none: the model may have no orbit."""
    return status if value is None else shown(value)


def lines(given: DesignAnswer) -> list[str]:
    """The answer as text, with the verdict first."""
    if isinstance(given.found, Description):
        return _description(given, given.found)
    return _assessment(given, given.found)


def _description(given: DesignAnswer, found: Description) -> list[str]:
    """The contact without a table."""
    return [
        _echo(given.question),
        *(f"Note: {doubt}." for doubt in given.doubts),
        *(_line(*row) for row in numbers(given)),
        _line("release", found.release),
        *_law_lines(found),
        *(f"Note: {note}." for note in found.notes),
        *_drop_remarks(given),
        *_of_parameters(given.at_step),
        *_engine_lines(given),
    ]


def _of_parameters(at: AtStep | None) -> list[str]:
    """What k, c and a drop are about, if the parameters contain a time step."""
    if at is None or not at.is_of_parameters or at.is_within:
        return []
    of = "of the contact whose positions these steps have"
    if at.speed is not None:
        of = "of small time steps"
    return [
        f"Note: all numbers but r are those {of}; r "
        "depends on where in a step the ball meets the table."
    ]


def _assessment(given: DesignAnswer, found: Assessment) -> list[str]:
    """The contact on a table, with the verdict first."""
    need = found.needed
    always = ThresholdStatus.ALWAYS_WITHIN
    asked = f"ϖ for {percent(need.tolerance)} in the {QUANTITIES[Quantity(need.quantity)]}"
    exact, corrected = (
        "any" if status == always else _ratio(value, status)
        for value, status in (
            (need.frequency_ratio, need.status),
            (need.corrected, need.corrected_status),
        )
    )
    by_law = _ratio(need.by_law, need.status)
    by_engine = given.engine is not None
    return [
        found.headline,
        found.verdict,
        f"Reason: {reason(found, given.hint)}.",
        _echo(given.question),
        found.ends.sentence,
        *(f"Note: {doubt}." for doubt in given.doubts),
        *(f"Note: {note}." for note in found.notes),
        *_drop_remarks(given),
        *_at_small_steps(given.at_step),
        *_engine_lines(given),
        "",
        *(_line(*row) for row in numbers(given) if not by_engine or row[0] != _STEP),
        *([] if by_engine else [f"Time step: {found.time_step.rule}."]),
        *_law_lines(found),
        "",
        _line(asked, "exact", *_SIMPLE),
        _line("", exact, by_law, corrected),
        *(_whole(found) if given.whole else _short(found)),
    ]
