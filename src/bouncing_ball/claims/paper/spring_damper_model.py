"""Claims about the spring-damper model and its damping, Eqs. 10-16."""

from bouncing_ball.claims import evidence
from bouncing_ball.claims.claim import claim, formulas, of_formula
from bouncing_ball.claims.verdict import at_least, at_most

_RATIO = "ϖ = Ω/ω, Ω of the contact"


@claim("before Eq. 11")
def frequency_ratio(data):
    """the frequency ratio is Ω/ω

    Condition: with this ratio Eq. 10 becomes Eq. 11

    Remark: Ω/ω is legible, but not which letter is the table's frequency and which the contact's.
    Only the contact's frequency over the table's turns Eq. 10 into Eq. 11, and only so is a stiff
    contact one of large ϖ; with the usual letters, Ω for the table, the printed ratio is inverted

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

    Remark: Eq. 16 neglects the weight of the ball during contact. Its effect fades as the contact
    gets stiffer, or the impact faster: a table at rest has no frequency, and what matters is the
    weight against the force of impact, g/(ωv), here 1/(πϖ)

    Answer: the relation is that of its source, which is for impacts faster than these
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

    Condition: on some curve of Figs. 5 and 6 the apparent restitution is somewhere at least 1 %
    from r
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

    Remark: 0.136 but for Fig. 16
    """
    return data["fig11"].damping_ratio
