"""Budgets of the variables of single artifacts, beside those that the variables declare.

They allow more where rounding decides; see :mod:`bouncing_ball.paper.exhibits.budgets`.
"""

from bouncing_ball.datasets.variables import ROUNDING, Budget


def _with_limits(name: str) -> tuple[str, str, str]:
    """A share and the limits of its confidence interval."""
    return name, f"{name}_low", f"{name}_high"


BUDGETS: dict[str, dict[str, Budget]] = {
    # A hundred times the largest disagreement of the page with Python, over the size of the
    # quantity where that is above 1; a contact's force is in proportion to ϖ.
    "explorer": {
        "*": Budget(1e-11, scale="1"),
        "contact_force": Budget(1e-11, scale="frequency_ratio"),
    },
    # The second order of a stiff contact is a small difference of large values.
    "ext_orders": {"relative_error": Budget(1e-11)},
    # A chaotic transient ends, and a basin's boundary is met, where rounding decides: a change of
    # 1e-15 in the start changes the kind at 1.4 % of the nodes, and moves a share of agreement by
    # 0.022 at most. Three times that is allowed.
    "ext_locking": {
        **dict.fromkeys(("kind", "periods", "impacts"), Budget(ROUNDING, share=0.05)),
        **dict.fromkeys(("agreement_low", "agreement_high"), Budget(0.07, scale="1")),
        **dict.fromkeys(("agreement_nodes", "many_digits_nodes"), Budget(0.05)),
        # Five standard errors; the standard error is an estimate itself.
        "lyapunov_exponent": Budget(5.0, scale="lyapunov_error", share=0.05),
        "lyapunov_error": Budget(0.5, share=0.05),
    },
    # Where a ball just leaves its orbit, rounding decides between two places of E.
    "ext_flights": dict.fromkeys(("leaving", "leaving_periods"), Budget(ROUNDING, share=0.1)),
    "ext_diagram": {
        # Densities of some hundred samples of a chaotic motion, and ends of balls that may change.
        "phase_density": Budget(0.05, scale="1", share=0.05),
        # Five standard errors. Rounding sends transients to other motions: up to 19 of 288 entries,
        # whose binomial limit at a chance of 1e-4 is 12.5 %.
        "lyapunov_exponent": Budget(5.0, scale="lyapunov_error", share=0.125),
        "lyapunov_error": Budget(0.5, share=0.05),
    },
    "ext_locked": {
        # On long locked orbits of contacts a deviation grows beyond the digits of a double, at some
        # 15 % of the places: rounding decides there. The periods of the restitution model have as
        # many digits as they need.
        **dict.fromkeys(("needed_ratio", "refuted_ratio", "last_known"), Budget(1e-6, share=0.3)),
        # A change of 4e-16 of the contacts' amplitude moves it by 0.6 %, and a concordance by
        # 0.004. Three times that is allowed.
        "ordered_pairs": Budget(0.02),
        # A change of 4e-16 of the amplitude moves a share by 0.0064 at most. Three times that is
        # allowed.
        **dict.fromkeys(
            (
                "same_known",
                *_with_limits("same"),
                *_with_limits("concordance"),
                *_with_limits("jump_share"),
                *_with_limits("uncertainty_exponent"),
            ),
            Budget(0.02, scale="1"),
        ),
    },
    # A change of 1e-15 of the start moves a share of 60 balls by 0.067 at most, and a mean life by
    # 11 of 100 periods. Three times the former is allowed.
    "ext_lives": {
        **dict.fromkeys(
            ("survival", *_with_limits("unstuck_share"), *_with_limits("lock_share")),
            Budget(0.2, scale="1"),
        ),
        **dict.fromkeys(_with_limits("mean_life"), Budget(0.5, share=0.2)),
        # A difference has the error of a mean, which is up to a half of its size.
        **dict.fromkeys(_with_limits("life_difference"), Budget(0.5, scale="mean_life", share=0.2)),
        # One ball of 60 that sticks in one of two runs.
        "pairs": Budget(0.2),
    },
    # One start of 2000 at a boundary moves a share by 0.0005. If it is one of the four that the
    # smallest shift moves, it moves an exponent or a limit of it by 0.04 at most.
    "ext_basins": dict.fromkeys(
        (
            *_with_limits("basin_share"),
            *_with_limits("uncertain_share"),
            *_with_limits("uncertainty_exponent"),
        ),
        Budget(0.05, scale="1"),
    ),
    # As for ext_locking: the same change moves an error by 2.2 of its margins at most, 7 % of the
    # decisions, a share by 0.12, and a number of nodes by 2 of 48. Three times that is allowed. A
    # margin is an estimate itself.
    "ext_means": {
        "mean_error": Budget(7.0, scale="mean_margin", share=0.05),
        "mean_margin": Budget(0.5, share=0.05),
        "decision": Budget(ROUNDING, share=0.2),
        "needed_ratio": Budget(ROUNDING, share=0.2),
        **dict.fromkeys(("right_low", "right_high"), Budget(0.37, scale="1")),
        "right_nodes": Budget(0.15),
    },
}
"""Budgets by artifact and variable; ``*`` stands for all variables that are not named."""
