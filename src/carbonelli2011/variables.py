"""What each variable of the datasets means, and its tolerance (`paper_replication.datasets`).

The usual tolerance, 1e-9, allows for the rounding of other processors and versions of numpy: the
orbits are solved to about 1e-13, and a bifurcation amplifies this error by some powers of ten.
Below the floor the tolerance is absolute, because a zero is not met to the last bit.

Symbols of the models mean the same in every dataset: `SYMBOLS`. All other variables belong to the
dataset that has them: `OF_DATASET`.
"""

from paper_replication.datasets import Variable

REFERENCE = (
    "Carbonelli, Perret-Liaudet, Rigaud and Feki, Investigation of restitution coefficient and "
    "spring-damper models for the bouncing ball problem, DETC2011-47870 (2011)"
)

SYMBOLS = {
    # Coordinates
    "amplitude": Variable("amplitude of the table", "Λ", "Eq. 4"),
    "case": Variable("parameter set"),
    "end": Variable("end of the branch"),
    "frequency_ratio": Variable("frequency ratio of contact and table", "ϖ", "Eq. 11"),
    "impact_map": Variable("map of the restitution model", equation="Eqs. 5, 8"),
    "multiplier": Variable("Floquet multiplier, in order of decreasing modulus", "μ"),
    "n": Variable("index of the family of periodic orbits", "n", "Eq. 6"),
    "point": Variable("point along the branch, at equal steps of arclength"),
    "restitution": Variable("restitution coefficient", "r", "Eq. 2"),
    "special": Variable("special point of the branch, in order of arclength"),
    "table_phase": Variable("phase of the table, whose height is Λ sin τ", "τ", units="rad"),
    "time": Variable("time since the first impact", "τ"),
    # Motions
    "ball": Variable("height of the ball", "z", "Eqs. 4, 12, 14"),
    "ball_velocity": Variable("velocity of the ball", "z′", "Eqs. 3, 13, 15"),
    "table": Variable("height of the table", "w", "Eq. 4"),
    "contact": Variable("whether the ball touches the table"),
    "restitution_ball": Variable("height of the ball, restitution model", "z_CR", "Eq. 4"),
    # Orbits
    "phase": Variable("phase of the table when the contact starts", "φ", "Eqs. 6, 21", "rad"),
    "contact_duration": Variable("duration of the contact", "τ_b", "Eq. 23"),
    "release_phase": Variable(
        "phase of the table when the contact ends", "φ + τ_b", "Eq. 23", "rad"
    ),
    "impact_velocity": Variable("velocity of the ball as contact starts", "z′_i", "Eq. 22"),
    "bounce_velocity": Variable("bouncing-off velocity of the ball", "z′_b", "Eqs. 24, 27"),
    "apparent_restitution": Variable("apparent restitution coefficient", "r_a", "Eq. 17"),
    "max_height": Variable("maximum height of the ball over a cycle", "max z", "Eq. 37"),
    "damping_ratio": Variable("damping ratio of the contact", "ζ", "Eq. 16"),
    # Multipliers that nearly coincide are known to the square root of the precision of the matrix,
    # about 1e-13.
    "multiplier_real": Variable(
        "real part of the Floquet multiplier", "Re μ", tolerance=1e-6, floor=1.0
    ),
    "multiplier_imag": Variable(
        "imaginary part of the Floquet multiplier", "Im μ", tolerance=1e-6, floor=1.0
    ),
    "stable": Variable("whether no Floquet multiplier is outside the unit circle", "|μ| ≤ 1"),
    "admissible": Variable("whether the orbit has no earlier impact or release"),
    "end_kind": Variable("kind of the end of the branch"),
    "end_reason": Variable("reason for the end of the branch"),
    # Orbits of the restitution model
    "restitution_amplitude": Variable("amplitude of the table, restitution model", "Λ"),
    "restitution_phase": Variable("phase of impact, restitution model", "φ_CR", "Eq. 6", "rad"),
    "restitution_impact_velocity": Variable(
        "velocity before impact, restitution model", "-nπ", "Eq. 3"
    ),
    "restitution_bounce_velocity": Variable(
        "bouncing-off velocity, restitution model", "nπ", "Eq. 6"
    ),
    "restitution_max_height": Variable("maximum height, restitution model", "max z_CR", "Eq. 37"),
    "restitution_stable": Variable("whether the restitution model's orbit is stable"),
    "restitution_admissible": Variable(
        "whether the orbit of the restitution model has no earlier impact"
    ),
    # Bifurcations and other special points
    "saddle_node_amplitude": Variable("amplitude of the saddle-node", "Λ_SN", "Eq. 7"),
    "saddle_node_phase": Variable("phase at the saddle-node", "φ_SN", "Eq. 6", "rad"),
    "period_doubling_amplitude": Variable("amplitude of the period doubling", "Λ_PD", "Eq. 8"),
    "period_doubling_phase": Variable("phase at the period doubling", "φ_PD", "Eq. 6", "rad"),
    "grazing_amplitude": Variable("amplitude at which the unstable orbit grazes the table", "Λ"),
    "grazing_phase": Variable(
        "phase at which the unstable orbit grazes the table", "φ", units="rad"
    ),
    "special_kind": Variable("kind of special point"),
    "special_amplitude": Variable("amplitude of the table at the special point", "Λ"),
    "special_phase": Variable("phase at the special point", "φ", "Eq. 21", "rad"),
    "special_contact_duration": Variable("contact duration at the special point", "τ_b", "Eq. 23"),
    "special_arclength": Variable(
        "arclength of the branch up to the special point, divided by the total arclength"
    ),
    "laid": Variable("number of the stable range on the branch from permanent contact"),
    "range_end": Variable("end of the stable range"),
    "laid_amplitude": Variable(
        "Λ at the ends of stable ranges on another branch than that of the figure, which begins at "
        "permanent contact",
        "Λ",
    ),
    "laid_contact_duration": Variable("contact duration at the ends of these ranges", "τ_b"),
    # Permanent contact
    "threshold_amplitude": Variable(
        "threshold of permanent contact", "Λ_SD, or Λ_F for the force release", "Eq. 33"
    ),
    "restitution_threshold": Variable(
        "threshold of permanent contact, restitution model", "Λ_CR", "Eq. 9"
    ),
    "minimum_frequency_ratio": Variable(
        "frequency ratio with the lowest threshold", "1/√(1-2ζ²)", "Eq. 36"
    ),
    "minimum_threshold": Variable("lowest threshold of permanent contact", "2ζ√(1-ζ²)", "Eq. 36"),
    # Errors of the restitution model
    "relative_error": Variable("relative error of the restitution model", "", "Eqs. 37-38"),
    "error_threshold": Variable(
        "frequency ratio above which the error stays below the tolerance",
        "ϖ_1%",
        "Eqs. 37-38",
    ),
    "threshold_status": Variable("whether the threshold is found, or why it is not"),
}

