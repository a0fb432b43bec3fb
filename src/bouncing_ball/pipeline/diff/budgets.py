"""How far a variable may change from the accepted record: its budget.

The drift of a number is |new - record| divided by the range of the record's values, or by a
scale. A study declares the budget and the scale of a variable beside the variable itself (see
:mod:`bouncing_ball.datasets.variables`); both are attributes of the dataset. The table of this
module holds budgets that hold in one artifact only, and those of points that may slide along a
curve.

A budget without another source comes from the convergence study, a test that varies tolerances,
grids and rounding: it is the next power of ten above ten times the largest change.
"""

import math
from collections.abc import Mapping
from typing import Any, NamedTuple

from bouncing_ball.datasets import LONG


class Budget(NamedTuple):
    """The largest change allowed of a variable, relative to a scale: "1", or another variable.

    Without a scale the change is relative to the range of the record's values. With ``over`` two
    curves over that variable are compared, through the samples along the dimension ``point``,
    because the samples may slide along the curve.
    """

    size: float
    scale: str = ""
    over: str = ""


ROUNDING = 1e-13
"""The smallest budget, for variables without another one."""

IGNORED = math.inf
"""The budget of what another dataset also has, or another machine measures otherwise."""

PICTURE = 1.0
"""The largest root mean square difference of two pictures, in grey levels of 255.

Changing parameters by two units in the last place changes all rounding errors, as another processor
does, and moves the pixels of a figure by at most 0.092 (Fig. 15). The budget is the next power of
ten above ten times this value. It is allowed only if the data of the picture moved."""

PIXEL = 1
"""The largest change of a pixel, in grey levels, if the data of the picture did not move.

A picture is drawn on a grid of 1/256 of a pixel. A rounding error moves a point to the next place
of this grid at most, and this changes a pixel by one grey level."""

_FLAGS = ("stable", "admissible", "restitution_stable", "restitution_admissible")
_ORBIT = (
    "phase",
    "release_phase",
    "contact_duration",
    "impact_velocity",
    "bounce_velocity",
    "apparent_restitution",
)
_MULTIPLIER = ("multiplier_real", "multiplier_imag")


def _branches(coordinate: float, multiplier: float) -> dict[str, Budget]:
    """Budgets of the branches of orbits in Figs. 8, 9 and 15.

    If one chord of a continued branch changes, all of its points move along the curve; the branches
    are therefore compared as curves. Rounding decides on which side of a bifurcation or a grazing
    orbit a sample lies: 1.2 of the 600 steps.
    """
    flags = dict.fromkeys(_FLAGS, Budget(0.002, over="point"))
    orbit = dict.fromkeys(_ORBIT, Budget(coordinate, over="amplitude"))
    multipliers = dict.fromkeys(_MULTIPLIER, Budget(multiplier, over="amplitude"))
    first = {**flags, "amplitude": Budget(coordinate, over="phase"), **orbit, **multipliers}
    # A second branch, with names of its own; it is one of the spring-damper model alone.
    second = {
        f"{LONG}{name}": budget._replace(over=f"{LONG}{budget.over}")
        for name, budget in first.items()
        if not name.startswith("restitution")
    }
    return first | second


ARTIFACTS: dict[str, dict[str, Budget]] = {
    # As in Fig. 8, with 400 steps.
    "fig03": dict.fromkeys(("stable", "admissible"), Budget(0.003, over="point")),
    "fig08": _branches(coordinate=1e-6, multiplier=1e-4),
    "fig09": _branches(coordinate=1e-8, multiplier=1e-5),
    "fig15": _branches(coordinate=1e-8, multiplier=1e-5),
    # A hundred times the largest disagreement of the page with Python, over the size of the
    # quantity where that is above 1; a contact's force is in proportion to ϖ.
    "explorer": {
        "*": Budget(1e-11, scale="1"),
        "contact_force": Budget(1e-11, scale="frequency_ratio"),
    },
    # The second order of a stiff contact is a small difference of large values.
    "ext_orders": {"relative_error": Budget(1e-11)},
    "engines": {
        # In an engine of another version an impact falls on another part of a time step. Each r is
        # within the tolerance of the requested one.
        "measured_restitution": Budget(2.0, scale="tolerance"),
        # Mean heights are within the scatter that a step causes.
        "height_error": Budget(1.0, scale="step_scatter"),
        # Few single bounces scatter by up to twice that; the next power of ten.
        "height_scatter": Budget(10.0, scale="step_scatter"),
        # Times differ between machines, and versions change.
        "bounce_time": Budget(IGNORED),
        "model_time": Budget(IGNORED),
        "engine_version": Budget(IGNORED),
    },
    # Saddle-nodes are found as minima here, and some readings are ill-conditioned.
    "forensics": {"computed": Budget(1e-8)},
}
"""Budgets of single artifacts, by variable; ``*`` stands for all variables that are not named."""


def budget_of(artifact: str, name: str, attributes: Mapping[str, Any] | None = None) -> Budget:
    """The budget of a variable of an artifact's dataset.

    It is that of the artifact if there is one, otherwise that of the variable's attributes, which
    its study has declared, otherwise rounding.

    Examples
    --------
    >>> budget_of("fig05", "phase").size, budget_of("fig08", "phase").over
    (1e-13, 'amplitude')
    >>> budget_of("fig05", "found", {"budget": 1e-8, "scale": "1"}).size
    1e-08
    """
    of_artifact = ARTIFACTS.get(artifact, {})
    if name in of_artifact:
        return of_artifact[name]
    if "*" in of_artifact:
        return of_artifact["*"]
    declared = attributes or {}
    return Budget(float(declared.get("budget", ROUNDING)), str(declared.get("scale", "")))
