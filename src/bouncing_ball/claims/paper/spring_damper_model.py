"""Claims about the spring-damper model and its damping, Eqs. 10-16."""

from functools import partial

from bouncing_ball.claims import evidence
from bouncing_ball.claims.claim import formula, number, of_formula, statement
from bouncing_ball.claims.paper import explanations as why
from bouncing_ball.claims.verdict import at_least, at_most, largest

_SECTION = "Spring-damper model"
_formula = partial(formula, section=_SECTION)
_RATIO = "ϖ = Ω/ω, Ω of the contact"


@statement(_SECTION, "before Eq. 11", clear=False, explanation=why.inverted_ratio)
def frequency_ratio(data):
    """the frequency ratio is Ω/ω

    Condition: with this ratio Eq. 10 becomes Eq. 11

    Remark: Ω/ω is legible, but not which letter is the table's frequency and which the contact's
    """
    return {
        "Ω is the table's frequency": of_formula(data, "ϖ = Ω/ω, Ω of the table"),
        "Ω is the contact's frequency": of_formula(data, _RATIO),
    }


EQUATIONS = [
    _formula(
        "contact equation",
        item="Eqs. 10-11",
        text="equation of contact, in physical and in dimensionless variables",
        row=_RATIO,
        remark="with the contact's frequency over the table's as the frequency ratio",
    ),
    _formula("contact response", item="Eqs. 12-13", text="response of the ball in contact"),
    _formula("free flight", item="Eqs. 14-15", text="motion of the ball in flight"),
    _formula("damping", item="Eq. 16", text="damping ratio that gives the restitution coefficient"),
    _formula(
        "no damping",
        item="after Eq. 16",
        text="a restitution coefficient of 1 leads to no damping",
        row="Eq. 16, r = 1",
        clear=True,
    ),
    _formula(
        "critical damping",
        item="after Eq. 16",
        text="a vanishing restitution coefficient leads to a damping ratio of 1",
        row="Eq. 16, r → 0",
        clear=True,
        remark="the paper calls the limit subcritical",
    ),
]


@statement(_SECTION, "after Eq. 16", explanation=why.weight_in_contact)
def static_table(data):
    """Eq. 16 is perfectly valid for a table at rest

    Condition: the restitution of a ball that falls on a table at rest with the velocity of the
    1-T orbit is within 1 % of r

    Remark: a table at rest has no frequency; what matters is the weight against the force of
    impact, g/(ωv), here 1/(πϖ)
    """
    weightless = data["formulas"].disagreement.sel(formula="Eq. 16")
    heavy = data["formulas"].static_error
    return {
        "without weight": at_most(weightless, 0.01),
        "with weight, ϖ = 100": at_most(heavy.sel(frequency_ratio=100), 0.01),
        "with weight, ϖ = 10": at_most(heavy.sel(frequency_ratio=10), 0.01),
    }


@statement(_SECTION, "after Eq. 16")
def moving_table(data):
    """Eq. 16 is not necessarily valid for a vibrating table

    Condition: on some curve of Figs. 5 and 6 the apparent restitution is somewhere at least 1 %
    from r
    """
    share = evidence.apparent(data, lambda off, r: (abs(off) / r).max("frequency_ratio"))
    return at_least(largest(share), 0.01)


@number("Results of the spring-damper model", "Figs. 8-10", "0.052", id="damping of 0.85")
def damping_of_085(data):
    """damping ratio of the restitution coefficient 0.85"""
    return data["ext_release"].damping_ratio


@number("Permanent contact and Results", "Figs. 11-15", "0.136", id="damping of 0.65")
def damping_of_065(data):
    """damping ratio of the restitution coefficient 0.65"""
    return data["fig11"].damping_ratio


@number("Results", "Fig. 16", "0.1359", id="damping of 0.65, four digits", restates=damping_of_065)
def damping_in_four_digits(data):
    """damping ratio of the restitution coefficient 0.65"""
    return data["fig16"].damping_ratio
