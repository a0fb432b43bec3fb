"""What to write into a physics engine for a bounce, and what bounce a recording shows."""

from importlib import import_module
from typing import TYPE_CHECKING, Any

from bouncing_ball_contacts.answers import Answer
from bouncing_ball_contacts.bounces import Bounce
from bouncing_ball_contacts.questions import design, diagnose
from bouncing_ball_contacts.rows import ENGINES
from bouncing_ball_contacts.units import Refused

if TYPE_CHECKING:
    from bouncing_ball_contacts.fits import Fit, fit

__all__ = [
    "ENGINES",
    "Answer",
    "Bounce",
    "Fit",
    "Refused",
    "design",
    "diagnose",
    "fit",
]


def __getattr__(name: str) -> Any:
    # Fits need SciPy, whose import takes longer than a design, which does not need it.
    if name in ("Fit", "fit"):
        return getattr(import_module(f"{__name__}.fits"), name)
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
