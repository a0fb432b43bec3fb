"""What each variable of the datasets means, and how closely two computations of it agree.

These are the variables of the replication, whose module `datasets` says what a tolerance means, and
those of the studies here.
"""

from carbonelli2011.variables import SYMBOLS
from paper_replication.datasets import Variable

VARIABLES = SYMBOLS | {
    # Coordinates
    "quantity": Variable("quantity compared between the models"),
    "impacts": Variable("impacts until the motion repeats, 0 if it does not"),
    "periods": Variable("periods of the table after which the motion repeats, 0 if it does not"),
    "release": Variable("what ends a contact"),
    "model": Variable("model of the impact"),
    "place": Variable("the orbit, or the saddle-node of the restitution model"),
    "position": Variable(
        "position of the amplitude in the stable range of the restitution model, 0 at the "
        "saddle-node and 1 at the period doubling",
        "p",
    ),
    "law": Variable("law of the contact"),
    "centroid_ratio": Variable(
        "π over D + κ of the free impact, which stands for the frequency ratio", "π/(D+κ)"
    ),
    "calibration": Variable(
        "orbit at whose relative impact speed |δ′_i| the contact has the given r and centroid"
    ),
    "motion": Variable("ball that is followed"),
    # The three answers
    "branch": Variable("model of the impact, or the error law"),
    "branch_amplitude": Variable("excitation amplitude along the branch", "Λ"),
    "branch_phase": Variable("phase of the touch along the branch", "φ", units="rad"),
    "branch_stable": Variable("whether the orbit is stable"),
    "window_n": Variable("number of periods between two impacts", "n"),
    "window_restitution": Variable("restitution coefficient", "r"),
    # By interpolation on a grid of ϖ.
    "window_ratio": Variable(
        "frequency ratio below which the saddle-node of the contact is above that of the "
        "restitution model; missing if that was not seen",
        "ϖ",
    ),
    "example_n": Variable("number of periods of the example", "n"),
    "example_restitution": Variable("restitution coefficient of the example", "r"),
    "example_ratio": Variable("frequency ratio of the example", "ϖ"),
    "example_amplitude": Variable("amplitude of the example's saddle-node", "Λ_SN"),
    "example_line": Variable("the same in the restitution model", "C"),
    "doubling_restitution": Variable("restitution coefficient", "r"),
    "table_restitution": Variable("restitution coefficient", "r"),
    # Λ_PD at ϖ = 3000 is known to some 1e-13, its shift to 1e-9 of itself.
    "doubling_coefficient": Variable(
        "relative shift of the period doubling times ϖ, error law", "K", tolerance=1e-6, floor=1e-2
    ),
    "table_coefficient": Variable(
        "relative shift of the period doubling times ϖ, error law", "K", tolerance=1e-6, floor=1e-2
    ),
    "table_shift": Variable(
        "relative shift of the period doubling times ϖ, exactly", tolerance=1e-6, floor=1e-2
    ),
    "harmonic_phase": Variable(
        "phase of the third harmonic at which it shifts the doubling most", units="rad"
    ),
    "example_doubling": Variable("amplitude of the period doubling on a contact", "Λ_PD"),
    "example_restitution_doubling": Variable("the same in the restitution model", "Λ_PD"),
    # Orbits that are reached. Where a ball starts beside the boundary of a basin, rounding decides.
    "basin_share": Variable("share of starts that end on the orbit", tolerance=0.1, floor=1.0),
    # Laid balls. The end of a motion is extrapolated from its last impacts.
    "hop": Variable(
        "maximum height above the table; missing if the motion is not known",
        "max δ",
        tolerance=1e-6,
    ),
    "start_decides": Variable(
        "whether a ball that touches the table at its phase 0, with its velocity, ends on another "
        "known motion"
    ),
    "flying_hop": Variable(
        "maximum height above the table on the stable 1-T orbit that flies for most of the period; "
        "missing if there is none",
        "max δ",
    ),
    "shown_ratio": Variable("frequency ratio of a line", "ϖ"),
    "scan_restitution": Variable("restitution coefficient", "r"),
    "scan_known": Variable(
        "points in the stable range of the flying 1-T orbit at which the motion of a laid ball is "
        "known"
    ),
    "scan_reached": Variable("points of these at which the laid ball ends on this orbit"),
    "scan_share": Variable(
        "largest height of the hops of the others over that on this orbit", tolerance=1e-6
    ),
    "shown_hop": Variable(
        "maximum height above the table; missing if the motion is not known",
        "max δ",
        tolerance=1e-6,
    ),
    "rigid_periods": Variable(
        "periods of the table after which the motion repeats in the restitution model, 0 if it is "
        "not known"
    ),
    "rigid_hop": Variable(
        "maximum height above the table in the restitution model; missing if the motion is not "
        "known",
        "max δ",
        tolerance=1e-6,
    ),
    # One contact
    "free_force": Variable("force of a free contact, over mω times the impact speed", "F/(mωv)"),
    "contact_end": Variable("duration of a free contact, in units of 1/ω", "ωD"),
    "end_restitution": Variable("restitution coefficient of a free impact by the release", "r"),
    "contact_force": Variable("force of the table over the weight", "F", floor=1.0),
    "flight_before": Variable("flight before the contact, continued", "z"),
    "flight_after": Variable("flight after the contact, continued backwards", "z"),
    "meeting_time": Variable("time at which the continued flights meet", "ψ"),
    "meeting_height": Variable("height at which the continued flights meet", "z"),
    "delay": Variable("delay of the instant by the signature of the contact", "t_c"),
    # The time of contacts
    "ball_name": Variable("material and diameter of a ball"),
    "frequency": Variable("frequency of the table", "Ω/2π", units="Hz"),
    "impact_speed": Variable("impact speed of the orbit, relative to the table", units="m/s"),
    "contact_time": Variable("contact time at the impact speed", "D", units="s", floor=1e-6),
    "longest_contact_time": Variable(
        "contact time at which π/D is the given frequency ratio", "D", units="s", floor=1e-6
    ),
    "stiff_frequency": Variable(
        "frequency of the table below which π/D exceeds the given frequency ratio", units="Hz"
    ),
    # Errors along the frequency ratio. What the corrected model and the error law leave is a small
    # difference of numbers of the size of 1 that are known to some 1e-13.
    "relative_error": Variable("relative error of a simple model", "", "Eqs. 37-38", floor=1e-2),
    "law_left": Variable("modulus of the error that the error law leaves", floor=1e-2),
    "node_error": Variable(
        "modulus of the relative error of the restitution model at its saddle-node"
    ),
    "coefficient": Variable("relative error times the frequency ratio, to first order", "K"),
    # The error at ϖ = 500 and 1000, some 1e-6 and known to some 1e-13, times ϖ².
    "second_order": Variable(
        "relative error of the corrected model times the squared frequency ratio",
        "C",
        tolerance=1e-6,
        floor=1.0,
    ),
    "law_second_order": Variable(
        "what the error law leaves times the squared frequency ratio",
        "c₂",
        tolerance=1e-6,
        floor=1.0,
    ),
    "law_third_order": Variable(
        "the next coefficient of what the error law leaves", "c₃", tolerance=1e-3, floor=1.0
    ),
    "law_threshold": Variable("frequency ratio for the tolerance by the error law", "ϖ"),
    "error_zero": Variable("frequency ratio at which the error passes through zero", "ϖ"),
    # At large ϖ the corrected model's error, which passes through zero there, is itself small.
    "corrected_error_zero": Variable(
        "frequency ratio at which the corrected model's error passes through zero",
        "ϖ",
        tolerance=1e-7,
    ),
    "permanent_coefficient": Variable(
        "relative error of the permanent contact times the squared frequency ratio", "K₂"
    ),
    "permanent_law": Variable("frequency ratio for the tolerance by this law", "√(|K₂|/ε)"),
    "permanent_threshold": Variable("frequency ratio for the tolerance, permanent contact", "ϖ_PC"),
    # Orders are quotients of such differences at ϖ = 1000 and 2000. Between random orbits they vary
    # by percents.
    "order": Variable(
        "order of convergence of the relative error in 1/ϖ", tolerance=1e-3, floor=1.0
    ),
    # At the saddle-node, rounding errors of 1e-13 are half a percent of what is left at ϖ = 200000.
    "law_order": Variable(
        "order of convergence in 1/ϖ of what the error law leaves", tolerance=1e-2, floor=1.0
    ),
    "node_order": Variable(
        "order of convergence in 1/ϖ of the error at the saddle-node", tolerance=1e-3, floor=1.0
    ),
    "order_frequency_ratio": Variable(
        "two frequency ratios between which the orders are measured", "ϖ"
    ),
    "node_order_frequency_ratio": Variable("the same at the saddle-node", "ϖ"),
    # Map
    "level": Variable("frequency ratio of a line of the map", "ϖ"),
    "threshold_by_law": Variable(
        "frequency ratio for the tolerance of the height by the error law", "ϖ"
    ),
    # The place of a greatest error, where this is level: rounding of 1e-10 of the error moves it by
    # the root of that. Two processors differed by 4.5e-5.
    "saddle_node_error": Variable("relative error of the amplitude of the saddle-node"),
    "saddle_node_law": Variable("the same by the error law", "-s/C"),
    "period_doubling_error": Variable("relative error of the amplitude of the period doubling"),
    "period_doubling_law": Variable("the same by the error law"),
    # Other contact laws
    "law_error_zero": Variable(
        "π over D + κ at which the error passes through zero", "π/(D+κ)", tolerance=1e-7
    ),
    "error_calibration": Variable("calibration of the contacts of the relative errors"),
    "stable_at_threshold": Variable("whether the orbit at the threshold is stable and admissible"),
    # What a phase tells. Remainders at ϖ = 10⁴ are some 1e-8, known to some 1e-15, times ϖ².
    "waveform": Variable("waveform of the table"),
    "contact_share": Variable("share of the period that a free impact takes", "D/(2π)"),
    "shown_share": Variable("the same of the contacts that are drawn", "D/(2π)"),
    "above": Variable("relative height of the amplitude above the saddle-node", "Λ/Λ_SN-1"),
    "phase_left": Variable(
        "what the error law leaves of the phase, times ϖ²", tolerance=1e-5, floor=1.0
    ),
    "height_left": Variable(
        "what the error law leaves of the maximum height, times ϖ²", tolerance=1e-5, floor=1.0
    ),
    "node_phase_left": Variable(
        "what the error law leaves of the phase at the saddle-node of the restitution model, times "
        "the power 3/2 of ϖ",
        tolerance=1e-5,
        floor=1.0,
    ),
    "node_shift": Variable(
        "relative error of max w′ at the saddle-node, times ϖ", tolerance=1e-7, floor=1.0
    ),
    "node_shift_law": Variable("the same by the error law", "-sϖ/C"),
    "touch_x": Variable("Λ cos φ at the touch", "X"),
    "touch_y": Variable("Λ sin φ at the touch", "Y"),
    "line_level": Variable("distance of the line of touches from the origin, error law", "C-s"),
    "line_angle": Variable("angle of the line of touches, error law", "θ", units="rad"),
    "restitution_line": Variable("this distance in the restitution model", "C"),
    "steepness": Variable("greatest velocity of the table over C", "max w′/C"),
    "touch_slope": Variable("velocity of the table at the touch over C", "w′(φ)/C"),
    "turned_slope": Variable("velocity of the table later by θ over C", "w′(φ+θ)/C"),
    # From a line through touches that differ little.
    "angle_ratio": Variable("angle that is found over that of the error law", tolerance=1e-7),
    "found_restitution": Variable("restitution coefficient that is found", "r", tolerance=1e-7),
    "duration_ratio": Variable("D + κ that is found over the true one", tolerance=1e-7),
    "unturned_restitution": Variable(
        "restitution coefficient from one phase, as if the contact took no time", "r"
    ),
    "counterfeit": Variable(
        "D + κ of the linear contact with the same two bifurcations, over the true one",
        tolerance=1e-6,
    ),
    "width_change": Variable("relative change of Λ_PD² - Λ_SN² by the contact"),
    # Noise is the same on each processor, but the last bits of a motion are not.
    "measured_restitution": Variable(
        "restitution coefficient of simulated measurements, mean",
        tolerance=1.0,
        tolerance_scale="measured_restitution_error",
    ),
    "measured_restitution_error": Variable("its standard deviation", tolerance=0.5),
    "measured_duration": Variable(
        "duration of simulated measurements over the true one, mean",
        tolerance=1.0,
        tolerance_scale="measured_duration_error",
    ),
    "measured_duration_error": Variable("its standard deviation", tolerance=0.5),
    "staying": Variable("share of balls that stay on the orbit", tolerance=0.3, floor=1.0),
    "half_escape": Variable(
        "relative height above the saddle-node at which half of the balls escape",
        tolerance=0.02,
        floor=1.0,
    ),
    # Averages agree as well as those of so many chaotic balls do, within five errors. Rounding may
    # decide when a ball comes to rest, and it does so for most of the balls of a row together.
    # Explorer
    "trace": Variable("trace of the derivative of the return map", "tr"),
    "determinant": Variable("determinant of the derivative of the return map", "det"),
    "restitution_trace": Variable("this trace in the restitution model", "tr"),
    "restitution_period_doubling": Variable(
        "amplitude of the period doubling, restitution model", "Λ_PD"
    ),
    "corrected_phase": Variable("phase of impact, corrected model", "φ", units="rad"),
    "corrected_trace": Variable("trace of the return map's derivative, corrected model", "tr"),
    "corrected_saddle_node": Variable("amplitude of the saddle-node, corrected model", "Λ_SN"),
    "corrected_period_doubling": Variable(
        "amplitude of the period doubling, corrected model", "Λ_PD"
    ),
    "corrected_max_height": Variable("maximum height, corrected model", "max z"),
    "ball_restitution": Variable("restitution coefficient of a ball that is followed", "r"),
    "ball_frequency_ratio": Variable(
        "frequency ratio of the contact of a ball that is followed", "ϖ"
    ),
    "ball_amplitude": Variable("amplitude of the table of a ball that is followed", "Λ"),
    "start_phase": Variable("phase of the table at the first impact", "φ", units="rad"),
    "velocity": Variable("velocity of the ball before the first impact", "z′_i"),
    "end_impact": Variable("number of the impact that is compared, from 0"),
    "end_phase": Variable("phase of the table at that impact", "φ", units="rad"),
    "end_speed": Variable("speed of the ball towards the table at that impact", "-δ′"),
    "end_time": Variable(
        "time of that impact since the first one, or of the rest that follows it", "τ"
    ),
}

LAW_NAMES = {
    "linear": "linear",
    "linear, force release": "linear, force release",
    "hunt-crossley": "Hunt and Crossley",
    "tsuji": "Tsuji",
    "kuwabara-kono": "Kuwabara and Kono",
}
"""The contact laws in words."""


def described(dataset: str) -> dict[str, Variable]:
    """Return the descriptions of variables; all datasets share them."""
    return VARIABLES
