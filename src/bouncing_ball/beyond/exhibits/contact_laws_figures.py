"""Errors of the simple models on the contacts of engineers."""

import xarray as xr
from matplotlib.figure import Figure

from bouncing_ball.datasets.selection import each
from bouncing_ball.drawing.canvas import panels_by_quantity
from bouncing_ball.drawing.labels import parameters
from bouncing_ball.drawing.style import GUIDE, LAWS
from bouncing_ball.drawing.tables import (
    Columns,
    TextTable,
    at,
    entry_of,
    quantity_in_words,
    table,
    text,
    value,
)


def contact_laws(data: xr.Dataset) -> Figure:
    """ext_laws: errors of both models for five laws, over D + κ as a share of the cycle."""
    figure, axes_of = panels_by_quantity(data, 5.0, r"share of the cycle, $(D+\kappa)/(2\pi n)$")
    share = 1 / (2 * data.attrs["n"] * data.centroid_ratio.values)
    for name, axes in axes_of.items():
        for law in data["law"].values:
            errors = data.relative_error.sel(law=law, quantity=name)
            axes.plot(share, errors.transpose(..., "model"), linewidth=1.1, **LAWS[law])
        for slope in (1, 2):
            axes.plot(share[[0, -1]], share[[0, -1]] ** slope, **GUIDE)
        axes.set(xscale="log", yscale="log")
    spare = figure.axes[len(axes_of)]
    spare.axis("off")
    title = (
        "upper five: restitution model\nlower five: corrected model\ndotted: slopes 1 and 2\n"
        + parameters(data, "n", "restitution", "amplitude")
    )
    # Each law has two lines; the legend takes the first.
    lines = figure.axes[0].lines[: 2 * data.sizes["law"] : 2]
    spare.legend(lines, data["law"].values, loc="upper left", title=title)
    return figure


def ext_laws(data: xr.Dataset) -> TextTable:
    """Errors on contacts of five laws with the same restitution coefficient and centroid.

    Columns give both models at the smallest, the middle and the largest π/(D + κ) of the grid, and
    the threshold of the height.
    """
    grid = data.centroid_ratio.values
    columns: Columns = {"quantity": quantity_in_words, "law": text("law")}
    for model in data.model.values:
        for ratio in grid[[0, round((len(grid) - 1) / 2), -1]]:
            error = at(value("relative_error", ".2g"), model=model, centroid_ratio=ratio)
            columns[f"{model}, π/(D + κ) = {ratio:.3g}"] = error
    columns[f"π/(D + κ) for {100 * data.attrs['tolerance']:g} %"] = _threshold
    return table(each(data, "quantity", "law"), columns)


def _threshold(part: xr.Dataset) -> str:
    """The threshold of the greatest height; the other quantities have none."""
    if part["quantity"] == "max_height":
        return entry_of(part.error_threshold.isel(case=0, calibration=0), ".4g")
    return "–"
