"""The change of a variable from the accepted record that the comparison allows: its budget.

A drift is |new - record| over the range of the record's values, or over ``scale``. Texts,
counts and truth values are compared exactly. The budget of a variable is in its row of
:mod:`bouncing_ball.datasets.variables`; those of single artifacts are here. They come from the
convergence study, a test that varies tolerances, grids and rounding: each is the power of ten next
above ten times the largest change. Other sources are given beside the number.
"""

import math
from typing import NamedTuple

from bouncing_ball.datasets.variables import BUDGETS


class Budget(NamedTuple):
    """The largest change allowed of a variable, as a share of its scale: "1", or another variable.

    Without a scale it is a share of the range of the record's values.
    With ``over`` two curves are compared, through the samples along the dimension
    ``point`` and over that variable, because the samples may slide along the curve.
    So large a ``share`` of the entries, of texts and counts too, may be beyond the budget, because
    rounding decides there.
    """

    size: float
    scale: str = ""
    over: str = ""
    share: float = 0.0


ROUNDING = 1e-13
"""The smallest budget, for variables without another one."""
IGNORED = math.inf
"""The budget of variables that another dataset has as well, or that rounding decides about;
``inf`` in the table."""


def _each(names: str, budget: Budget) -> dict[str, Budget]:
    return dict.fromkeys(names.split(), budget)


def _branch(curve: float, multiplier: float) -> dict[str, Budget]:
    """Budgets of a continued branch: if one chord changes, all of its points move along the
    curve.
    """
    observed = "phase release_phase contact_duration impact_velocity bounce_velocity"
    return {
        "amplitude": Budget(curve, over="phase"),
        **_each(f"{observed} apparent_restitution", Budget(curve, over="amplitude")),
        **_each("multiplier_real multiplier_imag", Budget(multiplier, over="amplitude")),
        **_one_sample_of(601),
    }


def _one_sample_of(count: int) -> dict[str, Budget]:
    """Budgets of truth values along a branch of ``count`` samples.

    Rounding decides on which side of a bifurcation or a grazing orbit a sample lies.
    """
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
        "*": Budget(1e-11, scale="1"),
        "contact_force": Budget(1e-11, scale="frequency_ratio"),
    },
    # The second order of a stiff contact is a small difference of large values.
    "ext_orders": {"relative_error": Budget(1e-11)},
    # Collocated orbits, each with an error of some 1e-13.
    "ext_hertz": _each("bifurcation_amplitude phase", Budget(1e-12)),
    # In an engine of another version an impact falls on another part of a time step. Each r is
    # within the tolerance of the requested one. Mean heights are within 6 times the change that a
    # step may cause, and single bounces scatter by up to 21 times that; the budgets are the next
    # powers of ten. Times differ between machines, and versions change.
    "engines": {
        "measured_restitution": Budget(2, scale="tolerance"),
        "height_error": Budget(10, scale="step_allowance"),
        "height_scatter": Budget(100, scale="step_allowance"),
        **_each("bounce_time model_time engine_version", Budget(IGNORED)),
    },
    # A chaotic transient ends, and a basin's boundary is met, where rounding decides: a change of
    # 1e-15 in the start changes the kind at 1.4 % of the nodes and a share of agreement by 0.022
    # at most. Three times that is allowed, and 5 standard errors of an exponent.
    "ext_locking": {
        **_each("kind periods impacts", Budget(ROUNDING, share=0.05)),
        "lyapunov_exponent": Budget(5, scale="lyapunov_error", share=0.05),
        "lyapunov_error": Budget(0.5, share=0.05),
        **_each("agreement agreement_low agreement_high", Budget(0.07, scale="1")),
        "agreement_nodes": Budget(0.05),
    },
    # Densities of some hundred samples of a chaotic motion, and ends of balls that may change.
    "ext_diagram": {
        "phase_density": Budget(0.05, scale="1", share=0.05),
        "lyapunov_exponent": Budget(5, scale="lyapunov_error", share=0.05),
        "lyapunov_error": Budget(0.5, share=0.05),
    },
    # As for ext_locking: the change moves an error by 2.2 of its margins at most, 7 % of the
    # decisions, and a share by 0.12; three times that is allowed.
    "ext_means": {
        "mean_error": Budget(7, scale="mean_margin", share=0.05),
        "mean_margin": Budget(0.5, share=0.05),
        **_each("decision needed_ratio", Budget(ROUNDING, share=0.2)),
        **_each("needed_share needed_low needed_high", Budget(0.37, scale="1")),
        "needed_nodes": Budget(0.15),
    },
    # Saddle-nodes are found as minima here, and some readings are ill-conditioned.
    "forensics": {"computed": Budget(1e-8)},
}
"""Budgets of single artifacts, by variable; ``*`` stands for all variables that are not named."""


PICTURE = 1.0
"""Root mean square difference of two pictures allowed, in grey levels of 255.

Parameters that differ by two units in the last place, which change every rounding as another
processor does, move the pixels of a figure by 0.092 at most (Fig. 15). The budget is the power of
ten next above ten times that."""
PICTURES = {"ext_diagram": 60.0, "ext_locking": 40.0, "ext_means": 60.0}
"""Pictures of motions about which rounding decides: three times the 19 and 12 grey levels by which
a change of 1e-15 in the start moves them."""


def budget_of(artifact: str, variable: str) -> Budget:
    """The budget of a variable of an artifact's dataset.

    Examples
    --------
    >>> budget_of("fig05", "phase").size, budget_of("fig08", "phase").over
    (1e-13, 'amplitude')
    """
    own = ARTIFACTS.get(artifact, {})
    return own.get(variable, own.get("*", Budget(*BUDGETS.get(variable, (ROUNDING,)))))
