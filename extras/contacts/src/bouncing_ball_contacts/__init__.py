"""What to write into a physics engine for a bounce, and what bounce a recording shows."""

from importlib import import_module
from typing import TYPE_CHECKING, Any

from bouncing_ball_contacts.designs import Bounce, Design, design
from bouncing_ball_contacts.engines import ENGINES
from bouncing_ball_contacts.units import Refused

if TYPE_CHECKING:
    from bouncing_ball_contacts.diagnosis import Diagnosis, diagnose
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


# Fits need SciPy, whose import takes longer than a design, which needs neither.
_ELSEWHERE = {"Fit": "fits", "fit": "fits", "Diagnosis": "diagnosis", "diagnose": "diagnosis"}


def __getattr__(name: str) -> Any:
    if name in _ELSEWHERE:
        return getattr(import_module(f"{__name__}.{_ELSEWHERE[name]}"), name)
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
