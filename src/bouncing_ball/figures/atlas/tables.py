"""The table of the atlas: how often the rule of thumb holds, and the suprema of the errors."""

import numpy as np
import xarray as xr

from bouncing_ball.datasets.selection import each
from bouncing_ball.figures.tables.formats import Table, words


def shares(data: xr.Dataset) -> Table:
    """Accuracy of the models on all nodes, by release rule and quantity; header and rows.

    Shares refer to nodes, so that a limit of the families has no share; suprema refer to all
    orbits.
    """
    rule, tolerance = float(data.rule_of_thumb), float(data.summary_tolerance)
    header = [
        "release",
        "quantity",
        f"nodes right from ϖ = {rule:g} on",
        f"ϖ for {100 * tolerance:g} %: half of the nodes",
        "99 % of the nodes",
        f"supremum of the error at ϖ = {rule:g}",
        f"ϖ for {100 * tolerance:g} %: all orbits",
        "all orbits, corrected model",
    ]
    body = []
    at = data.sel({"tolerance": tolerance})  # the keyword is another argument of sel
    # Without a threshold, an error is tolerated at every ϖ, or at no ϖ if it is not at the rule's.
    never = at.supremum_needed.isnull() & (at.supremum > tolerance)
    at = at.assign(supremum_needed=at.supremum_needed.where(~never, np.inf))
    for one in each(at.sel(frequency_ratio=rule), "release"):
        for part in each(one.max("n"), "supremum_quantity"):
            name = part.supremum_quantity.item()
            nodes = ["", "", ""]
            if name in one["quantity"]:
                simple = one.sel(model="restitution", quantity=name)
                most = [simple.needed_quantile.sel(share=share).max() for share in (0.5, 0.99)]
                # The mean of the shares is that of all nodes, because every n has equally many.
                nodes = [f"{100 * float(simple.holding_share.mean()):.2f} %", *map(_ratio, most)]
            error = 100 * float(part.supremum[0])
            largest = f"{error:.3g} %" if np.isfinite(error) else "unbounded"
            every = map(_ratio, part.supremum_needed.values)
            body.append([one.release.item(), words(name), *nodes, largest, *every])
    return header, body


def _ratio(value: float | xr.DataArray) -> str:
    """A frequency ratio, rounded up so that the contact is stiff enough."""
    number = float(value)
    if not np.isfinite(number):
        return "none"
    unit = 10.0 ** (np.floor(np.log10(number)) - 1)
    return f"{np.ceil(number / unit * (1 - 1e-12)) * unit:g}"
