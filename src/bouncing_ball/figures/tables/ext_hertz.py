"""Stability ranges on contacts of other laws, laid out as Table 1."""

from collections.abc import Sequence

import xarray as xr


def rows(data: xr.Dataset) -> tuple[Sequence[str], list[list[str]]]:
    """One row for each law and π/D, one column for each n: from saddle-node to doubling."""
    header = ["law", "π/D", *(f"n = {n}" for n in data.n.values)]
    body = []
    for law in data["law"].values:
        for ratio in data.shown_ratio.values:
            part = data.bifurcation_amplitude.sel(law=law, shown_ratio=ratio)
            ranges = [
                f"{float(part.sel(bound='saddle_node', n=n)):.4f}–"
                f"{float(part.sel(bound='period_doubling', n=n)):.4f}"
                for n in data.n.values
            ]
            body.append([str(law), f"{ratio:g}", *ranges])
    return header, body
