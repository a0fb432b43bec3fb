"""``bouncing-ball design``: the calculator's answer, as JSON or as text."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any, NamedTuple

from bouncing_ball.accuracy.errors import OF_IMPACTS, OF_ORBITS, QUANTITIES, Quantity
from bouncing_ball.accuracy.thresholds import ThresholdStatus
from bouncing_ball.cli.options import Parser, add_file, add_parameters, option
from bouncing_ball.contacts import design as calculator
from bouncing_ball.contacts import rows
from bouncing_ball.contacts.engines.given_step import AtStep
from bouncing_ball.contacts.given import quantities
from bouncing_ball.contacts.results import Design, Errors, Family, LoneContact, Needed
from bouncing_ball.contacts.units import percent, shown, signed
from bouncing_ball.datasets.files import PICTURES, require_writable
from bouncing_ball.errors import NoOrbitError, ParameterError, extra

_SIMPLE = "error law", "corrected"
# The row that an engine's time step takes the place of.
_STEP = "largest time step"
# More digits than a user types.
_TYPED = 12
# What has a default, and is said in the answer.
_NOT_ECHOED = {"quantity", "tolerance", "restitution_error"}


class Answer(NamedTuple):
    """The result of the calculator, the arguments of the call with quantities in SI units, and
    whether all numbers of each family are printed.
    """

    found: Design | LoneContact
    question: dict[str, Any]
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
    add_parameters(parser, calculator.design)


def design(*, plot: Path | None, all_families: bool, **given: Any) -> Answer:
    """The calculator's answer; with ``plot`` the page to print is written as well.

    Raises
    ------
    ModelError
        If the page has another name or cannot be written.
    """
    require_writable(plot, PICTURES)
    found = calculator.design(**given)
    if plot is not None:
        if isinstance(found, LoneContact):
            raise ParameterError("{plot} needs a table, such as {frequency} and {acceleration}")
        _draw(found, plot)
    whole = all_families or given.get("n") is not None
    return Answer(found, given | calculator.in_si(given), whole)


def _draw(found: Design, path: Path) -> None:
    if not any(each.exists for each in found.judged.standing.values()):
        raise NoOrbitError(f"without an orbit there is no page to print: {found.reason}")
    from bouncing_ball.contacts.page_data import page

    with extra("plot"):
        from bouncing_ball.contacts.page_figures import draw
        from bouncing_ball.drawing.files import write
        from bouncing_ball.drawing.style import style
    with style():
        numbers = rows.texts(found) + rows.texts(found.judged)
        figure = draw(rows.document(found), page(found), numbers)
        write(figure, path, "bouncing-ball design")


def _line(name: str, *columns: str) -> str:
    return f"{name:<38}" + "".join(f"{column + ' ':<18}" for column in columns).rstrip()


def _error(one: Family, quantity: Quantity) -> str:
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


def _without(one: Family, quantity: str, model: str) -> str:
    """The first of contact and model that lacks the orbit of a quantity; empty if both have it."""
    if model == "error law":
        # The law starts from an orbit of the restitution model, for the limits of orbits as well.
        return "" if one.standing["restitution"].exists else "restitution"
    if quantity not in OF_ORBITS:
        return ""
    if not one.exists:
        return "contact"
    return "" if one.standing[model].exists else model


def _off(one: Family, need: Needed, model: str, errors: Errors) -> str:
    """The error of the judged quantity, or the reason why there is none."""
    error = errors[need.quantity]
    missing = _without(one, need.quantity, model)
    if error is None and missing:
        return f"no orbit ({missing})"
    return signed(error, need.tolerance)


def _family_lines(one: Family) -> list[str]:
    lines = ["", f"{one.n}-T orbit", _line("", *one.standing)]
    for columns in zip(*map(rows.texts, one.standing.values()), strict=True):
        lines.append(_line(f"  {columns[0][0]}", *(text for _, text in columns)))
    if one.exists:
        lines += [_line(f"  {name}", text) for name, text in rows.texts(one)]
    holds = "error law" if one.law_holds else "law, out of range"
    lines.append(_line("  relative error", "restitution", holds, "corrected"))
    return lines + [_error(one, quantity) for quantity in OF_IMPACTS]


def document(given: Answer) -> dict[str, Any]:
    """The answer as plain values for JSON, with the arguments of the call."""
    answer = rows.document(given.found)
    # What was not asked for has no key.
    for name in ("dropped", "engine", "at_step"):
        if answer[name] is None:
            del answer[name]
    return answer | {"question": given.question}


def _engine_lines(found: Design | LoneContact) -> list[str]:
    """The settings of an engine, if one is named, and what it does at the time step given."""
    at = [] if found.at_step is None else _step_lines(found.at_step)
    engine = found.engine
    if engine is None:
        return at
    speed = found.slowed_speed
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


def _short(found: Design) -> list[str]:
    """One line for each family, and a line on the options that print the other results."""
    need = found.needed
    error = f"{QUANTITIES[Quantity(need.quantity)]} off by"
    head = (
        f"{'orbit':<9}{'stable':<9}{'greatest height':<18}{'peak force':<13}{error:<40}corrected by"
    )
    about = f"{option('n')} {found.n} prints all results for one, {option('all_families')} for all"
    return ["", head, *(_one_line(one, need) for one in found.orbits), f"({about}.)"]


def _one_line(one: Family, need: Needed) -> str:
    of_contact = {row.key: row.text for row in rows.rows(one) if row.words}
    height, force = (
        of_contact[name,] if one.exists else "no orbit" for name in ("max_height", "peak_force")
    )
    return (
        f"{f'{one.n}-T':<9}{('no', 'yes')[one.is_stable]:<9}{height:<18}{force:<13}"
        f"{_off(one, need, 'restitution', one.errors):<40}"
        f"{_off(one, need, 'corrected', one.corrected_errors)}"
    )


def _whole(found: Design) -> list[str]:
    """All results for each family."""
    return [
        *(line for one in found.orbits for line in _family_lines(one)),
        "",
        # The error of the permanent contact is the same in all families.
        _line("relative error", "restitution", *_SIMPLE),
        _error(found.orbits[0], Quantity.PERMANENT_CONTACT),
    ]


def _law_lines(found: Design) -> list[str]:
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
    kinds = quantities(calculator.design)
    said = []
    for name, value in question.items():
        if value is None or name in _NOT_ECHOED:
            continue
        words = name.replace("_", " ")
        if name not in kinds:
            said.append(f"{words} {_plain(value)}")
        elif name == "mass":
            said.append(f"{words} {shown(1000 * value, 'g', digits=_TYPED)}")
        else:
            unit = kinds[name].name.replace("*", " ")
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
    found = given.found
    engine = _engine_lines(found)
    if isinstance(found, LoneContact):
        about = [_line(*row) for row in rows.texts(found)]
        about += [_line("release", found.release), *(f"Note: {note}." for note in found.notes)]
        return [_echo(given.question), *about, *engine]
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
    by_engine = found.engine is not None
    return [
        found.headline,
        found.verdict,
        f"Reason: {found.reason}.",
        _echo(given.question),
        *(f"Note: {note}." for note in found.notes),
        *engine,
        "",
        *(_line(*row) for row in rows.texts(found) if not by_engine or row[0] != _STEP),
        *([] if by_engine else [f"Time step: {found.time_step.rule}."]),
        *_law_lines(found),
        "",
        _line(asked, "exact", *_SIMPLE),
        _line("", exact, by_law, corrected),
        *(_whole(found) if given.whole else _short(found)),
    ]
