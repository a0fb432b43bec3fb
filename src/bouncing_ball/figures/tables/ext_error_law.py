"""Error law of the restitution model: exact thresholds, formula, corrected model."""

from collections.abc import Sequence

import numpy as np
import xarray as xr


def rows(data: xr.Dataset) -> tuple[Sequence[str], list[list[str]]]:
    """One row for each quantity; the permanent contact last, without a correction.

    C is the corrected model's error times ϖ²; the last column is the ϖ at which
    the restitution model's error passes through zero by accident.
    """
    header = ["quantity", "K", "C", "law", "restitution", "corrected", "error zero at"]
    body = []
    for quantity in data.quantity.values:
        part = data.sel(quantity=quantity)
        line = [
            str(quantity).replace("_", " "),
            f"{float(part.coefficient):.4f}",
            f"{float(part.second_order):.4f}",
            f"{float(part.law_threshold):.4g}",
        ]
        for model in data.model.values:
            found, status = part.error_threshold.sel(model=model), part.threshold_status
            text = str(status.sel(model=model).item())
            line.append(f"{float(found):.4g}" if text == "found" else _outside(text))
        zero = float(part.error_zero)
        body.append([*line, f"{zero:.3g}" if np.isfinite(zero) else "–"])
    body.append(
        [
            "permanent contact, second order",
            f"{float(data.permanent_coefficient):.4f}",
            "–",
            f"{float(data.permanent_law):.4g}",
            f"{float(data.permanent_threshold):.4g}",
            "–",
            "–",
        ]
    )
    return header, body


def _outside(status: str) -> str:
    return "all" if status.startswith("within") else "none"
