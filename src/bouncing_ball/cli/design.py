"""``bouncing-ball design``: a contact is assessed or chosen, and written for an engine.

A contact without a table is described. The answer is printed as text or as JSON.
"""

from collections.abc import Mapping
from dataclasses import fields, replace
from pathlib import Path
from typing import Any, NamedTuple

from bouncing_ball.accuracy.errors import OF_IMPACTS, OF_ORBITS, QUANTITIES, Quantity
from bouncing_ball.accuracy.thresholds import ThresholdStatus
from bouncing_ball.cli.options import Parser, add_file, add_optional, option
from bouncing_ball.contacts import rows
from bouncing_ball.contacts.assess import Assessment, TimeStep, assess
from bouncing_ball.contacts.choose import choose
from bouncing_ball.contacts.contact import Contact
from bouncing_ball.contacts.describe import Description, Dropped, describe, drop
from bouncing_ball.contacts.engines.engine import ERROR, EngineSettings
from bouncing_ball.contacts.engines.given_step import AtStep
from bouncing_ball.contacts.families import ComparedOrbit, Errors, Needed
from bouncing_ball.contacts.quantities import quantities
from bouncing_ball.contacts.question import EngineSetup, Question
from bouncing_ball.contacts.resolve import resolve
from bouncing_ball.contacts.table import Table, TableMotion
from bouncing_ball.contacts.texts import percent, shown, signed
from bouncing_ball.contacts.units import in_si
from bouncing_ball.contacts.write import (
    at_given_step,
    resolve_for,
    settings,
    settings_on_table,
)
from bouncing_ball.datasets.files import PICTURES, require_writable
from bouncing_ball.errors import NoOrbitError, ParameterError, extra

_SIMPLE = "error law", "corrected"
# The row that an engine's time step takes the place of.
_STEP = "largest time step"
# More digits than a user types.
_TYPED = 12
# What has a default, and is said in the answer.
_NOT_ECHOED = {"quantity", "tolerance", "restitution_error"}
# Parameters of which each implies that there is a table.
_OF_TABLE = ("frequency", "angular_frequency", "period", "table_amplitude", "acceleration")
_KINDS = (
    quantities(Contact)
    | quantities(Table)
    | quantities(Question)
    | quantities(EngineSetup)
    | quantities(drop)
)
_OF_STIFFNESS_AND_LOSS = tuple(name for name in quantities(Contact) if name != "mass")
# The options in their order, in which the answer repeats them.
_OPTIONS = (
    (Contact, ("mass",)),
    (Table, (*_OF_TABLE, "gravity")),
    (Contact, _OF_STIFFNESS_AND_LOSS),
    (drop, ("speed",)),
    (Question, ("n",)),
    (Contact, ("release", "law")),
    (Question, ("quantity", "tolerance", "balls")),
    (EngineSetup, ("engine", "restitution_error", "time_step")),
    (Contact, ("from_engine", "solref", "solimp", "parameters")),
)


class Answer(NamedTuple):
    """The contact with all that was asked about it, and the options with quantities in SI units.

    ``found`` is the assessment of a contact on a table, or the description of one without a table.
    ``dropped``, ``engine`` and ``at_step`` are None if nothing was asked about them. ``hint`` is
    what may have been meant if no model has an orbit, and ``whole`` tells whether all numbers of
    each family are printed.
    """

    found: Assessment | Description
    dropped: Dropped | None
    engine: EngineSettings | None
    at_step: AtStep | None
    question: dict[str, Any]
    hint: str = ""
    whole: bool = True


def add_options(parser: Parser) -> None:
    """Add the options of :func:`design`."""
    add_file(parser, "plot", "File for one page to print: .pdf, .png or .svg.")
    each = "By default each family has one line, unless n is given."
    parser.add_argument(
        option("all_families"),
        dest="all_families",
        action="store_true",
        help=f"Print all results for every family. {each}",
    )
    for kind, names in _OPTIONS:
        add_optional(parser, kind, names)


def design(*, plot: Path | None, all_families: bool, **given: Any) -> Answer:
    """The answer about a contact; with ``plot`` the page to print is written as well.

    Raises
    ------
    ModelError
        If the page has another name or cannot be written, or if a parameter is missing, out of
        range or contradicts another.
    NoOrbitError
        If no model has the orbit.
    """
    require_writable(plot, PICTURES)
    found = answer(given)
    if plot is not None:
        _draw(found, plot)
    return found._replace(whole=all_families or given.get("n") is not None)


