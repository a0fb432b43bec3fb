"""What to write into a physics engine for a bounce, and what bounce a recording shows."""

from typing import TYPE_CHECKING, Any

from bouncing_ball_contacts.designs import Bounce, Design, design
from bouncing_ball_contacts.diagnosis import Diagnosis, diagnose
from bouncing_ball_contacts.engines import ENGINES
from bouncing_ball_contacts.units import Refused

if TYPE_CHECKING:
    from bouncing_ball_contacts.fits import Fit, fit

__all__ = [
    "ENGINES",
    "Bounce",
    "Design",
    "Diagnosis",
    "Fit",
    "Refused",
    "design",
    "diagnose",
    "fit",
]


def __getattr__(name: str) -> Any:
    # Fits need SciPy, whose import takes longer than a design.
    if name in ("Fit", "fit"):
        from bouncing_ball_contacts import fits

        return getattr(fits, name)
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
