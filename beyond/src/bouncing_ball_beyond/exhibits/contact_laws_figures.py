"""Errors of the simple models on the contacts of engineers."""

import xarray as xr
from matplotlib.figure import Figure

from bouncing_ball_beyond.drawing.laws_and_models import (
    LAW_NAMES,
    LAWS,
    law_name,
    panels_by_quantity,
)
from bouncing_ball_beyond.inherited.datasets.selection import each
from bouncing_ball_beyond.inherited.drawing.labels import parameters
from bouncing_ball_beyond.inherited.drawing.style import GUIDE
from bouncing_ball_beyond.inherited.drawing.tables import (
    Columns,
    TextTable,
    at,
    entry_of,
    quantity_in_words,
    text_table,
    value,
)
from bouncing_ball_beyond.inherited.drawing.thresholds import with_zeros

# The lowest error shown, as a share of the smallest at a sample.
_BELOW = 0.3


def contact_laws(data: xr.Dataset) -> Figure:
    """ext_laws: errors of both models for five laws, over D + κ as a share of the cycle."""
    figure, axes_of = panels_by_quantity(data, 5.0, r"share of the cycle, $(D+\kappa)/(2\pi n)$")
    ratio = data.centroid_ratio.values
    per_cycle = 2 * data.attrs["n"]
    share = 1 / (per_cycle * ratio)
    for name, axes in axes_of.items():
        for law in data["law"].values:
            for model in data["model"].values:
                one = data.sel(law=law, quantity=name, model=model)
                known = one.relative_error.notnull().values
                size = one.relative_error.values[known]
                place, error = with_zeros(ratio[known], size, one.law_error_zero)
                axes.plot(1 / (per_cycle * place), error, linewidth=1.1, **LAWS[law])
        for slope in (1, 2):
            axes.plot(share[[0, -1]], share[[0, -1]] ** slope, **GUIDE)
        axes.set(xscale="log", yscale="log")
    # The line of an error leaves the panel at its zero.
    low = float(data.relative_error.min())
    high = float(data.relative_error.max())
    axes.set_ylim(_BELOW * low, max(1.0, high))
    spare = figure.axes[len(axes_of)]
    spare.axis("off")
    title = (
        "upper five: restitution model\nlower five: corrected model\ndotted: slopes 1 and 2\n"
        + parameters(data, "n", "restitution", "amplitude")
    )
    # Each law has two lines; the legend takes the first.
    lines = figure.axes[0].lines[: 2 * data.sizes["law"] : 2]
    names = [LAW_NAMES[law] for law in data["law"].values]
    spare.legend(lines, names, loc="upper left", title=title)
    return figure


def ext_laws(data: xr.Dataset) -> TextTable:
    """Errors on contacts of five laws with the same restitution coefficient and centroid.

    Columns give both models at the smallest, the middle and the largest π/(D + κ) of the grid, and
    the threshold of the height.
    """
    grid = data.centroid_ratio.values
    columns: Columns = {"quantity": quantity_in_words, "law": law_name("law")}
    for model in data.model.values:
        for ratio in grid[[0, round((len(grid) - 1) / 2), -1]]:
            error = at(value("relative_error", ".2g"), model=model, centroid_ratio=ratio)
            columns[f"{model}, π/(D + κ) = {ratio:.3g}"] = error
    columns[f"π/(D + κ) for {100 * data.attrs['tolerance']:g} %"] = _threshold
    return text_table(each(data, "quantity", "law"), columns)


def _threshold(part: xr.Dataset) -> str:
    """The threshold of the greatest height; the other quantities have none."""
    if part["quantity"] == "max_height":
        return entry_of(part.error_threshold.isel(case=0, calibration=0), ".4g")
    return "–"