def answer(given: Mapping[str, Any]) -> Answer:
    """The answer for options by name; an option that is missing or None is not given.

    Raises
    ------
    ModelError, NoOrbitError
        See :func:`design`.
    """
    contact = Contact(**_of(Contact, given))
    question = Question(**_of(Question, given))
    # These are needed without a table or an engine, too.
    si = {
        name: in_si(name, given[name], _KINDS[name])
        for name in ("gravity", "speed", "restitution_error", "time_step")
        if given.get(name) is not None
    }
    read = {**given, **si}
    setup = None if given.get("engine") is None else EngineSetup(**_of(EngineSetup, read))
    has_table = any(given.get(name) is not None for name in ("n", *_OF_TABLE))
    has_stiffness = contact.from_engine or contact.stiffness or contact.contact_time
    if has_table or not (setup or has_stiffness):
        table = Table(**_of(Table, read))
        read |= _quantities_of(table)
        # An acceleration in m/s², with or without its unit, may have been meant in g.
        hint = "" if "gravity" in si else _meant_in_g(given.get("acceleration"), table)
        found, engine = _on_table(contact, table, question, setup, hint)
    else:
        hint = ""
        found, engine = _at_rest(contact, TableMotion.at_rest(si.get("gravity")), setup)
    dropped = drop(found.case, si["speed"]) if "speed" in si else None
    at_step = None if engine is None else engine.at_step
    if "time_step" in si and engine is None:
        at_step = at_given_step(contact, si["time_step"], si.get("restitution_error", ERROR))
    read |= _quantities_of(contact) | _quantities_of(question)
    return Answer(found, dropped, engine, at_step, read, hint)


def _of(kind: Any, given: Mapping[str, Any]) -> dict[str, Any]:
    """The options that are fields of a class."""
    return {each.name: given[each.name] for each in fields(kind) if each.name in given}


def _quantities_of(data: Any) -> dict[str, Any]:
    """The quantities of a dataclass in SI units, by name."""
    return {name: getattr(data, name) for name in quantities(type(data))}


def _on_table(
    contact: Contact,
    table: Table,
    question: Question,
    setup: EngineSetup | None,
    hint: str,
) -> tuple[Assessment, EngineSettings | None]:
    """The contact that is given, or the one that is chosen, and what to write into an engine."""
    written = None if setup is None else setup.engine
    try:
        if contact.is_stiff:
            case = resolve(contact, table.motion, question.families, written)
            found = assess(case, question)
        else:
            choice = choose(contact, table.motion, question, written)
            found = assess(choice.case, question, choice)
    except NoOrbitError as error:
        raise NoOrbitError(_both(str(error), hint)) from None
    if setup is None:
        return found, None
    engine = settings_on_table(found, setup)
    # The time step of the engine is the only one.
    rule = f"r of a free impact in {engine.name} is within {engine.error:g}"
    return replace(found, time_step=TimeStep(engine.time_step, rule)), engine


def _at_rest(
    contact: Contact, table: TableMotion, setup: EngineSetup | None
) -> tuple[Description, EngineSettings | None]:
    """The contact without a table, and what to write into an engine."""
    if setup is None:
        return describe(resolve(contact, table)), None
    found = describe(resolve_for(contact, setup, table))
    return found, settings(found.case, setup)


def _meant_in_g(acceleration: Any, table: Table) -> str:
    if acceleration is None or str(acceleration).strip().endswith("g"):
        return ""
    return f"perhaps {table.acceleration:g} g was meant"


def _both(reason: str, hint: str) -> str:
    return "; ".join(filter(None, [reason, hint]))


def _reason(found: Assessment, hint: str) -> str:
    """The reason of the verdict, and what may have been meant if no model has an orbit."""
    exists = any(each.exists for each in found.judged.standing.values())
    return found.reason if exists else _both(found.reason, hint)


def _draw(given: Answer, path: Path) -> None:
    found = given.found
    if isinstance(found, Description):
        raise ParameterError("{plot} needs a table, such as {frequency} and {acceleration}")
    if not any(each.exists for each in found.judged.standing.values()):
        why = _reason(found, given.hint)
        raise NoOrbitError(f"without an orbit there is no page to print: {why}")
    from bouncing_ball.contacts.page_data import page

    with extra("plot"):
        from bouncing_ball.contacts.page_figures import draw
        from bouncing_ball.drawing.files import write
        from bouncing_ball.drawing.style import style
    with style():
        numbers = _numbers(given) + rows.texts(found.judged)
        figure = draw(rows.document(found), page(found), numbers)
        write(figure, path, "bouncing-ball design")


