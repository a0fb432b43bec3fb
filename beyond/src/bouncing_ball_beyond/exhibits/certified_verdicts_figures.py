"""The table of the verdicts that certified intervals decide."""

import numpy as np
import xarray as xr

from bouncing_ball.datasets.selection import each
from bouncing_ball.drawing.tables import Columns, TextTable, entry_of, text, text_table


def ext_verdicts(data: xr.Dataset) -> TextTable:
    """The printed numbers with the limits between which the exact numbers lie, and the verdicts.

    The deviation is in units of the last printed digit, and in per cent.
    """
    columns: Columns = {
        "claim": text("claim"),
        "printed": text("printed_text"),
        "verdict": text("verdict"),
        "deviation": _deviation,
        "above": lambda part: entry_of(part.low, ".17g"),
        "below": lambda part: entry_of(part.high, ".17g"),
    }
    return text_table(each(data, "claim"), columns)


def _deviation(part: xr.Dataset) -> str:
    if np.isnan(part.deviation_units):
        return ""
    return f"{part.deviation_units:+.2f} ({100 * part.deviation:+.3g} %)"
