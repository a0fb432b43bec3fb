"""The motion of a table with several harmonics, over one period 2π of its phase.

The table is at the height w = Λ u(φ), and its shape is ::

    u(φ) = Σ a_k sin kφ + b_k cos kφ = Im Σ c_k e^{ikφ},    c_k = a_k + i b_k,    k = 1, …, N

All derivatives are known, and ``Σ k^j |c_k|`` is a bound of the derivative of order j. The sine of
the paper is a_1 = 1.
"""

from collections.abc import Sequence
from functools import cached_property, lru_cache
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from bouncing_ball.errors import ParameterError, shortened
from bouncing_ball.numerics.arrays import as_numbers
from bouncing_ball.numerics.elementary import reduce_angle, sine_and_versine

# Coefficients of samples below this part of the largest one are rounding errors of the samples.
_ROUNDING = 1e-14
_ONE = np.array(1.0)
# Parts of a period of the highest harmonic at which the search for a largest value begins, and the
# number of times that they are halved.
_PARTS, _HALVINGS = 16, 26


class Waveform:
    """The shape u of a table with several harmonics.

    Parameters
    ----------
    sine, cosine : sequence of float
        a_1, a_2, … and b_1, b_2, …; those that are missing are 0.

    Raises
    ------
    ParameterError
        If a coefficient is not finite, or if all are zero.

    Examples
    --------
    >>> table = Waveform([1.0, 0.25])
    >>> round(float(table.height(np.pi / 2)), 12), round(float(table.velocity(0.0)), 12)
    (1.0, 1.5)
    """

    def __init__(self, sine: Sequence[float], cosine: Sequence[float] = ()) -> None:
        rows = []
        for name, given in (("sine", sine), ("cosine", cosine)):
            row = as_numbers(given, name, "a row of numbers")
            if row.ndim != 1:
                raise ParameterError(f"{{{name}}} = {{}} is not a row of numbers", shortened(given))
            if not np.all(np.isfinite(row.astype(float))):
                raise ParameterError(f"{{{name}}} = {{}} are not finite numbers", shortened(given))
            rows.append(row.astype(float))
        size = max(row.size for row in rows)
        a, b = (np.concatenate([row, np.zeros(size - row.size)]) for row in rows)
        if not np.any(a) and not np.any(b):
            raise ParameterError("a table whose harmonics are all zero does not move: give Λ = 0")
        self.coefficients = a + 1j * b

    @classmethod
    def of_samples(cls, heights: ArrayLike, harmonics: int | None = None) -> "Waveform":
        """The table of which the heights at even times over one period are known.

        The first sample is at the phase 0, and the end of the period is not repeated. Their mean is
        left out, because it is the origin of the heights.

        Parameters
        ----------
        heights : array
            The samples of u, in any unit that is proportional to height.
        harmonics : int, optional
            The number N of harmonics, fewer than half the number of samples. By default it is the
            largest one, without the last ones that are below the rounding of the samples.

        Examples
        --------
        >>> phase = 2 * np.pi * np.arange(16) / 16
        >>> Waveform.of_samples(np.sin(phase) + 0.25 * np.sin(2 * phase))
        Waveform(sine=[1.0, 0.25], cosine=[0.0, 0.0])
        """
        row = np.asarray(heights)
        if row.ndim != 1 or row.size < 3 or row.dtype.kind not in "iuf":
            raise ParameterError("{heights} = {} are not three samples or more", shortened(heights))
        if not np.all(np.isfinite(row)):
            raise ParameterError("{heights} are not finite numbers")
        most = (row.size - 1) // 2
        if harmonics is not None and harmonics not in range(1, most + 1):
            raise ParameterError(
                f"{{harmonics}} = {{}} is not a whole number from 1 to {most}, fewer than half of "
                f"the {row.size} samples",
                shortened(harmonics),
            )
        # The transform is that of e^{-ikφ}: u = Re Σ 2 f_k e^{ikφ}.
        found = 2j * np.fft.rfft(row)[1 : 1 + (harmonics or most)] / row.size
        large = np.abs(found) > _ROUNDING * np.abs(found).max()
        found = np.where(large, found, 0.0)
        if harmonics is None and large.any():
            found = found[: 1 + int(np.flatnonzero(large)[-1])]
        clean = np.where(np.abs(found.real) > _ROUNDING * np.abs(found), found.real, 0.0)
        other = np.where(np.abs(found.imag) > _ROUNDING * np.abs(found), found.imag, 0.0)
        return cls(clean.round(15).tolist(), other.round(15).tolist())

    def __repr__(self) -> str:
        c = self.coefficients
        return f"Waveform(sine={c.real.tolist()}, cosine={c.imag.tolist()})"

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Waveform) and np.array_equal(self.coefficients, other.coefficients)

    def __hash__(self) -> int:
        return hash(self.coefficients.tobytes())

    @cached_property
    def orders(self) -> np.ndarray:
        """k = 1, …, N."""
        return np.arange(1, self.coefficients.size + 1)

    def bound(self, order: int) -> float:
        """A bound of the derivative of this order, ``Σ k^j |c_k|``.

        Examples
        --------
        >>> Waveform([1.0, 0.25]).bound(2)
        2.0
        """
        return float(np.sum(self.orders**order * np.abs(self.coefficients)))

    @cached_property
    def is_sine(self) -> bool:
        """Whether u = sin φ, exactly.

        A sine of another amplitude or phase is the same motion with another Λ or another zero of
        the phase, and these are parameters of a ball: such a table is not the paper's.

        Examples
        --------
        >>> tables = Waveform([1.0, 0.0]), Waveform([-1.0]), Waveform([0.0], [1.0])
        >>> [each.is_sine for each in tables]
        [True, False, False]
        """
        c = self.coefficients
        return bool(c[0] == 1) and not np.any(c[1:])

    @cached_property
    def fastest(self) -> float:
        """A bound of the speed of the table, ``Σ k |c_k|``."""
        return self.bound(1)

    def height(self, phase: Any) -> Any:
        """u, in the shape of the phases."""
        return np.imag(self._turned(phase).sum(axis=-1))

    def velocity(self, phase: Any) -> Any:
        """u′, in the shape of the phases."""
        return np.real((self.orders * self._turned(phase)).sum(axis=-1))

    def _turned(self, phase: Any) -> np.ndarray:
        """c_k e^{ikφ}, with a last axis for the harmonics."""
        return turned(self.coefficients, self.orders, phase)


