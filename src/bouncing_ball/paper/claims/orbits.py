"""Claims about the n-T orbits of the spring-damper model: Eqs. 18-27, Figs. 8-10, Table 1."""

from itertools import product
from typing import Any

from bouncing_ball.paper.claims import evidence, restitution_model
from bouncing_ball.paper.claims import explanations as why
from bouncing_ball.paper.claims.claim import Claim, claim, formulas
from bouncing_ball.paper.claims.parameters import STIFF
from bouncing_ball.paper.claims.verdict import above, at_least, at_most, below
from bouncing_ball.paper.exhibits.printed_table1 import AXES, printed_text
from bouncing_ball.paper.orbits.stability import Bifurcation

_FIGURES = "Figs. 8 and 9"
EQUATIONS = formulas("orbits")


@claim("Abstract and Eqs. 21-26")
def no_analytical_solution(data):
    """the n-T orbits of the spring-damper model need continuation, as they have no analytical
    solution

    Condition: a solution takes more than the evaluation of a formula. For the whole branch, the
    formula misses some published orbit by more than rounding. For a given amplitude, branches fold,
    so that the duration of contact is not a function of the amplitude

    Remark: at a fixed duration of contact the equations of the orbit are linear, so that the whole
    branch has a formula, with the duration as its parameter. At a given amplitude the duration is
    a root of a scalar equation, which has several roots; that they have no formula is not shown

    Answer: the equations are transcendental in the unknowns that the paper chose
    """
    return {
        "the whole branch": above(*evidence.route_disagreement(data)),
        "the orbits at a given amplitude": at_least(evidence.folds(data), 1),
    }


@claim("Figs. 3, 5, 6, 8-10 and 13-15")
def one_impact_per_period(data):
    """the orbits that are drawn have one impact per period

    Condition: all of them are admissible, so that no earlier impact or release occurs on them
    """
    return at_most(evidence.inadmissible_orbits(data), 0)


@claim(_FIGURES)
def superimposed_when_stiff(data):
    """for the stiff contact the curves of both phases coincide

    Condition: no contact of the stiffest branch is longer than a hundredth of a radian
    """
    return at_most(evidence.contact_durations(data, -1), 0.01)


@claim(_FIGURES)
def apart_when_compliant(data):
    """the curves of both phases diverge as the frequency ratio decreases

    Condition: every contact of the most compliant branch is longer than a hundredth of a radian
    """
    return at_least(evidence.contact_durations(data, 0), 0.01)


@claim("Figs. 8 and 9, Table 1", id="saddle-node falls")
def saddle_node_falls(data):
    """with decreasing frequency ratio the saddle-node moves to lower amplitudes

    Condition: it falls from every row of Table 1 to the next more compliant one, for every n

    Remark: the introduction says that the existence conditions of the orbits change
    """
    return below(evidence.row_shift(data).sel(bound=Bifurcation.SADDLE_NODE), 0)


@claim("Figs. 8 and 9, Table 1", explanation=why.period_doubling_turns)
def period_doubling_rises_when_stiff(data):
    """from the stiffest contact to a frequency ratio of 10 the period doubling moves to higher
    amplitudes

    Condition: it rises from the first row of Table 1 to the second, for every n

    Answer: compared with the restitution model of Eq. 8 it does rise
    """
    ends = evidence.row_shift(data).sel(bound=Bifurcation.PERIOD_DOUBLING)
    return above(ends.sel(frequency_ratio=10), 0)


@claim("Figs. 8 and 9, Table 1")
def period_doubling_rises_when_compliant(data):
    """from a frequency ratio of 10 to 2 the period doubling moves to higher amplitudes

    Condition: it rises from the second row of Table 1 to the third, for every n
    """
    ends = evidence.row_shift(data).sel(bound=Bifurcation.PERIOD_DOUBLING)
    return above(ends.sel(frequency_ratio=2), 0)


@claim("Table 1")
def range_widens(data):
    """with decreasing frequency ratio the stability range is extended

    Condition: the width grows from every row of Table 1 to the next more compliant one, for every n
    """
    return above(evidence.row_shift(data).diff("bound"), 0)


def _entry(ratio: float, n: int, bound: str) -> Claim:
    """The claim of one printed number of Table 1; the stiffest row restates Eqs. 7 and 8."""
    said: dict[str, Any] = {
        "explanation": why.no_reading_fits,
        "answer": "the last digits are those to which points of a branch were computed or read off",
    }
    if ratio == max(AXES["frequency_ratio"]):
        equation = getattr(restitution_model, Bifurcation(bound).name.lower())
        said = {"explanation": why.ends_of_the_approximate_map, "restates": equation}
        said["answer"] = "the row is that of Eqs. 7 and 8, as the text says"
    return Claim(
        f"Table 1: {ratio:g}, {n}, {bound}",
        "number",
        "Table 1",
        f"{bound} of the {n}-T orbits at a frequency ratio of {ratio:g}",
        lambda data: data["table1"].computed.sel(frequency_ratio=ratio, n=n, bound=bound),
        printed=printed_text(ratio, n, bound),
        remark="the exponent of the first frequency ratio is unreadable, taken as 4",
        **said,
    )


TABLE_1 = [_entry(*place) for place in product(*AXES.values())]


@claim("Table 1")
def stiff_row(data):
    """the stability ranges of the stiffest contact are those of the restitution model

    Condition: the computed ends agree to half a unit of the printed digits

    Remark: this holds for the computed ranges; the printed upper ends are those of Eq. 8
    """
    return at_most(evidence.stiff_difference(data, "computed", "exact"), 0.0005)


@claim("Fig. 10")
def departure_from_nπ(data):
    """the bouncing-off velocity is no longer nπ: it starts to depart below a frequency ratio of 100

    Condition: it differs from nπ by at least 0.2 % at every contact up to that frequency ratio, for
    every amplitude

    Remark: the paper does not say when a departure starts; we take 0.2 % for visible
    """
    sweep = data["fig10"].sel(frequency_ratio=slice(None, STIFF))
    error = abs(sweep.bounce_velocity / sweep.restitution_bounce_velocity - 1)
    return at_least(error, 0.002)


@claim("Fig. 10", meant=True)
def amplitude_does_not_matter(data):
    """the bouncing-off velocity does not depend on the amplitude

    Condition: the frequency ratio from which on the three curves are within 1 % of nπ of each other
    is below the left end of the axis

    Remark: the left end of the axis is unreadable; below the frequency ratio found the amplitude
    matters

    Answer: the three curves coincide in the figure except at its very edge
    """
    meeting = evidence.amplitude_matters_below(data)
    return {f"on an axis from {left} on": at_most(meeting, left) for left in (2, 1)}
