r"""Why claims are not reproduced. An explanation counts only if every check holds."""

from bouncing_ball.claims import evidence
from bouncing_ball.claims.claim import explanation, of_formula
from bouncing_ball.claims.parameters import TOLERANCE
from bouncing_ball.claims.verdict import above, at_least, at_most, below, largest


@explanation("linear at fixed duration")
def linear_at_fixed_duration(data):
    """At a fixed duration of contact the equations of the orbit are linear, so that the whole
    branch is an explicit curve; at a given amplitude one scalar root remains.
    """
    return {"difference of continuation and formula": at_most(*evidence.route_disagreement(data))}


@explanation("a scalar root is left")
def a_scalar_root_is_left(data):
    """The whole branch has a formula, with the duration of contact as its parameter. At a given
    amplitude the duration is the root of a scalar equation, of which there are several.
    """
    return {
        "difference of continuation and formula": at_most(*evidence.route_disagreement(data)),
        "orbits of each branch at one amplitude": at_least(
            evidence.durations_at_one_amplitude(data), 2
        ),
    }


@explanation("a pull is assumed")
def a_pull_is_assumed(data):
    """The contact ends where the ball is back on the table (Eq. 23). A damper pulls there, unless
    there is no damping, so that the ball is assumed to stick. Where the force vanishes instead,
    the bifurcations move.
    """
    moves = data["ext_release"].bifurcation_amplitude.diff("release")
    return {
        "strongest pull at release, in weights": above(evidence.release_pull(data), 0),
        "largest move of a bifurcation": at_least(abs(moves).max(), 0.01),
    }


@explanation("Eqs. 12-15")
def equations_12_to_15(data):
    """The equations of contact and flight, Eqs. 12-15 in number, give those of the orbits. Eqs. 16
    and 17 hold no motion; without a flight the ball would stay in contact to the next impact.
    """
    return {f"error of {row}": of_formula(data, row) for row in ("Eqs. 21-26", "Eqs. 14-15")}


@explanation("Figs. 8 and 9")
def figures_8_and_9(data):
    """Two of the three figures are of branches over the amplitude, one for each family."""
    return {"figures over the amplitude": at_least(evidence.existence_domains(data), 2)}


@explanation("Fig. 15 is over Λ")
def figure_15_is_over_the_amplitude(data):
    """The amplitude is the axis of Fig. 15 and has no value. At the one that the captions of
    Figs. 13 and 14 give for the 1-T orbit neither model has a 2-T orbit: their saddle-nodes lie
    above.
    """
    return {"lowest saddle-node": above([ends[0] for ends in evidence.ranges_of_fig15(data)], 1)}


@explanation("Holmes' map")
def holmes_map(data):
    """Eq. 8 is the period doubling of Holmes' map, for flights that are high against the
    excitation, an assumption that the paper announces in its introduction. Its own Eq. 5 does
    without, and so does the model that it compares with.
    """
    rows = ("Eq. 8, Holmes' map", "Eq. 8, corrected")
    return {f"error of {row}": of_formula(data, row) for row in rows}


@explanation("ends of Holmes' map")
def ends_of_holmes_map(data):
    """The printed upper ends of the stiffest row are those of Eq. 8, which belongs to Holmes' map,
    while the spring-damper model converges to Eq. 5.
    """
    printed, computed = (
        evidence.stiff_difference(data, source, impact_map)
        for source, impact_map in (("printed", "holmes"), ("computed", "exact"))
    )
    return {
        "largest distance of the printed ends from Eqs. 7 and 8": at_most(printed, 0.0005),
        "largest distance of the computed ends from the map of Eq. 5": at_most(computed, 0.0005),
    }


@explanation("inverted ratio")
def inverted_ratio(data):
    """Only the contact's frequency over the table's turns Eq. 10 into Eq. 11, and only so is a
    stiff contact one of large ϖ. With the usual letters, Ω for the table, the printed ratio is
    inverted.
    """
    rows = data["formulas"].disagreement
    return {
        "difference with Ω of the table": at_least(
            rows.sel(formula="ϖ = Ω/ω, Ω of the table"), 0.01
        ),
        "difference with Ω of the contact": of_formula(data, "ϖ = Ω/ω, Ω of the contact"),
    }


@explanation("weight in contact")
def weight_in_contact(data):
    """Eq. 16 neglects the weight of the ball during contact. Its effect fades as the contact gets
    stiffer, or the impact faster.
    """
    error = data["formulas"].static_error
    return {
        "largest error at ϖ = 10": at_least(largest(error.sel(frequency_ratio=10)), 0.01),
        "largest error at ϖ = 100": at_most(error.sel(frequency_ratio=100), 0.01),
    }


def _law(data):
    """Checks of the law of first order of the apparent restitution."""
    short = evidence.short_of_lift(data)
    error = evidence.apparent_restitution_law_error(data)
    return {
        "smallest 1 - Λ sin φ": above(short, 0),
        "largest error of the law in Λ sin φ": below(error, short),
    }


