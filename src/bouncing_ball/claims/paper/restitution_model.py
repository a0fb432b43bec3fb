"""Claims about the restitution model, Eqs. 1-9 and Fig. 3."""

from functools import partial

from bouncing_ball.claims import evidence
from bouncing_ball.claims.claim import formula, statement
from bouncing_ball.claims.paper import explanations as why
from bouncing_ball.claims.verdict import at_most

_SECTION = "Restitution model"
_formula = partial(formula, section=_SECTION)

MOTION = [
    _formula("restitution law", item="Eq. 2", text="velocity of the ball after an impact"),
    _formula("velocity before impact", item="Eq. 3", text="velocity of the ball before an impact"),
    _formula(
        "flight",
        item="Eqs. 1 and 4",
        text="flight of the ball, in physical and in dimensionless variables",
        row="Eq. 4",
    ),
    _formula("impact map", item="Eq. 5", text="phase and velocity from one impact to the next"),
    _formula("fixed point", item="Eq. 6", text="phase and velocity of the n-T orbit"),
]
saddle_node = _formula(
    "saddle-node", item="Eq. 7", text="the n-T orbits appear at this amplitude, in a saddle-node"
)
period_doubling = _formula(
    "period doubling",
    item="Eq. 8",
    text="the n-T orbits lose stability in a period doubling at this amplitude",
    remark="the paper refers to Holmes for the stability, and its introduction speaks of flights "
    "that are large compared with the excitation",
    explanation=why.holmes_map,
)


@statement(_SECTION, "Fig. 3")
def stable_between(data):
    """the orbits are stable from the saddle-node to the period doubling

    Condition: no computed orbit of Fig. 3 breaks the rule, with the period doubling of Eq. 5
    """
    return at_most(evidence.stability_exceptions(data), 0)


sticking = _formula("sticking", item="Eq. 9", text="permanent contact for amplitudes up to 1")
