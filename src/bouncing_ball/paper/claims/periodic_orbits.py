"""Claims about the n-T orbits of the spring-damper model and about permanent contact.

The orbits have Eqs. 18-27, Figs. 8-10 and Table 1, permanent contact Eqs. 28-36 and Fig. 11.
"""

from dataclasses import replace
from itertools import product

import xarray as xr

from bouncing_ball.datasets import PERIOD_DOUBLING, SADDLE_NODE
from bouncing_ball.paper.claims import FORMULA, evidence, impact_models
from bouncing_ball.paper.claims.claim import Claim, claim, formula, of_formula
from bouncing_ball.paper.claims.evidence import GRID, STIFF, TOLERANCE
from bouncing_ball.paper.claims.verdict import above, at_least, at_most, below, largest_number
from bouncing_ball.paper.exhibits.printed_table1 import AXES, printed_text
from bouncing_ball.periodic.orbit import Bifurcation

# The orbits.

_FIGURES = "Figs. 8 and 9"
EQUATIONS = [
    formula(
        "orbit equations",
        "Eqs. 18-26",
        "equations of the n-T orbits",
        "Eqs. 18-20",
        "Eqs. 21-26",
    ),
    formula("velocity balance", "Eq. 27", "bouncing-off velocity from that of impact"),
]


@claim("Abstract and Eqs. 21-26")
def no_analytical_solution(data):
    """the n-T orbits of the spring-damper model need continuation, as they have no analytical
    solution

    Compared: the smallest number of folds on a branch

    Condition: a solution takes more than the evaluation of a formula. For a given amplitude,
    branches fold, so that the duration of contact is not a function of the amplitude. For the whole
    branch, the formula misses some published orbit by more than rounding

    Remark: the paper looks for the orbits at a given amplitude, where the duration of contact is a
    root of a scalar equation with several roots; that they have no formula is not shown. At a fixed
    duration the equations are linear, so that the whole branch has a formula, with the duration as
    its parameter (*The branch in closed form*, Section 2 of the article)

    Answer: the equations are transcendental in the unknowns that the paper chose
    """
    folds = evidence.folds(data)
    both = data["witness"].sel(comparison=FORMULA)
    return {
        "the orbits at a given amplitude": at_least(folds, 1),
        "the whole branch": above(largest_number(both.disagreement), both.budget),
    }


@claim("Figs. 3, 5, 6, 8-10 and 13-15")
def one_impact_per_period(data):
    """the orbits that are drawn have one impact per period

    Compared: the number of orbits that are not admissible

    Condition: all orbits in our versions of these figures are admissible, so that no earlier impact
    or release occurs on them

    Remark: the orbits are those that we computed, as the figures of the paper were not available
    """
    return at_most(evidence.inadmissible_orbits(data), 0)


@claim(_FIGURES, at={"frequency_ratio": 1e4})
def superimposed_when_stiff(data):
    """for the stiff contact the curves of both phases coincide

    Compared: the longest contact, in radians of the table

    Condition: no contact of the stiffest branch is longer than a hundredth of a radian
    """
    return at_most(evidence.contact_durations(data, -1), 0.01)


@claim(_FIGURES, at={"frequency_ratio": 2.0})
def apart_when_compliant(data):
    """the curves of both phases diverge as the frequency ratio decreases

    Compared: the shortest contact, in radians of the table

    Condition: every contact of the most compliant branch is longer than a hundredth of a radian
    """
    return at_least(evidence.contact_durations(data, 0), 0.01)


@claim("Figs. 8 and 9, Table 1")
def bifurcations_move_apart(data):
    """with decreasing frequency ratio the saddle-node moves to lower amplitudes, and the period
    doubling to higher ones

    Compared: the smallest move of an end from the stiffest row to the most compliant one, in Λ

    Condition: for every n, the saddle-node falls and the period doubling rises

    Remark: the period doubling first falls, turns at a moderate ϖ, and then rises. In the printed
    table it rises at once: for the smaller two n because the upper ends of its stiffest row are
    those of Eq. 8, and for the largest n because the printed end of the next row is too high

    Answer: the sentence is about the whole move, from the stiffest to the most compliant contact
    """
    step = evidence.row_shift(data)
    whole = step.sum("frequency_ratio")
    return {
        "from the stiffest row of Table 1 to the most compliant one": above(_apart(whole), 0),
        "from each row to the next": above(_apart(step), 0),
    }


