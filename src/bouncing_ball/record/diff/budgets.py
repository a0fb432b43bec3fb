"""Budgets from the convergence study, by one rule."""

import math
from collections.abc import Iterable

import xarray as xr

from bouncing_ball.record.diff.data import drifts
from bouncing_ball.record.diff.tolerances import Tolerances

# Ten times the largest change seen: the study tries a handful of variations.
_MARGIN = 10
# In shares of the scale; 450 units in the last place of it. A formula here
# chains fewer than a hundred operations, and the elementary functions of
# mathematics libraries differ by a unit or two in the last place each.
FLOOR = 1e-13
# In grey levels of 255: one pixel in ten thousand one level off. Antialiasing
# rounds every pixel of an edge to a level, and an edge may round the other way.
PICTURE_FLOOR = 0.01
MEASURED = "convergence study"
"""How the source of a budget begins that follows from the study."""


def budget_for(change: float, floor: float = FLOOR) -> float:
    """The power of ten next above ten times the change, and not below the floor.

    Examples
    --------
    >>> budget_for(3e-9), budget_for(0.0)
    (1e-07, 1e-13)
    """
    if change == 0:
        return floor
    return max(float(f"1e{math.ceil(math.log10(_MARGIN * change))}"), floor)


def changes(
    artifact: str, base: xr.Dataset, varied: xr.Dataset, rules: Tolerances
) -> dict[str, float]:
    """Largest drift of every variable with a measured budget, as its mode measures it.

    Examples
    --------
    >>> from bouncing_ball.record.diff.tolerances import Mode, Tolerance
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


def expected_budgets(
    rows: Iterable[tuple[str, str, float]], rules: Tolerances
) -> dict[tuple[str, str], float]:
    """The budgets that the rule gives for the largest changes measured.

    Parameters
    ----------
    rows : iterable of (artifact, variable, change)
    rules : Tolerances
        Only asked which entries belong to one artifact alone.

    Returns
    -------
    dict
        By (artifact, variable); the artifact is empty for an entry that holds
        for all artifacts without their own.
    """
    largest: dict[tuple[str, str], float] = {}
    for artifact, variable, change in rows:
        own = variable in rules.artifacts.get(artifact, {})
        key = (artifact if own else "", variable)
        largest[key] = max(change, largest.get(key, 0.0))
    return {key: budget_for(change) for key, change in largest.items()}
