"""The frequency ratio from which each model is right, over r, n and Λ/Λ_SN."""

from collections.abc import Iterator, Mapping, Sequence
from itertools import product
from typing import Any

import numpy as np
import xarray as xr

from bouncing_ball.figures.model_errors import accidental

# One number for each family, whatever the amplitude.
_BIFURCATIONS = ("saddle_node", "period_doubling")


def rows(data: xr.Dataset) -> tuple[Sequence[str], list[list[str]]]:
    """One row for each quantity, n, model and Λ/Λ_SN, one column for each r.

    A star marks a restitution model whose error passes through zero above that ϖ:
    by accident, so that it looks better there than it is. A dash is outside the
    stable range of the restitution model.
    """
    header = ["quantity", "n", "model", "Λ/Λ_SN", *(f"r = {r:g}" for r in data.restitution.values)]
    marked = data.assign(
        there=data.error_threshold.notnull().any(("model", "quantity")),
        star=accidental(data) & (data.model == "restitution"),
    )
    body = []
    for quantity, n, model in product(data["quantity"].values, data.n.values, data.model.values):
        part = marked.sel(quantity=quantity, n=n, model=model)
        line = [str(quantity).replace("_", " "), str(n), str(model)]
        if quantity in _BIFURCATIONS:
            body.append([*line, "any", *_cells(part.isel(amplitude_ratio=0))])
            continue
        for k, place in enumerate(data.amplitude_ratio.values):
            body.append([*line, f"{place:g}", *_cells(part.isel(amplitude_ratio=k))])
    return header, body


def _cells(part: xr.Dataset) -> Iterator[str]:
    """One text for each r."""
    columns = zip(part.error_threshold.values, part.there.values, part.star.values, strict=True)
    for found, there, star in columns:
        if not there:
            yield "–"
        else:
            yield _bounded(found, part.attrs) + ("*" if star else "")


def _bounded(found: float, attributes: Mapping[str, Any]) -> str:
    lowest, highest = (attributes[f"frequency_ratio__{end}"] for end in ("min", "max"))
    if np.isnan(found):
        return f"> {highest:g}"
    # The end of the range itself, but for rounding.
    return f"< {lowest:g}" if found <= lowest * (1 + 1e-6) else f"{found:.3g}"
