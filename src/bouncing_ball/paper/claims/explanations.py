"""Why claims are close or contradicted. An explanation counts only if every check holds.

An undecidable claim has no explanation here, because its verdict and its remark give the reason.
"""

from bouncing_ball.paper.claims import evidence
from bouncing_ball.paper.claims.claim import of_formula
from bouncing_ball.paper.claims.verdict import above, at_least, at_most, below
from bouncing_ball.paper.orbits.stability import Bifurcation


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


def swapped_labels(data):
    """All three amplitudes lie below that of Eq. 8, and the dip is shallower the nearer they are to
    it. The dip that the paper describes is visible at the smallest amplitude and not at the
    largest, and both have the printed value at the compliant end. In the text at hand the labels
    stand in rising order from the top, but the curves in falling order. Swapped labels are the
    likely cause.
    """
    compliant_end = data["fig06"].apparent_restitution.sel(case=0, frequency_ratio=1.0)
    return {
        "smallest 1 - Λ sin φ": above(evidence.short_of_lift(data), 0),
        "dip below r at Λ = 0.7": at_least(evidence.dip(data, 0.7), 0.001),
        "dip below r at Λ = 1.2": below(evidence.dip(data, 1.2), 0.001),
        "compliant end at Λ = 0.7, from the printed one": at_most(abs(compliant_end - 0.81), 0.005),
    }


def period_doubling_turns(data):
    """With decreasing ϖ the period doubling first moves down, turns at a moderate ϖ, and then
    moves up. In the printed table it rises at once, because its stiffest row is that of Eq. 8.
    """
    computed = evidence.row_shift(data).sel(bound=Bifurcation.PERIOD_DOUBLING, frequency_ratio=10)
    return {"largest computed rise from the stiffest contact to ϖ = 10": below(computed, 0)}


def threshold_by_equation_34(data):
    """Eq. 34 of the paper, which is right, gives the computed frequency ratio. At the printed one
    the error is well above its limit.
    """
    return {
        "error of Eq. 34": of_formula(data, "Eq. 34"),
        "error at the printed one": at_least(evidence.permanent_contact_error(data), 0.02),
    }


def no_reading_fits(data):
    """No reading of the equations that we tried gives all printed digits of the more compliant
    contacts, and some of the printed saddle-nodes lie below every orbit of the equations.
    """
    # The second group of rows is that of the compliant contacts.
    rows = data["forensics"].isel(rows=1)
    below_all = rows.unreachable.sel(reading="equations as they stand")
    return {
        "largest number of entries reproduced in these rows": below(rows.reproduced, rows.entries),
        "saddle-nodes printed below every orbit": at_least(below_all, 1),
    }
