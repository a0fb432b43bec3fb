"""The claims of the paper, and the verdict on each, from the datasets of figures and tables.

A claim is a function of the datasets that decide it. If a number is printed, the function returns
the computed number. Otherwise it returns a condition for each sense of the words, first the literal
one. Section 3 of the article has the verdicts, and of which orbits a sense is asked; the module
`verdicts` has the former in code. The formulas were *restored* from a damaged text by deriving them
again; they are listed and not counted.
"""

from collections.abc import Callable, Mapping, Sequence
from functools import partial

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike, NDArray

from bouncing_ball import restitution
from carbonelli2011.measures import (
    STIFF_CONTACTS,
    at,
    at_ratio,
    branches,
    crossing,
    curve_errors,
    departure,
    error_of_eq_8,
    from_the_stiffest,
    laid_ranges,
    last_special,
    restitution_at_rest,
    spread,
    stable_ranges,
    steps,
    stiff_errors,
    whole_change,
)
from carbonelli2011.paper import (
    BOUNDS,
    LIMIT,
    PARAMETERS,
    PRINTED,
    QUANTITIES,
    STIFF,
    TABLE_1,
    TOLERANCES,
    end_of_range,
    printed_table,
)
from paper_replication.datasets import Datasets, parameters
from paper_replication.judgements import judged
from paper_replication.verdicts import (
    ROUNDING,
    Claim,
    Reading,
    above,
    argued,
    at_least,
    at_most,
    beyond,
    by_definition,
    largest,
    smallest,
    within,
)

within_limit = partial(within, limit=LIMIT)
"""Condition that a share is at most the error that the paper allows."""
beyond_limit = partial(beyond, limit=LIMIT)
"""Condition that a share is larger than that."""
LINE = 0.01
"""Width of a line divided by the length of the axis, about 0.5 mm of 5 cm. Smaller differences are
not visible in a figure."""


# Claims

CLAIMS: list[Claim] = []
"""The claims in the order of the paper, without the ends of Table 1."""


def claim(
    name: str,
    place: str,
    text: str,
    datasets: str = "",
    beside: str | None = None,
    uses: Mapping[str, Mapping] | None = None,
    **more,
) -> Callable:
    """Make a claim of the function that decides it, and add it to `CLAIMS`.

    `datasets` are the names of the datasets that the function takes, in its order; `uses` has them
    with the parameters that the claim needs, if these are not all of the paper. For a claim with a
    printed number, the function returns the computed one. The claim is shown `beside` a figure or
    table, by default that of the first dataset. A claim of one's own has an empty `place`.
    """

    def add(decide: Callable) -> Callable:
        needed = uses or {dataset: PARAMETERS.get(dataset, {}) for dataset in datasets.split()}
        printed = PRINTED.get(name, "")
        shown = next(iter(needed), "") if beside is None else beside
        CLAIMS.append(Claim(name, place, text, needed, decide, printed, beside=shown, **more))
        return decide

    return add


CURVES = "fig05 fig06 fig10"
"""The datasets of the paper's curves along ϖ, whose orbits are all stable and admissible. The orbit
of Figs. 12 to 14 is one of Fig. 5."""


def on_curves(asked: Callable[[xr.Dataset], ArrayLike], curves: Sequence[xr.Dataset]) -> NDArray:
    """Return the numbers that a sense asks of each dataset of `CURVES`, in one array."""
    return np.concatenate([np.ravel(asked(curve)) for curve in curves])


# Abstract and introduction


@claim(
    "stiff limit",
    "Abstract",
    "for a high contact stiffness the spring-damper model behaves as the restitution model",
    f"thresholds {CURVES}",
    remark="with the period doubling of Eq. 5, not of Eq. 8 (*period doubling*)",
)
def stiff_limit(thresholds, *curves):
    stiffest = thresholds["relative_error"].isel(frequency_ratio=-1)
    ends = on_curves(lambda curve: abs(curve_errors(curve).isel(frequency_ratio=-1)), curves)
    return [
        within_limit("every quantity at ϖ = 10⁴", stiffest),
        within_limit("every curve at its largest ϖ", ends),
    ]


@claim(
    "compliant divergence",
    "Abstract",
    "the predictions of the two models diverge when the stiffness decreases",
    f"thresholds {CURVES}",
    remark="at r = 1 the apparent restitution is exact",
)
def compliant_divergence(thresholds, *curves):
    errors = thresholds["relative_error"]
    growth = on_curves(lambda curve: whole_change(abs(curve_errors(curve))), curves)
    falling = []
    for line in errors:
        error = line.values[~np.isinf(line.values)]  # infinite if the contact has no saddle-node
        if np.any(np.diff(error) > 0):
            falling.append(QUANTITIES[line["quantity"].item()])
    count = np.nan if errors.isnull().any() else len(falling)
    passing = f" ({', '.join(falling)})" if falling else ""
    return [
        at_most(
            f"every step to a more compliant contact; errors that fall at a step{passing}",
            count,
            0,
        ),
        at_most(
            "every quantity on every curve from its stiffest contact to the most compliant",
            [*whole_change(errors).ravel(), *growth],
            ROUNDING,
        ),
    ]


