"""Periodic orbits and motions of a ball on a vibrating table, with any contact.

All quantities are dimensionless. The height of the table is ΛW(τ), by default Λ sin τ. Gravity is
1, and velocities are in units of g/Ω. A ball is an instance of a class of :mod:`.balls` or
:mod:`.laws`. Functions such as `orbit` and `simulate` take a ball as their first argument.
"""

from importlib import import_module as _import_module
from typing import Any as _Any

__version__ = "0.1.0"

# Module of each public name. A module is imported when one of its names is first used.
_MODULES = {
    "Ball": "balls",
    "Corrected": "balls",
    "Impact": "balls",
    "Rigid": "balls",
    "Signature": "balls",
    "SpringDamper": "balls",
    "restitution_of": "balls",
    "FollowedBranch": "branches",
    "cascade": "continuation",
    "follow": "continuation",
    "limits": "continuation",
    "OrbitEquations": "equations",
    "contact_values": "error_law",
    "error_thresholds": "error_law",
    "exact_errors": "error_law",
    "free_impact": "error_law",
    "law_coefficients": "error_law",
    "law_errors": "error_law",
    "law_thresholds": "error_law",
    "ForceLaw": "laws",
    "adams_impact": "named_laws",
    "hunt_crossley": "named_laws",
    "kuwabara_kono": "named_laws",
    "law_of_impact": "named_laws",
    "linear": "named_laws",
    "simscape_contact": "named_laws",
    "tsuji": "named_laws",
    "basins": "motions",
    "lyapunov": "motions",
    "motion_of": "motions",
    "orbit_diagram": "motions",
    "OrbitNotFound": "periodic",
    "PeriodicOrbit": "periodic",
    "orbit": "periodic",
    "orbits": "periodic",
    "permanent_contact": "permanent",
    "MeasuredTable": "tables",
    "Table": "tables",
    "SpecialCurve": "branches",
    "special_curve": "curves",
    "GrazingForm": "forms",
    "NormalForm": "forms",
    "grazing_form": "forms",
    "normal_form": "forms",
    "plot": "pictures",
    "to_dataset": "results",
    "on_shaker": "shaker",
    "drop": "simulation",
    "history": "simulation",
    "simulate": "simulation",
}
__all__ = sorted(_MODULES)


def __getattr__(name: str) -> _Any:
    if name not in _MODULES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(_import_module(f"{__name__}.{_MODULES[name]}"), name)


def __dir__() -> list[str]:
    return __all__
