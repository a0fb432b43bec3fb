r"""Releases of many balls on one contact, interpolated where they are smooth.

At one Λ the end of a contact is an analytic function of ln v and φ at its start, except
where a ball just fails to be released. The plane is covered with cells. Once as many balls
have started in a cell as it has Chebyshev nodes, its nodes are integrated, and balls are
interpolated from then on, if the last coefficients have fallen below 10⁻¹² of the largest. If
not, the cell is quartered. So what is spent on cells in vain is never much more than what is
needed anyway.

A table is that of one simulation: what a ball does depends on no earlier one, and on
the other balls in the last digits only.
"""

from collections import Counter
from typing import NamedTuple

import numpy as np

from bouncing_ball.contacts.laws.contact_law import ContactLaw
from bouncing_ball.motion.law_motion import ContactEnd, Touch, release

# Nodes of a cell along each axis, its widths in ln v and φ, and how often it is quartered.
_NODES = 16
_WIDTHS = np.array([[0.75], [np.pi / 4]])
_LEVELS = 7
# Last coefficients over the largest, and how many they are.
_SPECTRUM, _TAIL = 1e-12, 2
_ANGLE = np.pi * (np.arange(_NODES) + 0.5) / _NODES
_WAVES = np.cos(np.outer(np.arange(_NODES), _ANGLE)) * (2 / _NODES)
_WAVES[0] /= 2


class _Cell(NamedTuple):
    """A cell by its level and its place in the grid of that level."""

    level: int
    column: int
    row: int

    def starts(self) -> tuple[np.ndarray, np.ndarray]:
        """v and φ at the nodes, in a row."""
        inside = (1 + np.cos(_ANGLE)) / 2
        width = _WIDTHS[:, 0] / 2**self.level
        log, phase = width[0] * (self.column + inside), width[1] * (self.row + inside)
        return np.repeat(np.exp(log), _NODES), np.tile(phase, _NODES)


class ReleaseTable:
    """Releases of one law at one Λ.

    Examples
    --------
    >>> from bouncing_ball.contacts.laws.linear import Linear
    >>> speed, zero = np.full(1000, 2.0), np.zeros(1000)
    >>> table = ReleaseTable(Linear(1e3, 0.0), 0.0)
    >>> again = [table.release(Touch(zero, speed, zero, 0.0)).rate for _ in range(2)]
    >>> [rate[0].round(11).tolist() for rate in again], len(table.cells)
    ([-2.0, -2.0], 1)
    """

    def __init__(self, law: ContactLaw, amplitude: float):
        self.law, self.amplitude = law, amplitude
        # Coefficients of D, p and p′/v, or None where they have not fallen.
        self.cells: dict[_Cell, np.ndarray | None] = {}
        self._integrated: Counter[_Cell] = Counter()

    def release(self, touch: Touch) -> ContactEnd:
        """The release of each ball."""
        out = np.full((3, touch.rate.size), np.nan)
        left = np.flatnonzero((touch.depth == 0) & (touch.rate > 0))
        for level in range(_LEVELS):
            if left.size:
                left = self._interpolate(level, touch, left, out)
        undecided = np.zeros(touch.rate.size, dtype=bool)
        rest = np.flatnonzero(np.isnan(out[0]))
        if rest.size:
            end = release(self.law, touch.take(rest))
            out[:, rest], undecided[rest] = end[:3], end.undecided
        return ContactEnd(out[0], out[1], out[2], undecided)

    def _interpolate(self, level: int, touch: Touch, which, out) -> np.ndarray:
        """Fill in the balls in cells that are known; returns those in cells to be quartered."""
        place = np.stack([np.log(touch.rate[which]), touch.phase[which]]) / _WIDTHS * 2**level
        corner = np.floor(place)
        x = 2 * (place - corner) - 1
        order = np.lexsort(corner)
        edges = np.flatnonzero(np.any(np.diff(corner[:, order]) != 0, axis=0)) + 1
        groups = np.split(order, edges)
        cells = [_Cell(level, *(int(k) for k in corner[:, group[0]])) for group in groups]
        self._learn(cells, groups)
        refused = np.zeros(which.size, dtype=bool)
        for cell, group in zip(cells, groups, strict=True):
            coefficients = self.cells.get(cell)
            if coefficients is None:
                refused[group] = cell in self.cells
                continue
            first, second = (np.polynomial.chebyshev.chebvander(y, _NODES - 1) for y in x[:, group])
            along = (first @ coefficients).reshape(group.size, _NODES, 3)
            values = np.einsum("bk,bkc->cb", second, along)
            values[2] *= touch.rate[which[group]]
            out[:, which[group]] = values
        return which[refused]

    def _learn(self, cells: list[_Cell], groups: list[np.ndarray]) -> None:
        """Integrate the nodes of the cells that have become worth it."""
        new = []
        for cell, group in zip(cells, groups, strict=True):
            if cell not in self.cells:
                self._integrated[cell] += group.size
                if self._integrated[cell] >= _NODES**2:
                    new.append(cell)
        if not new:
            return
        starts = [cell.starts() for cell in new]
        speed, phase = (np.concatenate(x) for x in zip(*starts, strict=True))
        end = release(self.law, Touch(0 * speed, speed, phase, self.amplitude))
        values = np.stack([end.duration, end.depth, end.rate / speed], axis=-1)
        for cell, part in zip(new, values.reshape(-1, _NODES, _NODES, 3), strict=True):
            self.cells[cell] = _coefficients(part)


def _coefficients(values: np.ndarray) -> np.ndarray | None:
    """Chebyshev coefficients of values at the nodes, if the last ones have fallen."""
    spectrum = np.einsum("im,jn,mnc->ijc", _WAVES, _WAVES, values, optimize=True)
    size = np.max(np.abs(spectrum), axis=(0, 1))
    ends = (spectrum[-_TAIL:], spectrum[:, -_TAIL:])
    last = np.max([np.max(np.abs(x), axis=(0, 1)) for x in ends], axis=0)
    return spectrum.reshape(_NODES, -1) if np.all(last <= _SPECTRUM * size) else None
