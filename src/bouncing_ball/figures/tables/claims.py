"""Claims of the paper with their verdicts."""

from collections.abc import Sequence

import numpy as np
import xarray as xr

from bouncing_ball.datasets.rounding import compared_text

_TEXTS = ("claim", "item", "statement", "required", "verdict")


def found_text(claim: xr.Dataset) -> str:
    """The number found: two digits more than printed, or four in all, or its bound
    where that is of the size of rounding."""
    value, printed = float(claim.found), str(claim.printed_text.values)
    if np.isnan(value):
        return "–"
    if not printed:
        return compared_text(value, float(claim.limit))
    decimals = len(printed.partition(".")[2])
    return f"{value:.{decimals + 2}f}"


def deviation_text(claim: xr.Dataset) -> str:
    """In units of the last printed digit, and in per cent."""
    units, share = float(claim.deviation_units), float(claim.deviation)
    return "" if np.isnan(units) else f"{units:+.2f} ({100 * share:+.3g} %)"


def _text(claim: xr.Dataset, key: str) -> str:
    text = claim[key].item()
    if not isinstance(text, str):
        raise TypeError(f"{key} is not a text but {text!r}")
    return text


def rows(data: xr.Dataset) -> tuple[Sequence[str], list[list[str]]]:
    """One row for each claim: place, statement, number, deviation, verdict.

    The column "printed or required" has the printed number, or the bound that a
    formula or a statement must meet.
    """
    header = ["claim", "where", "what the paper says", "printed or required", "found"]
    header += ["deviation", "verdict"]
    body = []
    for index in range(data.sizes["claim"]):
        claim = data.isel(claim=index)
        *texts, verdict = (_text(claim, key) for key in _TEXTS)
        body.append([*texts, found_text(claim), deviation_text(claim), verdict])
    return header, body