@claim(
    "kinds of motion",
    "Introduction",
    "periodic, subharmonic and chaotic motions can be observed",
    "three_balls",
    remark="three balls start alike in the restitution model: one must repeat after each impact, "
    "one after several impacts and periods, and one never, without sticking to the table and with "
    "a Lyapunov exponent that is positive by five standard errors",
)
def kinds_of_motion(balls):
    periodic = (balls["impacts"] == 1) & (balls["periods"] > 0)
    subharmonic = (balls["impacts"] > 1) & (balls["periods"] > 1)
    kinds = sum(largest(kind) for kind in (periodic, subharmonic, chaotic(balls)))
    return [at_least("kinds of motion found", kinds, 3)]


def chaotic(balls: xr.Dataset) -> xr.DataArray:
    """1 for a chaotic motion: not periodic, no sticking, and a Lyapunov exponent of more than five
    standard errors. 0 for other motions; NaN if the exponent is missing.
    """
    wild = balls["impacts"] == 0
    exponent = balls["lyapunov_exponent"]
    is_chaotic = wild & (balls["stickings"] == 0) & (exponent > 5 * balls["lyapunov_error"])
    return is_chaotic.astype(float).where(~wild | exponent.notnull())


@claim(
    "high flights",
    "Introduction",
    "the flights are high against the excitation",
    "fig05 fig06 fig10",
    missing="how many times higher than the excitation a high flight is",
    remark="at the largest ϖ; the lowest ratio is that of r = 0.1",
)
def high_flights(*sweeps):
    ratios = [sweep["max_height"].isel(frequency_ratio=-1) / sweep["amplitude"] for sweep in sweeps]
    lowest = smallest([smallest(ratio) for ratio in ratios])
    neglect = []
    for sweep in sweeps:
        n = parameters(sweep)["n"]
        r = sweep["restitution"].values
        exact = restitution.period_doubling(n, r)
        neglect.append(abs(exact / restitution.holmes_period_doubling(n, r) - 1).max())
    return [
        at_least("flights ten times as high as the excitation, Figs. 5, 6 and 10", lowest, 10.0),
        at_least("flights higher than the excitation on these orbits", lowest, 1.0),
        within_limit("so high that Eq. 8 is right within 1 %", neglect),
    ]


@claim(
    "direct map",
    "Introduction and Abstract",
    "if flights are high against the excitation, the restitution model has a direct iterated map",
)
def direct_map():
    return [
        argued("the map whose flights end at the height of their start", True, "it is explicit"),
        argued("the map of Eq. 5", False, "the time of flight is a root of its first line"),
    ]


@claim(
    "complete study",
    "Introduction and Conclusion",
    "the direct map allows a complete analytical study of the restitution model",
    remark="the paper itself says that the motion can be chaotic",
)
def complete_study():
    return [
        argued("a study of every motion", False, "we know no formula for a chaotic motion"),
        argued("the n-T orbits and their first bifurcations", True, "Eqs. 6-8 are formulas"),
    ]


@claim(
    "no assumptions",
    "Introduction",
    "no assumptions are needed to solve the motion of the spring-damper model",
    remark="the model itself has assumptions: a constant damping ratio, and a contact that pulls "
    "before its release",
)
def no_assumptions():
    reason = "Eqs. 21-26 do not neglect the table against the height of the flight"
    return [by_definition("the solution of the equations of motion", reason)]


@claim(
    "no analytical solution",
    "Abstract, Introduction and after Eq. 26",
    "the n-T orbits of the spring-damper model have no analytical solution, and need numerical "
    "continuation",
    remark="at a given Λ the duration of the contact is the root of one transcendental equation; "
    "the paper does not show that it has no formula",
)
def no_analytical_solution():
    linear = "at a given duration of the contact Eqs. 21-26 are linear, so that it has a formula"
    return [
        argued("the orbits at a given Λ", True, "as far as we know"),
        argued("the whole branch", False, linear),
        argued("the need for continuation", False, "roots of one equation in the duration do"),
    ]


@claim(
    "contact lengthens",
    "Abstract and Introduction",
    "the contact gets longer as its stiffness decreases",
    CURVES,
)
def contact_gets_longer(*curves):
    shortening = on_curves(lambda curve: -steps(curve["contact_duration"]), curves)
    return [above("the smallest change of the duration to the next contact", shortening)]


@claim(
    "existence changes",
    "Introduction",
    "for a lower stiffness the n-T orbits exist under other conditions than in the restitution "
    "model",
    "table1",
)
def existence_changes(table1):
    compliant = from_the_stiffest(table1).isel(frequency_ratio=slice(1, None))
    node = compliant["computed"].sel(bound="saddle-node")
    rigid = table1["restitution_range"].sel(impact_map="exact", bound="saddle-node")
    moved = abs(node / rigid - 1)
    return [beyond_limit("the smallest relative change of a saddle-node at ϖ = 2 and 10", moved)]


# The restitution model


