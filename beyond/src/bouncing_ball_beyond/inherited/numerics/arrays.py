"""Frozen dataclasses over arrays, which have one element for each row, and rows in blocks.

Their fields broadcast together, like the arguments of a function. A scalar field
applies to all elements and remains a scalar.
"""

import math
from dataclasses import dataclass, fields, is_dataclass
from itertools import pairwise
from typing import Any, Self

import numpy as np
from numpy.typing import ArrayLike

from bouncing_ball_beyond.inherited.errors import ModelError, shortened


def _entry(value: Any, shape: tuple[int, ...], index: Any) -> Any:
    """The elements of a field at an index; a scalar, which applies to all, is unchanged."""
    if isinstance(value, Batch):
        return value._entries(shape, index)
    if not np.ndim(value):
        return value
    return (value if np.shape(value) == shape else np.broadcast_to(value, shape))[index]


def as_numbers(value: ArrayLike, name: str, allowed: str) -> np.ndarray:
    """A parameter as an array of floating-point numbers.

    Raises
    ------
    ModelError
        If it is no number and no array of numbers: text, True or False, or rows of unequal length.

    Examples
    --------
    >>> as_numbers("x", "frequency ratio ϖ", "a finite number > 0")
    Traceback (most recent call last):
    ...
    bouncing_ball_beyond.inherited.errors.ModelError: frequency ratio ϖ = 'x' is not a finite \
number > 0
    """
    try:
        x = np.asarray(value)
    # Rows of unequal lengths, and objects such as datasets.
    except (TypeError, ValueError):
        x = None
    if x is None or x.dtype.kind not in "iuf" or isinstance(value, np.ma.MaskedArray):
        raise ModelError(f"{name} = {shortened(value)} is not {allowed}")
    return x.astype(float, copy=False)


def in_words(value: Any) -> str:
    """A number or an array as text, rounded and abbreviated.

    Examples
    --------
    >>> in_words(np.pi), in_words(np.linspace(0, 1, 100)), in_words("force")
    ('3.14159', '[0 0.010101 ... 0.989899 1]', "'force'")
    """
    if isinstance(value, str):
        return f"'{value}'"
    # numpy would take apart a row of dataclasses.
    if is_dataclass(value):
        return repr(value)
    if not np.issubdtype(np.asarray(value).dtype, np.number):
        return repr(value)
    return np.array2string(
        np.asarray(value),
        threshold=8,
        edgeitems=2,
        formatter={"float_kind": lambda number: f"{number:.6g}"},
    )


@dataclass(frozen=True, repr=False)
class Batch:
    """Base class of frozen dataclasses of arrays: a shape, indexing, a length.

    A single element, of shape (), has no length and cannot be indexed.

    Examples
    --------
    >>> @dataclass(frozen=True, repr=False)
    ... class Line(Batch):
    ...     slope: float | np.ndarray
    ...     level: float | np.ndarray
    >>> lines = Line(np.array([5.0, 10.0]), 0.1)
    >>> lines.shape, len(lines), lines[1]
    ((2,), 2, Line(slope=10, level=0.1))
    """

    def __repr__(self) -> str:
        values = (f"{f.name}={in_words(getattr(self, f.name))}" for f in fields(self))
        return f"{type(self).__name__}({', '.join(values)})"

    @property
    def shape(self) -> tuple[int, ...]:
        """The shape to which the fields broadcast."""
        shapes = {np.shape(getattr(self, f.name)) for f in fields(self)} - {()}
        return shapes.pop() if len(shapes) == 1 else np.broadcast_shapes(*shapes)

    @property
    def size(self) -> int:
        """The number of elements; 1 for a single element."""
        return math.prod(self.shape)

    def check_shape(self) -> None:
        """Raise :class:`ModelError` unless all fields broadcast to one shape.

        Examples
        --------
        >>> @dataclass(frozen=True, repr=False)
        ... class Line(Batch):
        ...     slope: np.ndarray
        ...     level: np.ndarray
        >>> Line(np.zeros(2), np.zeros(3)).check_shape()
        Traceback (most recent call last):
        ...
        bouncing_ball_beyond.inherited.errors.ModelError: slope of shape (2,) and level of shape \
(3,) do not \
broadcast to one shape
        """
        shapes = {f.name: np.shape(getattr(self, f.name)) for f in fields(self)}
        try:
            np.broadcast_shapes(*shapes.values())
        except ValueError:
            arrays = (f"{name} of shape {shape}" for name, shape in shapes.items() if shape)
            raise ModelError(f"{' and '.join(arrays)} do not broadcast to one shape") from None

    def __len__(self) -> int:
        if not self.shape:
            raise TypeError(f"a single {type(self).__name__} has no length")
        return self.shape[0]

    def _entries(self, shape: tuple[int, ...], index: Any) -> Self:
        # The values have been checked, so that __init__ need not be called.
        part = object.__new__(type(self))
        values = {f.name: getattr(self, f.name) for f in fields(self)}
        part.__dict__.update({k: _entry(v, shape, index) for k, v in values.items()})
        return part

    def __getitem__(self, index: Any) -> Self:
        shape = self.shape
        if not shape and index != ():
            raise IndexError(f"a single {type(self).__name__} cannot be indexed")
        return self._entries(shape, index)

    def flat(self, shape: tuple[int, ...]) -> Self:
        """The elements broadcast to a shape and flattened to a row.

        A single element is unchanged, because it applies to all elements of the row.
        """
        if not self.shape:
            return self
        return self._entries(shape, np.unravel_index(np.arange(math.prod(shape)), shape))

    def take(self, which: Any) -> Self:
        """The elements of a row with these indices.

        A single element is unchanged, because it applies to the whole row.
        """
        shape = self.shape
        return self._entries(shape, which) if shape else self


BLOCK = 8192
"""The largest number of rows in a block, chosen such that the arrays stay in the cache. Smaller
blocks cost more, because a few slow rows determine the number of steps of each block.
"""


def blocks(size: int, largest: int = BLOCK) -> list[slice]:
    """Slices of about equal length that cover all rows, each of at most ``largest``.

    Examples
    --------
    >>> blocks(3), len(blocks(10_000))
    ([slice(0, 3, None)], 2)
    """
    edges = np.linspace(0, size, -(-size // largest) + 1, dtype=int)
    return [slice(int(a), int(b)) for a, b in pairwise(edges)]


class Row:
    """An object whose attributes are flat arrays over rows, or numbers that apply to all rows."""

    def take(self, which: Any) -> Self:
        """The same object, restricted to some of the rows."""
        part = object.__new__(type(self))
        vars(part).update({name: pick(value, which) for name, value in vars(self).items()})
        return part


def pick(value: Any, which: Any) -> Any:
    """Some entries of a flat array, of a tuple of arrays, or of a :class:`Row`.

    A number applies to all rows and is returned unchanged.

    Examples
    --------
    >>> pick(np.array([1.0, 2.0, 3.0]), [0, 2]).tolist(), pick(0.5, [0, 2])
    ([1.0, 3.0], 0.5)
    """
    if isinstance(value, np.ndarray):
        return value[which] if value.ndim else value
    if isinstance(value, tuple):
        return type(value)(*(pick(x, which) for x in value))
    return value.take(which) if isinstance(value, Row) else value
