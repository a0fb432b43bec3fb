"""Claims about both models side by side, Figs. 10 and 12-16, and the conclusion."""

from bouncing_ball.claims import evidence
from bouncing_ball.claims.claim import number, statement
from bouncing_ball.claims.paper import explanations as why
from bouncing_ball.claims.parameters import TOLERANCE
from bouncing_ball.claims.verdict import above, at_most

_RATIO = "Effects of the frequency ratio"
_RANGES = "Existence and stability, both models"
_PERMANENT = "Permanent contact, both models"


@statement(_RATIO, "Fig. 10")
def velocity_rises(data):
    """with rising frequency ratio the bouncing-off velocity rises

    Condition: it rises from every contact to the next stiffer one, for every amplitude
    """
    return above(data["fig10"].bounce_velocity.diff("frequency_ratio"), 0)


@statement(_RATIO, "Figs. 12 and 14")
def height_rises(data):
    """with rising frequency ratio the greatest height rises

    Condition: it rises from every contact to the next stiffer one
    """
    return above(data["fig14"].max_height.diff("frequency_ratio"), 0)


@statement(_RATIO, "Fig. 13")
def impact_phase_converges(data):
    """the phase of impact converges to that of the restitution model

    Condition: it is within 1 % at the stiffest contact
    """
    return at_most(evidence.end_error(data, "phase"), 0.01)


@statement(_RATIO, "Fig. 13")
def release_phase_converges(data):
    """the phase of release converges to that of the restitution model

    Condition: it is within 1 % at the stiffest contact
    """
    return at_most(evidence.end_error(data, "release_phase"), 0.01)


@number(_RATIO, "Eq. 37, Fig. 14", "82")
def height_threshold(data):
    """frequency ratio at which the greatest heights differ by 1 %"""
    return data["fig14"].error_threshold


@statement(_RANGES, "Fig. 15")
def representative(data):
    """the restitution model makes a small error on the stability range at ϖ = 10

    Condition: neither end of the range is off by more than the ends of Table 1 are printed to move
    from the stiffest contact to ϖ = 10, which the paper calls slight

    Remark: small is what the paper calls so; its limit of 1 % is for other quantities
    """
    return at_most(evidence.range_error(data), evidence.printed_slight_move(data))


@statement(
    _RANGES,
    "Fig. 15",
    id="amplitude of Fig. 15",
    clear=False,
    explanation=why.figure_15_is_over_the_amplitude,
)
def amplitude_of_fig_15(data):
    """the 2-T orbits of Fig. 15 are those at an amplitude of 1

    Condition: one of the models has such an orbit at that amplitude

    Remark: the caption gives 1 to a letter that is lost; n, r, ζ and ϖ have values of their own,
    and those of Figs. 13 and 14 give 1 to Λ
    """
    return at_most(min(ends[0] for ends in evidence.ranges_of_fig15(data)), 1)


@number(_PERMANENT, "Eq. 38, Fig. 16", "6", explanation=why.threshold_by_equation_34)
def permanent_contact_threshold(data):
    """frequency ratio at which the thresholds of permanent contact differ by 1 %"""
    return data["fig16"].error_threshold


@statement(
    _PERMANENT,
    "Fig. 16",
    clear=False,
    explanation=why.threshold_by_equation_34,
    restates=permanent_contact_threshold,
)
def permanent_contact_above_6(data):
    """the models differ in permanent contact only below a frequency ratio of 6

    Condition: the relative error is at most 1 % at that frequency ratio
    """
    return at_most(evidence.permanent_contact_error(data), TOLERANCE)


@statement("Conclusion", explanation=why.limit_of_which_quantity)
def safe_above_100(data):
    """considering all results, the restitution model is good above a frequency ratio of 100

    Condition: every orbit of Figs. 5, 6 and 10 is within 1 %, the limit that the paper sets, from
    there on

    Remark: the paper sets its limit for the greatest height and for permanent contact only
    """
    error = evidence.stiff_orbit_error(data)
    readings = {
        "greatest height, Eq. 37": "max_height",
        "bouncing-off velocity": "bounce_velocity",
        "apparent restitution": "apparent_restitution",
        "phase, as a share of a cycle": "phase in cycles",
        "phase, relative to its own size": "phase",
    }
    return {name: at_most(error.sel(measure=key), TOLERANCE) for name, key in readings.items()}
