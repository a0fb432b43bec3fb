"""The answer of ``bouncing-ball design`` about a contact."""

from typing import TYPE_CHECKING, Any, NamedTuple

from bouncing_ball_beyond.inherited.contacts.contact.contact import Contact
from bouncing_ball_beyond.inherited.contacts.contact.describe import Description
from bouncing_ball_beyond.inherited.contacts.contact.drops import Dropped, drop_at_rest
from bouncing_ball_beyond.inherited.contacts.contact.quantities import quantities
from bouncing_ball_beyond.inherited.contacts.contact.question import Question
from bouncing_ball_beyond.inherited.contacts.contact.table import Table

# It imports orbits, for longer than most recipes are computed.
if TYPE_CHECKING:
    from bouncing_ball_beyond.inherited.contacts.contact.assess import Assessment

KINDS = quantities(Contact) | quantities(Table) | quantities(Question) | quantities(drop_at_rest)
"""The options with a unit."""


class DesignAnswer(NamedTuple):
    """The contact with all that was asked about it, and the options with quantities in SI units.

    ``found`` is the assessment of a contact on a table, or the description of one without a table.
    ``dropped`` is None if no drop was asked about. ``diagnosis`` says what keeps the parameters of
    an engine from a bounce. ``doubts`` are sentences on numbers that may have been meant in another
    unit. ``whole`` tells whether all numbers of each family are printed.
    """

    found: "Assessment | Description"
    dropped: Dropped | None
    question: dict[str, Any]
    whole: bool = True
    diagnosis: tuple[str, ...] = ()
    doubts: tuple[str, ...] = ()
