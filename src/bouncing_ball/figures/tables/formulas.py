"""Printed formulas against a second computation."""

from collections.abc import Sequence

import xarray as xr

from bouncing_ball.datasets.rounding import compared_text


def rows(data: xr.Dataset) -> tuple[Sequence[str], list[list[str]]]:
    """One row for each formula: compared with what, disagreement, what is allowed.

    Disagreements of the size of rounding are given by their bound.
    """
    header = ["formula", "compared with", "largest disagreement", "allowed"]
    body = [
        [str(formula), str(other), compared_text(found, budget, ".1e"), f"{budget:.0e}"]
        for formula, other, found, budget in zip(
            data.formula.values,
            data.compared_with.values,
            data.disagreement.values,
            data.budget.values,
            strict=True,
        )
    ]
    return header, body
