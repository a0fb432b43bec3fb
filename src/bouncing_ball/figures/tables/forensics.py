"""Readings of Table 1, ranked by their distance to the printed values."""

from collections.abc import Sequence

import numpy as np
import xarray as xr


def _number(value: float) -> str:
    return "–" if np.isnan(value) else f"{value:.2f}"


def rows(data: xr.Dataset) -> tuple[Sequence[str], list[list[str]]]:
    """One row for each reading, the closest first; differences in last digits.

    A dash is where a reading has no orbit.
    """
    compared = [str(name) for name in data.rows.values[:2]]
    header = ["rank", "reading"]
    for name in compared:
        header += [f"largest, {name}", f"rms, {name}"]
    header += [f"reproduced, {name}" for name in compared]
    header += ["printed below every orbit"]
    body = []
    for reading in data.reading.values:
        at = data.sel(reading=reading)
        line = [str(int(at["rank"])), str(reading)]
        for name in compared:
            part = at.sel(rows=name)
            line += [_number(float(part.largest_difference)), _number(float(part.rms_difference))]
        for name in compared:
            part = at.sel(rows=name)
            line.append(f"{int(part.reproduced)} of {int(part.entries)}")
        line.append(str(int(at.unreachable)))
        body.append(line)
    return header, body
