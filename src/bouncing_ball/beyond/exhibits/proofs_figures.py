"""The table of certified numbers."""

import xarray as xr

from bouncing_ball.datasets.selection import each
from bouncing_ball.drawing.tables import Table, table, text


def ext_proofs(data: xr.Dataset) -> Table:
    """Certified numbers, a bound of the distance from the exact ones, and what is printed."""

    def printed(part: xr.Dataset) -> str:
        return str(part.certified_printed_text.item()) or "–"

    def verdict(part: xr.Dataset) -> str:
        return str(part.certified_print.item()) or "–"

    columns = {
        "number": text("certificate"),
        "certified": lambda part: str(part.certified.item()) or "–",
        "radius": lambda part: str(part.certified_radius.item()) or "–",
        "printed": printed,
        "the printed number is": verdict,
        "what is proved": text("certified_what"),
    }
    return table(each(data, "certificate"), columns)