@claim(
    "flight duration",
    "before Eq. 6",
    "on the n-T orbits the free flight lasts exactly 2V′",
    remark="both maps have the orbits of Eq. 6, and differ in their stability only (Eqs. 8 and R1)",
)
def flight_duration():
    reason = "by algebra: the flight ends at the height at which it begins, so that s = 2V′"
    return [
        argued("the map of Eq. 5", True, reason),
        argued("the map whose flights end at the height of their start", True, "by algebra"),
    ]


@claim(
    "saddle-node",
    "after Eq. 7, Fig. 3",
    "the n-T orbits appear in a saddle-node at the Λ of Eq. 7",
    beside="fig03",
)
def saddle_node():
    return [
        argued("the smallest Λ at which Eq. 6 has a phase", True, "by algebra: cos φ ≤ 1"),
        argued("a multiplier of Eq. 5 that is 1 there", True, "by algebra: sin φ = 0"),
    ]


@claim(
    "period doubling",
    "Eq. 8",
    "the n-T orbits lose their stability in a period doubling at the Λ of Eq. 8",
    "fig03",
    remark="the introduction announces flights that are high against the excitation, and Eq. 5 "
    "does not assume them",
)
def period_doubling(fig03):
    doubling = fig03["period_doubling_amplitude"]
    off = abs(doubling.sel(impact_map="exact") / doubling.sel(impact_map="holmes") - 1)
    return [
        at_most("the map of Eq. 5", off, ROUNDING),
        argued(
            "the map whose flights end at the height of their start",
            True,
            "by algebra: Eq. 8 is its period doubling",
        ),
    ]


@claim(
    "stable between",
    "Fig. 3, Figs. 8 and 9, Table 1",
    "the stable orbits of a family are those from its saddle-node to its period doubling",
    "fig08 fig09 fig15",
    remark="in the restitution model it follows from Eq. 5 by algebra; the other ranges have long "
    "contacts, which pull at their end",
    beside="table1",
)
def stability_range(*figures):
    absent = 0.0
    others = []
    for branch in branches(*figures):
        ends = last_special(branch, "saddle-node"), last_special(branch, "period doubling")
        ranges = stable_ranges(branch)
        absent += np.nan if np.isnan(ends).any() else ends not in ranges
        ranges += laid_ranges(branch)
        others += [f"{low:.4f}-{high:.4f}" for low, high in ranges if (low, high) != ends]
    extra = f" (Λ = {', '.join(others)})" if others else ""
    followed = "the instability of all other orbits on the branches of one contact that we followed"
    return [
        at_most("the stability of this range, in branches without it", absent, 0),
        at_most(f"{followed}, in stable ranges{extra}", len(others), 0),
    ]


# The spring-damper model


@claim(
    "bounces off later",
    "after Eq. 15",
    "contrary to the restitution model the ball bounces off later than its impact",
)
def bounces_off_later():
    reason = "a contact of finite stiffness needs time to stop the ball"
    return [by_definition("every contact", reason)]


@claim(
    "critical damping",
    "after Eq. 16",
    "a restitution coefficient that tends to zero leads to the subcritical case, in which the "
    "damping ratio tends to 1",
    remark="r and ζ are illegible in our copy, and the arrows after them are not",
)
def critical_damping():
    limit = "by algebra: 1 - ζ tends to zero as π²/(2 ln²r)"
    return [
        argued("a damping ratio that tends to 1", True, limit),
        argued("a subcritical case for every r > 0", True, "by algebra: ζ < 1 in Eq. 16"),
    ]


@claim("no damping", "after Eq. 16", "a restitution coefficient of 1 leads to no damping")
def no_damping():
    return [argued("a damping ratio of 0 at r = 1", True, "by algebra: ln 1 = 0 in Eq. 16")]


@claim(
    "static table",
    "after Eq. 16",
    "Eq. 16 is perfectly valid for a table at rest",
    remark="the ball falls with the velocity π of the 1-T orbit, with each r of Fig. 5; the weight "
    "matters less for a stiffer contact, a faster ball or a larger r",
)
def static_table():
    coefficients = [curve["restitution"] for curve in PARAMETERS["fig05"]["cases"].values]

    def error(ratio: float, weight: float) -> list[float]:
        return [abs(restitution_at_rest(r, ratio, weight) / r - 1) for r in coefficients]

    return [
        at_most("a contact with weight (Eq. 10), at ϖ = 100", error(100, 1), ROUNDING),
        at_most("a contact without weight", error(10, 0), ROUNDING),
        within_limit("a contact with weight at ϖ = 100, within 1 %", error(100, 1)),
        within_limit("a contact with weight at ϖ = 10, within 1 %", error(10, 1)),
    ]


@claim(
    "moving table",
    "after Eq. 16",
    "Eq. 16 is not necessarily valid for a vibrating table",
    "fig05 fig06",
)
def moving_table(fig05, fig06):
    both = [abs(data["apparent_restitution"] / data["restitution"] - 1) for data in (fig05, fig06)]
    curves = fig06.sel(frequency_ratio=10.0, method="nearest")
    r = float(curves["restitution"].max())
    at_rest = restitution_at_rest(r, float(curves["frequency_ratio"]))
    moved = abs(curves["apparent_restitution"] / at_rest - 1)
    name = "the largest relative difference of the apparent restitution from"
    return [
        beyond_limit(f"{name} r", largest([largest(error) for error in both])),
        beyond_limit(f"{name} that on a table at rest, at ϖ = 10", largest(moved)),
    ]


