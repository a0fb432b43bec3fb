"""Claims about permanent contact, Eqs. 29-36."""

from bouncing_ball.claims.claim import claim, formula
from bouncing_ball.claims.verdict import at_most

THRESHOLD = [
    formula("steady response", "Eqs. 29-31", "displacement in permanent contact", "Eq. 31"),
    formula("threshold", "Eqs. 32-33", "the largest amplitude of permanent contact", "Eq. 33"),
]


@claim("after Eq. 33")
def stiff_threshold(data):
    """the threshold tends to 1 for an infinite frequency ratio

    Condition: it is within a millionth at the stiffest contact scanned
    """
    error = data["thresholds"].relative_error.sel(quantity="permanent_contact")
    return at_most(error.isel(frequency_ratio=-1), 1e-6)


SHAPE = [
    formula(
        "soft threshold",
        "after Eq. 33",
        "the threshold grows beyond all bounds for a vanishing frequency ratio",
        "Eq. 33, ϖ → 0",
        remark="found to grow as the inverse square of the frequency ratio",
    ),
    formula("resonant threshold", "after Eq. 33", "the threshold is 2ζ at ϖ = 1", "Eq. 33, ϖ = 1"),
    formula("larger frequency ratio", "Eq. 34", "the larger frequency ratio of a threshold"),
    formula("smaller frequency ratio", "Eq. 35", "the smaller frequency ratio of a threshold"),
    formula("lowest threshold", "Eq. 36, Fig. 11", "the lowest threshold, at any ϖ", "Eq. 36"),
]
