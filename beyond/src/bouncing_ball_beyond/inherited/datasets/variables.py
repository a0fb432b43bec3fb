"""The variables of datasets: name, symbol, unit, equation and budget of each.

A name has the same meaning in every dataset. All quantities but those of measured impacts are
dimensionless: times are Ωt, lengths Ω²y/g, velocities Ωẏ/g, and phases and angles are in
radians of the table's motion. Units follow the CF conventions ("1", "rad").
"""

import math
from collections.abc import Mapping
from types import MappingProxyType
from typing import Any, NamedTuple

import numpy as np
import xarray as xr

from bouncing_ball_beyond.inherited.errors import ModelError


class Variable(NamedTuple):
    """The description of a variable in a dataset.

    ``symbol`` and ``equation`` are empty if the paper has none for it. ``budget`` is the largest
    change from the accepted record, as a share of ``scale``: of 1, of another variable, or, if it
    is empty, of the range of the values; without a budget only rounding may change the variable.
    """

    long_name: str
    symbol: str = ""
    units: str = "1"
    equation: str = ""
    budget: float | None = None
    scale: str = ""

    def attributes(self) -> dict[str, Any]:
        """The attributes of the variable in a dataset."""
        attributes: dict[str, Any] = {
            "long_name": self.long_name,
            "symbol": self.symbol,
            "units": self.units,
            "equation": self.equation,
        }
        if self.budget is not None:
            attributes |= {"budget": self.budget, "scale": self.scale}
        return attributes


ROUNDING = 1e-13
"""The budget of variables that declare none."""

IGNORED = math.inf
"""The budget of variables that another dataset also has, or about which rounding decides."""


class Budget(NamedTuple):
    """The budget of a variable in one artifact, which takes the place of that of the variable.

    ``size`` and ``scale`` are the ``budget`` and the ``scale`` of :class:`Variable`. With ``over``
    two curves over that variable are compared, through the samples along the dimension ``point``,
    because the samples may slide along the curve.
    """

    size: float = ROUNDING
    scale: str = ""
    over: str = ""

    def attributes(self) -> dict[str, Any]:
        """The attributes of the variable in the dataset of the artifact.

        Examples
        --------
        >>> Budget(1e-6, over="amplitude").attributes()
        {'budget': 1e-06, 'scale': '', 'over': 'amplitude'}
        """
        attributes: dict[str, Any] = {"budget": self.size, "scale": self.scale}
        if self.over:
            attributes["over"] = self.over
        return attributes


def budgeted(dataset: xr.Dataset, budgets: Mapping[str, Budget]) -> xr.Dataset:
    """The dataset, whose variables get the budgets of its artifact; ``*`` stands for all others.

    Examples
    --------
    >>> data = budgeted(xr.Dataset({"x": 0.0, "y": 0.0}), {"x": Budget(1e-6), "*": Budget(1e-9)})
    >>> data.x.attrs["budget"], data.y.attrs["budget"]
    (1e-06, 1e-09)
    """
    for name in map(str, dataset.variables):
        if budget := budgets.get(name, budgets.get("*")):
            dataset[name].attrs |= budget.attributes()
    return dataset