@claim(
    "table velocities",
    "before Eq. 17",
    "contrary to the restitution model the velocities of the table before and after the impact are "
    "different",
    "fig08 fig09 fig15",
    remark="they are equal where φ = -τ_b/2, next to the saddle-node of every branch",
)
def table_velocities(*figures):
    middles = [branch["phase"] + branch["contact_duration"] / 2 for branch in branches(*figures)]
    signs = [np.sign(np.sin(phases.values.ravel())) for phases in middles]
    equal = [np.abs(np.sign(np.diff(curve))).sum() for curve in signs]
    return [
        at_most("every orbit, in orbits with equal velocities", sum(equal), 0),
        at_most("all orbits of a branch but one", equal, 1),
    ]


@claim(
    "closer with stiffness",
    "after Fig. 5",
    "the higher the frequency ratio, the closer the apparent restitution coefficient is to r",
    CURVES,
    remark="in Fig. 5 the curves with damping cross r and return to it from below; the curve of r "
    "= 1 equals r",
)
def closer_with_stiffness(*curves):
    def off(curve: xr.Dataset) -> xr.DataArray:
        return abs(curve["apparent_restitution"] - curve["restitution"])

    ends = on_curves(lambda curve: whole_change(off(curve)), curves)
    return [
        at_most("each step on the curves of Fig. 5", steps(off(curves[0])), ROUNDING),
        at_most("the ends of every curve", ends, ROUNDING),
    ]


def line_width(curves: xr.DataArray) -> float:
    """The width of a line on an axis that the curves fill."""
    return max(LINE * (largest(curves) - smallest(curves)), ROUNDING)


@claim(
    "depends on amplitude",
    "before Fig. 6",
    "the apparent restitution coefficient depends on the amplitude",
    "fig06",
    remark="two curves must be apart by more than the width of a line, 1 % of the axis",
)
def depends_on_amplitude(fig06):
    curves = fig06["apparent_restitution"]
    apart = curves.max("case", skipna=False) - curves.min("case", skipna=False)
    return [at_least("the largest distance of two curves", largest(apart), line_width(curves))]


@claim(
    "dip at 1.2",
    "before Fig. 6",
    "at Λ = 1.2, as the frequency ratio falls, the apparent restitution coefficient first "
    "decreases slightly",
    "fig06",
    remark="a dip must be deeper than the width of a line, 1 % of the axis; the curve of Λ = 0.7 "
    "has one, so the labels may be swapped",
)
def dip_at_12(fig06):
    curves = fig06.swap_dims(case="amplitude")["apparent_restitution"]
    depth = (curves["restitution"] - curves).max("frequency_ratio", skipna=False)
    name = f"the depth below r at Λ = 1.2; it is {float(at(depth, amplitude=0.7)):.2g} at Λ = 0.7"
    return [at_least(name, at(depth, amplitude=1.2), line_width(curves))]


@claim(
    "compliant end of 1.2",
    "before Fig. 6",
    "at Λ = 1.2 the apparent restitution coefficient tends to this value at ϖ = 1",
    "fig06",
    remark="the two other curves round to the same digits there, so the number says little about "
    "the amplitude",
)
def compliant_end(fig06):
    curves = fig06.swap_dims(case="amplitude")["apparent_restitution"]
    return at(curves, amplitude=1.2, frequency_ratio=1.0)


@claim(
    "negligible above 100",
    "after Fig. 6",
    "the difference of the apparent restitution coefficient from r is negligible above ϖ = 100",
    "fig05 fig06",
    remark="negligible is taken as 1 %, the limit that the paper sets for errors",
)
def negligible_above_100(*sweeps):
    stiff = [sweep.sel(frequency_ratio=STIFF_CONTACTS) for sweep in sweeps]
    off = [abs(part["apparent_restitution"] - part["restitution"]) for part in stiff]
    shares = [part / part["restitution"] for part in off]
    return [
        within_limit("the difference", [largest(part) for part in off]),
        within_limit("the difference as a share of r", [largest(part) for part in shares]),
    ]


# n-T orbits of the spring-damper model


@claim(
    "one impact per period",
    "Conclusion and Introduction",
    "the periodic orbits that are studied have one impact per period",
    "fig03 fig05 fig06 fig08 fig09 fig10 fig13 fig14 fig15 table1",
    remark="no earlier impact or release may occur on the orbits of our figures and of Table 1",
    beside="several",
)
def one_impact_per_period(*figures):
    wrong = 0.0
    for figure in figures:
        phase = figure["phase" if "phase" in figure else "special_phase"]
        admissible = figure["admissible"].values[phase.notnull().values]
        wrong += np.count_nonzero(~admissible.astype(bool)) if admissible.size else np.nan
    return [at_most("orbits that are not admissible", wrong, 0)]


@claim(
    "six unknowns",
    "before Eq. 21",
    "the orbits have six unknowns, two of them for convenience",
    remark="at a given duration of the contact Eqs. 21-26 are linear, so that one unknown suffices",
)
def six_unknowns():
    reason = "z′_i, z′_b, τ_b and φ, with A and B, are as many as Eqs. 21-26"
    return [by_definition("as many unknowns as equations", reason)]


