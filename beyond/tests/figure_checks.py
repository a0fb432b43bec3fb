"""What figures draw, and whether it follows their data."""

from collections.abc import Callable
from typing import Any

import numpy as np
import xarray as xr
from matplotlib.contour import ContourSet


def lines(figure):
    return [line for axes in figure.axes for line in axes.lines]


def contours(figure):
    """The points of all contours."""
    found = (each for axes in figure.axes for each in axes.collections)
    return [
        path.vertices for each in found if isinstance(each, ContourSet) for path in each.get_paths()
    ]


def follows_its_data(draw: Callable[[xr.Dataset], Any], data: xr.Dataset) -> None:
    """The figure of a dataset names its axes, and changes with the numbers of the dataset."""
    moved = data.map(lambda values: values * 1.1 + 0.01 if values.dtype.kind == "f" else values)
    before = draw(data)
    after = draw(moved.assign_attrs(data.attrs))
    assert any(axes.get_xlabel() for axes in before.axes)
    assert any(axes.get_ylabel() or axes.get_yticklabels() for axes in before.axes)
    same = [
        np.array_equal(line.get_xydata(), other.get_xydata(), equal_nan=True)
        for line, other in zip(lines(before), lines(after), strict=True)
        if len(line.get_xydata()) > 2
    ]
    # One in a panel may follow from the parameters alone: the table of Figure 12, or the arrows at
    # the end of a range. A map has levels in place of lines.
    levels = ([path.tolist() for path in contours(figure)] for figure in (before, after))
    assert sum(same) <= len(before.axes)
    assert not all(same) if same else next(levels) != next(levels)
