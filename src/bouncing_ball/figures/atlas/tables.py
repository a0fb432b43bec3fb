"""Tables of the atlas: how often the rule of thumb holds, and the orbits with the largest
errors.
"""

import numpy as np
import xarray as xr

from bouncing_ball.datasets.selection import each
from bouncing_ball.figures.tables.formats import Table, words
from bouncing_ball.figures.tables.layout import Columns, table, text, value

_MODELS = ("restitution", "corrected")


def shares(data: xr.Dataset) -> Table:
    """Accuracy of the models on all nodes, by release rule and quantity; header and rows.

    A limit of the families has no position in the stable range. Suprema are those of all orbits.
    """
    rule, tolerance = float(data.rule_of_thumb), float(data.summary_tolerance)
    header = [
        "release",
        "quantity",
        f"right from ϖ = {rule:g} on",
        f"supremum of the error at ϖ = {rule:g}",
        f"ϖ for {100 * tolerance:g} %: half of the nodes",
        "99 % of the nodes",
        "all orbits",
        "all orbits, corrected model",
    ]
    body = []
    at = data.sel({"tolerance": tolerance})  # the keyword is another argument of sel
    for one in each(at.sel(frequency_ratio=rule), "release"):
        for part in each(one.max("n"), "supremum_quantity"):
            name = part.supremum_quantity.item()
            if name in one["quantity"]:
                simple = one.sel(model="restitution", quantity=name)
                # The mean of the shares is that of all nodes, because every n has equally many.
                holding = float(simple.holding_share.mean())
                most = [simple.needed_quantile.sel(share=share).max() for share in (0.5, 0.99)]
            else:
                limits = one.limit_needed.sel(model="restitution", limit_quantity=name).values
                there = limits[np.isfinite(limits)]
                holding, most = np.mean(there <= rule), [*np.quantile(there, (0.5, 0.99))]
            cells = [words(name), f"{100 * holding:.2f} %", _error(part.isel(model=0))]
            every = part.supremum_needed.values
            body.append([one.release.item(), *cells, *map(_ratio, (*most, *every))])
    return header, body


def _error(part: xr.Dataset) -> str:
    value = 100 * float(part.worst_error)
    return f"{value:.3g} %" if np.isfinite(value) else "unbounded"


def _ratio(value: float | xr.DataArray) -> str:
    """A frequency ratio rounded up, so that it suffices."""
    number = float(value)
    if not np.isfinite(number):
        return "none"
    unit = 10.0 ** (np.floor(np.log10(number)) - 1)
    return f"{np.ceil(number / unit * (1 - 1e-12)) * unit:g}"


def worst(data: xr.Dataset) -> Table:
    """The orbit at which the restitution model's error has its supremum at the rule of thumb, by
    release and quantity, if it is bounded. The digits of r and Λ are enough to compute the error.
    """
    columns: Columns = {
        "release": text("release"),
        "quantity": lambda part: words(part.supremum_quantity.item()),
        "error": _error,
        "n": text("n"),
        "r": value("worst_restitution", ".15g"),
        "Λ": value("worst_amplitude", ".15g"),
    }
    simple = data.sel(model="restitution", supremum_quantity=data["quantity"].values)
    parts = each(simple, "release", "supremum_quantity")
    largest = (part.isel(n=int(part.worst_error.values.argmax())) for part in parts)
    return table((part for part in largest if np.isfinite(part.worst_error)), columns)
