"""Table 1, the thresholds, and Table 1 under other readings, as Markdown and as CSV.

Each table is a function of its dataset that returns rows of texts, the header first.
"""

import csv
import io

import numpy as np
import xarray as xr

from bouncing_ball.claims import (
    QUANTITIES,
    against_print,
    distance_text,
    markdown,
    other_parameters,
)

__all__ = ["TABLES", "comma_separated", "markdown", "table1", "table1_readings", "thresholds"]

MAPS = {"exact": "restitution model, Eq. 5", "holmes": "restitution model, Eqs. 7 and 8"}


def comma_separated(rows: list[list[str]]) -> str:
    """Rows as CSV; the first is the header."""
    text = io.StringIO()
    csv.writer(text, lineterminator="\n").writerows(rows)
    return text.getvalue()


def number(value: xr.DataArray | float, form: str, none: str = "–") -> str:
    """A number in a format; `none` if it is NaN or infinite."""
    return f"{float(value):{form}}" if np.isfinite(value) else none


def table1(data: xr.Dataset) -> list[list[str]]:
    """Table 1: each end of a range of stable orbits, computed and printed, with the verdict.

    A range goes from the saddle-node to the period doubling next to it; other stable orbits of the
    same family are not in it. The paper prints Λ to three decimals. The last rows are the ranges
    of the restitution model, for which it prints none.
    """
    rows = [["ϖ", "n", "end", "computed", "printed", "distance", "verdict"]]
    not_asked = other_parameters("table1", data)
    for end in each(data, "frequency_ratio", "n", "bound"):
        place = [number(end["frequency_ratio"], "g"), str(end["n"].item()), end["bound"].item()]
        printed = number(end["printed"], ".3f", "")
        judged = ["", ""]
        if printed and not_asked:
            judged = ["", "not asked"]
        elif printed:
            comparison = against_print(float(end["computed"]), printed)
            judged = [distance_text(comparison.units, comparison.share), comparison.verdict]
        rows.append([*place, number(end["computed"], ".5f"), printed, *judged])
    for end in each(data, "impact_map", "n", "bound"):
        place = [MAPS[end["impact_map"].item()], str(end["n"].item()), end["bound"].item()]
        rows.append([*place, number(end["restitution_range"], ".5f"), "", "", ""])
    return rows


def thresholds(data: xr.Dataset) -> list[list[str]]:
    """The frequency ratio from which on each error stays within each tolerance.

    Outside of the range scanned it is given as the end of the range, after < or >.
    """
    lowest, highest = data["frequency_ratio"].values[[0, -1]]
    outside = {"within": f"< {lowest:g}", "outside": f"> {highest:g}"}
    rows = [["quantity", *(f"{100 * tolerance:g} %" for tolerance in data["tolerance"].values)]]
    for line in each(data, "quantity"):
        status = line["threshold_status"].values
        ratios = line["error_threshold"].values
        entries = [
            outside.get(str(kind), number(ratio, ".5g"))
            for kind, ratio in zip(status, ratios, strict=True)
        ]
        rows.append([QUANTITIES[line["quantity"].item()], *entries])
    return rows


def table1_readings(data: xr.Dataset) -> list[list[str]]:
    """Table 1 under other readings of what the authors computed, the closest first.

    Distances from the printed ends, the largest and the root mean square (rms), are in units of the
    last printed digit. The last column counts the saddle-nodes that are printed below every orbit.
    """
    groups = [str(name) for name in data["rows"].values[:2]]
    measures = [(measure, name) for name in groups for measure in ("largest", "rms")]
    header = ["rank", "reading", *(f"{measure}, {name}" for measure, name in measures)]
    header += [f"reproduced, {name}" for name in groups]
    rows = [[*header, "printed below every orbit"]]
    for line in each(data, "reading"):
        distances = [
            number(line[f"{measure}_difference"].sel(rows=name), ".2f")
            for measure, name in measures
        ]
        counts = [
            f"{int(line['reproduced'].sel(rows=name))} of {int(line['entries'].sel(rows=name))}"
            for name in groups
        ]
        place = [str(int(line["rank"])), line["reading"].item()]
        rows.append([*place, *distances, *counts, str(int(line["unreachable"]))])
    return rows


def each(data: xr.Dataset, *dimensions: str) -> list[xr.Dataset]:
    """The parts of a dataset along dimensions, the last dimension fastest."""
    parts = [data]
    for name in dimensions:
        parts = [part.isel({name: place}) for part in parts for place in range(data.sizes[name])]
    return parts


TABLES = {"table1": table1, "thresholds": thresholds, "table1_readings": table1_readings}
"""The tables by name."""
