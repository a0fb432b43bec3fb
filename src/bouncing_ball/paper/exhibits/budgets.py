"""Budgets of the variables of single artifacts, beside those that the variables declare.

They allow more: points that slide along a curve, and entries about which rounding decides. A budget
without another source comes from the convergence study, a test that varies tolerances, grids and
rounding: it is the next power of ten above ten times the largest change.
"""

from bouncing_ball.datasets.variables import Budget

_FLAGS = ("stable", "admissible", "restitution_stable", "restitution_admissible")
_ORBIT = (
    "phase",
    "release_phase",
    "contact_duration",
    "impact_velocity",
    "bounce_velocity",
    "apparent_restitution",
)
_MULTIPLIER = ("multiplier_real", "multiplier_imag")


def _branches(coordinate: float, multiplier: float) -> dict[str, Budget]:
    """Budgets of the branches of orbits in Figs. 8, 9 and 15.

    If one chord of a continued branch changes, all of its points move along the curve; the branches
    are therefore compared as curves. Rounding decides on which side of a bifurcation or a grazing
    orbit a sample lies: 1.2 of the 600 steps.
    """
    flags = dict.fromkeys(_FLAGS, Budget(0.002, over="point"))
    orbit = dict.fromkeys(_ORBIT, Budget(coordinate, over="amplitude"))
    multipliers = dict.fromkeys(_MULTIPLIER, Budget(multiplier, over="amplitude"))
    return {**flags, "amplitude": Budget(coordinate, over="phase"), **orbit, **multipliers}


BUDGETS: dict[str, dict[str, Budget]] = {
    # As in Fig. 8, with 400 steps.
    "fig03": dict.fromkeys(("stable", "admissible"), Budget(0.003, over="point")),
    "fig08": _branches(coordinate=1e-6, multiplier=1e-4),
    "fig09": _branches(coordinate=1e-8, multiplier=1e-5),
    "fig15": _branches(coordinate=1e-8, multiplier=1e-5),
    # Saddle-nodes are found as minima here, and some readings are ill-conditioned.
    "forensics": {"computed": Budget(1e-8)},
}
"""Budgets by artifact and variable; ``*`` stands for all variables that are not named."""