@claim(
    "exactly computed",
    "after Fig. 7",
    "the n-T orbits can be exactly computed from the periodicity",
)
def exactly_computed():
    return [
        argued("a numerical solution of Eqs. 21-26", True, "they neglect nothing"),
        argued("a formula at a given Λ", False, "as far as we know (*no analytical solution*)"),
    ]


@claim(
    "damping of 0.85",
    "Figs. 8-10",
    "damping ratio for r = 0.85",
    "fig08",
    remark="a value of the restored Eq. 16",
)
def damping_of_085(fig08):
    return fig08["damping_ratio"]


@claim(
    "superimposed when stiff",
    "after Fig. 9",
    "for the stiff contact the curves of φ and of the phase of release coincide",
    "fig08 fig09",
    remark="they must be closer than the width of a line, 1 % of the axis of phases",
)
def superimposed_when_stiff(*figures):
    stiff = [figure.sel(frequency_ratio=figure["frequency_ratio"].max()) for figure in figures]
    width = smallest([line_width(figure["phase"]) for figure in stiff])
    longest = [largest(figure["contact_duration"]) for figure in stiff]
    return [
        at_most("the longest contact at the largest ϖ, in radians of the table", longest, width)
    ]


@claim(
    "apart when compliant",
    "after Fig. 9",
    "the curves of φ and of the phase of release diverge as the frequency ratio decreases",
    "fig08 fig09",
    remark="every contact must be longer than all contacts of the next stiffer branch",
)
def apart_when_compliant(*figures):
    growth = []
    for figure in figures:
        duration = figure["contact_duration"].sortby("frequency_ratio", ascending=False)
        shortest = duration.min("point", skipna=False).values
        longest = duration.max("point", skipna=False).values
        growth.append(shortest[1:] - longest[:-1])
    return [above("the smallest growth from a branch to the next", growth)]


def outwards_in(fig15: xr.Dataset) -> list[xr.DataArray]:
    """Return how far Λ of saddle-node and period doubling lie outside the range of Eq. 5."""
    (branch,) = branches(fig15)
    return [
        fig15["saddle_node_amplitude"] - last_special(branch, "saddle-node"),
        last_special(branch, "period doubling") - fig15["period_doubling_amplitude"],
    ]


@claim(
    "bifurcations move apart",
    "after Fig. 9, Table 1",
    "as the frequency ratio falls the saddle-node moves to lower amplitudes, and the period "
    "doubling to higher ones",
    "table1 lowest_doubling fig15",
    remark="the printed period doubling rises from the first row on; the paper calls the moves "
    "slight",
)
def bifurcations_move(table1, lowest, fig15):
    move = from_the_stiffest(table1)["computed"].diff("frequency_ratio")
    outwards = xr.concat(
        [-move.sel(bound="saddle-node"), move.sel(bound="period doubling")], "bound"
    )
    turn = lowest["period_doubling_turn"]
    turns = ", ".join(f"{ratio:.4g}" for ratio in turn.values)
    turning = f"both from each row of Table 1 to the next (the doubling is lowest at ϖ = {turns})"
    return [
        above(turning, outwards.where(turn.notnull().all())),
        above("both from the first row to the last", outwards.sum("frequency_ratio", skipna=False)),
        above("both in Fig. 15", outwards_in(fig15)),
    ]


@claim(
    "range widens",
    "after Fig. 9, Table 1",
    "as the frequency ratio falls the stability range is extended",
    "table1 fig15 validity_map",
    remark="at ϖ = 2 there are further stable ranges; both ends move",
)
def range_widens(table1, fig15, validity_map):
    width = from_the_stiffest(table1)["computed"].diff("bound")
    return [
        above("the smallest growth from a row to the next, in Λ", width.diff("frequency_ratio")),
        above("the growth in Fig. 15", sum(outwards_in(fig15))),
        above(
            "the smallest growth on the map, divided by the width",
            validity_map["below_share"] - validity_map["doubled_share"],
        ),
    ]


@claim(
    "stiff row",
    "after Table 1",
    "the stability ranges at the largest frequency ratio are those of the restitution model",
    "table1",
    remark="half a unit of the printed digits is allowed; the printed row is that of Eqs. 7 and 8",
)
def stiff_row(table1):
    stiffest = from_the_stiffest(table1).isel(frequency_ratio=0)
    exact = table1["restitution_range"].sel(impact_map="exact")
    holmes = table1["restitution_range"].sel(impact_map="holmes")
    half = 0.0005
    return [
        at_most(
            "difference of the computed row and Eqs. 7 and 8",
            abs(stiffest["computed"] - holmes),
            half,
        ),
        at_most(
            "difference of the computed row and the map of Eq. 5",
            abs(stiffest["computed"] - exact),
            half,
        ),
        at_most(
            "difference of the printed row and Eqs. 7 and 8",
            abs(stiffest["printed"] - holmes),
            half,
        ),
    ]


