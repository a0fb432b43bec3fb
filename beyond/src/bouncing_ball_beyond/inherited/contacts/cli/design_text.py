"""How the answer of ``bouncing-ball design`` is written as text."""

from collections.abc import Mapping
from typing import Any

from bouncing_ball_beyond.inherited.contacts.cli.contact_text import (
    contact_numbers,
    law_lines,
    line,
)
from bouncing_ball_beyond.inherited.contacts.cli.design_answer import KINDS, DesignAnswer
from bouncing_ball_beyond.inherited.contacts.contact.describe import Description
from bouncing_ball_beyond.inherited.contacts.contact.texts import lines, shown

# More digits than a user types.
_TYPED = 12
# What has a default, and is said in the answer.
_NOT_ECHOED = {"quantity", "tolerance"}


def design_lines(given: DesignAnswer) -> list[str]:
    """The answer as text, with the verdict first."""
    found = given.found
    if isinstance(found, Description):
        numbers = _of_contact(given, found)
    else:
        # Imported here, because orbits are imported for longer than most recipes are computed.
        from bouncing_ball_beyond.inherited.contacts.cli.table_text import table_numbers

        numbers = table_numbers(given, found)
    return lines(
        "design",
        given=given,
        found=found,
        is_on_table=not isinstance(found, Description),
        echo=_echo(given.question),
        numbers=numbers,
    )


def _of_contact(given: DesignAnswer, found: Description) -> list[str]:
    """The numbers of the contact, with its release and its law."""
    return [
        *(line(*row) for row in contact_numbers(given)),
        line("release", found.release),
        *law_lines(found),
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
