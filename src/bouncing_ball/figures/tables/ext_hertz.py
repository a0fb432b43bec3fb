"""Stability ranges on contacts of other laws, laid out as Table 1."""

from itertools import product

import xarray as xr

from bouncing_ball.figures.tables.formats import Table


def rows(data: xr.Dataset) -> Table:
    """One row for each law and π/D, one column for each n: from saddle-node to doubling."""
    body = []
    for law, ratio in product(data["law"].values, data.shown_ratio.values):
        ends = data.bifurcation_amplitude.sel(law=law, shown_ratio=ratio).transpose("n", ...)
        ranges = [f"{low:.4f}–{high:.4f}" for low, high in ends.values]
        body.append([str(law), f"{ratio:g}", *ranges])
    return ["law", "π/D", *(f"n = {n}" for n in data.n.values)], body