@claim(
    "no longer nπ",
    "before Fig. 10",
    "the bouncing-off velocity is no longer nπ",
    CURVES,
    beside="fig10",
)
def no_longer_nπ(*curves):
    return [above("the smallest relative departure from nπ", on_curves(departure, curves))]


@claim(
    "departure from nπ",
    "after Fig. 10",
    "the bouncing-off velocity starts to depart from nπ below ϖ = 100",
    "fig10 validity_map",
    remark="1 % is the paper's limit for errors; the width of a line is 1 % of the axis",
)
def departs_below_100(fig10, validity_map):
    error = departure(fig10)

    def begins(name: str, size: float) -> Reading:
        onset = crossing(error.min("case", skipna=False), size)
        return Reading(name, abs(onset - STIFF) <= STIFF / 2, onset, "100 ± 50")

    return [
        begins("the ϖ at which a departure of 1 % begins", LIMIT),
        begins("the ϖ at which a departure by the width of a line begins", LINE * largest(error)),
        within_limit(
            "no departure of 1 % above ϖ = 100, on the map",
            validity_map["largest_error"].sel(quantity="bounce_velocity"),
        ),
    ]


@claim(
    "amplitude does not matter",
    "after Fig. 10",
    "the bouncing-off velocity does not depend on the amplitude",
    "fig10 fig06",
    missing="the left end of the axis of Fig. 10, which cannot be read",
    remark="the three curves must lie within 1 % of nπ",
)
def amplitude_does_not_matter(fig10, fig06):
    apart = spread(fig10)
    meeting = crossing(apart, LIMIT)
    at_2 = at_ratio(apart, 2.0)
    stiffer = apart.sel(frequency_ratio=slice(2.0, None))
    return [
        within_limit("an axis from ϖ = 2 on", [at_2, *stiffer]),
        within_limit(
            f"an axis that begins at ϖ = 1 (the velocities agree above {meeting:.4f})", apart
        ),
        within_limit("the curves of Fig. 6", spread(fig06)),
    ]


# Permanent contact

CONTACT_OF_FIG11 = {"fig11": {"release": "displacement"}}
"""What Eqs. 33 to 36 need. Algebra decides on them, for every r and ϖ."""


@claim(
    "stiff threshold",
    "after Fig. 11",
    "the threshold of permanent contact tends to 1 for an infinite frequency ratio",
    uses=CONTACT_OF_FIG11,
)
def stiff_threshold(_):
    return [argued("the limit of Eq. 33", True, "by algebra: 1/ϖ² and 1/ϖ⁴ vanish")]


@claim(
    "compliant threshold",
    "after Fig. 11",
    "the threshold of permanent contact grows beyond all bounds for a vanishing frequency ratio",
    uses=CONTACT_OF_FIG11,
)
def compliant_threshold(_):
    return [argued("the limit of Eq. 33", True, "by algebra: 1/ϖ⁴ prevails")]


@claim(
    "resonant threshold",
    "after Fig. 11",
    "the threshold of permanent contact is 2ζ at ϖ = 1",
    uses=CONTACT_OF_FIG11,
)
def resonant_threshold(_):
    return [argued("Eq. 33 at ϖ = 1", True, "by algebra: 1 + 4ζ² - 2 + 1 = 4ζ²")]


@claim(
    "lowest threshold",
    "Eq. 36, Fig. 11",
    "permanent contact remains stable at every frequency ratio up to Λ = 2ζ√(1 - ζ²)",
    remark="we did not show that large disturbances decay",
    uses=CONTACT_OF_FIG11,
)
def lowest_threshold(_):
    return [
        argued("its existence at every ϖ", True, "by algebra: the minimum of Eq. 33"),
        argued("the decay of small disturbances", True, "by algebra: they are damped by ζ > 0"),
    ]


# Both models side by side


@claim(
    "damping of 0.65",
    "Figs. 11-16",
    "damping ratio for r = 0.65",
    "fig16",
    remark="a value of the restored Eq. 16; printed as 0.136 except at Fig. 16",
)
def damping_of_065(fig16):
    return fig16["damping_ratio"]


@claim(
    "velocity rises",
    "after Fig. 12, Fig. 10",
    "as the frequency ratio rises the bouncing-off velocity rises",
    CURVES,
    beside="fig10",
)
def velocity_rises(*curves):
    def rises(curve: xr.Dataset) -> NDArray:
        return steps(curve["bounce_velocity"])

    return [
        above("the smallest rise on the curves of Fig. 10", rises(curves[-1])),
        above("the smallest rise on every curve", on_curves(rises, curves)),
    ]


@claim(
    "height rises",
    "after Fig. 12, Fig. 14",
    "as the frequency ratio rises the maximum height of the flight rises",
    f"fig12 fig14 {CURVES}",
)
def height_rises(fig12, fig14, *curves):
    highest = fig12["ball"].max("table_phase", skipna=False)
    everywhere = on_curves(lambda curve: steps(curve["max_height"]), curves)
    return [
        above("the smallest rise on the orbits of Fig. 12", steps(highest)),
        above("the smallest rise on the same orbits at every ϖ", steps(fig14["max_height"])),
        above(f"every curve, which falls in {np.sum(everywhere <= 0)} steps", everywhere),
    ]


