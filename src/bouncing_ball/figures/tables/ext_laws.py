"""Errors on contacts of five laws with the same restitution coefficient and duration."""

from collections.abc import Sequence

import numpy as np
import xarray as xr

# Contacts that are shown: soft, middling and hard ones of the grid.
_SHARES = (0.0, 0.5, 1.0)


def rows(data: xr.Dataset) -> tuple[Sequence[str], list[list[str]]]:
    """One row for each quantity and law: both models at three π/D, and the height's threshold."""
    last = data.sizes["duration_ratio"] - 1
    chosen = [round(share * last) for share in _SHARES]
    ratios = data.duration_ratio.values[chosen]
    header = ["quantity", "law"]
    header += [f"{model}, π/D = {x:.3g}" for model in data.model.values for x in ratios]
    header.append(f"π/D for {100 * data.attrs['tolerance']:g} %")
    body = []
    for quantity in data["quantity"].values:
        for law in data["law"].values:
            part = data.relative_error.sel(quantity=quantity, law=law).isel(duration_ratio=chosen)
            numbers = [f"{x:.2g}" for x in part.values.ravel()]
            found = float(data.error_threshold.sel(law=law))
            there = quantity == "max_height" and np.isfinite(found)
            text = f"{found:.4g}" if there else "–"
            body.append([str(quantity).replace("_", " "), str(law), *numbers, text])
    return header, body
