"""The table of the verdicts that certified intervals decide."""

import xarray as xr

from bouncing_ball.datasets.selection import each
from bouncing_ball.drawing.tables import Columns, TextTable, entry_of, text, text_table
from bouncing_ball.paper.claims.tables import deviation_text


def ext_verdicts(data: xr.Dataset) -> TextTable:
    """The printed numbers with the limits between which the exact numbers lie, and the verdicts."""
    columns: Columns = {
        "claim": text("claim"),
        "printed": text("printed_text"),
        "verdict": text("verdict"),
        "deviation": deviation_text,
        "above": lambda part: entry_of(part.low, ".17g"),
        "below": lambda part: entry_of(part.high, ".17g"),
    }
    return text_table(each(data, "claim"), columns)
