"""Frequency ratio needed for a tolerance, quantity by quantity."""

from collections.abc import Sequence

import xarray as xr


def rows(data: xr.Dataset) -> tuple[Sequence[str], list[list[str]]]:
    """One row for each quantity, one column for each tolerance.

    Where the threshold lies outside the range scanned, the entry is the end of
    the range after < or >.
    """
    header = ["quantity", *(f"{100 * tolerance:g} %" for tolerance in data.tolerance.values)]
    low, high = (float(data.frequency_ratio[k]) for k in (0, -1))
    body = []
    for quantity in data.quantity.values:
        line = [str(quantity).replace("_", " ")]
        for tolerance in data.tolerance.values:
            at = {"quantity": quantity, "tolerance": tolerance}
            status = str(data.threshold_status.sel(at).item())
            if status == "found":
                line.append(f"{float(data.error_threshold.sel(at)):.5g}")
            else:
                line.append(f"< {low:g}" if status.startswith("within") else f"> {high:g}")
        body.append(line)
    return header, body
