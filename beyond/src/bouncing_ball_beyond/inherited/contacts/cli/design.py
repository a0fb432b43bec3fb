"""``bouncing-ball design``: a contact is assessed or chosen.

A contact without a table is described. The answer is printed as JSON, as a page, or as text
(:mod:`bouncing_ball_beyond.inherited.contacts.cli.design_text`).
"""

from collections.abc import Mapping
from dataclasses import fields, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from bouncing_ball_beyond.cli.options import add_file
from bouncing_ball_beyond.inherited.cli.options import Parser
from bouncing_ball_beyond.inherited.contacts.cli.contact_text import contact_numbers
from bouncing_ball_beyond.inherited.contacts.cli.design_answer import KINDS, DesignAnswer
from bouncing_ball_beyond.inherited.contacts.cli.options import add_optional, option
from bouncing_ball_beyond.inherited.contacts.contact import rows
from bouncing_ball_beyond.inherited.contacts.contact.contact import Contact
from bouncing_ball_beyond.inherited.contacts.contact.describe import Description, describe_contact
from bouncing_ball_beyond.inherited.contacts.contact.diagnose import diagnosis
from bouncing_ball_beyond.inherited.contacts.contact.drops import drop_at_rest
from bouncing_ball_beyond.inherited.contacts.contact.quantities import quantities
from bouncing_ball_beyond.inherited.contacts.contact.question import Question
from bouncing_ball_beyond.inherited.contacts.contact.resolve import resolve
from bouncing_ball_beyond.inherited.contacts.contact.table import Table
from bouncing_ball_beyond.inherited.contacts.contact.units import doubts, in_si
from bouncing_ball_beyond.inherited.errors import NoOrbitError, ParameterError, extra

# It imports orbits, for longer than most recipes are computed.
if TYPE_CHECKING:
    from bouncing_ball_beyond.inherited.contacts.contact.assess import Assessment

# Parameters of which each implies that there is a table.
_OF_TABLE = ("frequency", "table_amplitude", "acceleration")
_OF_STIFFNESS_AND_LOSS = tuple(name for name in quantities(Contact) if name != "mass")
# The options in their order, in which the answer repeats them.
_OPTIONS = (
    (Contact, ("mass",)),
    (Table, (*_OF_TABLE, "gravity")),
    (Contact, _OF_STIFFNESS_AND_LOSS),
    (drop_at_rest, ("speed",)),
    (Question, ("n",)),
    (Contact, ("release", "law")),
    (Question, ("quantity", "tolerance")),
    (Contact, ("from_engine", "solref", "solimp", "parameters")),
)


def add_options(parser: Parser) -> None:
    """Add the options of :func:`design`."""
    add_file(parser, "plot", "File for one page to print: .pdf, .png or .svg.")
    each = "By default each orbit has one line, unless n is given."
    parser.add_argument(
        option("all_families"),
        dest="all_families",
        action="store_true",
        help=f"Print all numbers of the contact and of the orbits of every n. {each}",
    )
    for kind, names in _OPTIONS:
        add_optional(parser, kind, names)


def design(*, plot: Path | None, all_families: bool, **given: Any) -> DesignAnswer:
    """The answer about a contact; with ``plot`` the page to print is written as well.

    Raises
    ------
    ModelError
        If the page has another name or cannot be written, or if a parameter is missing, out of
        range or contradicts another.
    NoOrbitError
        If no model has the orbit.
    """
    if plot is not None:
        # Imported here, because it imports xarray, which takes longer than most recipes.
        from bouncing_ball_beyond.inherited.datasets.files import PICTURES, require_writable

        require_writable(plot, PICTURES)
    found = answer_design(given)
    if plot is not None:
        _draw(found, plot)
    return found._replace(whole=all_families or given.get("n") is not None)


def answer_design(given: Mapping[str, Any]) -> DesignAnswer:
    """The answer for options by name; an option that is missing or None is not given.

    Raises
    ------
    ModelError, NoOrbitError
        See :func:`design`.
    """
    contact = Contact(**_of(Contact, given))
    question = Question(**_of(Question, given))
    # These are needed without a table, too.
    si = {
        name: in_si(name, given[name], KINDS[name])
        for name in ("gravity", "speed")
        if given.get(name) is not None
    }
    read = {**given, **si}
    speed = si.get("speed")
    has_table = any(given.get(name) is not None for name in ("n", *_OF_TABLE))
    # With a speed an impact is meant, whose stiffness may be missing.
    if has_table or not (contact.is_stiff or speed is not None):
        table = Table(**_of(Table, read))
        read |= _quantities_of(table)
        found = _on_table(contact, table, question)
    else:
        found = describe_contact(contact, si.get("gravity"), speed)
    read |= _quantities_of(contact) | _quantities_of(question)
    return DesignAnswer(
        found=found,
        dropped=None if speed is None else drop_at_rest(found.case, speed),
        question=read,
        diagnosis=diagnosis(contact),
        doubts=doubts(given, KINDS),
    )


def _of(kind: Any, given: Mapping[str, Any]) -> dict[str, Any]:
    """The options that are fields of a class."""
    return {each.name: given[each.name] for each in fields(kind) if each.name in given}


def _quantities_of(data: Any) -> dict[str, Any]:
    """The quantities of a dataclass in SI units, by name."""
    return {name: getattr(data, name) for name in quantities(type(data))}


def _on_table(contact: Contact, table: Table, question: Question) -> "Assessment":
    """The assessment of the contact that is given, or of the one that is chosen."""
    from bouncing_ball_beyond.inherited.contacts.contact.assess import assess
    from bouncing_ball_beyond.inherited.contacts.contact.choose import choose

    with table.hinting():
        if contact.is_stiff:
            case = resolve(contact, table.motion, question.families)
            found = assess(case, question)
        else:
            choice = choose(contact, table.motion, question)
            found = assess(choice.case, question, choice)
    return replace(found, hint=table.hint)


def _draw(given: DesignAnswer, path: Path) -> None:
    found = given.found
    if isinstance(found, Description):
        raise ParameterError("{plot} needs a table, such as {frequency} and {acceleration}")
    if not any(each.exists for each in found.judged.standing.values()):
        raise NoOrbitError(f"without an orbit there is no page to print: {found.reason}")
    from bouncing_ball_beyond.inherited.contacts.contact.page_data import chart_and_motion

    with extra("plot"):
        from bouncing_ball_beyond.inherited.contacts.contact.page_figures import draw
        from bouncing_ball_beyond.inherited.drawing.files import write
        from bouncing_ball_beyond.inherited.drawing.style import style
    with style():
        listed = contact_numbers(given) + rows.texts(found.judged)
        figure = draw(rows.document(found), chart_and_motion(found), listed)
        write(figure, path, "bouncing-ball design")


def design_document(given: DesignAnswer) -> dict[str, Any]:
    """The answer as plain values for JSON, with the options."""
    found = rows.document(given.found)
    # What was not asked for has no key.
    if given.dropped is not None:
        found["dropped"] = rows.document(given.dropped)
    for name in ("doubts", "diagnosis"):
        if sentences := getattr(given, name):
            found[name] = list(sentences)
    return found | {"question": given.question}
