"""The labelled results of calls: :class:`xarray.Dataset` whose method ``plot`` draws their figure.

The attribute ``kind`` of a dataset determines its figure. ``found.plot()`` returns the figure, and
``found.plot("name.png")`` also writes it to a file. ``PLOTS`` in the package of figures gives the
function that draws each kind. That package is imported by the first call of ``plot``, because
computations do not need matplotlib.
"""

import math
from collections.abc import Mapping
from importlib import import_module
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr
from xarray.plot.accessor import DatasetPlotAccessor

from bouncing_ball.datasets import CASE
from bouncing_ball.datasets.variables import SHARED
from bouncing_ball.errors import ParameterError, extra


class Plot(DatasetPlotAccessor):
    """Draws the figure of a labelled dataset when called; its methods are the plots of xarray."""

    __slots__ = ()

    def __call__(self, path: str | Path | None = None) -> Any:
        """The figure as a :class:`matplotlib.figure.Figure`, written to ``path`` if it is given.

        Raises
        ------
        ModelError
            If the suffix of the path is not that of a picture, or the file cannot be written.
        """
        with extra("plot"):
            figures = import_module("bouncing_ball.calls.plots")
        return figures.plot(self._ds, path)


class Labelled(xr.Dataset):
    """A dataset with the attribute ``kind``, whose :attr:`plot` draws the figure of that kind.

    Examples
    --------
    >>> found = Labelled({"phase": ("n", [0.5])}, attrs={"kind": "branch"})
    >>> type(found.isel(n=0)).__name__, found.isel(n=0).kind
    ('Labelled', 'branch')
    """

    __slots__ = ()

    @property
    def plot(self) -> Plot:  # type: ignore[override]
        """``plot()`` draws the figure; ``plot.scatter`` and other methods are those of xarray."""
        return Plot(self)


class Grid:
    """The arguments of a call and the grid that its arrays span, one axis for each array.

    A list or an array becomes an axis named after its parameter, so that two arrays make a grid.
    A :class:`xarray.DataArray` keeps its axis, so that two along the same axis are taken in pairs.

    Examples
    --------
    >>> grid = Grid(restitution=[0.5, 0.9], amplitude=[1.0, 2.0, 3.0], n=1)
    >>> grid.shape, grid.flat["restitution"].tolist(), grid.flat["n"]
    ((2, 3), [0.5, 0.5, 0.5, 0.9, 0.9, 0.9], 1)
    """

    def __init__(self, **given: Any) -> None:
        for name, value in given.items():
            if isinstance(value, Mapping) and any(np.ndim(x) for x in value.values()):
                raise ParameterError(
                    f"{{{name}}} must be single numbers, because an array needs a named axis"
                )
        self.coords = {
            name: _axis(name, value).assign_attrs(_attributes(name))
            for name, value in given.items()
            if np.ndim(value)
        }
        whole = dict(zip(self.coords, xr.broadcast(*self.coords.values()), strict=True))
        template = next(iter(whole.values()), xr.DataArray(0.0))
        self.dims, self.shape = template.dims, template.shape
        self.single = {name: value for name, value in given.items() if name not in whole}
        self.attrs = {n: x for n, x in self.single.items() if isinstance(x, str | int | float)}
        self.flat = self.single | {name: each.values.ravel() for name, each in whole.items()}

    @property
    def size(self) -> int:
        """Number of places of the grid."""
        return math.prod(self.shape)

    def row(self, name: str) -> np.ndarray:
        """The values of an argument at all places of the grid, shape (size,)."""
        return np.broadcast_to(np.asarray(self.flat[name], dtype=float), self.size)

    def cells(self) -> list[dict[str, Any]]:
        """The arguments at each place of the grid, one after another."""
        rows = {name: self.flat[name].tolist() for name in self.coords}
        places = zip(*rows.values(), strict=True) if rows else [()]
        return [self.single | dict(zip(rows, each, strict=True)) for each in places]

    def unfold(self, rows: xr.Dataset) -> Labelled:
        """Results along one axis, with one entry for each place, given the axes of the grid.

        Arguments that are single values become attributes.
        """
        own = {name: each for name, each in rows.variables.items() if name not in self.coords}
        for name, each in own.items():
            if CASE in each.dims:
                dims, shape = (*self.dims, *each.dims[1:]), (*self.shape, *each.shape[1:])
                own[name] = xr.Variable(dims, each.values.reshape(shape), each.attrs)
        own.pop(CASE, None)
        coords = {name: own.pop(name) for name in rows.coords if name in own}
        return Labelled(own, coords | self.coords, rows.attrs | self.attrs)


def _attributes(name: str) -> dict[str, Any]:
    return SHARED[name].attributes() if name in SHARED else {}


def _axis(name: str, value: Any) -> xr.DataArray:
    if isinstance(value, xr.DataArray):
        return value
    array = np.asarray(value)
    if array.ndim > 1:
        raise ParameterError(
            f"{{{name}}} has {array.ndim} axes without names: give an xarray.DataArray"
        )
    if array.dtype.kind not in "iuf":
        raise ParameterError(f"{{{name}}} must be one value or an array of numbers")
    return xr.DataArray(array, dims=name, coords={name: array})