def _apart(move: xr.DataArray) -> list[xr.DataArray]:
    """How far the saddle-node falls and the period doubling rises."""
    fall = -move.sel(bound=Bifurcation.SADDLE_NODE, drop=True)
    rise = move.sel(bound=Bifurcation.PERIOD_DOUBLING, drop=True)
    return [fall, rise]


@claim("Table 1")
def range_widens(data):
    """with decreasing frequency ratio the stability range is extended

    Compared: the smallest growth of the width from a row to the next, in Λ

    Condition: the width grows from every row of Table 1 to the next more compliant one, for every n
    """
    return above(evidence.row_shift(data).diff("bound"), 0)


def ends_of_the_approximate_map(data):
    """The printed upper ends of the stiffest row are those of Eq. 8, which assumes flights that are
    high against the excitation. The spring-damper model does not assume this and converges to the
    map of Eq. 5.
    """
    printed = evidence.stiff_difference(data, "printed", "holmes")
    computed = evidence.stiff_difference(data, "computed", "exact")
    return {
        "largest distance of the printed ends from Eqs. 7 and 8": at_most(printed, 0.0005),
        "largest distance of the computed ends from the map of Eq. 5": at_most(computed, 0.0005),
        "error of the period doubling of Eq. 5": of_formula(data, "Eq. 8, corrected"),
    }


def scatter_of_the_printed_orbits(data):
    """The printed ranges of the more compliant contacts fit the exact stability of the orbits, with
    a scatter that is larger than that of rounding, and some of the printed saddle-nodes lie below
    every orbit. A continuation that was converged loosely could give both, but has more free
    numbers than the table can decide.
    """
    # The second group of rows is that of the compliant contacts.
    rows = data["forensics"].isel(rows=1)
    below_all = rows.unreachable.sel(reading="equations as they stand")
    compliant = rows.frequency_ratio < rows.frequency_ratio.max()
    off = (rows.printed_stable_width - rows.stable_width).where(compliant)
    size = (off**2).mean(["frequency_ratio", "n"]) ** 0.5
    exact, high_bounce = (
        size.sel(reading=name) for name in ("equations as they stand", "high-bounce stability")
    )
    rounding = rows.printed_stable_width_rounding.where(compliant).max()
    return {
        "distance from the exact stability, less than from the high-bounce one": (
            below(exact, high_bounce)
        ),
        "the same distance, more than rounding": above(exact, rounding),
        "saddle-nodes printed below every orbit": at_least(below_all, 1),
    }


# The limits of the stiffest row.
_LIMITS = {SADDLE_NODE: impact_models.saddle_node, PERIOD_DOUBLING: impact_models.period_doubling}


def _entry(ratio: float, n: int, bound: str) -> Claim:
    """The claim of one printed number of Table 1; the stiffest row restates Eqs. 7 and 8."""
    entry = Claim(
        f"Table 1: {ratio:g}, {n}, {bound}",
        "number",
        "Table 1",
        f"{bound} of the {n}-T orbits at a frequency ratio of {ratio:g}",
        lambda data: data["table1"].computed.sel(frequency_ratio=ratio, n=n, bound=bound),
        printed=printed_text(ratio, n, bound),
        compared="Λ",
        at={"frequency_ratio": ratio, "n": n},
        remark="the exponent of the first frequency ratio is unreadable, taken as 4",
        answer="the last digits are those to which points of a branch were computed or read off",
        explanation=scatter_of_the_printed_orbits,
    )
    if ratio < max(AXES["frequency_ratio"]):
        return entry
    return replace(
        entry,
        answer="the row is that of Eqs. 7 and 8, as the text says",
        explanation=ends_of_the_approximate_map,
        restates=_LIMITS[bound],
    )


