"""Printed formulas against a second computation."""

from collections.abc import Sequence

import xarray as xr


def rows(data: xr.Dataset) -> tuple[Sequence[str], list[list[str]]]:
    """One row for each formula: compared with what, disagreement, what is allowed."""
    header = ["formula", "compared with", "largest disagreement", "allowed"]
    body = [
        [str(formula), str(other), f"{float(found):.1e}", f"{float(budget):.0e}"]
        for formula, other, found, budget in zip(
            data.formula.values,
            data.compared_with.values,
            data.disagreement.values,
            data.budget.values,
            strict=True,
        )
    ]
    return header, body
