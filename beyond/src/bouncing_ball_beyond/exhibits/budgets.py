"""Budgets of the variables of single artifacts, beside those that the variables declare.

They allow more where rounding decides.
"""

from bouncing_ball_beyond.inherited.datasets.variables import Budget

BUDGETS: dict[str, dict[str, Budget]] = {
    # A hundred times the largest disagreement of the page with Python, over the size of the
    # quantity where that is above 1; a contact's force is in proportion to ϖ.
    "explorer": {
        "*": Budget(1e-11, scale="1"),
        "contact_force": Budget(1e-11, scale="frequency_ratio"),
    },
    # The second order of a stiff contact is a small difference of large values.
    "ext_orders": {"relative_error": Budget(1e-11)},
}
"""Budgets by artifact and variable; ``*`` stands for all variables that are not named."""
