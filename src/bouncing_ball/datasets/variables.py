"""The vocabulary of the datasets: every variable, with symbol, equation and budget.

A name means the same in every dataset. All quantities are dimensionless:
times are Ωt, lengths Ω²y/g, velocities Ωẏ/g, and phases and angles are in
radians of the table's motion. Units follow the CF conventions ("1", "rad").

A budget is how far a variable may move before the comparison with the accepted
record calls it a drift: |new - record| over the range of the record's values, or over
``scale``. Texts, counts, and yes or no are compared exactly. Budgets of numbers come from
the convergence study, the test that varies tolerances, grids and rounding: the power of ten
next above ten times the largest change. Other sources stand beside the number.
"""

import math
from collections.abc import Mapping
from typing import Any, NamedTuple

import numpy as np
import xarray as xr

ROUNDING = 1e-13
"""The least budget, for a number whose entry names no other."""
IGNORED = math.inf
"""The budget of what another dataset holds already, or what rounding decides."""


class Variable(NamedTuple):
    """What a variable is: in words, as in the paper, where it is defined, and its budget.

    Symbol and equation are empty where the paper has none.
    """

    long_name: str
    symbol: str = ""
    units: str = "1"
    equation: str = ""
    budget: float = ROUNDING
    scale: float | str | None = None
    """What a drift is a share of: a number, or a variable of the same dataset."""


class Budget(NamedTuple):
    """How far a variable may move, as a share of its scale.

    With ``over`` two curves are compared, through the samples along the dimension
    ``point`` and over that variable: the samples may slide along the curve.
    """

    size: float
    scale: float | str | None = None
    over: str = ""


