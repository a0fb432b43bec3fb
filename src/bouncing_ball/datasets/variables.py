"""The vocabulary of the datasets: every variable, with symbol and equation.

A name means the same in every dataset. All quantities are dimensionless:
times are Ωt, lengths Ω²y/g, velocities Ωẏ/g, and phases and angles are in
radians of the table's motion. Units follow the CF conventions ("1", "rad").
How far a variable may move from the accepted record stands in
:mod:`bouncing_ball.compare.budgets`.
"""

from collections.abc import Mapping
from typing import Any

import numpy as np
import xarray as xr

VARIABLES: dict[str, tuple[str, ...]] = {
    # coordinates
    "n": ("index of the family of periodic orbits", "n", "Eq. 6"),
    "case": ("parameter set",),
    "frequency_ratio": ("frequency ratio of contact and table", "ϖ", "Eq. 11"),
    "point": ("point along the branch, at equal steps of arclength",),
    "sample": ("sample number",),
    "special": ("special point of the branch, in order of arclength",),
    "end": ("end of the branch",),
    "bound": ("end of the stability range",),
    "multiplier": ("Floquet multiplier, the larger modulus first", "μ"),
    "quantity": ("quantity compared between the two models",),
    "tolerance": ("relative error tolerated", "", "Eqs. 37-38"),
    "impact_map": ("map of the restitution model", "", "Eqs. 5, 8"),
    # parameters that appear as variables
    "restitution": ("restitution coefficient", "r", "Eq. 2"),
    "damping_ratio": ("damping ratio of the contact", "ζ", "Eq. 16"),
    "amplitude": ("excitation amplitude", "Λ", "Eq. 4"),
    # orbits
    "phase": ("phase of the table when the contact starts", "φ", "Eqs. 6, 21"),
    "release_phase": ("phase of the table when the contact ends", "φ + τ_b", "Eq. 23"),
    "contact_duration": ("duration of the contact", "τ_b", "Eq. 23"),
    "impact_velocity": ("velocity of the ball as contact starts", "z′_i", "Eq. 22"),
    "bounce_velocity": ("bouncing-off velocity of the ball", "z′_b", "Eq. 27"),
    "apparent_restitution": ("apparent restitution coefficient", "r_a", "Eq. 17"),
    "max_height": ("greatest height of the ball over the cycle", "max z", "Eq. 37"),
    "labelled": ("whether the figure marks this frequency ratio",),
    "stable": ("whether both Floquet multipliers are inside the unit circle", "|μ| < 1"),
    "admissible": ("whether nothing else happens during the orbit",),
    "restitution_admissible": (
        "whether nothing else happens during the restitution model's orbit",
    ),
    "grazing_amplitude": ("amplitude at which the unstable orbit grazes the table", "Λ"),
    "grazing_phase": ("phase at which the unstable orbit grazes the table", "φ"),
    "multiplier_real": ("real part of the Floquet multiplier", "Re μ"),
    "multiplier_imag": ("imaginary part of the Floquet multiplier", "Im μ"),
    "trace": ("trace of the monodromy", "tr"),
    "determinant": ("determinant of the monodromy", "det"),
    "residual": ("largest defect of the orbit equations", "", "Eqs. 21-26"),
    # special points
    "special_kind": ("kind of special point",),
    "special_amplitude": ("excitation amplitude at the special point", "Λ"),
    "special_phase": ("phase at the special point", "φ", "Eq. 21"),
    "special_contact_duration": ("contact duration at the special point", "τ_b", "Eq. 23"),
    "special_residual": ("residual of the extended system at the special point",),
    "absence": ("why there is no stable range",),
    "end_reason": ("why the branch ends there",),
    # restitution model's limits
    "saddle_node_amplitude": ("amplitude of the saddle-node", "Λ_SN", "Eq. 7"),
    "saddle_node_phase": ("phase at the saddle-node", "φ_SN", "Eq. 6"),
    "period_doubling_amplitude": ("amplitude of the period doubling", "Λ_PD", "Eq. 8"),
    "period_doubling_phase": ("phase at the period doubling", "φ_PD", "Eq. 6"),
    # time histories
    "time": ("time since the first impact", "τ"),
    "table_phase": ("phase of the table", "τ + φ"),
    "ball": ("height of the ball", "z", "Eqs. 4, 12, 14"),
    "ball_velocity": ("velocity of the ball", "z′", "Eqs. 4, 13, 15"),
    "table": ("height of the table", "w", "Eq. 4"),
    "contact": ("whether the ball touches the table",),
    # the same quantities in the restitution model, for comparison
    "restitution_phase": ("phase of impact, restitution model", "φ_CR", "Eq. 6"),
    "restitution_amplitude": ("excitation amplitude, restitution model", "Λ"),
    "restitution_stable": ("whether the restitution model's orbit is stable",),
    "restitution_bounce_velocity": ("bouncing-off velocity, restitution model", "nπ", "Eq. 6"),
    "restitution_impact_velocity": ("velocity before impact, restitution model", "-nπ", "Eq. 3"),
    "restitution_max_height": ("greatest height, restitution model", "max z_CR", "Eq. 37"),
    "restitution_ball": ("height of the ball, restitution model", "z_CR", "Eq. 4"),
    # permanent contact
    "threshold_amplitude": (
        "threshold of permanent contact",
        "Λ_SD, or Λ_F for the force release",
        "Eq. 33",
    ),
    "minimum_threshold": ("lowest threshold of permanent contact", "2ζ√(1-ζ²)", "Eq. 36"),
    "minimum_frequency_ratio": ("where the lowest threshold is", "1/√(1-2ζ²)", "Eqs. 34-36"),
    "restitution_threshold": ("threshold of permanent contact, restitution model", "Λ_CR", "Eq. 9"),
    # errors
    "relative_error": ("relative error of the restitution model", "", "Eqs. 37-38"),
    "error_threshold": (
        "frequency ratio above which the relative error stays below the tolerance",
        "ϖ_1%",
        "Eqs. 37-38",
    ),
    "threshold_status": ("whether the threshold lies within the range scanned",),
    # orbits with a long contact
    "window_amplitude": ("upper end of the window of stable orbits above Λ_SD", "Λ"),
    "window_flight": ("time of flight at the upper end of the window", "T"),
    "window_end": ("what ends the window of stable orbits",),
    "stiff_window": ("width of the window times ϖ², limit for ϖ → ∞", "ϖ²(Λ - Λ_SD)"),
    "joining_ratio": ("frequency ratio below which both families are one", "ϖ"),
    "motion": ("motion on which a ball ends",),
    "start_phase": ("phase of the table at the first impact", "φ"),
    "start_speed": ("relative speed at the first impact", "-δ′"),
    "destination": ("motion on which a start ends, index of the motion",),
    "basin_share": ("share of the starts that end on a motion",),
    "orbit_phase": ("phase of impact of the stable orbit", "φ"),
    "orbit_speed": ("relative speed of impact of the stable orbit", "-δ′"),
    "other_period": ("impacts after which the other motion repeats, 0 if unknown",),
    # kinds of motion
    "motion_period": ("impacts after which the motion repeats, 0 if it does not",),
    "lyapunov_exponent": ("largest Lyapunov exponent, per impact", "λ"),
    "lyapunov_error": ("standard error of the largest Lyapunov exponent",),
    # release rules
    "release": ("what ends a contact",),
    "reading": ("what is assumed, one reading of the paper each",),
    "bifurcation_amplitude": ("excitation amplitude of the bifurcation", "Λ"),
    "force_restitution": ("restitution coefficient of the force release", "r_F"),
    # other contact laws
    "law": ("law of the contact",),
    "duration_ratio": (
        "π over the duration of the free impact, which stands for the frequency ratio",
        "π/D",
    ),
    "shown_ratio": ("π over the duration of the free impact, of a branch or row", "π/D"),
    # the corrected restitution model
    "model": ("model of the impact",),
    "coefficient": ("relative error times the frequency ratio, to first order", "K"),
    "second_order": (
        "relative error of the corrected model times the squared frequency ratio",
        "C",
    ),
    "law_threshold": ("frequency ratio for the tolerance by the error law", "|K|/ε"),
    "error_zero": ("frequency ratio at which the error passes through zero", "ϖ"),
    "permanent_coefficient": (
        "relative error of the permanent contact times the squared frequency ratio",
        "K₂",
    ),
    "permanent_law": ("frequency ratio for the tolerance by this law", "√(|K₂|/ε)"),
    "permanent_threshold": ("frequency ratio for the tolerance, permanent contact", "ϖ_PC"),
    "order": ("order of convergence of the relative error in 1/ϖ",),
    "law_sample": ("random orbit on which the error law is tried",),
    "law_remainder": ("remainder of the error law over its stated scale", "M"),
    "small_parameter": ("what must be small for the error law", "δ"),
    "stated_below": ("small parameter below which the error law is stated", "δ"),
    "amplitude_ratio": ("amplitude over that of the saddle-node", "Λ/Λ_SN"),
    "restitution_trace": ("trace of the monodromy, restitution model", "tr"),
    "restitution_period_doubling": ("amplitude of the period doubling, restitution model", "Λ_PD"),
    "corrected_phase": ("phase of impact, corrected model", "φ"),
    "corrected_trace": ("trace of the monodromy, corrected model", "tr"),
    "corrected_saddle_node": ("amplitude of the saddle-node, corrected model", "Λ_SN"),
    "corrected_period_doubling": ("amplitude of the period doubling, corrected model", "Λ_PD"),
    "corrected_max_height": ("greatest height, corrected model", "max z"),
    "flight_before": ("flight before the contact, continued", "z"),
    "flight_after": ("flight after the contact, continued backwards", "z"),
    "contact_force": ("force of the table over the weight", "F"),
    "meeting_time": ("time at which the continued flights meet", "t_c"),
    "meeting_height": ("height at which the continued flights meet", "z"),
    "delay": ("delay of the instant by the law's signature", "t_c"),
    # the atlas
    "row": ("row of tiles: a release rule, an index n and a range of r",),
    "position": (
        "place in the stable range of the restitution model, from its saddle-node at 0 to its "
        "period doubling at 1",
        "(Λ - Λ_SN)/(Λ_PD - Λ_SN)",
    ),
    "threshold_bin": (
        "lower end of a bin of thresholds; 0: at every ϖ scanned, infinity: at none",
        "ϖ",
    ),
    "largest_threshold": ("ϖ from which the error of all nodes is tolerated", "ϖ"),
    "threshold_counts": ("number of nodes by the ϖ from which their error is tolerated",),
    "holding": ("number of nodes whose error is tolerated from this ϖ on",),
    "exceeding": ("number of nodes whose error exceeds the tolerance at this ϖ",),
    "largest_error": ("largest relative error of a node at this ϖ",),
    "worst_restitution": ("restitution coefficient of the node with this error", "r"),
    "worst_amplitude": ("amplitude of the node with this error", "Λ"),
    "law_stated": ("number of nodes for which the error law is stated",),
    "law_exceeding": ("number of these beyond the stated remainder",),
    "unstable": ("number of nodes whose exact orbit is not stable",),
    "sought": ("number of orbits that the walk did not reach, looked for directly",),
    "limit_quantity": ("limit of the stable range, or of permanent contact",),
    "needed": ("ϖ from which the error of all nodes of a tile is tolerated", "ϖ"),
    "limit_needed": ("ϖ from which the error of all limits of a range of r is tolerated", "ϖ"),
    "needed_quantile": ("ϖ from which the error of a share of nodes is tolerated", "ϖ"),
    "share": ("share of nodes",),
    "holding_share": ("share of nodes whose error is tolerated from this ϖ on",),
    "exceeding_share": ("share of nodes whose error exceeds the tolerance at this ϖ",),
    "failing_restitution": ("r below which all nodes lie on which it fails", "r"),
    "failing_position": ("position below which all nodes lie on which it fails",),
    "unstable_share": ("share of nodes whose exact orbit is not stable",),
    "worst_error": ("largest relative error where the rule of thumb begins",),
    "restitution_edge": ("ends of the ranges of r", "r"),
    "position_edge": ("ends of the ranges of positions",),
    "law_coefficient": ("modulus of the error law's K in the middle of the tile", "|K|"),
    "limit_law_needed": ("ϖ for the tolerance by the error law", "(|K|/ε)^(1/order)"),
    "sought_orbits": ("orbits that the walk did not reach, looked for directly",),
    "resolution": ("largest relative step of ϖ: a threshold lies within one",),
    "summary_tolerance": ("relative error tolerated in the summary",),
    "rule_of_thumb": ("frequency ratio that is said to be enough", "ϖ"),
    # witness
    "artifact": ("figure or table whose orbits are compared",),
    "comparison": ("the two routes compared",),
    "disagreement": ("largest disagreement between two routes",),
    "budget": ("disagreement allowed",),
    "orbits": ("number of orbits or bifurcations compared",),
    # formulas
    "formula": ("printed formula",),
    "compared_with": ("what the formula is compared with",),
    "static_error": ("relative error of Eq. 16 on a table at rest, with gravity", "", "Eq. 16"),
    "curve_points": ("random points of the explicit curve",),
    "curve_points_admissible": ("those of them with one impact per period",),
    # numbers printed with the claims
    "period_doubling_turn": ("frequency ratio at which the period doubling is lowest", "ϖ"),
    "orbit": ("orbit along the frequency ratio, curve of a figure",),
    "measure": ("quantity compared along these orbits",),
    "stiff_orbit_error": ("largest relative error of an orbit among stiff contacts",),
    "apparent_restitution_law_error": (
        "largest error of 1 - Λ sin φ as the limit of nπϖ(r - r_a)/[ζ(1 + r)²] on Fig. 6",
    ),
    "short_of_lift": ("smallest 1 - Λ sin φ of Fig. 6, with φ of Eq. 6",),
    "inadmissible_orbits": ("orbits drawn that do not have one impact per period",),
    "range_error": ("relative error of the ends of the stability range",),
    "printed_slight_move": (
        "largest relative move of a printed end from the stiffest row to the next",
        "",
        "Table 1",
    ),
    "period_doubling_lowest": ("ϖ at which the period doubling is lowest", "ϖ"),
    "permanent_contact_error": ("relative error of Λ_CR at the printed threshold", "", "Eq. 38"),
    # claims: the paper against the replication
    "claim": ("claim of the paper",),
    "section": ("section of the paper",),
    "item": ("figure, table or equation of the paper",),
    "kind": ("number, formula or statement",),
    "group": ("what the claim is counted as",),
    "restates": ("claim that it says again",),
    "statement": ("what the claim says",),
    "printed_text": ("the number as printed",),
    "legibility": ("how legible the claim is in the text at hand",),
    "remark": ("how the claim was read",),
    "condition": ("condition that decides a statement in words",),
    "decided_by": ("datasets that decide",),
    "required": ("the number as printed, or the bound to be met",),
    "limit": ("the bound to be met, as a number",),
    "found": ("the number found",),
    "deviation_units": ("deviation in units of the last printed digit",),
    "deviation": ("relative deviation",),
    "verdict": ("reproduced, close, contradicted, undecidable or not asked",),
    "printed_table": ("the printed table whose entry the claim is",),
    "reason": ("why a claim is undecidable or not asked",),
    "explained_by": ("name of the explanation",),
    "explained": ("reproduced, not asked, or explained by checks that hold",),
    "explanation": ("explanation of claims that are not reproduced",),
    "explanation_text": ("the explanation in words",),
    "explanation_checks": ("the checks of the explanation, with the numbers found",),
    "explanation_holds": ("whether the checks of the explanation hold",),
    # Table 1
    "computed": ("end of the stability range, this replication", "Λ"),
    "printed": ("end of the stability range, as printed", "Λ", "Table 1"),
    "restitution_range": ("end of the stability range, restitution model", "Λ"),
    # forensics
    "rows": ("rows of the table that are compared", "", "Table 1"),
    "rank": ("place of the reading, the closest to the printed table first",),
    "description": ("what the reading assumes, in words",),
    "difference": ("computed less printed value, in units of the last digit",),
    "largest_difference": ("largest difference, in units of the last digit",),
    "rms_difference": ("root mean square difference, in units of the last digit",),
    "reproduced": ("number of entries within half a unit of the last digit",),
    "entries": ("number of entries compared",),
    "unreachable": ("number of saddle-nodes printed below every computed orbit",),
}
"""What a variable is in words, its symbol in the paper and where it is defined, as far as it has
them."""


