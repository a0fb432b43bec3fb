"""``bouncing-ball design``: the calculator's answer, as JSON or as text."""

from collections.abc import Mapping
from dataclasses import asdict
from pathlib import Path
from typing import Any, NamedTuple

from bouncing_ball.beyond.calculator import design as calculator
from bouncing_ball.beyond.calculator.results import Contact, Design, Family, rows
from bouncing_ball.beyond.calculator.units import percent, shown, signed
from bouncing_ball.cli.options import Parser, add_file, add_parameters, option
from bouncing_ball.datasets.files import PICTURES, require_writable
from bouncing_ball.errors import NoOrbitError, ParameterError, extra
from bouncing_ball.paper.comparison.errors import OF_IMPACTS, QUANTITIES, Quantity
from bouncing_ball.paper.comparison.thresholds import ThresholdStatus

_SIMPLE = "error law", "corrected"
# What has a default, and is said in the answer.
_NOT_ECHOED = {"quantity", "tolerance", "restitution_error"}


class Answer(NamedTuple):
    """The result of the calculator, and whether all numbers of each family are printed."""

    found: Design | Contact
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
        if isinstance(found, Contact):
            raise ParameterError("{plot} needs a table, such as {frequency} and {acceleration}")
        _draw(found, plot)
    whole = all_families or given.get("n") is not None
    return Answer(found, whole)


def _draw(found: Design, path: Path) -> None:
    if not any(each.exists for each in found.judged.standing.values()):
        raise NoOrbitError(f"without an orbit there is no page to print: {found.reason}")
    from bouncing_ball.beyond.calculator.page_data import page

    with extra("plot"):
        from bouncing_ball.beyond.calculator.page_figures import draw
        from bouncing_ball.drawing.files import write
        from bouncing_ball.drawing.style import style
    with style():
        figure = draw(asdict(found), page(found), rows(found) + rows(found.judged))
        write(figure, path, "bouncing-ball design")


def _line(name: str, *columns: str) -> str:
    return f"{name:<38}" + "".join(f"{column + ' ':<18}" for column in columns).rstrip()


def _error(one: Family, quantity: Quantity) -> str:
    errors = (of[quantity] for of in (one.errors, one.law_errors, one.corrected_errors))
    return _line(f"    {QUANTITIES[quantity]}", *map(signed, errors))


def _family_lines(one: Family) -> list[str]:
    lines = ["", f"{one.n}-T orbit", _line("", *one.standing)]
    for columns in zip(*map(rows, one.standing.values()), strict=True):
        lines.append(_line(f"  {columns[0][0]}", *(text for _, text in columns)))
    if one.exists:
        lines += [_line(f"  {name}", text) for name, text in rows(one)]
    holds = "error law" if one.law_holds else "law, out of range"
    lines.append(_line("  relative error", "restitution", holds, "corrected"))
    return lines + [_error(one, quantity) for quantity in OF_IMPACTS]


def document(given: Answer) -> dict[str, Any]:
    """The answer as plain values for JSON, with the settings of an engine if one is named."""
    found = given.found
    answer = asdict(found)
    if found.question["engine"]:
        answer["engine"] = asdict(found.engine_settings())
    return answer


def _engine_lines(found: Design | Contact) -> list[str]:
    engine = found.engine_settings()
    speed = found.slowed_speed
    slowed = "" if speed is None else f" of a fast impact, 1 % less at {shown(speed, 'm/s')}"
    expected = [
        ("greatest height", engine.max_height, "m"),
        ("duration of contact", engine.contact_duration, "s"),
        ("penetration", engine.penetration, "m"),
    ]
    return [
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


def _short(found: Design) -> list[str]:
    """One line for each family, and a line on the options that print the other results."""
    quantity = found.needed.quantity
    least = found.needed.tolerance
    error = f"{QUANTITIES[Quantity(quantity)]} off by"
    head = (
        f"{'orbit':<9}{'stable':<9}{'greatest height':<18}{'peak force':<13}{error:<40}corrected by"
    )
    rows = [
        f"{f'{one.n}-T':<9}{('no', 'yes')[one.is_stable]:<9}{shown(one.max_height, 'm'):<18}"
        f"{shown(one.peak_force, 'N'):<13}{signed(one.errors[quantity], least):<40}"
        f"{signed(one.corrected_errors[quantity], least)}"
        for one in found.orbits
    ]
    about = f"{option('n')} {found.n} prints all results for one, {option('all_families')} for all"
    return ["", head, *rows, f"({about}.)"]


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
            shown(x, units[key].name if key in units else ""),
        )
        for key, x in values.items()
    ]


def _echo(question: Mapping[str, Any]) -> str:
    """The parameters that were given, with their units."""
    kinds = calculator.quantities()
    said = []
    for name, value in question.items():
        if value is None or name in _NOT_ECHOED:
            continue
        words = name.replace("_", " ")
        if name not in kinds:
            said.append(f"{words} {_plain(value)}")
        elif name == "mass":
            said.append(f"{words} {shown(1000 * value, 'g')}")
        else:
            said.append(f"{words} {shown(value, kinds[name].name.replace('*', ' '))}")
    return f"Given: {', '.join(said)}."


def _plain(value: Any) -> str:
    """A name, a number, or the parameters of an engine."""
    if isinstance(value, dict):
        return " ".join(f"{name}={number:g}" for name, number in value.items())
    return str(value)


def lines(given: Answer) -> list[str]:
    """The answer as text, with the verdict first."""
    found = given.found
    engine = _engine_lines(found) if found.question["engine"] else []
    if isinstance(found, Contact):
        about = [_line(*row) for row in rows(found)]
        about += [_line("release", found.release), *(f"Note: {note}." for note in found.notes)]
        return [_echo(found.question), *about, *engine]
    need = found.needed
    always = ThresholdStatus.ALWAYS_WITHIN
    asked = f"ϖ for {percent(need.tolerance)} in the {QUANTITIES[Quantity(need.quantity)]}"
    exact = "any" if need.status == always else shown(need.frequency_ratio)
    corrected = "any" if need.corrected_status == always else shown(need.corrected)
    return [
        found.headline,
        found.verdict,
        f"Reason: {found.reason}.",
        _echo(found.question),
        *(f"Note: {note}." for note in found.notes),
        *engine,
        "",
        *(_line(*row) for row in rows(found) if not engine or row[0] != "largest time step"),
        *([] if engine else [f"Time step: {found.time_step.rule}."]),
        *_law_lines(found),
        "",
        _line(asked, "exact", *_SIMPLE),
        _line("", exact, shown(need.by_law), corrected),
        *(_whole(found) if given.whole else _short(found)),
    ]
