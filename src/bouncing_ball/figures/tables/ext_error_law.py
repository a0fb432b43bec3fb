"""Error law of the restitution model: exact thresholds, formula, corrected model."""

import xarray as xr

from bouncing_ball.figures.tables.formats import Table, number, words


def rows(data: xr.Dataset) -> Table:
    """One row for each quantity; the permanent contact last, without a correction.

    C is the corrected model's error times ϖ²; the last column is the ϖ at which
    the restitution model's error passes through zero by accident.
    """
    header = ["quantity", "K", "C", "law", "restitution", "corrected", "error zero at"]
    body = []
    for quantity in data.quantity.values:
        part = data.sel(quantity=quantity)
        found = [
            f"{value:.4g}"
            if status == "found"
            else ("all" if status.startswith("within") else "none")
            for value, status in zip(
                part.error_threshold.values, part.threshold_status.values, strict=True
            )
        ]
        law = [f"{float(x):.4f}" for x in (part.coefficient, part.second_order)]
        law.append(f"{float(part.law_threshold):.4g}")
        body.append([words(quantity), *law, *found, number(part.error_zero, ".3g")])
    law = [f"{float(data.permanent_coefficient):.4f}", "–", f"{float(data.permanent_law):.4g}"]
    found = [f"{float(data.permanent_threshold):.4g}", "–", "–"]
    return header, [*body, ["permanent contact, second order", *law, *found]]
