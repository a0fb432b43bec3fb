"""Claims of the paper with their verdicts."""

from collections.abc import Sequence

import numpy as np
import xarray as xr


def _found(claim: xr.Dataset) -> str:
    """The number found: two digits more than printed, or four in all."""
    value, printed = float(claim.found), str(claim.printed_text.values)
    if np.isnan(value):
        return ""
    if not printed:
        return f"{value:.4g}"
    decimals = len(printed.partition(".")[2])
    return f"{value:.{decimals + 2}f}"


def rows(data: xr.Dataset) -> tuple[Sequence[str], list[list[str]]]:
    """One row for each claim: place, statement, printed, found, deviation, verdict.

    The deviation is given in units of the last printed digit and in per cent.
    """
    header = ["claim", "where", "what the paper says", "printed", "found", "deviation", "verdict"]
    body = []
    for index in range(data.sizes["claim"]):
        claim = data.isel(claim=index)
        units, share = float(claim.deviation_units), float(claim.deviation)
        deviation = "" if np.isnan(units) else f"{units:+.2g} ({100 * share:+.2g} %)"
        body.append(
            [
                str(claim.claim.values),
                str(claim.item.values),
                str(claim.statement.values),
                str(claim.printed_text.values),
                _found(claim),
                deviation,
                str(claim.verdict.values),
            ]
        )
    return header, body