SHARED = {
    # Axes of datasets, and parameters.
    "n": Variable("index of the family of periodic orbits", symbol="n", equation="Eq. 6"),
    "case": Variable("parameter set"),
    "frequency_ratio": Variable(
        "frequency ratio of contact and table", symbol="ϖ", equation="Eq. 11"
    ),
    "restitution": Variable("restitution coefficient", symbol="r", equation="Eq. 2"),
    "damping_ratio": Variable("damping ratio of the contact", symbol="ζ", equation="Eq. 16"),
    "amplitude": Variable("excitation amplitude", symbol="Λ", equation="Eq. 4"),
    "release": Variable("what ends a contact"),
    "model": Variable("model of the impact"),
    "simple": Variable("simple model with which the contact is compared"),
    "impact_map": Variable("map of the restitution model", equation="Eqs. 5, 8"),
    "reading": Variable("what is assumed, one reading of the paper each"),
    "point": Variable("point along the branch, at equal steps of arclength"),
    "sample": Variable("sample number"),
    "height": Variable("height from which the ball falls", symbol="h"),
    # n-T orbits.
    "phase": Variable(
        "phase of the table when the contact starts", symbol="φ", units="rad", equation="Eqs. 6, 21"
    ),
    "release_phase": Variable(
        "phase of the table when the contact ends", symbol="φ + τ_b", units="rad", equation="Eq. 23"
    ),
    "contact_duration": Variable("duration of the contact", symbol="τ_b", equation="Eq. 23"),
    "impact_velocity": Variable(
        "velocity of the ball as contact starts", symbol="z′_i", equation="Eq. 22"
    ),
    "bounce_velocity": Variable(
        "bouncing-off velocity of the ball", symbol="z′_b", equation="Eq. 27"
    ),
    "apparent_restitution": Variable(
        "apparent restitution coefficient", symbol="r_a", equation="Eq. 17", budget=1e-12
    ),
    "max_height": Variable(
        "greatest height of the ball over the cycle", symbol="max z", equation="Eq. 37"
    ),
    "stable": Variable(
        "whether both Floquet multipliers are inside the unit circle", symbol="|μ| < 1"
    ),
    "admissible": Variable("whether nothing else happens during the orbit"),
    "restitution_phase": Variable(
        "phase of impact, restitution model", symbol="φ_CR", units="rad", equation="Eq. 6"
    ),
    # Bifurcations, and the ranges of stability between them.
    "bound": Variable("end of the stability range"),
    "saddle_node_amplitude": Variable(
        "amplitude of the saddle-node", symbol="Λ_SN", equation="Eq. 7"
    ),
    "saddle_node_phase": Variable(
        "phase at the saddle-node", symbol="φ_SN", units="rad", equation="Eq. 6"
    ),
    "period_doubling_amplitude": Variable(
        "amplitude of the period doubling", symbol="Λ_PD", equation="Eq. 8"
    ),
    "period_doubling_phase": Variable(
        "phase at the period doubling", symbol="φ_PD", units="rad", equation="Eq. 6"
    ),
    "period_doubling_turn": Variable(
        "frequency ratio at which the period doubling is lowest", symbol="ϖ", budget=1e-05
    ),
    "computed": Variable("end of the stability range, this replication", symbol="Λ"),
    "printed": Variable("end of the stability range, as printed", symbol="Λ", equation="Table 1"),
    # Ball and table over time.
    "time": Variable("time since the first impact", symbol="τ"),
    "ball": Variable("height of the ball", symbol="z", equation="Eqs. 4, 12, 14"),
    "ball_velocity": Variable("velocity of the ball", symbol="z′", equation="Eqs. 4, 13, 15"),
    "table": Variable("height of the table", symbol="w", equation="Eq. 4"),
    "contact": Variable("whether the ball touches the table"),
    # Errors and thresholds.
    "quantity": Variable("quantity compared between the two models"),
    "tolerance": Variable("relative error tolerated", equation="Eqs. 37-38"),
    "relative_error": Variable("relative error of the restitution model", equation="Eqs. 37-38"),
    "error_threshold": Variable(
        "frequency ratio above which the relative error stays below the tolerance",
        symbol="ϖ_1%",
        equation="Eqs. 37-38",
        budget=1e-10,
    ),
    "threshold_status": Variable("whether the threshold lies within the range scanned"),
    "threshold_amplitude": Variable(
        "threshold of permanent contact",
        symbol="Λ_SD, or Λ_F for the force release",
        equation="Eq. 33",
    ),
    # Comparisons of two computations.
    "disagreement": Variable("largest disagreement between two routes", budget=1.0, scale="budget"),
    "budget": Variable("disagreement allowed"),
    "orbits": Variable("number of orbits or bifurcations compared"),
    # Motions on which balls end.
    "reason": Variable("why a claim or a motion is undecided"),
    "periods": Variable("periods of the table after which the motion repeats, 0 if it does not"),
    "impacts": Variable("impacts until the motion repeats, 0 if it does not"),
    "lyapunov_exponent": Variable(
        "largest Lyapunov exponent, per period of the table",
        symbol="λ",
        budget=5.0,
        scale="lyapunov_error",
    ),
    "lyapunov_error": Variable(
        "error of the largest Lyapunov exponent: twice it on both sides are 95 %", budget=0.5
    ),
}
"""The variables that several stages or calls write; the others stand beside the one that does."""


def describe(
    dataset: xr.Dataset, variables: Mapping[str, Variable] = MappingProxyType({})
) -> xr.Dataset:
    """The dataset with attributes for every variable and coordinate.

    A dimension without a coordinate gets its index as the coordinate.

    Raises
    ------
    ModelError
        If a name is neither in ``variables`` nor in :data:`SHARED`.

    Examples
    --------
    >>> describe(xr.Dataset({"phase": ("point", [0.0])})).phase.attrs["symbol"]
    'φ'
    """
    bare = [name for name in dataset.dims if name not in dataset.coords]
    whole = dataset.assign_coords({name: np.arange(dataset.sizes[name]) for name in bare})
    known = {**SHARED, **variables}
    if unknown := [name for name in whole.variables if name not in known]:
        raise ModelError(f"{unknown[0]} is not declared among the VARIABLES of its study")
    for name in whole.variables:
        whole[name].attrs = known[str(name)].attributes()
    return whole


def described(
    data: Mapping[str, Any],
    coords: Mapping[str, Any] | None = None,
    variables: Mapping[str, Variable] = MappingProxyType({}),
) -> xr.Dataset:
    """A dataset of these variables with their attributes, see :func:`describe`.

    Raises
    ------
    ModelError
        If a name is neither in ``variables`` nor in :data:`SHARED`.

    Examples
    --------
    >>> described({"phase": ("point", [0.0])}).phase.attrs["units"]
    'rad'
    """
    return describe(xr.Dataset(data, coords), variables)
