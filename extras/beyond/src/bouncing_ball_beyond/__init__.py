"""Periodic orbits and motions of a ball on a vibrating table, with any contact.

All quantities are dimensionless. The height of the table is ΛW(τ), by default Λ sin τ. Gravity is
1, and velocities are in units of g/Ω. A ball is an instance of a class of :mod:`.balls` or
:mod:`.laws`. Functions such as `orbit` and `simulate` take a ball as their first argument.

A folder imports only from the folders before it: ``tables``, ``contacts``, ``motions``,
``periodic``, ``errors``, ``output``.
"""

from importlib import import_module as _import_module
from typing import Any as _Any

__version__ = "0.1.0"

# Module of each public name. A module is imported when one of its names is first used.
_MODULES = {
    "MeasuredTable": "tables.table",
    "Table": "tables.table",
    "Ball": "contacts.balls",
    "Corrected": "contacts.balls",
    "Impact": "contacts.balls",
    "restitution_of": "contacts.balls",
    "Rigid": "contacts.balls",
    "Signature": "contacts.balls",
    "SpringDamper": "contacts.balls",
    "ForceLaw": "contacts.laws",
    "adams_impact": "contacts.named_laws",
    "hunt_crossley": "contacts.named_laws",
    "kuwabara_kono": "contacts.named_laws",
    "law_of_impact": "contacts.named_laws",
    "linear": "contacts.named_laws",
    "simscape_contact": "contacts.named_laws",
    "tsuji": "contacts.named_laws",
    "basins": "motions.long_term",
    "lyapunov": "motions.long_term",
    "motion_of": "motions.long_term",
    "orbit_diagram": "motions.long_term",
    "SearchEnded": "motions.effort",
    "permanent_contact": "motions.permanent",
    "drop": "motions.simulation",
    "history": "motions.simulation",
    "simulate": "motions.simulation",
    "FollowedBranch": "periodic.branches",
    "SpecialCurve": "periodic.branches",
    "cascade": "periodic.continuation",
    "follow": "periodic.continuation",
    "limits": "periodic.continuation",
    "special_curve": "periodic.curves",
    "OrbitEquations": "periodic.equations",
    "OrbitNotFound": "periodic.equations",
    "PeriodicOrbit": "periodic.equations",
    "grazing_form": "periodic.forms",
    "GrazingForm": "periodic.forms",
    "normal_form": "periodic.forms",
    "NormalForm": "periodic.forms",
    "orbit": "periodic.orbits",
    "orbits": "periodic.orbits",
    "contact_values": "errors.error_law",
    "error_thresholds": "errors.error_law",
    "exact_errors": "errors.error_law",
    "free_impact": "errors.error_law",
    "law_coefficients": "errors.error_law",
    "law_errors": "errors.error_law",
    "law_thresholds": "errors.error_law",
    "on_shaker": "errors.shaker",
    "plot": "output.pictures",
    "to_dataset": "output.results",
}
__all__ = sorted(_MODULES)


def __getattr__(name: str) -> _Any:
    if name not in _MODULES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(_import_module(f"{__name__}.{_MODULES[name]}"), name)


def __dir__() -> list[str]:
    return __all__
