"""The answer of ``bouncing-ball design`` about a contact."""

from typing import TYPE_CHECKING, Any, NamedTuple

from bouncing_ball_contacts.contact.contact import Contact
from bouncing_ball_contacts.contact.describe import Description
from bouncing_ball_contacts.contact.drops import Dropped, drop_at_rest
from bouncing_ball_contacts.contact.quantities import quantities
from bouncing_ball_contacts.contact.question import EngineSetup, Question
from bouncing_ball_contacts.contact.table import Table
from bouncing_ball_contacts.engines.drop_in_steps import DropInSteps
from bouncing_ball_contacts.engines.engine import EngineSettings
from bouncing_ball_contacts.engines.given_step import AtStep

# It imports orbits, for longer than most recipes are computed.
if TYPE_CHECKING:
    from bouncing_ball_contacts.contact.assess import Assessment

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
    ``dropped``, ``engine`` and ``at_step`` are None if nothing was asked about them.
    ``dropped_at_step`` is a drop onto the parameters of an engine at a time step, and ``diagnosis``
    says what keeps them from a bounce. ``doubts`` are
    sentences on numbers that may have been meant in another unit. ``whole`` tells whether all
    numbers are printed, those of the contact in an engine and those of each family.
    """

    found: "Assessment | Description"
    dropped: Dropped | None
    engine: EngineSettings | None
    at_step: AtStep | None
    question: dict[str, Any]
    whole: bool = True
    dropped_at_step: DropInSteps | None = None
    diagnosis: tuple[str, ...] = ()
    doubts: tuple[str, ...] = ()
