"""Table 1: stability ranges over Λ, computed and printed."""

from itertools import product

import numpy as np
import xarray as xr

from bouncing_ball.figures.tables.formats import Table


def rows(data: xr.Dataset) -> Table:
    """One row for each end of each range: computed, printed, difference.

    The last unit is that of the last printed digit, 0.001.
    """
    ends = list(product(data.n.values, data.bound.values))
    body = []
    for ratio, (n, bound) in product(data.frequency_ratio.values, ends):
        at = data.sel(frequency_ratio=ratio, n=n, bound=bound)
        computed, printed = float(at.computed), float(at.printed)
        there = np.isfinite(printed)
        compared = [f"{printed:.3f}", f"{computed - printed:+.5f}"] if there else ["", ""]
        body.append([f"{ratio:g}", str(n), str(bound), f"{computed:.5f}", *compared])
    for kind, (n, bound) in product(data.impact_map.values, ends):
        value = float(data.restitution_range.sel(impact_map=kind, n=n, bound=bound))
        where = [f"restitution ({kind} map)", str(n), str(bound)]
        body.append([*where, f"{value:.5f}", "", ""])
    return ["ϖ", "n", "bound", "computed", "printed", "difference"], body
