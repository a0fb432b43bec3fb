"""Claims about the restitution model, Eqs. 1-9 and Fig. 3."""

from bouncing_ball.datasets import PERIOD_DOUBLING, SADDLE_NODE
from bouncing_ball.paper.claims.claim import Claim, claim, formula, formulas, of_formula
from bouncing_ball.paper.claims.evidence import GRID
from bouncing_ball.paper.claims.verdict import at_most

MOTION = formulas("motion")
saddle_node = formula(SADDLE_NODE, "Eq. 7", "the n-T orbits appear here, in a saddle-node")


def _of_both_maps(data):
    """Eq. 8 compared with the map whose period doubling it is, and with the map of Eq. 5."""
    first = data["fig03"].period_doubling_amplitude.isel(n=0)
    error = abs(first.sel(impact_map="holmes") / first.sel(impact_map="exact") - 1)
    return {
        "for flights high against the excitation": of_formula(data, "Eq. 8, Holmes' map"),
        "for the map of Eq. 5, r = 0.85, n = 1": at_most(
            error, data["formulas"].budget.sel(formula="Eq. 8")
        ),
    }


period_doubling = Claim(
    PERIOD_DOUBLING,
    "restored formula",
    "Eq. 8",
    "the n-T orbits lose stability in a period doubling at this amplitude",
    _of_both_maps,
    meant=True,
    remark="the introduction considers flights that are high against the excitation, as Holmes' "
    "map does; Eq. 5 does not assume this",
    answer="the assumption is announced, and the stability is taken from Holmes",
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
