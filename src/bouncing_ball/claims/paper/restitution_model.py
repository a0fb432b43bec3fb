"""Claims about the restitution model, Eqs. 1-9 and Fig. 3."""

from bouncing_ball.claims.claim import claim, formula
from bouncing_ball.claims.evidence import GRID
from bouncing_ball.claims.paper import explanations as why
from bouncing_ball.claims.verdict import at_most

MOTION = [
    formula("restitution law", "Eq. 2", "velocity of the ball after an impact"),
    formula("flight", "Eqs. 1, 3 and 4", "flight of the ball", "Eq. 4"),
    formula("impact map", "Eq. 5", "phase and velocity from one impact to the next"),
    formula("fixed point", "Eq. 6", "phase and velocity of the n-T orbit"),
]
saddle_node = formula("saddle-node", "Eq. 7", "the n-T orbits appear here, in a saddle-node")
period_doubling = formula(
    "period doubling",
    "Eq. 8",
    "the n-T orbits lose stability in a period doubling at this amplitude",
    remark="the paper refers to Holmes for the stability, and its introduction speaks of flights "
    "that are large compared with the excitation",
    explanation=why.approximate_map,
)


@claim("Fig. 3")
def stable_between(data):
    """the orbits are stable from the saddle-node to the period doubling

    Condition: no computed orbit of Fig. 3 breaks the rule, with the period doubling of Eq. 5
    """
    orbits = data["fig03"]
    doubling = orbits.period_doubling_amplitude.sel(impact_map="exact")
    node, lam = orbits.saddle_node_amplitude, orbits.amplitude
    between = (orbits.phase > 0) & (lam > node) & (lam < doubling)
    # At a bifurcation itself rounding decides.
    beside = (abs(lam / node - 1) > GRID) & (abs(lam / doubling - 1) > GRID)
    return at_most(((orbits.stable != between) & beside).sum(), 0)


sticking = formula("sticking", "Eq. 9", "permanent contact for amplitudes up to 1")
