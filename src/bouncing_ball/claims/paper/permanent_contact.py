"""Claims about permanent contact, Eqs. 29-36."""

from functools import partial

from bouncing_ball.claims.claim import formula, statement
from bouncing_ball.claims.verdict import at_most

_SECTION = "Permanent contact"
_formula = partial(formula, section=_SECTION)

THRESHOLD = [
    _formula(
        "steady response",
        item="Eqs. 29-31",
        text="relative displacement in permanent contact",
        row="Eq. 31",
    ),
    _formula(
        "threshold",
        item="Eqs. 32-33",
        text="amplitude up to which the contact is permanent",
        row="Eq. 33",
    ),
]


@statement(_SECTION, "after Eq. 33", clear=False)
def stiff_threshold(data):
    """the threshold tends to 1 for an infinite frequency ratio

    Condition: it is within a millionth at the stiffest contact scanned
    """
    error = data["thresholds"].relative_error.sel(quantity="permanent_contact")
    return at_most(error.isel(frequency_ratio=-1), 1e-6)


SHAPE = [
    _formula(
        "soft threshold",
        item="after Eq. 33",
        text="the threshold grows beyond all bounds for a vanishing frequency ratio",
        row="Eq. 33, ϖ → 0",
        remark="found to grow as the inverse square of the frequency ratio",
    ),
    _formula(
        "resonant threshold",
        item="after Eq. 33",
        text="the threshold is twice the damping ratio at a frequency ratio of 1",
        row="Eq. 33, ϖ = 1",
    ),
    _formula(
        "larger frequency ratio", item="Eq. 34", text="the larger frequency ratio of a threshold"
    ),
    _formula(
        "smaller frequency ratio", item="Eq. 35", text="the smaller frequency ratio of a threshold"
    ),
    _formula(
        "lowest threshold",
        item="Eq. 36, Fig. 11",
        text="below this amplitude the contact is permanent at every frequency ratio",
        row="Eq. 36",
    ),
]
