"""Claims about permanent contact, Eqs. 29-36."""

from bouncing_ball.paper.claims.claim import claim, formulas
from bouncing_ball.paper.claims.verdict import at_most

THRESHOLD = formulas("threshold")


@claim("after Eq. 33")
def stiff_threshold(data):
    """the threshold tends to 1 for an infinite frequency ratio

    Condition: it is within a millionth at the stiffest contact scanned
    """
    error = data["thresholds"].relative_error.sel(quantity="permanent_contact")
    return at_most(error.isel(frequency_ratio=-1), 1e-6)


SHAPE = formulas("shape")