TABLE_1 = [_entry(*place) for place in product(*AXES.values())]


@claim("Table 1", at={"frequency_ratio": 1e4})
def stiff_row(data):
    """the stability ranges of the stiffest contact are those of the restitution model

    Compared: the largest distance of a computed end from that of the restitution model, in Λ

    Condition: the computed ends agree to half a unit of the printed digits

    Remark: this holds for the computed ranges; the printed upper ends are those of Eq. 8
    """
    return at_most(evidence.stiff_difference(data, "computed", "exact"), 0.0005)


@claim("Fig. 10", missing="the departure from nπ that counts as visible")
def departure_from_nπ(data):
    """the bouncing-off velocity is no longer nπ: it starts to depart below a frequency ratio of 100

    Compared: the relative departure of the velocity from nπ

    Condition: for every amplitude it differs from nπ by a visible share at every contact up to that
    frequency ratio, and by less at every stiffer one

    Remark: the difference falls as the inverse of the frequency ratio, without a step, so that the
    visible share decides where it starts

    Answer: the departure is read off the figure
    """
    sweep = data["fig10"]
    error = abs(sweep.bounce_velocity / sweep.restitution_bounce_velocity - 1)
    ratio = sweep.frequency_ratio
    departed = error.sel(frequency_ratio=ratio <= STIFF * (1 + GRID))
    stiffer = error.sel(frequency_ratio=ratio > STIFF * (1 + GRID))
    return {
        "the departure at a frequency ratio of 100 is just visible": below(stiffer, departed),
        "a departure of 1 % is just visible": at_least(departed, TOLERANCE),
    }


@claim("Fig. 10", missing="the left end of the axis of Fig. 10, which is illegible")
def amplitude_does_not_matter(data):
    """the bouncing-off velocity does not depend on the amplitude

    Compared: the frequency ratio from which on the curves agree

    Condition: the frequency ratio from which on the three curves are within 1 % of nπ of each other
    is below the left end of the axis

    Remark: below the frequency ratio found the amplitude matters

    Answer: the three curves coincide in the figure except at its very edge
    """
    meeting = evidence.amplitude_matters_below(data)
    return {f"on an axis from {left} on": at_most(meeting, left) for left in (2, 1)}


# Permanent contact.

THRESHOLD = [
    formula("steady response", "Eqs. 29-31", "displacement in permanent contact", "Eq. 31"),
    formula("threshold", "Eqs. 32-33", "the largest amplitude of permanent contact", "Eq. 33"),
]


@claim("after Eq. 33", at={"frequency_ratio": 1e4})
def stiff_threshold(data):
    """the threshold tends to 1 for an infinite frequency ratio

    Compared: the relative distance of the threshold from 1

    Condition: it is within a millionth at the stiffest contact scanned
    """
    error = data["thresholds"].relative_error.sel(quantity="permanent_contact")
    return at_most(error.isel(frequency_ratio=-1), 1e-6)


SHAPE = [
    formula(
        "compliant threshold",
        "after Eq. 33",
        "the threshold grows beyond all bounds for a vanishing frequency ratio",
        "Eq. 33, ϖ → 0",
        at={"frequency_ratio": 1e-4, "damping_ratio": "random numbers"},
        remark="found to grow as the inverse square of the frequency ratio",
    ),
    formula(
        "resonant threshold",
        "after Eq. 33",
        "the threshold is 2ζ at ϖ = 1",
        "Eq. 33, ϖ = 1",
        at={"frequency_ratio": 1.0, "damping_ratio": "random numbers"},
    ),
    formula("larger frequency ratio", "Eq. 34", "the larger frequency ratio of a threshold"),
    formula("smaller frequency ratio", "Eq. 35", "the smaller frequency ratio of a threshold"),
    formula("lowest threshold", "Eq. 36, Fig. 11", "the lowest threshold, at any ϖ", "Eq. 36"),
]
