"""Claims about the n-T orbits of the spring-damper model: Eqs. 18-27, Figs. 8-10, Table 1."""

from itertools import product

from bouncing_ball.claims import evidence
from bouncing_ball.claims.claim import Claim, formula, number, of_formula, statement
from bouncing_ball.claims.paper import explanations as why
from bouncing_ball.claims.paper import restitution_model
from bouncing_ball.claims.verdict import above, at_least, at_most, below
from bouncing_ball.studies.printed_table1 import AXES, printed_text

_METHOD, _EXISTENCE = "Computational method", "Existence and stability"
_FIGURES = "Figs. 8 and 9"

orbit_equations = formula(
    "orbit equations", _METHOD, "Eqs. 18-26", "equations of the n-T orbits", "Eqs. 21-26"
)


@statement(_METHOD, "Eqs. 21-26", explanation=why.equations_12_to_15)
def equations_cited(data):
    """Eqs. 12, 13, 16 and 17 give the equations of the n-T orbits

    Condition: orbits that repeat in the simulation fulfil them to rounding

    Remark: a slip of the numbers; Eqs. 16 and 17 define the damping and the apparent restitution
    """
    return of_formula(data, "Eqs. 21-26 by Eqs. 12, 13, 16, 17")


@statement(_METHOD, "Eqs. 21-26", explanation=why.a_scalar_root_is_left)
def no_analytical_solution(data):
    """the n-T orbits of the spring-damper model have no analytical solution

    Condition: a solution takes more than evaluating a formula

    Remark: decided for a formula of the branch; that the scalar root which is left at a given
    amplitude has none is not shown, only that the duration is not a function of the amplitude
    """
    return {
        "the whole branch": above(*evidence.route_disagreement(data)),
        "the orbits at a given amplitude": at_least(evidence.durations_at_one_amplitude(data), 2),
    }


velocity_balance = formula(
    "velocity balance",
    _METHOD,
    "Eq. 27",
    "bouncing-off velocity from the impact velocity and the duration of flight",
)


@statement("Computational method and Conclusion", "Figs. 3, 5, 6, 8-10 and 13-15")
def one_impact_per_period(data):
    """the orbits that are drawn have one impact per period

    Condition: nothing else happens on any of them
    """
    return at_most(evidence.inadmissible_orbits(data), 0)


@statement(_EXISTENCE, "Figs. 8-10", explanation=why.figures_8_and_9)
def figures_of_existence_domains(data):
    """Figs. 8-10 show the existence domains of the 1-T and 2-T orbits

    Condition: all three are drawn over the amplitude, with the bifurcations

    Remark: a slip of the numbers; the caption of Fig. 10 is of a velocity against the frequency
    ratio
    """
    return at_least(evidence.existence_domains(data), 3)


@statement(_EXISTENCE, _FIGURES)
def superimposed_when_stiff(data):
    """for the stiff contact the curves of both phases coincide

    Condition: no contact of the stiffest branch is longer than a hundredth of a radian
    """
    figures = (data[name].sortby("frequency_ratio") for name in ("fig08", "fig09"))
    durations = (figure.contact_duration.isel(frequency_ratio=-1) for figure in figures)
    return at_most([duration.max() for duration in durations], 0.01)


@statement(_EXISTENCE, _FIGURES)
def apart_when_soft(data):
    """the curves of both phases diverge as the frequency ratio decreases

    Condition: the contact at the saddle-node of the softest branch is longer than a hundredth of
    a radian
    """
    return at_least([evidence.fold_duration(data[name]) for name in ("fig08", "fig09")], 0.01)


@statement(_EXISTENCE, "Figs. 8 and 9, Table 1", id="saddle-node falls")
def saddle_node_falls(data):
    """with decreasing frequency ratio the saddle-node moves to lower amplitudes

    Condition: it falls from every row of Table 1 to the next softer one, for every n
    """
    return below(evidence.softening(data, "computed").sel(bound="saddle-node"), 0)


@statement(_EXISTENCE, "Figs. 8 and 9, Table 1", explanation=why.period_doubling_turns)
def period_doubling_rises(data):
    """with decreasing frequency ratio the period doubling moves to higher amplitudes

    Condition: it rises from every row of Table 1 to the next softer one, for every n
    """
    return above(evidence.softening(data, "computed").sel(bound="period doubling"), 0)


@statement(_EXISTENCE, "Table 1")
def range_widens(data):
    """with decreasing frequency ratio the stability range is extended

    Condition: the width grows from every row of Table 1 to the next softer one, for every n
    """
    return above(evidence.softening(data, "computed").diff("bound"), 0)


def _entry(ratio: float, n: int, bound: str) -> Claim:
    """One printed number of Table 1."""
    stiffest = ratio == max(AXES["frequency_ratio"])
    ends = {
        "saddle-node": restitution_model.saddle_node,
        "period doubling": restitution_model.period_doubling,
    }
    return Claim(
        f"Table 1: {ratio:g}, {n}, {bound}",
        "number",
        _EXISTENCE,
        "Table 1",
        f"{bound} of the {n}-T orbits at a frequency ratio of {ratio:g}",
        lambda data: data["table1"].computed.sel(frequency_ratio=ratio, n=n, bound=bound),
        printed=printed_text(ratio, n, bound),
        remark="the exponent of the first frequency ratio is unreadable, taken as 4",
        explanation=why.ends_of_holmes_map if stiffest else why.no_reading_fits,
        restates=ends[bound] if stiffest else None,
        table="Table 1",
    )


TABLE_1 = [_entry(*place) for place in product(*AXES.values())]


@statement(_EXISTENCE, "Table 1")
def stiff_row(data):
    """the stability ranges of the stiffest contact are those of the restitution model

    Condition: the computed ends agree to half a unit of the printed digits

    Remark: true of the computed ranges; the printed upper ends are those of Eq. 8
    """
    return at_most(evidence.stiff_difference(data, "computed", "exact"), 0.0005)


@statement(_EXISTENCE, "Fig. 10")
def velocity_is_not_nπ(data):
    """the bouncing-off velocity is no longer nπ

    Condition: it is at least 1 % from nπ at the softest contact, for every amplitude

    Remark: at a frequency ratio of 1; the end of the axis is unreadable
    """
    return at_least(evidence.bounce_velocity_error(data).isel(frequency_ratio=0), 0.01)


@number(_EXISTENCE, "Fig. 10", "100", unit=100, explanation=why.gradual_departure)
def departure_from_nπ(data):
    """the bouncing-off velocity starts to depart from nπ below this frequency ratio

    Remark: a round number, taken to have one digit; the paper does not say when a departure starts
    """
    readings = {f"departure of {100 * x:g} %": x for x in (0.01, 0.005, 0.002)}
    return {reading: evidence.departure(data, x) for reading, x in readings.items()}


@statement(_EXISTENCE, "Fig. 10", explanation=why.amplitude_matters_when_soft)
def amplitude_does_not_matter(data):
    """the bouncing-off velocity does not depend on the amplitude

    Condition: the three curves are within 1 % of nπ of each other from the left end of the axis on

    Remark: the end of the axis is unreadable
    """
    end = evidence.spread_end(data)
    return {f"the axis begins at {left}": at_most(end, left) for left in (1, 2)}