@explanation("below r")
def below_r(data):
    r"""For a stiff contact $r_a - r = -\zeta(1+r)^2(1-\Lambda\sin\varphi)/(n\pi\varpi)$ to first
    order. The apparent restitution therefore comes from below r exactly where
    $\Lambda\sin\varphi < 1$, which is below the amplitude of Eq. 8.
    """
    return _law(data)


@explanation("swapped labels")
def swapped_labels(data):
    """All three amplitudes lie below that of Eq. 8, and the dip is the shallower the nearer they
    are to it: what the paper describes is seen at the smallest one and cannot be seen at the
    largest. There the value at the soft end has the same digits. In the text at hand the labels
    stand in rising order from the top, the curves, where they are farthest apart, in falling
    order. Swapped labels are the likely cause.
    """
    soft_end = data["fig06"].apparent_restitution.sel(case=0, frequency_ratio=1.0)
    return _law(data) | {
        "dip below r at Λ = 0.7": at_least(evidence.dip(data, 0.7), 0.001),
        "dip below r at Λ = 1.2": below(evidence.dip(data, 1.2), 0.001),
        "soft end at Λ = 0.7": at_least(soft_end, 0.805),
        "the same": below(soft_end, 0.815),
        "smallest step to the curve of the next larger Λ": above(
            evidence.curves_of_fig06(data)[1], 0
        ),
    }


@explanation("period doubling turns")
def period_doubling_turns(data):
    """With decreasing ϖ the period doubling first moves down, turns at a moderate ϖ, and then
    moves up. Against the printed stiffest row, which is Holmes', it seems to rise at once.
    """
    computed, printed = (
        evidence.softening(data, source).sel(bound="period doubling")
        for source in ("computed", "printed")
    )
    to_ten, to_two = "from the stiffest contact to ϖ = 10", "from ϖ = 10 to 2"
    return {
        "smallest fall to the minimum": above(evidence.period_doubling_drop(data), 0),
        f"smallest computed rise {to_two}": above(computed.sel(frequency_ratio=2), 0),
        f"largest computed rise {to_ten}": below(computed.sel(frequency_ratio=10), 0),
        f"smallest printed rise {to_ten}": above(printed.sel(frequency_ratio=10), 0),
    }


@explanation("gradual departure")
def gradual_departure(data):
    """The velocity leaves nπ gradually. Where it starts depends on what is seen as a departure."""
    return {
        "ϖ at a departure of 1 %": at_least(evidence.departure(data, 0.01), 20),
        "ϖ at a departure of 0.2 %": at_least(evidence.departure(data, 0.002), 100),
    }


@explanation("amplitude matters when soft")
def amplitude_matters_when_soft(data):
    """The amplitude matters at the very soft end only; the curves then come within the paper's
    limit of each other.
    """
    return {"ϖ from which on they do": at_most(evidence.spread_end(data), 2)}


@explanation("threshold by Eq. 34")
def threshold_by_equation_34(data):
    """The paper's own Eq. 34, which is right, gives the same threshold as the root of Eq. 38. At
    the printed one the error is still well above its limit.
    """
    return {
        "error of Eq. 34": of_formula(data, "Eq. 34"),
        "difference of both thresholds": at_most(evidence.permanent_contact_inverse(data), 1e-9),
        "error at the printed one": at_least(evidence.permanent_contact_error(data), 0.02),
    }


@explanation("limit of which quantity")
def limit_of_which_quantity(data):
    """The paper sets its limit for the greatest height (Eq. 37), and there every orbit keeps it.
    The bouncing-off velocity and the apparent restitution miss it for the smallest restitution
    coefficient, by little. As a share of a cycle the phase keeps it; relative to its own size,
    which depends on the origin, it does not: the phase is zero at the saddle-node, so that next
    to it no contact is stiff enough.
    """
    error = evidence.stiff_orbit_error(data)
    lossy = error.sel(orbit="fig05 r=0.1 Λ=2.6")
    return {
        "largest error of the greatest height": at_most(error.sel(measure="max_height"), TOLERANCE),
        "error of the bouncing-off velocity at r = 0.1": at_least(
            lossy.sel(measure="bounce_velocity"), TOLERANCE
        ),
        "error of the apparent restitution at r = 0.1": at_least(
            lossy.sel(measure="apparent_restitution"), TOLERANCE
        ),
        "largest error of the phase in cycles": at_most(
            error.sel(measure="phase in cycles"), TOLERANCE
        ),
        "largest relative error of the phase": at_least(largest(error.sel(measure="phase")), 0.1),
    }


@explanation("no reading fits")
def no_reading_fits(data):
    """No reading of the equations that was tried gives all printed digits of the softer contacts,
    and some of the printed saddle-nodes lie below every orbit that the equations have.
    """
    readings = data["forensics"]
    soft = readings.sel(rows="softer rows")
    return {
        "largest number of softer entries reproduced": below(soft.reproduced, soft.entries),
        "saddle-nodes printed below every orbit": at_least(
            readings.unreachable.sel(reading="equations as they stand"), 1
        ),
    }
