"""Claims of the abstract and the introduction."""

from bouncing_ball.claims import evidence
from bouncing_ball.claims.claim import statement
from bouncing_ball.claims.paper import explanations as why
from bouncing_ball.claims.parameters import TOLERANCE
from bouncing_ball.claims.verdict import above, at_least, at_most, below


@statement("Abstract")
def stiff_limit(data):
    """for a high contact stiffness both models behave alike

    Condition: every relative error is below the paper's 1 % at the stiffest contact scanned
    """
    return at_most(data["thresholds"].relative_error.isel(frequency_ratio=-1), TOLERANCE)


@statement("Abstract")
def soft_divergence(data):
    """the models diverge when the stiffness decreases

    Condition: no relative error is below 1 % at the softest contact scanned

    Remark: at a frequency ratio of 1; the spring-damper model has no saddle-node there
    """
    return at_least(data["thresholds"].relative_error.isel(frequency_ratio=0), TOLERANCE)


@statement("Introduction")
def kinds_of_motion(data):
    """periodic, subharmonic and chaotic motions can be observed

    Condition: among three motions of the restitution model all three kinds are found

    Remark: chaotic means a positive Lyapunov exponent until the ball sticks to the table
    """
    return at_least(evidence.motion_kinds(data), 3)


@statement("Abstract and Introduction")
def contact_shortens(data):
    """the contact gets shorter as its stiffness increases

    Condition: the contact duration falls from every contact of Fig. 13 to the next stiffer one
    """
    return below(data["fig13"].contact_duration.diff("frequency_ratio"), 0)


@statement("Introduction", explanation=why.a_pull_is_assumed)
def no_assumptions(data):
    """the spring-damper model needs no assumptions

    Condition: no contact of Figs. 5, 6 and 10 pulls at the ball when it lets it go

    Remark: in weights of the ball
    """
    return at_most(evidence.release_pull(data), 0)


@statement("Abstract", explanation=why.linear_at_fixed_duration)
def needs_continuation(data):
    """the spring-damper model needs numerical continuation

    Condition: a formula without continuation misses some published orbit by more than rounding

    Remark: that the equations are transcendental is another claim
    """
    return above(*evidence.route_disagreement(data))


@statement("Introduction")
def existence_changes(data):
    """for a soft contact the existence conditions of the orbits change

    Condition: every saddle-node of the softest row of Table 1 is at least 1 % from that of Eq. 7
    """
    table = data["table1"].sel(bound="saddle-node")
    softest = table.computed.sel(frequency_ratio=table.frequency_ratio.min())
    return at_least(abs(softest / table.restitution_range.sel(impact_map="exact") - 1), 0.01)
