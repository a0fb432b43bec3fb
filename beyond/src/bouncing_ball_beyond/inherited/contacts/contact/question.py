"""What is asked of a contact: how accurate the restitution model must be."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Annotated, Literal, get_args

from bouncing_ball_beyond.inherited.contacts.contact.quantities import Tolerance, convert
from bouncing_ball_beyond.inherited.errors import (
    FAMILY,
    ModelError,
    one_of,
    shortened,
    suggesting,
)

# All quantities but the apparent restitution, which nobody measures or writes.
_Judged = Literal[
    "max_height", "bounce_velocity", "phase", "saddle_node", "period_doubling", "permanent_contact"
]
# The families of which one is judged by default: those that the paper shows, and some more.
_FAMILIES = range(1, 9)


@suggesting
@dataclass(frozen=True, kw_only=True)
class Question:
    """What is asked of a contact on a table.

    Parameters
    ----------
    n
        Index n of the orbits, which repeat after n periods of the table, with one impact. By
        default n = 1 to 8, with a verdict on the first stable orbit.
    quantity
        Name of the quantity that must be accurate.
    tolerance
        Largest error of the restitution model's quantity against the contact's, relative to that of
        the contact, such as "5 %" or 0.05.

    Raises
    ------
    ModelError
        If there is no such quantity, or a number is out of range.

    Examples
    --------
    >>> Question(tolerance="5 %").tolerance, list(Question(n=2).families)
    (0.05, [2])
    """

    n: Annotated[int, FAMILY] | None = None
    quantity: _Judged = "max_height"
    tolerance: Tolerance = 0.01

    def __post_init__(self) -> None:
        convert(self)
        one_of("quantity", self.quantity, {each: each for each in get_args(_Judged)})
        if self.n is not None and (isinstance(self.n, bool) or self.n not in FAMILY):
            raise ModelError(f"index of the orbits n = {shortened(self.n)} is not {FAMILY}")

    @property
    def families(self) -> Sequence[int]:
        """The families n among which the orbit of the answer is."""
        return _FAMILIES if self.n is None else [int(self.n)]