VARIABLES: dict[str, Variable] = {
    # coordinates
    "n": Variable("index of the family of periodic orbits", "n", equation="Eq. 6"),
    "case": Variable("parameter set"),
    "frequency_ratio": Variable("frequency ratio of contact and table", "ϖ", equation="Eq. 11"),
    "point": Variable("point along the branch, at equal steps of arclength"),
    "sample": Variable("sample number"),
    "special": Variable("special point of the branch, in order of arclength"),
    "end": Variable("end of the branch"),
    "bound": Variable("end of the stability range"),
    "multiplier": Variable("Floquet multiplier, the larger modulus first", "μ"),
    "quantity": Variable("quantity compared between the two models"),
    "tolerance": Variable("relative error tolerated", equation="Eqs. 37-38"),
    "impact_map": Variable("map of the restitution model", equation="Eqs. 5, 8"),
    # parameters that appear as variables
    "restitution": Variable("restitution coefficient", "r", equation="Eq. 2"),
    "damping_ratio": Variable("damping ratio of the contact", "ζ", equation="Eq. 16"),
    "amplitude": Variable("excitation amplitude", "Λ", equation="Eq. 4"),
    # orbits
    "phase": Variable("phase of the table when the contact starts", "φ", "rad", "Eqs. 6, 21"),
    "release_phase": Variable(
        "phase of the table when the contact ends", "φ + τ_b", "rad", "Eq. 23"
    ),
    "contact_duration": Variable("duration of the contact", "τ_b", equation="Eq. 23"),
    "impact_velocity": Variable(
        "velocity of the ball as contact starts", "z′_i", equation="Eq. 22"
    ),
    "bounce_velocity": Variable("bouncing-off velocity of the ball", "z′_b", equation="Eq. 27"),
    "apparent_restitution": Variable(
        "apparent restitution coefficient", "r_a", equation="Eq. 17", budget=1e-12
    ),
    "max_height": Variable(
        "greatest height of the ball over the cycle", "max z", equation="Eq. 37"
    ),
    "labelled": Variable("whether the figure marks this frequency ratio"),
    "stable": Variable("whether both Floquet multipliers are inside the unit circle", "|μ| < 1"),
    "admissible": Variable("whether nothing else happens during the orbit"),
    "restitution_admissible": Variable(
        "whether nothing else happens during the restitution model's orbit"
    ),
    "grazing_amplitude": Variable("amplitude at which the unstable orbit grazes the table", "Λ"),
    "grazing_phase": Variable("phase at which the unstable orbit grazes the table", "φ", "rad"),
    "multiplier_real": Variable("real part of the Floquet multiplier", "Re μ"),
    "multiplier_imag": Variable("imaginary part of the Floquet multiplier", "Im μ"),
    "trace": Variable("trace of the monodromy", "tr"),
    "determinant": Variable("determinant of the monodromy", "det"),
    "residual": Variable(
        "largest defect of the orbit equations", equation="Eqs. 21-26", budget=1e-12, scale=1.0
    ),
    # special points
    "special_kind": Variable("kind of special point"),
    "special_amplitude": Variable("excitation amplitude at the special point", "Λ"),
    "special_phase": Variable("phase at the special point", "φ", "rad", "Eq. 21"),
    "special_contact_duration": Variable(
        "contact duration at the special point", "τ_b", equation="Eq. 23", budget=1e-12
    ),
    "special_residual": Variable(
        "residual of the extended system at the special point", budget=1e-12, scale=1.0
    ),
    "absence": Variable("why there is no stable range"),
    "end_reason": Variable("why the branch ends there"),
    # restitution model's limits
    "saddle_node_amplitude": Variable("amplitude of the saddle-node", "Λ_SN", equation="Eq. 7"),
    "saddle_node_phase": Variable("phase at the saddle-node", "φ_SN", "rad", "Eq. 6"),
    "period_doubling_amplitude": Variable(
        "amplitude of the period doubling", "Λ_PD", equation="Eq. 8"
    ),
    "period_doubling_phase": Variable("phase at the period doubling", "φ_PD", "rad", "Eq. 6"),
    # time histories
    "time": Variable("time since the first impact", "τ"),
    "table_phase": Variable("phase of the table", "τ + φ", "rad"),
    "ball": Variable("height of the ball", "z", equation="Eqs. 4, 12, 14"),
    "ball_velocity": Variable("velocity of the ball", "z′", equation="Eqs. 4, 13, 15"),
    "table": Variable("height of the table", "w", equation="Eq. 4"),
    "contact": Variable("whether the ball touches the table"),
    # the same quantities in the restitution model, for comparison
    "restitution_phase": Variable("phase of impact, restitution model", "φ_CR", "rad", "Eq. 6"),
    "restitution_amplitude": Variable("excitation amplitude, restitution model", "Λ"),
    "restitution_stable": Variable("whether the restitution model's orbit is stable"),
    "restitution_bounce_velocity": Variable(
        "bouncing-off velocity, restitution model", "nπ", equation="Eq. 6"
    ),
    "restitution_impact_velocity": Variable(
        "velocity before impact, restitution model", "-nπ", equation="Eq. 3"
    ),
    "restitution_max_height": Variable(
        "greatest height, restitution model", "max z_CR", equation="Eq. 37"
    ),
    "restitution_ball": Variable("height of the ball, restitution model", "z_CR", equation="Eq. 4"),
    # permanent contact
    "threshold_amplitude": Variable(
        "threshold of permanent contact", "Λ_SD, or Λ_F for the force release", equation="Eq. 33"
    ),
    "minimum_threshold": Variable(
        "lowest threshold of permanent contact", "2ζ√(1-ζ²)", equation="Eq. 36"
    ),
    "minimum_frequency_ratio": Variable(
        "where the lowest threshold is", "1/√(1-2ζ²)", equation="Eqs. 34-36"
    ),
    "restitution_threshold": Variable(
        "threshold of permanent contact, restitution model", "Λ_CR", equation="Eq. 9"
    ),
    # errors
    "relative_error": Variable("relative error of the restitution model", equation="Eqs. 37-38"),
    "error_threshold": Variable(
        "frequency ratio above which the relative error stays below the tolerance",
        "ϖ_1%",
        equation="Eqs. 37-38",
        budget=1e-10,
    ),
    "threshold_status": Variable("whether the threshold lies within the range scanned"),
    # orbits with a long contact
    "window_amplitude": Variable("upper end of the window of stable orbits above Λ_SD", "Λ"),
    "window_flight": Variable("time of flight at the upper end of the window", "T", budget=1e-12),
    "window_end": Variable("what ends the window of stable orbits"),
    "stiff_window": Variable("width of the window times ϖ², limit for ϖ → ∞", "ϖ²(Λ - Λ_SD)"),
    "joining_ratio": Variable("frequency ratio below which both families are one", "ϖ"),
    "motion": Variable("motion on which a ball ends"),
    "start_phase": Variable("phase of the table at the first impact", "φ", "rad"),
    "start_speed": Variable("relative speed at the first impact", "-δ′"),
    "destination": Variable("motion on which a start ends, index of the motion", budget=IGNORED),
    "basin_share": Variable("share of the starts that end on a motion", budget=1e-4, scale=1.0),
    "orbit_phase": Variable("phase of impact of the stable orbit", "φ", "rad"),
    "orbit_speed": Variable("relative speed of impact of the stable orbit", "-δ′"),
    "other_period": Variable("impacts after which the other motion repeats, 0 if unknown"),
    # kinds of motion
    "motion_period": Variable("impacts after which the motion repeats, 0 if it does not"),
    "lyapunov_exponent": Variable(
        "largest Lyapunov exponent, per impact", "λ", budget=5.0, scale="lyapunov_error"
    ),
    "lyapunov_error": Variable("standard error of the largest Lyapunov exponent", budget=0.5),
    # release rules
    "release": Variable("what ends a contact"),
    "reading": Variable("what is assumed, one reading of the paper each"),
    "bifurcation_amplitude": Variable("excitation amplitude of the bifurcation", "Λ"),
    "force_restitution": Variable("restitution coefficient of the force release", "r_F"),
    # other contact laws
    "law": Variable("law of the contact"),
    "duration_ratio": Variable(
        "π over the duration of the free impact, which stands for the frequency ratio", "π/D"
    ),
    "shown_ratio": Variable("π over the duration of the free impact, of a branch or row", "π/D"),
    # the corrected restitution model
    "model": Variable("model of the impact"),
    "coefficient": Variable("relative error times the frequency ratio, to first order", "K"),
    "second_order": Variable(
        "relative error of the corrected model times the squared frequency ratio", "C", budget=1e-7
    ),
    "law_threshold": Variable("frequency ratio for the tolerance by the error law", "|K|/ε"),
    "error_zero": Variable(
        "frequency ratio at which the error passes through zero", "ϖ", budget=1e-9
    ),
    "permanent_coefficient": Variable(
        "relative error of the permanent contact times the squared frequency ratio", "K₂"
    ),
    "permanent_law": Variable("frequency ratio for the tolerance by this law", "√(|K₂|/ε)"),
    "permanent_threshold": Variable("frequency ratio for the tolerance, permanent contact", "ϖ_PC"),
    "order": Variable("order of convergence of the relative error in 1/ϖ", budget=1e-4, scale=1.0),
    "law_sample": Variable("random orbit on which the error law is tried"),
    "law_remainder": Variable(
        "remainder of the error law over its stated scale", "M", budget=1e-4, scale=1.0
    ),
    "small_parameter": Variable("what must be small for the error law", "δ"),
    "stated_below": Variable("small parameter below which the error law is stated", "δ"),
    "amplitude_ratio": Variable("amplitude over that of the saddle-node", "Λ/Λ_SN"),
    "restitution_trace": Variable("trace of the monodromy, restitution model", "tr"),
    "restitution_period_doubling": Variable(
        "amplitude of the period doubling, restitution model", "Λ_PD"
    ),
    "corrected_phase": Variable("phase of impact, corrected model", "φ", "rad"),
    "corrected_trace": Variable("trace of the monodromy, corrected model", "tr"),
    "corrected_saddle_node": Variable("amplitude of the saddle-node, corrected model", "Λ_SN"),
    "corrected_period_doubling": Variable(
        "amplitude of the period doubling, corrected model", "Λ_PD"
    ),
    "corrected_max_height": Variable("greatest height, corrected model", "max z"),
    "flight_before": Variable("flight before the contact, continued", "z"),
    "flight_after": Variable("flight after the contact, continued backwards", "z"),
    "contact_force": Variable("force of the table over the weight", "F"),
    "meeting_time": Variable("time at which the continued flights meet", "t_c"),
    "meeting_height": Variable("height at which the continued flights meet", "z", budget=1e-12),
    "delay": Variable("delay of the instant by the law's signature", "t_c"),
    # the atlas
    "row": Variable("row of tiles: a release rule, an index n and a range of r"),
    "position": Variable(
        "place in the stable range of the restitution model, from its saddle-node at 0 to its "
        "period doubling at 1",
        "(Λ - Λ_SN)/(Λ_PD - Λ_SN)",
    ),
    "threshold_bin": Variable(
        "lower end of a bin of thresholds; 0: at every ϖ scanned, infinity: at none", "ϖ"
    ),
    "largest_threshold": Variable("ϖ from which the error of all nodes is tolerated", "ϖ"),
    "threshold_counts": Variable("number of nodes by the ϖ from which their error is tolerated"),
    "holding": Variable("number of nodes whose error is tolerated from this ϖ on"),
    "exceeding": Variable("number of nodes whose error exceeds the tolerance at this ϖ"),
    "largest_error": Variable("largest relative error of a node at this ϖ"),
    "worst_restitution": Variable("restitution coefficient of the node with this error", "r"),
    "worst_amplitude": Variable("amplitude of the node with this error", "Λ"),
    "law_stated": Variable("number of nodes for which the error law is stated"),
    "law_exceeding": Variable("number of these beyond the stated remainder"),
    "unstable": Variable("number of nodes whose exact orbit is not stable"),
    "sought": Variable("number of orbits that the walk did not reach, looked for directly"),
    "limit_quantity": Variable("limit of the stable range, or of permanent contact"),
    "needed": Variable("ϖ from which the error of all nodes of a tile is tolerated", "ϖ"),
    "limit_needed": Variable(
        "ϖ from which the error of all limits of a range of r is tolerated", "ϖ"
    ),
    "needed_quantile": Variable("ϖ from which the error of a share of nodes is tolerated", "ϖ"),
    "share": Variable("share of nodes"),
    "holding_share": Variable("share of nodes whose error is tolerated from this ϖ on"),
    "exceeding_share": Variable("share of nodes whose error exceeds the tolerance at this ϖ"),
    "failing_restitution": Variable("r below which all nodes lie on which it fails", "r"),
    "failing_position": Variable("position below which all nodes lie on which it fails"),
    "unstable_share": Variable("share of nodes whose exact orbit is not stable"),
    "worst_error": Variable("largest relative error where the rule of thumb begins"),
    "restitution_edge": Variable("ends of the ranges of r", "r"),
    "position_edge": Variable("ends of the ranges of positions"),
    "law_coefficient": Variable("modulus of the error law's K in the middle of the tile", "|K|"),
    "limit_law_needed": Variable("ϖ for the tolerance by the error law", "(|K|/ε)^(1/order)"),
    "sought_orbits": Variable("orbits that the walk did not reach, looked for directly"),
    "resolution": Variable("largest relative step of ϖ: a threshold lies within one"),
    "summary_tolerance": Variable("relative error tolerated in the summary"),
    "rule_of_thumb": Variable("frequency ratio that is said to be enough", "ϖ"),
    # witness
    "artifact": Variable("figure or table whose orbits are compared"),
    "comparison": Variable("the two routes compared"),
    "disagreement": Variable("largest disagreement between two routes", budget=1.0, scale="budget"),
    "budget": Variable("disagreement allowed"),
    "orbits": Variable("number of orbits or bifurcations compared"),
    # formulas
    "formula": Variable("printed formula"),
    "compared_with": Variable("what the formula is compared with"),
    "static_error": Variable(
        "relative error of Eq. 16 on a table at rest, with gravity", equation="Eq. 16", budget=1e-12
    ),
    "curve_points": Variable("random points of the explicit curve"),
    "curve_points_admissible": Variable("those of them with one impact per period"),
    # numbers printed with the claims
    "period_doubling_turn": Variable(
        "frequency ratio at which the period doubling is lowest", "ϖ", budget=1e-5
    ),
    "orbit": Variable("orbit along the frequency ratio, curve of a figure"),
    "measure": Variable("quantity compared along these orbits"),
    "stiff_orbit_error": Variable(
        "largest relative error of an orbit among stiff contacts", budget=1e-12
    ),
    "apparent_restitution_law_error": Variable(
        "largest error of 1 - Λ sin φ as the limit of nπϖ(r - r_a)/[ζ(1 + r)²] on Fig. 6",
        budget=1e-10,
        scale=1.0,
    ),
    "short_of_lift": Variable("smallest 1 - Λ sin φ of Fig. 6, with φ of Eq. 6", budget=1e-11),
    "inadmissible_orbits": Variable("orbits drawn that do not have one impact per period"),
    "range_error": Variable("relative error of the ends of the stability range", budget=1e-12),
    "printed_slight_move": Variable(
        "largest relative move of a printed end from the stiffest row to the next",
        equation="Table 1",
    ),
    "period_doubling_lowest": Variable(
        "ϖ at which the period doubling is lowest", "ϖ", budget=1e-5
    ),
    "permanent_contact_error": Variable(
        "relative error of Λ_CR at the printed threshold", equation="Eq. 38"
    ),
    # claims: the paper against the replication
    "claim": Variable("claim of the paper"),
    "section": Variable("section of the paper"),
    "item": Variable("figure, table or equation of the paper"),
    "kind": Variable("number, formula or statement"),
    "group": Variable("what the claim is counted as"),
    "restates": Variable("claim that it says again"),
    "statement": Variable("what the claim says"),
    "printed_text": Variable("the number as printed"),
    "legibility": Variable("how legible the claim is in the text at hand"),
    "remark": Variable("how the claim was read"),
    "condition": Variable("condition that decides a statement in words"),
    "decided_by": Variable("datasets that decide"),
    "required": Variable("the number as printed, or the bound to be met"),
    "limit": Variable("the bound to be met, as a number", budget=IGNORED),
    "found": Variable("the number found", budget=IGNORED),
    "deviation_units": Variable("deviation in units of the last printed digit", budget=IGNORED),
    "deviation": Variable("relative deviation", budget=IGNORED),
    "verdict": Variable("reproduced, close, contradicted, undecidable or not asked"),
    "printed_table": Variable("the printed table whose entry the claim is"),
    "reason": Variable("why a claim is undecidable or not asked"),
    "explained_by": Variable("name of the explanation"),
    "explained": Variable("reproduced, not asked, or explained by checks that hold"),
    "explanation": Variable("explanation of claims that are not reproduced"),
    "explanation_text": Variable("the explanation in words"),
    "explanation_checks": Variable(
        "the checks of the explanation, with the numbers found", budget=IGNORED
    ),
    "explanation_holds": Variable("whether the checks of the explanation hold"),
    # Table 1
    "computed": Variable("end of the stability range, this replication", "Λ"),
    "printed": Variable("end of the stability range, as printed", "Λ", equation="Table 1"),
    "restitution_range": Variable("end of the stability range, restitution model", "Λ"),
    # forensics
    "rows": Variable("rows of the table that are compared", equation="Table 1"),
    "rank": Variable("place of the reading, the closest to the printed table first"),
    "description": Variable("what the reading assumes, in words"),
    "difference": Variable("computed less printed value, in units of the last digit", budget=1e-8),
    "largest_difference": Variable("largest difference, in units of the last digit", budget=1e-8),
    "rms_difference": Variable(
        "root mean square difference, in units of the last digit", budget=1e-8
    ),
    "reproduced": Variable("number of entries within half a unit of the last digit"),
    "entries": Variable("number of entries compared"),
    "unreachable": Variable("number of saddle-nodes printed below every computed orbit"),
}


