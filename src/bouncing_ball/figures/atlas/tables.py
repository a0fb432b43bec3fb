"""Tables of the atlas: how often the rule of thumb holds, and the orbits with the largest
errors.
"""

import numpy as np
import xarray as xr

from bouncing_ball.datasets.selection import each
from bouncing_ball.figures.tables.formats import Table, words
from bouncing_ball.figures.tables.layout import Columns, quantity, table, text, value

_MODELS = ("restitution", "corrected")


def shares(data: xr.Dataset) -> Table:
    """Accuracy of the models on all nodes, by release rule and quantity; header and rows.

    A limit of the families has no position in the stable range, and no error at one ϖ.
    """
    rule, tolerance = float(data.rule_of_thumb), float(data.summary_tolerance)
    header = [
        "release",
        "quantity",
        f"right from ϖ = {rule:g} on",
        f"largest error at ϖ = {rule:g}",
        f"ϖ for {100 * tolerance:g} %: half of the orbits",
        "99 %",
        "all",
        "all, corrected model",
    ]
    body = []
    at = data.sel({"tolerance": tolerance})  # the keyword is another argument of sel
    for one in each(at.sel(frequency_ratio=rule), "release"):
        for part in each(one, "quantity"):
            simple, corrected = (part.sel(model=model) for model in _MODELS)
            # The mean of the shares is that of all nodes, because every n has equally many.
            holding, error = float(simple.holding_share.mean()), float(simple.worst_error.max())
            most = [simple.needed_quantile.sel(share=share).max() for share in (0.5, 0.99)]
            needed = (*most, simple.needed.max(), corrected.needed.max())
            cells = [quantity(part), f"{100 * holding:.2f} %", f"{100 * error:.3g} %"]
            body.append([one.release.item(), *cells, *map(_ratio, needed)])
        for part in each(one, "limit_quantity"):
            simple, corrected = (part.limit_needed.sel(model=x).values for x in _MODELS)
            there = simple[np.isfinite(simple)]
            needed = (*np.quantile(there, (0.5, 0.99, 1.0)), np.nanmax(corrected))
            cells = [words(part.limit_quantity.item()), f"{100 * np.mean(there <= rule):.2f} %", ""]
            body.append([one.release.item(), *cells, *map(_ratio, needed)])
    return header, body


def _ratio(value: float | xr.DataArray) -> str:
    """A frequency ratio rounded up, so that it suffices."""
    number = float(value)
    if not np.isfinite(number):
        return "beyond the atlas"
    unit = 10.0 ** (np.floor(np.log10(number)) - 1)
    return f"{np.ceil(number / unit * (1 - 1e-12)) * unit:g}"


def worst(data: xr.Dataset) -> Table:
    """The orbit with the restitution model's largest error at the rule of thumb, by release and
    quantity. The digits of r and Λ are enough to compute this error again.
    """
    columns: Columns = {
        "release": text("release"),
        "quantity": quantity,
        "error": lambda part: f"{100 * float(part.worst_error):.3g} %",
        "n": text("n"),
        "r": value("worst_restitution", ".11g"),
        "Λ": value("worst_amplitude", ".11g"),
    }
    parts = each(data.sel(model="restitution"), "release", "quantity")
    return table((part.isel(n=int(part.worst_error.values.argmax())) for part in parts), columns)
