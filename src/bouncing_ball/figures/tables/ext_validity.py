"""The frequency ratio from which each model is right, over r, n and Λ/Λ_SN."""

from itertools import product

import numpy as np
import xarray as xr

from bouncing_ball.figures.model_errors import accidental
from bouncing_ball.figures.tables.formats import Table, words


def rows(data: xr.Dataset) -> Table:
    """One row for each quantity, n, model and Λ/Λ_SN, one column for each r.

    A star marks a restitution model whose error passes through zero above that ϖ:
    by accident, so that it looks better there than it is. A dash is outside the
    stable range of the restitution model.
    """
    low, high = (data.attrs[f"frequency_ratio__{end}"] for end in ("min", "max"))
    found = data.error_threshold
    shown = xr.apply_ufunc(lambda x: _bounded(x, low, high), found, vectorize=True)
    accident = accidental(data) & (data.model == "restitution")
    starred = shown.astype(object) + xr.where(accident, "*", "")
    cells = starred.where(found.notnull().any(("model", "quantity")), "–")
    body = []
    for quantity, n, model in product(data["quantity"].values, data.n.values, data.model.values):
        part = cells.sel(quantity=quantity, n=n, model=model).transpose("amplitude_ratio", ...)
        where = [words(quantity), str(n), str(model)]
        if quantity in ("saddle_node", "period_doubling"):
            # One for each family, whatever the amplitude.
            body.append([*where, "any", *part.values[0]])
            continue
        for ratio, line in zip(data.amplitude_ratio.values, part.values, strict=True):
            body.append([*where, f"{ratio:g}", *line])
    header = ["quantity", "n", "model", "Λ/Λ_SN", *(f"r = {r:g}" for r in data.restitution.values)]
    return header, body


def _bounded(found: float, low: float, high: float) -> str:
    if np.isnan(found):
        return f"> {high:g}"
    # The end of the range itself, but for rounding.
    return f"< {low:g}" if found <= low * (1 + 1e-6) else f"{found:.3g}"
