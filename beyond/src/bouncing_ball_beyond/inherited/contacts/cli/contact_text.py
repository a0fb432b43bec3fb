"""The numbers of a contact, and the parameters of its law, as they are printed."""

from typing import TYPE_CHECKING

from bouncing_ball_beyond.inherited.contacts.cli.design_answer import DesignAnswer
from bouncing_ball_beyond.inherited.contacts.contact import rows
from bouncing_ball_beyond.inherited.contacts.contact.describe import Description
from bouncing_ball_beyond.inherited.contacts.contact.texts import shown

# It imports orbits, for longer than most recipes are computed.
if TYPE_CHECKING:
    from bouncing_ball_beyond.inherited.contacts.contact.assess import Assessment


def line(name: str, *columns: str) -> str:
    """A name with what stands in the columns beside it."""
    return f"{name:<38}" + "".join(f"{column + ' ':<18}" for column in columns).rstrip()


def contact_numbers(given: DesignAnswer) -> list[tuple[str, str]]:
    """The numbers of the contact and of a drop, by name."""
    dropped = [] if given.dropped is None else rows.texts(given.dropped)
    return rows.texts(given.found) + dropped


def law_lines(found: "Assessment | Description") -> list[str]:
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