# The fields of a variable that its dataset carries.
_ATTRIBUTES = ("long_name", "symbol", "units", "equation")


def _branch(curve: float, multiplier: float) -> dict[str, Budget]:
    """Budgets of a continued branch: with one chord all of its points move along the curve."""
    observed = "phase release_phase contact_duration impact_velocity bounce_velocity"
    return {
        "amplitude": Budget(curve, over="phase"),
        **dict.fromkeys(observed.split(), Budget(curve, over="amplitude")),
        "apparent_restitution": Budget(curve, over="amplitude"),
        "multiplier_real": Budget(multiplier, over="amplitude"),
        "multiplier_imag": Budget(multiplier, over="amplitude"),
        **_one_sample_of(601),
    }


def _one_sample_of(count: int) -> dict[str, Budget]:
    """Where a bifurcation or a grazing falls on a sample, rounding decides it."""
    names = ("stable", "admissible", "restitution_stable", "restitution_admissible")
    return dict.fromkeys(names, Budget(1.2 / (count - 1), over="point"))


ARTIFACTS: dict[str, dict[str, Budget]] = {
    "fig03": _one_sample_of(401),
    "fig08": _branch(1e-6, 1e-4),
    "fig09": _branch(1e-8, 1e-5),
    "fig15": _branch(1e-8, 1e-5),
    # A hundred times the largest disagreement of the page with Python, over the size of the
    # quantity where that is above 1; a contact's force is in proportion to ϖ.
    "explorer": {
        "*": Budget(1e-11, scale=1.0),
        "contact_force": Budget(1e-11, scale="frequency_ratio"),
    },
    # Next to a saddle-node an error hardly falls with the frequency ratio.
    "ext_validity": {"error_threshold": Budget(1e-9)},
    # The second order of a stiff contact is a small difference of large values.
    "ext_orders": {"relative_error": Budget(1e-11)},
    # Collocated orbits, each right to some 1e-13.
    "ext_hertz": {
        **dict.fromkeys(("bifurcation_amplitude", "phase"), Budget(1e-12)),
        "threshold_amplitude": Budget(1e-8),
    },
    # Saddle-nodes are found as minima here, and some readings are ill-conditioned.
    "forensics": {"computed": Budget(1e-8)},
}
"""Budgets of single artifacts, by variable; ``*`` stands for all that are not named."""


def budget_of(artifact: str, variable: str) -> Budget | None:
    """The budget of a variable of an artifact's dataset; None for an unknown variable.

    Examples
    --------
    >>> budget_of("fig05", "phase"), budget_of("fig08", "phase")
    (Budget(size=1e-13, scale=None, over=''), Budget(size=1e-06, scale=None, over='amplitude'))
    """
    own = ARTIFACTS.get(artifact, {})
    entry = VARIABLES.get(variable)
    of_all = entry and Budget(entry.budget, entry.scale)
    return own.get(variable, own.get("*", of_all))


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
        entry = VARIABLES[str(name)]
        whole[name].attrs = dict(zip(_ATTRIBUTES, entry, strict=False))
    return whole


def described(variables: Mapping[str, Any], coords: Mapping[str, Any] | None = None) -> xr.Dataset:
    """A dataset of these variables, with the attributes of all: see :func:`describe`."""
    return describe(xr.Dataset(variables, coords))
