"""Frequency ratio needed for a tolerance, quantity by quantity."""

import xarray as xr

from bouncing_ball.figures.tables.formats import Table, words


def rows(data: xr.Dataset) -> Table:
    """One row for each quantity, one column for each tolerance.

    Where the threshold lies outside the range scanned, the entry is the end of
    the range after < or >.
    """
    low, high = (float(data.frequency_ratio[k]) for k in (0, -1))
    body = []
    for quantity in data.quantity.values:
        at = data.sel(quantity=quantity)
        cells = [
            f"{found:.5g}"
            if status == "found"
            else (f"< {low:g}" if status.startswith("within") else f"> {high:g}")
            for found, status in zip(
                at.error_threshold.values, at.threshold_status.values, strict=True
            )
        ]
        body.append([words(quantity), *cells])
    return ["quantity", *(f"{100 * tolerance:g} %" for tolerance in data.tolerance.values)], body