def _numbers(given: Answer) -> list[tuple[str, str]]:
    """The numbers of the contact and of a drop, by name."""
    dropped = [] if given.dropped is None else rows.texts(given.dropped)
    return rows.texts(given.found) + dropped


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


def _off(one: ComparedOrbit, need: Needed, model: str, errors: Errors) -> str:
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


def document(given: Answer) -> dict[str, Any]:
    """The answer as plain values for JSON, with the options."""
    found = rows.document(given.found)
    if isinstance(given.found, Assessment):
        found["reason"] = _reason(given.found, given.hint)
    # What was not asked for has no key.
    for name in ("dropped", "engine", "at_step"):
        more = getattr(given, name)
        if more is not None:
            found[name] = rows.document(more)
    return found | {"question": given.question}


def _engine_lines(given: Answer) -> list[str]:
    """The settings of an engine, if one is named, and what it does at the time step given."""
    at = [] if given.at_step is None else _step_lines(given.at_step)
    engine = given.engine
    if engine is None:
        return at
    speed = given.found.slowed_speed
    slowed = "" if speed is None else f" of a fast impact, 1 % less at {shown(speed, 'm/s')}"
    expected = [
        ("greatest height", engine.max_height, "m"),
        ("duration of contact", engine.contact_duration, "s"),
        ("penetration", engine.penetration, "m"),
    ]
    return [
        *at,
        "",
        f"For {engine.name}, with the {engine.release} release "
        f"(r = {engine.restitution:.4g}{slowed}, within {engine.error:g} in {engine.steps} steps "
        f"of {engine.scheme} in a contact):",
        "",
        *(f"    {line}".rstrip() for line in engine.snippet.splitlines()),
        "",
        _line("time step", shown(engine.time_step, "s")),
        *(_line(f"orbit, {words}", shown(x, unit)) for words, x, unit in expected if x is not None),
    ]


def _step_lines(at: AtStep) -> list[str]:
    allowed = f"the same r within {at.allowed:g}"
    return [
        "",
        f"At a time step of {shown(at.time_step, 's')} the given contact, of {at.steps:.4g} steps, "
        f"is {at.verdict}.",
        f"The stiffest contact with {allowed} has {shown(at.stiffest, 'N/m')}, with a damping of "
        f"{shown(at.stiffest_damping, 'N s/m')} and a contact time of "
        f"{shown(at.stiffest_contact_time, 's')} ({at.stiffest_steps:.4g} steps).",
        *(f"Note: {remark}." for remark in at.remarks),
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


def _law_lines(found: Assessment) -> list[str]:
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
            shown(x, units[key].name if key in units else ""),
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
        if name not in _KINDS:
            said.append(f"{words} {_plain(value)}")
        elif name == "mass":
            said.append(f"{words} {shown(1000 * value, 'g', digits=_TYPED)}")
        else:
            unit = _KINDS[name].name.replace("*", " ")
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


def lines(given: Answer) -> list[str]:
    """The answer as text, with the verdict first."""
    if isinstance(given.found, Description):
        return _description(given, given.found)
    return _assessment(given, given.found)


def _description(given: Answer, found: Description) -> list[str]:
    """The contact without a table."""
    return [
        _echo(given.question),
        *(_line(*row) for row in _numbers(given)),
        _line("release", found.release),
        *(f"Note: {note}." for note in found.notes),
        *_engine_lines(given),
    ]


def _assessment(given: Answer, found: Assessment) -> list[str]:
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
        f"Reason: {_reason(found, given.hint)}.",
        _echo(given.question),
        *(f"Note: {note}." for note in found.notes),
        *_engine_lines(given),
        "",
        *(_line(*row) for row in _numbers(given) if not by_engine or row[0] != _STEP),
        *([] if by_engine else [f"Time step: {found.time_step.rule}."]),
        *_law_lines(found),
        "",
        _line(asked, "exact", *_SIMPLE),
        _line("", exact, by_law, corrected),
        *(_whole(found) if given.whole else _short(found)),
    ]