class Sine(Waveform):
    """The table of the paper, u = sin φ."""

    def __init__(self) -> None:
        super().__init__([1.0])

    def height(self, phase: Any) -> Any:
        """sin φ."""
        return np.sin(phase)

    def velocity(self, phase: Any) -> Any:
        """cos φ."""
        return np.cos(phase)


def turned(coefficients: np.ndarray, orders: np.ndarray, phase: ArrayLike) -> np.ndarray:
    """c_k e^{ikφ} with the operations of :mod:`bouncing_ball.numerics.elementary`, and a last axis
    for the harmonics.
    """
    phi = reduce_angle(np.asarray(phase, dtype=float))
    sine, versine = sine_and_versine(orders * phi[..., np.newaxis])
    cosine = _ONE - versine
    a = coefficients.real
    b = coefficients.imag
    return (a * cosine - b * sine) + 1j * (a * sine + b * cosine)


def largest(harmonics: np.ndarray) -> np.ndarray:
    """The largest values of ``Im Σ s_k e^{ikφ}`` for harmonics of shape (..., N).

    The result is an upper bound that differs from the value by rounding errors.

    Examples
    --------
    >>> float(largest(np.array([3.0 + 4.0j])).round(12))
    5.0
    """
    rows = harmonics.reshape(-1, harmonics.shape[-1])
    found = [_largest(tuple(row.tolist())) for row in rows]
    return np.reshape(found, harmonics.shape[:-1])


@lru_cache(maxsize=4096)
def _largest(harmonics: tuple[complex, ...]) -> float:
    row = np.array(harmonics)
    k = np.arange(1, row.size + 1)
    bend = float(np.sum(k * k * np.abs(row)))
    # Half the width of the parts, and their centres.
    half = np.pi / (_PARTS * row.size)
    centre = -np.pi + half * (2 * np.arange(_PARTS * row.size) + 1)
    for _ in range(_HALVINGS):
        whole = turned(row, k, centre)
        value = whole.imag.sum(axis=-1)
        slope = (k * whole.real).sum(axis=-1)
        most = value + np.abs(slope) * half + bend * half * half / 2
        keep = centre[most >= value.max()]
        half = half / 2
        centre = np.concatenate([keep - half, keep + half])
    return float(most.max())


SINE = Sine()
