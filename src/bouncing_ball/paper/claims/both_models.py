"""Claims about both models side by side, Figs. 10 and 12-16, and the conclusion."""

from bouncing_ball.paper.claims import evidence
from bouncing_ball.paper.claims.claim import claim, of_formula
from bouncing_ball.paper.claims.evidence import TOLERANCE
from bouncing_ball.paper.claims.verdict import above, at_least, at_most
from bouncing_ball.paper.exhibits.printed_table1 import PERMANENT_CONTACT


@claim("Fig. 10")
def velocity_rises(data):
    """with rising frequency ratio the bouncing-off velocity rises

    Compared: the smallest rise of the velocity from a contact to the next

    Condition: it rises from every contact to the next stiffer one, for every amplitude
    """
    return above(data["fig10"].bounce_velocity.diff("frequency_ratio"), 0)


@claim("Figs. 12 and 14")
def height_rises(data):
    """with rising frequency ratio the greatest height rises

    Compared: the smallest rise of the height from a contact to the next

    Condition: it rises from every contact to the next stiffer one
    """
    return above(data["fig14"].max_height.diff("frequency_ratio"), 0)


@claim("Fig. 13", at={"frequency_ratio": 1e3})
def phases_converge(data):
    """the phases of impact and of release converge to that of the restitution model

    Compared: the largest relative distance of both phases from that of the restitution model

    Condition: both are within 1 % at the stiffest contact
    """
    last = data["fig13"].isel(frequency_ratio=-1)
    phases = last[["phase", "release_phase"]].to_array()
    return at_most(abs(phases / last.restitution_phase - 1), 0.01)


@claim("Eq. 37, Fig. 14", printed="82")
def height_threshold(data):
    """frequency ratio at which the greatest heights differ by 1 %

    Compared: the frequency ratio
    """
    return data["fig14"].error_threshold


@claim("Fig. 15", missing="the error of a stability range that the paper calls small")
def representative(data):
    """the restitution model makes a small error on the stability range at ϖ = 10

    Compared: the larger relative error of the two ends of the range

    Condition: the error of neither end exceeds what can be called small: either the move of the
    ends of Table 1 from the stiffest contact to ϖ = 10, which the paper calls slight, or the limit
    of 1 %, which the paper sets for other quantities

    Answer: both ranges look alike in the figure, and the limit of 1 % is not set for them
    """
    error = evidence.range_error(data)
    return {
        "as a slight move of Table 1": at_most(error, evidence.printed_slight_move(data)),
        "as the limit of 1 %": at_most(error, TOLERANCE),
    }


def threshold_by_equation_34(data):
    """Eq. 34 of the paper, which is right, gives the computed frequency ratio. At the printed one
    the error is well above its limit.
    """
    return {
        "error of Eq. 34": of_formula(data, "Eq. 34"),
        "error at the printed one": at_least(evidence.permanent_contact_error(data), 0.02),
    }


@claim("Eq. 38, Fig. 16", printed=f"{PERMANENT_CONTACT:g}", explanation=threshold_by_equation_34)
def permanent_contact_threshold(data):
    """frequency ratio at which the thresholds of permanent contact differ by 1 %

    Compared: the frequency ratio

    Answer: the number is an example read off the figure; the conclusion asks for 100
    """
    return data["fig16"].error_threshold


@claim("Conclusion")
def safe_above_100(data):
    """considering all results, the restitution model is good above a frequency ratio of 100

    Compared: the largest relative error of the greatest height at a frequency ratio of 100 or more

    Condition: every orbit of Figs. 5, 6 and 10 is within 1 %, the limit that the paper sets, from
    that frequency ratio on

    Remark: the paper sets its limit for the greatest height (Eq. 37) and for permanent contact
    only, and every orbit stays within it there. The bouncing-off velocity and the apparent
    restitution exceed it slightly for the smallest restitution coefficient. The phase stays within
    it as a share of a cycle. Relative to its own size, which depends on the origin, it does not,
    because it is zero at the saddle-node

    Answer: the limit is set for heights and permanent contact, and there it holds
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
