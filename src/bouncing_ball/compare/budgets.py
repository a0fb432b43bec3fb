"""How far a variable may move before the comparison with the accepted record calls it a drift.

A drift is |new - record| over the range of the record's values, or over ``scale``. Texts,
counts, and yes or no are compared exactly. Budgets of numbers come from the convergence study,
the test that varies tolerances, grids and rounding: the power of ten next above ten times the
largest change. Other sources stand beside the number.
"""

import math
from typing import NamedTuple


class Budget(NamedTuple):
    """How far a variable may move, as a share of its scale: a number, or another variable.

    With ``over`` two curves are compared, through the samples along the dimension
    ``point`` and over that variable: the samples may slide along the curve.
    """

    size: float
    scale: float | str | None = None
    over: str = ""


ROUNDING = Budget(1e-13)
"""The least budget, for what has no other."""
IGNORED = Budget(math.inf)
"""For what another dataset holds already, or what rounding decides."""


def _each(names: str, budget: Budget) -> dict[str, Budget]:
    return dict.fromkeys(names.split(), budget)


BUDGETS: dict[str, Budget] = {
    **_each("destination limit found deviation_units deviation explanation_checks", IGNORED),
    **_each("residual special_residual", Budget(1e-12, scale=1.0)),
    **_each("apparent_restitution special_contact_duration window_flight", Budget(1e-12)),
    **_each("meeting_height static_error stiff_orbit_error range_error", Budget(1e-12)),
    "short_of_lift": Budget(1e-11),
    "error_threshold": Budget(1e-10),
    "apparent_restitution_law_error": Budget(1e-10, scale=1.0),
    "error_zero": Budget(1e-9),
    **_each("difference largest_difference rms_difference", Budget(1e-8)),
    "second_order": Budget(1e-7),
    **_each("period_doubling_turn period_doubling_lowest", Budget(1e-5)),
    **_each("basin_share order law_remainder", Budget(1e-4, scale=1.0)),
    "lyapunov_exponent": Budget(5.0, scale="lyapunov_error"),
    "lyapunov_error": Budget(0.5),
    "disagreement": Budget(1.0, scale="budget"),
}
"""Budgets by variable."""


def _branch(curve: float, multiplier: float) -> dict[str, Budget]:
    """Budgets of a continued branch: with one chord all of its points move along the curve."""
    observed = "phase release_phase contact_duration impact_velocity bounce_velocity"
    return {
        "amplitude": Budget(curve, over="phase"),
        **_each(f"{observed} apparent_restitution", Budget(curve, over="amplitude")),
        **_each("multiplier_real multiplier_imag", Budget(multiplier, over="amplitude")),
        **_one_sample_of(601),
    }


def _one_sample_of(count: int) -> dict[str, Budget]:
    """Where a bifurcation or a grazing falls on a sample, rounding decides it."""
    names = "stable admissible restitution_stable restitution_admissible"
    return _each(names, Budget(1.2 / (count - 1), over="point"))


ARTIFACTS: dict[str, dict[str, Budget]] = {
    "fig03": _one_sample_of(401),
    "fig08": _branch(1e-6, 1e-4),
    "fig09": _branch(1e-8, 1e-5),
    "fig15": _branch(1e-8, 1e-5),
    # A hundred times the largest disagreement of the page with Python, over the size of the
    # quantity where that is above 1; a contact's force is in proportion to ϖ.
    "explorer": {
        "*": Budget(1e-11, scale=1.0),
        "contact_force": Budget(1e-11, scale="frequency_ratio"),
    },
    # The second order of a stiff contact is a small difference of large values.
    "ext_orders": {"relative_error": Budget(1e-11)},
    # Collocated orbits, each right to some 1e-13.
    "ext_hertz": _each("bifurcation_amplitude phase", Budget(1e-12)),
    # Saddle-nodes are found as minima here, and some readings are ill-conditioned.
    "forensics": {"computed": Budget(1e-8)},
}
"""Budgets of single artifacts, by variable; ``*`` stands for all that are not named."""


def budget_of(artifact: str, variable: str) -> Budget:
    """The budget of a variable of an artifact's dataset.

    Examples
    --------
    >>> budget_of("fig05", "phase"), budget_of("fig08", "phase")
    (Budget(size=1e-13, scale=None, over=''), Budget(size=1e-06, scale=None, over='amplitude'))
    """
    own = ARTIFACTS.get(artifact, {})
    return own.get(variable, own.get("*", BUDGETS.get(variable, ROUNDING)))
