"""The table of certified numbers."""

import xarray as xr

from bouncing_ball.datasets.selection import each
from bouncing_ball.drawing.tables import TextTable, text, text_table


def ext_proofs(data: xr.Dataset) -> TextTable:
    """Certified numbers, a bound of the distance from the exact ones, and what is proved."""
    columns = {
        "number": text("certificate"),
        "certified": lambda part: str(part.certified.item()) or "–",
        "radius": lambda part: str(part.certified_radius.item()) or "–",
        "bits": text("certified_bits"),
        "what is proved": text("certified_what"),
    }
    return text_table(each(data, "certificate"), columns)
