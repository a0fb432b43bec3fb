"""Claims about the spring-damper model and its damping, Eqs. 10-16."""

from bouncing_ball.paper.claims import evidence
from bouncing_ball.paper.claims.claim import claim, formulas, of_formula
from bouncing_ball.paper.claims.verdict import at_least, at_most

_RATIO = "ϖ = Ω/ω, Ω of the contact"


@claim("before Eq. 11")
def frequency_ratio(data):
    """the frequency ratio is Ω/ω

    Condition: with this ratio Eq. 10 becomes Eq. 11

    Remark: Ω/ω can be read, but not which of the letters is the frequency of the table. Only the
    contact's frequency divided by the table's turns Eq. 10 into Eq. 11 and makes ϖ large for a
    stiff contact; with the usual letters, where Ω belongs to the table, the printed ratio would be
    inverted

    Answer: the letters are those of the paper's list of symbols, which is unreadable in our text
    """
    return {
        "Ω is the table's frequency": of_formula(data, "ϖ = Ω/ω, Ω of the table"),
        "Ω is the contact's frequency": of_formula(data, _RATIO),
    }


EQUATIONS = formulas("contact")


@claim("after Eq. 16")
def no_damping(data):
    """a restitution coefficient of 1 leads to no damping"""
    return of_formula(data, "Eq. 16, r = 1")


@claim("after Eq. 16")
def critical_damping(data):
    """a vanishing restitution coefficient leads to a damping ratio of 1

    Remark: the paper calls the limit subcritical
    """
    return of_formula(data, "Eq. 16, r → 0")


@claim("after Eq. 16", meant=True)
def static_table(data):
    """Eq. 16 is perfectly valid for a table at rest

    Condition: the restitution of a ball that falls on a table at rest with the velocity of the
    1-T orbit is within 1 % of r

    Remark: Eq. 16 neglects the weight of the ball during contact. The effect of the weight fades as
    the contact gets stiffer or the impact faster, because it depends on the ratio of the weight to
    the force of the impact, g/(ωv), which is 1/(πϖ) here

    Answer: the relation is taken from its source, which considers faster impacts than these
    """
    heavy = data["formulas"].static_error
    return {
        "without weight": of_formula(data, "Eq. 16"),
        "with weight, ϖ = 100": at_most(heavy.sel(frequency_ratio=100), 0.01),
        "with weight, ϖ = 10": at_most(heavy.sel(frequency_ratio=10), 0.01),
    }


@claim("after Eq. 16")
def moving_table(data):
    """Eq. 16 is not necessarily valid for a vibrating table

    Condition: on some curve of Figs. 5 and 6 the apparent restitution differs from r by at least
    1 % at some frequency ratio
    """
    sweep = evidence.curves(data, "fig05", "fig06")
    off = abs(sweep.apparent_restitution / sweep.restitution - 1)
    return at_least(off.max(), 0.01)


@claim("Figs. 8-10", printed="0.052", id="damping of 0.85")
def damping_of_085(data):
    """damping ratio of the restitution coefficient 0.85"""
    return data["ext_release"].damping_ratio


@claim("Figs. 11-16", printed="0.1359", id="damping of 0.65")
def damping_of_065(data):
    """damping ratio of the restitution coefficient 0.65

    Remark: printed as 0.136 except in Fig. 16
    """
    return data["fig11"].damping_ratio
