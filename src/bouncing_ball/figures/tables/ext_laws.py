"""Errors on contacts of five laws with the same restitution coefficient and duration."""

from itertools import product

import numpy as np
import xarray as xr

from bouncing_ball.figures.tables.formats import Table, number, words


def rows(data: xr.Dataset) -> Table:
    """One row for each quantity and law: both models at three π/D, and the height's threshold.

    The contacts shown are the softest, the middle and the stiffest of the grid.
    """
    last = data.sizes["duration_ratio"] - 1
    shown = data.isel(duration_ratio=[round(share * last) for share in (0.0, 0.5, 1.0)])
    columns = product(data.model.values, shown.duration_ratio.values)
    body = []
    for quantity, law in product(data["quantity"].values, data["law"].values):
        errors = shown.relative_error.sel(quantity=quantity, law=law).values.ravel()
        found = float(data.error_threshold.sel(law=law)) if quantity == "max_height" else np.nan
        cells = [*(f"{error:.2g}" for error in errors), number(found, ".4g")]
        body.append([words(quantity), str(law), *cells])
    named = [f"{model}, π/D = {ratio:.3g}" for model, ratio in columns]
    return ["quantity", "law", *named, f"π/D for {100 * data.attrs['tolerance']:g} %"], body
