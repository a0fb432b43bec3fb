"""Witness table: largest disagreement between the routes to each orbit."""

from collections.abc import Sequence

import xarray as xr


def rows(data: xr.Dataset) -> tuple[Sequence[str], list[list[str]]]:
    """One row for each figure or table, one column for each comparison.

    An entry is the largest disagreement and, in brackets, the number of orbits.
    """
    header = ["artifact", *(str(kind) for kind in data.comparison.values)]
    body = [["budget", *(f"{float(value):.0e}" for value in data.budget.values)]]
    for artifact in data.artifact.values:
        line = [str(artifact)]
        for kind in data.comparison.values:
            at = {"artifact": artifact, "comparison": kind}
            count = int(data.orbits.sel(at))
            value = float(data.disagreement.sel(at))
            line.append(f"{value:.1e} ({count})" if count else "–")
        body.append(line)
    return header, body