@claim(
    "phases converge",
    "after Fig. 12, Fig. 13",
    "as the frequency ratio rises the phases of impact and of release converge to the phase of the "
    "restitution model",
    f"fig13 {CURVES}",
)
def phases_converge(fig13, *curves):
    def off(curve: xr.Dataset) -> NDArray:
        impact = curve_errors(curve).sel(measure="phase")
        release = impact + curve["contact_duration"] / (2 * np.pi)
        return np.abs([impact, release])[..., -1]

    return [
        within_limit("the largest distance at the stiffest contact, in periods", off(fig13)),
        within_limit("the same on every curve", on_curves(off, curves)),
    ]


@claim(
    "height threshold",
    "after Eq. 37, Fig. 14",
    "frequency ratio above which the maximum heights differ by less than 1 %",
    uses={"fig14": PARAMETERS["fig14"] | TOLERANCES["fig14"]},
)
def height_threshold(fig14):
    return fig14["error_threshold"]


@claim(
    "threshold ensures",
    "before Eq. 37",
    "above this threshold the relative error is less than 1 %",
    f"fig14 {CURVES}",
    remark="our threshold is the largest solution, which ensures it",
)
def threshold_ensures(fig14, *curves):
    def solutions(error: xr.DataArray) -> NDArray:
        side = np.sign(np.abs(error.values) - LIMIT)
        return np.abs(np.diff(side)).sum(axis=-1) / 2

    everywhere = on_curves(
        lambda curve: solutions(curve_errors(curve).sel(measure="max_height")), curves
    )
    return [
        at_most("one solution of Eq. 37 on Fig. 14", solutions(fig14["relative_error"]), 1),
        at_most("one on every curve", everywhere, 1),
    ]


@claim(
    "representative",
    "after Fig. 15",
    "the restitution model remains representative, with a small error on the stability range",
    "fig15",
    missing="which error counts as small",
)
def representative(fig15):
    (branch,) = branches(fig15)
    node = abs(last_special(branch, "saddle-node") / fig15["saddle_node_amplitude"] - 1)
    upper = last_special(branch, "period doubling")
    eq_5 = abs(upper / fig15["period_doubling_amplitude"] - 1)
    given = parameters(fig15)
    printed = restitution.holmes_period_doubling(given["n"], given["restitution"])
    rows = printed_table().astype(float)
    slight = float(abs(rows / rows.sel(frequency_ratio=rows["frequency_ratio"].max()) - 1).max())
    return [
        at_most("both ends, as the moves of Table 1 that are called slight", [node, eq_5], slight),
        within_limit("the upper end and Eq. 8, within 1 %", abs(upper / printed - 1)),
        within_limit("the upper end and Eq. 5, within 1 %", eq_5),
        within_limit("the lower end, within 1 %", node),
    ]


@claim(
    "permanent contact threshold",
    "Fig. 16 and after it",
    "frequency ratio below which the thresholds of permanent contact differ by more than 1 %",
    uses={"fig16": PARAMETERS["fig16"] | TOLERANCES["fig16"]},
)
def permanent_contact_threshold(fig16):
    return fig16["error_threshold"]


@claim(
    "different below 6 only",
    "after Fig. 16",
    "the thresholds of permanent contact differ only for really low frequency ratios, below 6",
    "fig16",
    remark="thresholds differ if their relative difference is more than 1 %, as in Eq. 38",
)
def different_below_6_only(fig16):
    printed = float(PRINTED["permanent contact threshold"])
    error = fig16["relative_error"]
    stiffer = error.sel(frequency_ratio=slice(printed, None))
    return [within_limit("no difference from ϖ = 6 on", [at_ratio(error, printed), *stiffer])]


@claim(
    "easy maps",
    "Conclusion",
    "the restitution model leads quickly to analytical solutions, which give maps of phase and "
    "velocity easily",
    remark="the paper introduces Eq. 5 as its map of phase and velocity; the direct map is a claim "
    "of its own",
)
def easy_maps():
    return [
        argued("the map of Eq. 5", False, "the time of flight is a root of its first line"),
        argued("the map whose flights end at the height of their start", True, "it is explicit"),
        argued("the n-T orbits of Eq. 5", True, "Eqs. 6 and 7 are formulas"),
    ]


@claim(
    "safe above 100",
    "Conclusion",
    "the restitution model is good above a frequency ratio of 100",
    f"validity_map fig16 thresholds {CURVES}",
    remark="the paper sets the limit of 1 % for the maximum height and for permanent contact; "
    "the orbits of the map are stable in both models, with n = 1, 2, 3 and r = 0.05 to 0.95, and "
    "limits at the ends of their range; the last two senses are those of n = 1, r = 0.65",
)
def safe_above_100(validity_map, fig16, thresholds, *curves):
    orbits = validity_map["largest_error"]
    presented = stiff_errors(*curves)
    contact = fig16["relative_error"].sel(frequency_ratio=STIFF_CONTACTS)
    ends = thresholds["relative_error"].sel(frequency_ratio=STIFF_CONTACTS)
    return [
        within_limit("every quantity on Figs. 5, 6 and 10", presented),
        within_limit("the maximum height there", presented.sel(measure="max_height")),
        within_limit("the maximum height on the orbits of the map", orbits.sel(quantity="summit")),
        within_limit("the bouncing-off velocity", orbits.sel(quantity="bounce_velocity")),
        within_limit("the apparent restitution", orbits.sel(quantity="apparent_restitution")),
        within_limit("the phase in periods", orbits.sel(quantity="phase_in_periods")),
        within_limit("the period doubling of Eq. 8", error_of_eq_8(thresholds)),
        within_limit("permanent contact", contact),
        within_limit("the saddle-node", ends.sel(quantity="saddle_node")),
        within_limit("the period doubling of Eq. 5", ends.sel(quantity="period_doubling")),
    ]


