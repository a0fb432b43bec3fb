"""What the convergence study measures, for the budgets that follow from it."""

import xarray as xr

from bouncing_ball.compare.data import drifts
from bouncing_ball.compare.tolerances import Tolerances

MEASURED = "convergence study"
"""How the source of a budget begins that follows from the study."""


def changes(
    artifact: str, base: xr.Dataset, varied: xr.Dataset, rules: Tolerances
) -> dict[str, float]:
    """Largest drift of every variable with a measured budget, as its mode measures it.

    Examples
    --------
    >>> from bouncing_ball.compare.tolerances import Mode, Tolerance
    >>> rule = Tolerance(Mode.POINTWISE, MEASURED, budget=1e-9)
    >>> base = xr.Dataset({"x": ("t", [0.0, 4.0])})
    >>> changes("fig", base, base + 1.0, Tolerances({"x": rule}, rule))
    {'x': 0.25}
    """
    found = {}
    for name in map(str, base.variables):
        rule = rules.of(artifact, name)
        if rule is not None and rule.source.startswith(MEASURED):
            found[name] = float(drifts(name, base, varied, rule).max())
    return found
