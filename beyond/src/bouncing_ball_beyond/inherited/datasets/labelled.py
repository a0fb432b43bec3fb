"""Results with named axes: the grid that arrays of arguments span, and datasets over this grid.

A list or an array that is given for an argument becomes an axis named after the argument, so that
two arrays span a grid. A :class:`xarray.DataArray` keeps its axis, so that two along the same axis
are taken in pairs.
"""

import math
from collections.abc import Collection, Mapping
from typing import Any

import numpy as np
import xarray as xr

from bouncing_ball_beyond.inherited.datasets import CASE
from bouncing_ball_beyond.inherited.datasets.arguments import require_memory
from bouncing_ball_beyond.inherited.datasets.variables import SHARED
from bouncing_ball_beyond.inherited.errors import ParameterError


class Grid:
    """The arguments of a call and the grid that its arrays span, one axis for each array.

    ``single`` has the arguments that are single values, and ``flat`` all arguments, where those
    that are arrays have one entry for each place of the grid.

    Coordinates of a :class:`xarray.DataArray` that are not its axis belong to the result that it
    was taken from, and are dropped.

    Raises
    ------
    ParameterError
        If an array has several axes without names, or does not consist of numbers; if two arrays
        have other labels on the same axis; if an axis has the name of another argument that
        does not lie along it; or if the results would fill the memory.

    Examples
    --------
    >>> grid = Grid(restitution=[0.5, 0.9], amplitude=[1.0, 2.0, 3.0], n=1)
    >>> grid.shape, grid.flat["restitution"].tolist(), grid.flat["n"]
    ((2, 3), [0.5, 0.5, 0.5, 0.9, 0.9, 0.9], 1)
    """

    def __init__(self, **given: Any) -> None:
        self.coords = {name: _axis(name, value) for name, value in given.items() if np.ndim(value)}
        _check_axes(self.coords, given)
        lengths = {axis: n for each in self.coords.values() for axis, n in each.sizes.items()}
        require_memory(math.prod(lengths.values()), "places of a grid", "values")
        whole = _broadcast(self.coords)
        template = next(iter(whole.values()), xr.DataArray(0.0))
        self.dims = template.dims
        self.shape = template.shape
        self.single = {name: value for name, value in given.items() if name not in whole}
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

    def numbers_of(self, names: Collection[str]) -> np.ndarray:
        """The number of each place in the smaller grid that these arguments span, shape (size,).

        Examples
        --------
        >>> grid = Grid(amplitude=[1.0, 2.0], restitution=[0.5, 0.7, 0.9])
        >>> grid.numbers_of(["restitution"]).tolist()
        [0, 1, 2, 0, 1, 2]
        """
        part = _broadcast({name: self.coords[name] for name in self.coords if name in names})
        template = next(iter(part.values()), xr.DataArray(0.0))
        number = np.arange(template.size).reshape(template.shape)
        inner = xr.DataArray(number, dims=template.dims)
        outer = xr.DataArray(np.zeros(self.shape), dims=self.dims)
        return (inner + outer).transpose(*self.dims).values.astype(int).ravel()

    def unfold(self, rows: xr.Dataset) -> xr.Dataset:
        """Results along one axis, with one entry for each place, given the axes of the grid.

        Arguments that are single values become attributes.

        Raises
        ------
        ParameterError
            If an axis has the name of a result.
        """
        taken = {*rows.variables, *rows.sizes} - {*self.coords, CASE}
        if same := [str(axis) for axis in self.dims if axis in taken]:
            raise ParameterError(
                f"an array has an axis {same[0]}, which is the name of a result: rename this axis"
            )
        data = {name: each for name, each in rows.variables.items() if name not in self.coords}
        for name, each in data.items():
            if CASE in each.dims:
                dims = (*self.dims, *each.dims[1:])
                values = each.values.reshape((*self.shape, *each.shape[1:]))
                data[name] = xr.Variable(dims, values, each.attrs)
        data.pop(CASE, None)
        coords = {name: data.pop(name) for name in rows.coords if name in data}
        values = {n: x for n, x in self.single.items() if isinstance(x, str | int | float)}
        return xr.Dataset(data, coords | self.coords, rows.attrs | values)


def _broadcast(coords: Mapping[str, xr.DataArray]) -> dict[str, xr.DataArray]:
    """The arguments at all places of the grid that they span."""
    return dict(zip(coords, xr.broadcast(*coords.values()), strict=True))


def _check_axes(coords: Mapping[str, xr.DataArray], given: Mapping[str, Any]) -> None:
    """Refuse arrays whose axes contradict each other, or another argument.

    Examples
    --------
    >>> phase = xr.DataArray([0.1, 0.2], dims="amplitude", coords={"amplitude": [1.0, 1.2]})
    >>> _check_axes({"phase": phase}, {"amplitude": 1.5, "phase": phase})
    Traceback (most recent call last):
    bouncing_ball_beyond.inherited.errors.ParameterError: phase lies along amplitude, but \
amplitude is a single value
    """
    labels: dict[Any, tuple[str, xr.DataArray]] = {}
    for name, array in coords.items():
        for axis in array.dims:
            if axis in given and axis not in coords:
                raise ParameterError(
                    f"{{{name}}} lies along {axis}, but {{{axis}}} is a single value"
                )
            if axis in coords and coords[str(axis)].dims != (axis,):
                raise ParameterError(f"{{{name}}} lies along {axis}, but {{{axis}}} does not")
            other, labelled = labels.setdefault(axis, (name, array))
            if array.sizes[axis] != labelled.sizes[axis]:
                raise ParameterError(
                    f"{{{other}}} and {{{name}}} have {labelled.sizes[axis]} and "
                    f"{array.sizes[axis]} entries on the same axis {axis}"
                )
            if axis not in labelled.coords:
                labels[axis] = name, array
            elif axis in array.coords and not array[axis].equals(labelled[axis]):
                raise ParameterError(
                    f"{{{other}}} and {{{name}}} have other labels on the same axis {axis}"
                )


def _axis(name: str, value: Any) -> xr.DataArray:
    """An argument with a named axis, and with its description where it has one."""
    attributes = SHARED[name].attributes() if name in SHARED else {}
    if isinstance(value, xr.DataArray):
        return value.reset_coords(drop=True).assign_attrs(attributes)
    array = np.asarray(value)
    if array.ndim > 1:
        raise ParameterError(
            f"{{{name}}} has {array.ndim} axes without names: give an xarray.DataArray"
        )
    if array.dtype.kind not in "iuf":
        raise ParameterError(f"{{{name}}} must be one value or an array of numbers")
    return xr.DataArray(array, dims=name, coords={name: array}, attrs=attributes)
