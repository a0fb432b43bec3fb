"""Table 1: stability ranges over Λ, computed and printed."""

from collections.abc import Sequence

import numpy as np
import xarray as xr


def rows(data: xr.Dataset) -> tuple[Sequence[str], list[list[str]]]:
    """One row for each end of each range: computed, printed, difference.

    The last unit is that of the last printed digit, 0.001.
    """
    header = ["ϖ", "n", "bound", "computed", "printed", "difference"]
    body = []
    for ratio in data.frequency_ratio.values:
        for n in data.n.values:
            for bound in data.bound.values:
                at = {"frequency_ratio": ratio, "n": n, "bound": bound}
                computed, printed = float(data.computed.sel(at)), float(data.printed.sel(at))
                known = not np.isnan(printed)
                body.append(
                    [
                        f"{ratio:g}",
                        f"{n}",
                        str(bound),
                        f"{computed:.5f}",
                        f"{printed:.3f}" if known else "",
                        f"{computed - printed:+.5f}" if known else "",
                    ]
                )
    for kind in data.impact_map.values:
        for n in data.n.values:
            for bound in data.bound.values:
                value = float(data.restitution_range.sel(impact_map=kind, n=n, bound=bound))
                body.append(
                    [f"restitution ({kind} map)", f"{n}", str(bound), f"{value:.5f}", "", ""]
                )
    return header, body
