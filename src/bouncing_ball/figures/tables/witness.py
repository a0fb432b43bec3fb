"""Witness table: largest disagreement between the routes to each orbit."""

from collections.abc import Sequence

import xarray as xr


def rows(data: xr.Dataset) -> tuple[Sequence[str], list[list[str]]]:
    """One row for each figure or table, one column for each comparison.

    An entry is a bound of the largest disagreement, which is the budget unless
    it is exceeded, and in brackets the number of orbits. The disagreement itself
    is rounding, and no two processors have the same.
    """
    header = ["artifact", *(str(kind) for kind in data.comparison.values)]
    body = [["budget", *(f"{float(value):.0e}" for value in data.budget.values)]]
    for artifact in data.artifact.values:
        line = [str(artifact)]
        for kind in data.comparison.values:
            at = {"artifact": artifact, "comparison": kind}
            count = int(data.orbits.sel(at))
            value = float(data.disagreement.sel(at))
            allowed = float(data.budget.sel(comparison=kind))
            text = f"≤ {allowed:.0e}" if value <= allowed else f"{value:.1e}"
            line.append(f"{text} ({count})" if count else "–")
        body.append(line)
    return header, body
