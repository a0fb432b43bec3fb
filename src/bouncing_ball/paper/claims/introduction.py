"""Claims of the abstract and the introduction."""

from bouncing_ball.paper.claims.claim import claim
from bouncing_ball.paper.claims.parameters import TOLERANCE
from bouncing_ball.paper.claims.verdict import at_least, at_most, below


@claim("Abstract")
def stiff_limit(data):
    """for a high contact stiffness both models behave alike

    Condition: every relative error is below the paper's 1 % at the stiffest contact scanned
    """
    return at_most(data["thresholds"].relative_error.isel(frequency_ratio=-1), TOLERANCE)


@claim("Abstract")
def compliant_divergence(data):
    """the models diverge when the stiffness decreases

    Condition: no relative error is below 1 % at the most compliant contact scanned

    Remark: this contact has a frequency ratio of 1, where the spring-damper model has no
    saddle-node
    """
    return at_least(data["thresholds"].relative_error.isel(frequency_ratio=0), TOLERANCE)


@claim("Introduction")
def kinds_of_motion(data):
    """periodic, subharmonic and chaotic motions can be observed

    Condition: among the motions of the restitution model on a grid over Λ and r all three kinds are
    found

    Remark: a chaotic motion does not repeat, and its Lyapunov exponent is positive by five standard
    errors, which happens by chance once in three million cases
    """
    found = data["ext_locking"].kind.sel(model="restitution")
    return at_least(
        sum(bool((found == kind).any()) for kind in ("orbit", "subharmonic", "chaotic")), 3
    )


@claim("Abstract and Introduction")
def contact_shortens(data):
    """the contact gets shorter as its stiffness increases

    Condition: the contact duration falls from every contact of Fig. 13 to the next stiffer one
    """
    return below(data["fig13"].contact_duration.diff("frequency_ratio"), 0)
