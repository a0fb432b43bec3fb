"""Frozen dataclasses over arrays, one element per contact, ball or orbit.

Their fields broadcast together, as arguments of a function do. A scalar field
is that of all elements, and stays a scalar.
"""

import math
from dataclasses import dataclass, fields, replace
from typing import Any, Self

import numpy as np


def _shape(value: Any) -> tuple[int, ...]:
    return value.shape if isinstance(value, Batch) else np.shape(value)


def _entry(value: Any, shape: tuple[int, ...], index: Any) -> Any:
    """Some elements of a field; a scalar is that of all."""
    if isinstance(value, Batch):
        return value._entries(shape, index)
    return np.broadcast_to(value, shape)[index] if np.ndim(value) else value


def in_words(value: Any) -> str:
    """A number or an array, rounded and abbreviated.

    Examples
    --------
    >>> in_words(np.pi), in_words(np.linspace(0, 1, 100)), in_words("force")
    ('3.14159', '[0 0.010101 ... 0.989899 1]', "'force'")
    """
    if isinstance(value, str):
        return f"'{value}'"
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
    """What a frozen dataclass of arrays inherits: a shape, indexing, a length.

    Examples
    --------
    >>> from bouncing_ball.contacts.spring_damper import SpringDamper
    >>> contact = SpringDamper(np.array([5.0, 10.0]), 0.1)
    >>> contact.shape, contact[1]
    ((2,), SpringDamper(frequency_ratio=10, damping_ratio=0.1, release='displacement'))
    """

    def __repr__(self) -> str:
        values = (f"{f.name}={in_words(getattr(self, f.name))}" for f in fields(self))
        return f"{type(self).__name__}({', '.join(values)})"

    @property
    def shape(self) -> tuple[int, ...]:
        """Common shape of the fields."""
        return np.broadcast_shapes(*(_shape(getattr(self, f.name)) for f in fields(self)))

    @property
    def size(self) -> int:
        """Number of elements."""
        return math.prod(self.shape)

    def __len__(self) -> int:
        if not self.shape:
            raise TypeError(f"a single {type(self).__name__} has no length")
        return self.shape[0]

    def _entries(self, shape: tuple[int, ...], index: Any) -> Self:
        values = {f.name: getattr(self, f.name) for f in fields(self)}
        return replace(self, **{k: _entry(v, shape, index) for k, v in values.items()})

    def __getitem__(self, index: Any) -> Self:
        if not self.shape and index != ():
            raise IndexError(f"a single {type(self).__name__} cannot be indexed")
        return self._entries(self.shape, index)

    def flat(self, shape: tuple[int, ...]) -> Self:
        """One element for each entry of an array, in a row; a single one is that of all."""
        if not self.shape:
            return self
        return self._entries(shape, np.unravel_index(np.arange(math.prod(shape)), shape))

    def take(self, which: Any) -> Self:
        """Some elements of a row; a single one is that of all."""
        return self[which] if self.shape else self
