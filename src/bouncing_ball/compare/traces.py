"""Where along a variable it has moved: its drifts in a size that can be drawn and read."""

from dataclasses import dataclass
from typing import Any

import numpy as np
import xarray as xr

# A plot has no more columns than these; of more samples each shows the largest.
_COLUMNS = 400
# More lines than these are one: the largest of all.
_LINES = 6
_LARGEST = 5
_TICKS = 5


@dataclass(frozen=True)
class Moved:
    """One entry: where, its drift over its budget, and its values."""

    place: str
    share: float
    record: str
    new: str


@dataclass(frozen=True)
class Trace:
    """Drift over budget along a variable.

    Parameters
    ----------
    along : str
        The dimension.
    ticks : tuple of (float, str)
        Places along it, from 0 to 1, and their coordinates.
    lines : tuple of (str, tuple of float)
        For each other entry that has moved, where it is, and the drift over the
        budget at places evenly spread; ∞ where a value is another and has none.
    largest : tuple of Moved
        The entries that have moved most.
    """

    along: str
    ticks: tuple[tuple[float, str], ...]
    lines: tuple[tuple[str, tuple[float, ...]], ...]
    largest: tuple[Moved, ...]


def value_text(value: Any) -> str:
    """A value in few characters, so that neighbouring numbers look different.

    Examples
    --------
    >>> value_text(np.float64(0.1)), value_text("a" * 100)[-5:]
    ('0.1', 'aa...')
    """
    value = value.item() if isinstance(value, np.generic) else value
    if isinstance(value, np.ndarray):
        value = value.tolist()
    text = repr(value) if isinstance(value, float) else str(value)
    return text if len(text) <= 60 else text[:57] + "..."


def _label(variable: xr.DataArray, name: Any, position: int) -> str:
    label = variable[name].values[position] if name in variable.coords else position
    return f"{label:.6g}" if isinstance(label, float) else str(label)


def place_text(variable: xr.DataArray, index: tuple[int, ...]) -> str:
    """Coordinates of an entry, or its indices where a dimension has none.

    Examples
    --------
    >>> place_text(xr.DataArray([[1.0, 2.0]], {"t": [0.0, 0.5]}, ("case", "t")), (0, 1))
    'case = 0, t = 0.5'
    """
    pairs = zip(variable.dims, index, strict=True)
    return ", ".join(f"{name} = {_label(variable, name, k)}" for name, k in pairs)


def _columns(values: np.ndarray) -> np.ndarray:
    """Along the last axis, the largest of neighbours that share a column."""
    width = -(-values.shape[-1] // _COLUMNS)
    padding = [(0, 0)] * (values.ndim - 1) + [(0, -values.shape[-1] % width)]
    padded = np.pad(values, padding)
    return padded.reshape(*values.shape[:-1], -1, width).max(axis=-1)


def trace(
    record: xr.DataArray, new: xr.DataArray, shares: np.ndarray, along: Any = None
) -> Trace | None:
    """Where two variables differ, along one of their dimensions.

    Parameters
    ----------
    record, new : DataArray
    shares : ndarray
        Drift over budget, place by place.
    along : str, optional
        The longest dimension if not given.

    Returns
    -------
    Trace or None
        None for a variable of one value, about which its place says all.

    Examples
    --------
    >>> record = xr.DataArray([0.0, 1.0, 2.0], dims="t")
    >>> found = trace(record, record + [0, 0, 0.5], np.array([0.0, 0.0, 5.0]))
    >>> found.along, found.lines
    ('t', (('', (0.0, 0.0, 5.0)),))
    >>> found.largest
    (Moved(place='t = 2', share=5.0, record='2.0', new='2.5'),)
    """
    if record.size < 2:
        return None
    along = along or max(record.dims, key=lambda name: record.sizes[name])
    axis, count = record.dims.index(along), record.sizes[along]
    rows = np.moveaxis(shares, axis, -1).reshape(-1, count)
    moved = np.flatnonzero(rows.any(axis=1))
    if len(moved) > _LINES:
        lines = [(f"largest of {len(moved)} that moved", rows.max(axis=0))]
    else:
        others = [name for name in record.dims if name != along]
        shape = [record.sizes[name] for name in others]
        one = record.isel({along: 0}, drop=True)
        places = [tuple(map(int, np.unravel_index(k, shape))) for k in moved]
        lines = [(place_text(one, at), rows[k]) for k, at in zip(moved, places, strict=True)]
    order = np.argsort(-shares, axis=None, kind="stable")[:_LARGEST]
    at = [tuple(map(int, np.unravel_index(k, shares.shape))) for k in order]
    ticks = np.unique(np.linspace(0, count - 1, _TICKS).round().astype(int))
    return Trace(
        str(along),
        tuple((float(k / max(count - 1, 1)), _label(record, along, int(k))) for k in ticks),
        tuple((label, tuple(map(float, _columns(row)))) for label, row in lines),
        tuple(
            Moved(
                place_text(record, index),
                float(shares[index]),
                value_text(record.values[index]),
                value_text(new.values[index]),
            )
            for index in at
            if shares[index] > 0
        ),
    )