def attributes(name: str) -> dict[str, str]:
    """The attributes of a variable; what is an angle is called a phase.

    Raises
    ------
    KeyError
        If the name is not in :data:`VARIABLES`.

    Examples
    --------
    >>> attributes("saddle_node_phase")
    {'long_name': 'phase at the saddle-node', 'symbol': 'φ_SN', 'units': 'rad', 'equation': 'Eq. 6'}
    """
    long_name, symbol, equation = (*VARIABLES[name], "", "")[:3]
    units = "rad" if name.endswith("phase") else "1"
    return {"long_name": long_name, "symbol": symbol, "units": units, "equation": equation}


def describe(dataset: xr.Dataset) -> xr.Dataset:
    """The dataset with the attributes of every variable and coordinate.

    Dimensions without a coordinate get their index as one.

    Raises
    ------
    KeyError
        If a name is not in :data:`VARIABLES`.

    Examples
    --------
    >>> describe(xr.Dataset({"phase": ("point", [0.0])})).phase.attrs["symbol"]
    'φ'
    """
    bare = [name for name in dataset.dims if name not in dataset.coords]
    whole = dataset.assign_coords({name: np.arange(dataset.sizes[name]) for name in bare})
    for name in whole.variables:
        whole[name].attrs = attributes(str(name))
    return whole


def described(variables: Mapping[str, Any], coords: Mapping[str, Any] | None = None) -> xr.Dataset:
    """A dataset of these variables, with the attributes of all: see :func:`describe`."""
    return describe(xr.Dataset(variables, coords))
