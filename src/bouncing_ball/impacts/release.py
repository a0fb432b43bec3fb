"""The rule that ends a contact: a choice of the model, with a name."""

from enum import StrEnum


class Release(StrEnum):
    """What ends a contact."""

    DISPLACEMENT = "displacement"
    """The ball is back at the table's level, δ = 0 (Eq. 23, the paper's)."""
    FORCE = "force"
    """The contact force vanishes, 2ζϖ δ′ + ϖ² δ = 0: no tension."""
