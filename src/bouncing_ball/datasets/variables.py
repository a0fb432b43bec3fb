"""The variables of datasets: name, symbol, unit, equation and budget of each.

A name has the same meaning in every dataset. All quantities are dimensionless:
times are Ωt, lengths Ω²y/g, velocities Ωẏ/g, and phases and angles are in
radians of the table's motion. Units follow the CF conventions ("1", "rad").
"""

import math
from collections.abc import Mapping
from types import MappingProxyType
from typing import Any, NamedTuple

import numpy as np
import xarray as xr

from bouncing_ball.errors import ModelError


class Variable(NamedTuple):
    """What a dataset says of one of its variables.

    ``symbol`` and ``equation`` are empty if the paper has none for it. ``budget`` is the largest
    change from the accepted record, as a share of ``scale``: of 1, of another variable, or, if it is
    empty, of the range of the values; without a budget only rounding may change the variable.
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


SHARED = {
    "n": Variable("index of the family of periodic orbits", symbol="n", equation="Eq. 6"),
    "case": Variable("parameter set"),
    "frequency_ratio": Variable(
        "frequency ratio of contact and table", symbol="ϖ", equation="Eq. 11"
    ),
    "point": Variable("point along the branch, at equal steps of arclength"),
    "sample": Variable("sample number"),
    "bound": Variable("end of the stability range"),
    "quantity": Variable("quantity compared between the two models"),
    "tolerance": Variable("relative error tolerated", equation="Eqs. 37-38"),
    "impact_map": Variable("map of the restitution model", equation="Eqs. 5, 8"),
    "restitution": Variable("restitution coefficient", symbol="r", equation="Eq. 2"),
    "damping_ratio": Variable("damping ratio of the contact", symbol="ζ", equation="Eq. 16"),
    "amplitude": Variable("excitation amplitude", symbol="Λ", equation="Eq. 4"),
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
    "absence": Variable("why there is no stable range"),
    "saddle_node_amplitude": Variable(
        "amplitude of the saddle-node", symbol="Λ_SN", equation="Eq. 7"
    ),
    "saddle_node_phase": Variable(
        "phase at the saddle-node", symbol="φ_SN", units="rad", equation="Eq. 6"
    ),
    "period_doubling_amplitude": Variable(
        "amplitude of the period doubling", symbol="Λ_PD", equation="Eq. 8"
    ),
    "period_doubling_turn": Variable(
        "frequency ratio at which the period doubling is lowest", symbol="ϖ", budget=1e-05
    ),
    "period_doubling_phase": Variable(
        "phase at the period doubling", symbol="φ_PD", units="rad", equation="Eq. 6"
    ),
    "time": Variable("time since the first impact", symbol="τ"),
    "ball": Variable("height of the ball", symbol="z", equation="Eqs. 4, 12, 14"),
    "ball_velocity": Variable("velocity of the ball", symbol="z′", equation="Eqs. 4, 13, 15"),
    "table": Variable("height of the table", symbol="w", equation="Eq. 4"),
    "restitution_phase": Variable(
        "phase of impact, restitution model", symbol="φ_CR", units="rad", equation="Eq. 6"
    ),
    "threshold_amplitude": Variable(
        "threshold of permanent contact",
        symbol="Λ_SD, or Λ_F for the force release",
        equation="Eq. 33",
    ),
    "relative_error": Variable("relative error of the restitution model", equation="Eqs. 37-38"),
    "error_threshold": Variable(
        "frequency ratio above which the relative error stays below the tolerance",
        symbol="ϖ_1%",
        equation="Eqs. 37-38",
        budget=1e-10,
    ),
    "threshold_status": Variable("whether the threshold lies within the range scanned"),
    "motion": Variable("motion on which a ball ends"),
    "start_phase": Variable("phase of the table at the first impact", symbol="φ", units="rad"),
    "lyapunov_exponent": Variable(
        "largest Lyapunov exponent, per period of the table",
        symbol="λ",
        budget=5.0,
        scale="lyapunov_error",
    ),
    "lyapunov_error": Variable("standard error of the largest Lyapunov exponent", budget=0.5),
    "release": Variable("what ends a contact"),
    "reading": Variable("what is assumed, one reading of the paper each"),
    "model": Variable("model of the impact"),
    "contact_force": Variable("force of the table over the weight", symbol="F"),
    "disagreement": Variable("largest disagreement between two routes", budget=1.0, scale="budget"),
    "budget": Variable("disagreement allowed"),
    "digits_lost": Variable(
        "decimal digits of the start that the motion has lost on the way", budget=math.inf
    ),
    "computed": Variable("end of the stability range, this replication", symbol="Λ"),
    "printed": Variable("end of the stability range, as printed", symbol="Λ", equation="Table 1"),
    "height": Variable("height from which the ball falls", symbol="h"),
    "periods": Variable("periods of the table after which the motion repeats, 0 if it does not"),
    "impacts": Variable("impacts until the motion repeats, 0 if it does not"),
    "end_velocity": Variable("velocity of the ball before that impact"),
    "start": Variable("start of a ball at one amplitude"),
    "impact": Variable("impact of the motion on which the ball ends"),
    "impact_phase": Variable(
        "phase of the table at an impact of the motion on which the ball ends",
        symbol="φ",
        units="rad",
    ),
    "impact_speed": Variable(
        "speed of the ball towards the table at an impact of the motion on which it ends"
    ),
    "motion_kind": Variable("kind of one of the motions on which balls end"),
    "motion_periods": Variable("periods of the table after which one of the motions repeats"),
    "motion_impacts": Variable("impacts until one of the motions repeats"),
    "share_error": Variable("standard error of a share"),
    "simple": Variable("simple model with which the contact is compared"),
    "needed_ratio": Variable(
        "smallest of the frequency ratios tried from which on the error is known to be within the tolerance",
        symbol="ϖ",
    ),
    "shift": Variable("change of the amplitude"),
    "uncertainty_exponent": Variable(
        "exponent of the share that a change of this size moves", symbol="α"
    ),
    "uncertainty_exponent_low": Variable(
        "lower limit of the confidence interval of the exponent of uncertainty"
    ),
    "uncertainty_exponent_high": Variable(
        "upper limit of the confidence interval of the exponent of uncertainty"
    ),
    "case_restitution": Variable("restitution coefficient of a case", symbol="r"),
    "case_amplitude": Variable("amplitude of a case", symbol="Λ"),
    "kind": Variable("kind of motion on which the ball ends"),
    "orbits": Variable("number of orbits or bifurcations compared"),
    "contact": Variable("whether the ball touches the table"),
    "residual": Variable(
        "largest defect of the orbit equations", equation="Eqs. 21-26", budget=1e-12, scale="1"
    ),
    "destination": Variable("motion on which a start ends, index of the motion", budget=math.inf),
    "item": Variable("figure, table or equation of the paper"),
    "special_kind": Variable("kind of special point"),
    "special_amplitude": Variable("excitation amplitude at the special point", symbol="Λ"),
    "special_phase": Variable(
        "phase at the special point", symbol="φ", units="rad", equation="Eq. 21"
    ),
    "special_contact_duration": Variable(
        "contact duration at the special point", symbol="τ_b", equation="Eq. 23", budget=1e-12
    ),
    "special_residual": Variable(
        "residual of the extended system at the special point", budget=1e-12, scale="1"
    ),
    "multiplier_real": Variable("real part of the Floquet multiplier", symbol="Re μ"),
    "multiplier_imag": Variable("imaginary part of the Floquet multiplier", symbol="Im μ"),
    "end_reason": Variable("why the branch ends there"),
    "special": Variable("special point of the branch, in order of arclength"),
    "end": Variable("end of the branch"),
    "multiplier": Variable("Floquet multiplier, the larger modulus first", symbol="μ"),
    "share": Variable("share of nodes"),
    "reason": Variable("why a claim or a motion is undecided"),
    "end_phase": Variable(
        "phase of the table at an impact of the motion on which the ball ends", units="rad"
    ),
    "start_speed": Variable("relative speed at the first impact", symbol="-δ′"),
    "end_speed": Variable("speed of the ball towards the table at that impact", symbol="-δ′"),
}
"""The variables that datasets of several stages have; the others are declared beside their study."""


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