OF_DATASET: dict[str, dict[str, Variable]] = {
    "table1": {
        "bound": Variable("end of the stability range"),
        "computed": Variable("end of the stability range, this replication", "Λ"),
        "printed": Variable("end of the stability range, as printed", "Λ", "Table 1"),
        "restitution_range": Variable("end of the stability range, restitution model", "Λ"),
    },
    "thresholds": {
        "relative_error": Variable(
            "error of the restitution model: relative, but for the phase a fraction of a period",
            "",
            "Eqs. 37-38",
        ),
        "quantity": Variable("quantity compared between the two models"),
        "tolerance": Variable("error tolerated", equation="Eqs. 37-38"),
    },
    "validity_map": {
        "quantity": Variable("quantity compared between the two models"),
        # Stored in single precision, which has seven digits.
        "place": Variable("relative amplitude: 0 at the saddle-node, 1 at the period doubling"),
        "enough_from": Variable(
            "smallest frequency ratio above which the error stays within the tolerance, or the "
            "smallest one scanned",
            "ϖ",
            tolerance=1e-6,
        ),
        "stiff_error": Variable(
            "largest error at frequency ratios of at least the advised one: relative, but for the "
            "phase a fraction of a period",
            tolerance=1e-6,
        ),
        "stable": Variable(
            "whether the orbit is stable in both models, at the advised frequency ratio"
        ),
        "largest_error": Variable(
            "largest of these errors on the orbits that are stable in both models, or its limit at "
            "the ends of their range",
            tolerance=1e-6,
        ),
        "not_reached": Variable("number of orbits without a result"),
        "failing_share": Variable(
            "fraction of the stable range of Λ with orbits that are stable in both models, and for "
            "which the advised frequency ratio is too small",
            tolerance=1e-6,
        ),
        "failing_mean": Variable("mean of this fraction over r", tolerance=1e-6),
        "failing_up_to": Variable(
            "largest r at which the advised frequency ratio is too small for some Λ, 0 if none",
            "r",
            tolerance=1e-6,
        ),
        "doubled_share": Variable(
            "fraction of the stable range of Λ on which the period has doubled at the advised "
            "frequency ratio",
            tolerance=1e-6,
        ),
        "doubled_mean": Variable("mean of this fraction over r", tolerance=1e-6),
        "below_share": Variable(
            "range of Λ below the saddle-node of the restitution model in which the contact of the "
            "advised frequency ratio has stable orbits, as a fraction of the stable range",
            tolerance=1e-6,
        ),
        "below_mean": Variable("mean of this fraction over r", tolerance=1e-6),
    },
    "lowest_doubling": {
        # At a minimum over ϖ, ϖ is known to the square root of the precision of Λ, about 1e-13.
        "period_doubling_turn": Variable(
            "frequency ratio at which the period doubling is lowest", "ϖ", tolerance=1e-5
        ),
    },
    "three_balls": {
        "impact": Variable("number of the impact"),
        "impact_time": Variable("time of the impact", "τ", "Eq. 5"),
        "impact_bounce": Variable("velocity of the ball after the impact", "z′", "Eq. 5"),
        "impacts": Variable("impacts until the motion repeats, 0 if it does not"),
        "periods": Variable(
            "periods of the table after which the motion repeats, 0 if it does not"
        ),
        "stickings": Variable("number of impacts after which the ball sticks to the table"),
        # Along a chaotic motion rounding errors grow until another processor computes a different
        # motion. Only their averages agree, within the statistical error: five standard errors.
        "lyapunov_exponent": Variable(
            "largest Lyapunov exponent, per period of the table",
            "λ",
            tolerance=5.0,
            tolerance_scale="lyapunov_error",
        ),
        # A standard error from about thirty blocks of impacts is itself known to about 13 %.
        "lyapunov_error": Variable(
            "standard error of the largest Lyapunov exponent", tolerance=0.5
        ),
    },
    "impact_instant": {
        "sample": Variable("number of the sample around the contact"),
        "time": Variable("time since the impact of the restitution model", "τ - φ_CR"),
        "instant_ball": Variable("height of the ball with the equivalent impact at an instant"),
        "force": Variable("contact force on the ball, divided by its weight", "F"),
        "touch": Variable("start of the contact: time since the impact of the restitution model"),
        "centroid": Variable(
            "centroid of the contact force: time since the impact of the restitution model"
        ),
        "release": Variable("end of the contact: time since the impact of the restitution model"),
        "depth": Variable("height of the ball above the table at the equivalent impact", "z - w"),
        "table_rise": Variable(
            "height of the table at the equivalent impact minus its height at the impact of the "
            "restitution model"
        ),
        "summit": Variable("maximum height of the ball in flight"),
    },
    "hypotheses": {
        "hypothesis": Variable("hypothesis on what the authors computed"),
        # A distance in units of the last digit is a difference of two close numbers, and has fewer
        # digits than these.
        "number": Variable("printed number, as the claims name it"),
        "contact_of": Variable("hypothesis that has the same contact; empty without a contact"),
        "row": Variable("frequency ratio of the row of Table 1 that has the number", "ϖ"),
        "exponent": Variable("exponent of the largest frequency ratio"),
        "agrees": Variable("whether the number found rounds to the printed one"),
        "reproduced": Variable("number of printed numbers within half a unit of the last digit"),
        "compliant_reproduced": Variable(
            "number of these among the ends on the compliant contacts"
        ),
        "largest_difference": Variable("largest distance of these ends, in units", tolerance=1e-6),
        "below_orbits": Variable(
            "number of saddle-nodes printed below every orbit of the equations"
        ),
        "rms_difference": Variable(
            "root mean square distance of the ends of Table 1 on the compliant contacts, in units",
            tolerance=1e-6,
        ),
        "damping_of_82": Variable("ζ for which the height threshold is 81.5 and 82.5", "ζ"),
        "stiff_reproduced": Variable("number of ends of the stiffest row that are reproduced"),
        "mean_difference": Variable(
            "mean distance of the ends on the compliant contacts, in units", tolerance=1e-6
        ),
        "printed_text": Variable("the number as printed"),
        "found": Variable("the number found"),
        "deviation_units": Variable("deviation in units of the last printed digit", tolerance=1e-6),
    },
    "choices": {
        "choice": Variable("what cannot be read in the paper"),
        "instead": Variable("what was chosen instead; empty if nothing was tried"),
        "changes": Variable("verdicts that change"),
    },
    "claims": {
        "claim": Variable("claim of the paper"),
        "verdict": Variable("verdict on the claim"),
        "own_sense": Variable("whether the literal reading holds, or that none can fail"),
        "item": Variable("figure, table, equation or section of the paper"),
        "statement": Variable("what the claim says"),
        "remark": Variable("how we read the claim"),
        "condition": Variable(
            "conditions that decide a statement, one for each sense of its words"
        ),
        "group": Variable("category in which the claim is counted"),
        "printed_text": Variable("the number as printed"),
        "decided_by": Variable("datasets that decide, or algebra"),
        "beside": Variable("figure or table beside which the claim is shown"),
        "found": Variable("the number found"),
        # A difference of two numbers that agree to three or four digits.
        "deviation": Variable("relative deviation", tolerance=1e-6),
        "deviation_units": Variable("deviation in units of the last printed digit", tolerance=1e-6),
        "reason": Variable("why a claim or a motion is undecided"),
    },
}
OF_DATASET["regimes"] = {
    name: OF_DATASET["validity_map"][name] for name in ("place", "enough_from")
}


def described(dataset: str) -> dict[str, Variable]:
    """Return the descriptions of the variables that a dataset may have."""
    return SYMBOLS | OF_DATASET.get(dataset, {})