@claim(
    "other problems",
    "Conclusion",
    "a frequency ratio above 100 is enough for bouncing-ball-like problems",
    missing="whether it computed other motions than n-T orbits with one impact and permanent "
    "contact",
    remark="the paper says itself that it studies only these two",
)
def other_problems():
    return []


# Table 1


def table1_ends(
    table: Mapping[tuple[float, int], tuple[str, str]] = TABLE_1,
) -> list[Claim]:
    """A claim for each end that Table 1 prints."""
    ends = []
    stiffest = max(ratio for ratio, _ in table)
    for (ratio, n), texts in table.items():
        for bound, text in zip(BOUNDS, texts, strict=True):
            where = {"frequency_ratio": ratio, "n": n, "bound": bound}
            remark = ""
            if ratio == stiffest and bound == "period doubling":
                remark = "the printed end is that of Eq. 8 (*stiff row*)"
            elif ratio == stiffest:
                remark = "a value of Eq. 7, to which every stiff contact tends"
            ends.append(
                Claim(
                    end_of_range(ratio, n, bound),
                    TABLE,
                    f"Λ of the {bound} of the {n}-T orbits at ϖ = {ratio:g}",
                    {"table1": PARAMETERS["table1"]},
                    lambda table1, where=where: at(table1["computed"], **where),
                    printed=text,
                    remark=remark,
                    beside="table1",
                )
            )
    return ends


# The restored formulas

FORMULAS = [
    (
        "Eqs. 1, 3 and 4",
        "height and velocity in flight",
        "restitution.height, restitution.velocity",
    ),
    ("Eq. 2", "velocity after an impact", "restitution.impact_map"),
    (
        "Eq. 5",
        "phase and velocity from one impact to the next",
        "restitution.impact_map, restitution.flight_time",
    ),
    (
        "Eq. 6",
        "velocity and phase of the n-T orbit",
        "restitution.bounce_velocity, restitution.impact_phase",
    ),
    ("Eq. 7", "saddle-node", "restitution.saddle_node"),
    ("Eq. 8", "period doubling", "restitution.holmes_period_doubling"),
    ("Eq. 9", "threshold of permanent contact", "restitution.PERMANENT_CONTACT"),
    (
        "Eqs. 10-13",
        "equation of contact, and the motion that solves it",
        "spring_damper.Contact.motion",
    ),
    ("Eqs. 14 and 15", "motion in flight", "orbits.Family.motion"),
    ("Eq. 16", "damping ratio", "spring_damper.damping_ratio"),
    ("Eq. 17", "apparent restitution coefficient", "orbits.Family.apparent_restitution"),
    (
        "Eqs. 18-26",
        "equations of the n-T orbits",
        "orbits.Family.contact_end, orbits.Family.equations",
    ),
    ("Eq. 27", "bouncing-off velocity", "orbits.Family.bounce_velocity"),
    (
        "Eqs. 28-33",
        "displacement in permanent contact, and its threshold",
        "spring_damper.permanent_contact",
    ),
    ("Eqs. 34 and 35", "ϖ of a threshold", "spring_damper.permanent_contact_ratios"),
    ("Eq. 36", "lowest threshold", "spring_damper.lowest_permanent_contact"),
    ("Eqs. 37 and 38", "relative errors", "errors.relative_error"),
]
"""Equations of the paper, what they give, and the members that compute them. Each equation is
compared with its printed form in tests/test_formulas.py.
"""


TABLE = "Table 1"
"""Where the ends stand that have a table of their own."""

INTRODUCTION = """\
# The claims of the paper and the verdict on each

A row is one claim of the paper, in our words; the ends of Table 1 are in [table1.md](table1.md).
[Section 3 of the article](../paper.md) defines the four verdicts and the senses.
A distance is in units of the last printed digit, and in per cent of the printed number.
Each sense of a statement has a condition, which holds ("yes") or does not ("no"), the literal one
first; brackets have what we computed, then what the sense requires. If the senses disagree, the
column *literal sense* says whether it holds; "cannot fail" marks what holds by definition.
Formulas were *restored* from the damaged text by deriving them again, and are not counted;
[claims.csv](claims.csv) lists them, and `tests/test_formulas.py` compares each with its print.
"""
"""The text above the claims on their page."""


def judge(datasets: Datasets) -> xr.Dataset:
    """Judge the claims of the paper, and list the restored formulas."""
    return judged(datasets, [*CLAIMS, *table1_ends()], FORMULAS, "tests/test_formulas.py")
