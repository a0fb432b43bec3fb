"""The motion ΛW(τ) of the table. The waveform W is a sum of harmonics and has the period 2π.

Other modules use waveforms only through this module. The sine of the paper is :data:`SINE`. W is
analytic in τ and in its parameters, the sizes and phases of the harmonics. Complex steps therefore
give all derivatives.
"""

import warnings
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise
from math import isfinite
from typing import Any, NamedTuple

import numpy as np

from bouncing_ball_beyond.tables.records import PERIOD, fit_harmonics, overshoot

SAMPLES = 64
"""Number of samples of W in a period of its highest harmonic.

At half: bounds are too large by up to 5e-3, instead of 1e-3. At twice: by 3e-4.
"""

JUMP = 2.0
"""Largest step from the last sample to the first, divided by the largest other step.

Larger steps mean that the samples do not cover exactly one period.

At half: 34 of 800 records more are refused. At twice: 58 fewer, of which 28 are cut records.
"""
UPPER_SHARE = 0.1
"""Maximum share of the acceleration that the upper half of the harmonics of samples may have.

If the share is larger, the caller must give the highest harmonic.

At half: 67 of 800 records more are refused. At twice: 34 fewer.
"""

FUNDAMENTAL = {"harmonic_1": 1.0, "phase_1": 0.0}
"""Default size and phase of the first harmonic. Its amplitude is then Λ, and its phase is τ."""

Values = Any
"""Numbers or arrays, real or complex. All functions accept complex steps."""

REAL = np.dtype(float)

CYCLE = (np.sin, np.cos)
"""sin and its first derivative. The next two derivatives have the opposite sign."""


def swing(x: Values) -> tuple[Values, Values]:
    """Return sin x and 1 - cos x. Both keep all digits if x is small."""
    half = x / 2
    if getattr(x, "dtype", REAL).kind == "c" or isinstance(x, complex):
        sine = np.sin(half)
        twice = 2 * sine
        return twice * np.cos(half), twice * sine
    half = np.tan(half)
    sine = 2 * half / (1 + half * half)
    return sine, half * sine


def checked_harmonic(harmonic: Any) -> tuple[int, float, float]:
    """Return (k, a, p) as numbers. Raises ValueError unless k ≥ 1 is whole and a, p are finite."""
    try:
        k, a, p = harmonic
        good = int(k) == k >= 1 and isfinite(a) and isfinite(p)
    except (TypeError, ValueError):
        good = False
    if not good:
        raise ValueError(
            f"harmonics: {harmonic!r}: must be (k, a, p) for a harmonic a · sin(kτ + p), with a"
            " whole number k from 1 and numbers a, p; frequencies in a ratio of whole numbers have"
            " a common period: take it as the period of the table, such as k = 2 and 3 instead of"
            " 1 and 1.5"
        )
    return int(k), float(a), float(p)


def finite_row(name: str, values: Values) -> Values:
    """Return values as an array. Raises ValueError unless it has one axis and is finite."""
    try:
        row = np.asarray(values)
    except ValueError:
        row = np.empty(0)
    if row.ndim != 1 or not row.size or row.dtype.kind not in "iuf" or not np.isfinite(row).all():
        raise ValueError(f"{name}: must be a row of finite numbers")
    return row.astype(float)


def highest(value: Any) -> int:
    """Return the order of a harmonic as int. Raises ValueError unless it is a whole number ≥ 1."""
    number = isinstance(value, int | float | np.integer) and not isinstance(value, bool)
    if not number or value % 1 or value < 1:
        raise ValueError("harmonics: must be whole numbers from 1")
    return int(value)


class MeasuredTable(NamedTuple):
    """Result of :meth:`Table.of_record`.

    Attributes
    ----------
    table : Table
        Waveform W, scaled so that the maximum of |W″| is 1.
    amplitude, amplitude_error : float
        Amplitude Λ of the table, and its standard error.
    frequency, frequency_error : float
        Frequency of the table in Hz, and its standard error.
    residual : float
        Root mean square of what the table does not explain, in m/s².
    """

    table: "Table"
    amplitude: float
    amplitude_error: float
    frequency: float
    frequency_error: float
    residual: float


@dataclass(frozen=True, init=False, eq=True)
class Table:
    """A periodic waveform W(τ) = Σ a sin(kτ + p).

    The height of the table is ΛW(τ), in units of g/Ω². Functions take the amplitude Λ as an
    argument. The maximum acceleration of the table divided by gravity is Λ times ``acceleration``.
    This factor is 1 for the sine and for tables made of samples. Orbits can be followed along the
    sizes and phases of harmonics, the parameters ``harmonic_k`` and ``phase_k``.

    Parameters
    ----------
    harmonics : list of (k, a, p)
        Order k ≥ 1, size a and phase p of each harmonic.

    Raises
    ------
    ValueError
        If an order occurs twice, if all sizes are 0, or if a number is not allowed.

    Examples
    --------
    >>> skewed = Table([(1, 1.0, 0.0), (2, 0.25, 2.5)])
    >>> round(float(skewed(0.5, 1)), 6), list(skewed.parameters)
    (0.409354, ['harmonic_1', 'harmonic_2', 'phase_1', 'phase_2'])
    """

    orders: tuple
    sizes: tuple
    phases: tuple

    is_sine = False
    """Whether the table is a sine. The loops of :mod:`.one_ball` then follow single balls."""

    def __init__(self, harmonics: Any) -> None:
        if not isinstance(harmonics, Iterable):
            raise ValueError(f"harmonics = {harmonics!r}: must be a list of (k, a, p)")
        harmonics = sorted(checked_harmonic(harmonic) for harmonic in harmonics)
        orders = tuple(k for k, _, _ in harmonics)
        if not any(a for _, a, _ in harmonics):
            raise ValueError("harmonics: at least one must have a size other than 0")
        for k, after in pairwise(orders):
            if k == after:
                raise ValueError(f"harmonics: the order {k} occurs twice: give each order once")
        values = orders, *zip(*((a, p) for _, a, p in harmonics), strict=True)
        for name, value in zip(("orders", "sizes", "phases"), values, strict=True):
            object.__setattr__(self, name, value)

    @classmethod
    def of_samples(
        cls, values: Values, harmonics: Any = None, *, acceleration: bool = False
    ) -> "Table":
        """Make a table from equally spaced samples of one period.

        The mean of the samples is removed. W is scaled so that the maximum of |W″| is 1. Λ is then
        the maximum acceleration of the table divided by gravity.

        Parameters
        ----------
        values : array_like, shape (samples,)
            Heights or accelerations, in any unit.
        harmonics : int, optional
            Highest harmonic to keep. By default all harmonics that the samples resolve are kept,
            except those at the level of rounding errors, 2.2e-16 times the largest sample. Give the
            highest harmonic for measured heights, because the acceleration amplifies noise by k².
            A bifurcation may depend on this choice: for a triangle and r = 0.8, the Λ of the period
            doubling is 1.38, 1.16, 1.07 and 1.03 times the Λ of the saddle-node, with 5, 9, 15 and
            25 harmonics. Compare bifurcations with those of twice as many harmonics. If the
            acceleration jumps, this does not help, and a warning gives the factor of Λ.
        acceleration : bool
            Whether the values are accelerations.

        Returns
        -------
        Table

        Raises
        ------
        ValueError
            If the first and the last sample do not join. If ``harmonics`` is not given, and the
            upper half of all harmonics has more than a tenth of the acceleration.

        Examples
        --------
        >>> tau = 2 * np.pi * np.arange(16) / 16
        >>> table = Table.of_samples(np.sin(tau) + 0.1 * np.cos(3 * tau), harmonics=3)
        >>> [round(float(size), 3) for size in table.sizes]
        [0.562, 0.056]
        """
        values = finite_row("values", values)
        if len(values) < 3:
            raise ValueError("values: must be at least three samples of one period")
        last = (len(values) - 1) // 2
        if harmonics is not None:
            last = min(highest(harmonics), last)
        steps = np.abs(np.diff(values))
        jump = abs(values[0] - values[-1])
        if jump > JUMP * steps.max():
            raise ValueError(
                f"values: the first and the last sample do not join: the step between them is"
                f" {jump:.3g}, but all other steps are at most {steps.max():.3g}; give samples"
                " of exactly one period that does not start at a jump, or use Table.of_record"
            )
        series = np.fft.rfft(values) / len(values)
        k = np.arange(1, last + 1)
        waves = 2 * series[1 : last + 1]
        # Harmonics up to a rounding error of the samples may be rounding errors.
        waves[np.abs(waves) <= np.finfo(float).eps * np.abs(values).max()] = 0.0
        pulls = waves * (1.0 if acceleration else -(k**2))
        size = np.linalg.norm(pulls)
        if size <= 1e-12 * np.abs(values).max():
            raise ValueError("values: are all equal: the table would be at rest")
        upper = np.linalg.norm(pulls[k > max(last / 2, 2)]) / size
        if harmonics is None and upper > UPPER_SHARE:
            raise ValueError(
                f"values: harmonics above {max(last // 2, 2)} have {upper:.0%} of the acceleration,"
                " because of noise, a jump, or equal samples at both ends of a period; give the"
                " highest harmonic to keep, such as harmonics=5"
            )
        factor = overshoot(pulls)
        if factor > 1:
            warnings.warn(
                "values: the acceleration jumps, and its harmonics overshoot a jump, however many"
                f" they are: Λ is here {factor:.3g} times the largest acceleration without the"
                " overshoot, divided by gravity; give samples with a smooth step to avoid this",
                stacklevel=2,
            )
        return cls._of_accelerations(k, pulls)[0]

    @classmethod
    def of_record(
        cls,
        time: Values,
        acceleration: Values,
        *,
        frequency: float,
        harmonics: Any,
        gravity: float = 9.80665,
    ) -> "MeasuredTable":
        """Fit a table to a measured acceleration by least squares.

        The frequency is fitted, too, because an error of 0.01 % makes Λ of a minute's record too
        small by a tenth.

        Parameters
        ----------
        time : array_like, shape (samples,)
            Times in s. At the time 0 the phase of the table is 0. The times may have gaps.
        acceleration : array_like, shape (samples,)
            Upward acceleration in m/s². A constant part, such as gravity, and a slow drift are
            ignored.
        frequency : float
            Frequency of the table in Hz, within 3 %. If the table has two frequencies, give their
            greatest common divisor.
        harmonics : int or list of int
            Highest harmonic, or the orders of all harmonics to fit, such as [12, 17].
        gravity : float
            Acceleration of gravity in m/s².

        Returns
        -------
        MeasuredTable
            The table, Λ and the frequency, with standard errors.

        Raises
        ------
        ValueError
            If an argument is out of range, or if the record is too short for the harmonics. If the
            fit leaves a tone that noise does not explain: a harmonic is missing, the frequency is
            wrong, or the motion of the table changed during the record.

        Examples
        --------
        >>> time = np.arange(0.0, 0.83, 1e-3)
        >>> signal = 9.81 + 7.0 * np.sin(157.08 * time) + 2.0 * np.sin(471.24 * time)
        >>> measured = Table.of_record(time, signal, frequency=25.1, harmonics=[1, 3])
        >>> round(measured.amplitude * 9.80665 * measured.table.sizes[0], 4), measured.table.orders
        (7.0, (1, 3))
        >>> round(measured.frequency, 6)
        25.000058
        """
        time = finite_row("time", time)
        acceleration = finite_row("acceleration", acceleration)
        for name, value in (("frequency", frequency), ("gravity", gravity)):
            if not (isinstance(value, int | float | np.number) and 0 < value < np.inf):
                raise ValueError(f"{name} = {value!r}: must be a positive number")
        orders = harmonics
        if np.ndim(harmonics) == 0:
            orders = range(1, highest(harmonics) + 1)
        k = np.array(sorted({highest(order) for order in orders}), int)
        if not k.size:
            raise ValueError("harmonics: is empty: give at least one order")
        if len(time) != len(acceleration):
            raise ValueError(
                f"time, acceleration: have {len(time)} and {len(acceleration)} samples, but must"
                " have equally many"
            )
        if len(time) < 2 * len(k) + 4 or np.ptp(time) * frequency < 1 - 1 / len(time):
            raise ValueError(
                f"time: {len(time)} samples of {np.ptp(time) * frequency:.3g} periods are too few"
                f" for {len(k)} harmonics"
            )
        if np.ptp(acceleration) <= 1e-12 * np.abs(acceleration).max():
            raise ValueError("acceleration: is constant: the table would be at rest")
        order = np.argsort(time, kind="stable")
        fit = fit_harmonics(time[order], acceleration[order], frequency, k)
        table, largest = cls._of_accelerations(k, fit.waves)
        # The error of the largest acceleration is that of the sum at its phase.
        tau = np.linspace(0, PERIOD, SAMPLES * k[-1], endpoint=False)
        at = tau[np.abs((np.exp(1j * np.multiply.outer(tau, k)) @ fit.waves).real).argmax()]
        slopes = np.concatenate([np.cos(k * at), np.sin(k * at)])
        error = np.sqrt(slopes @ fit.covariance @ slopes)
        turn = PERIOD * fit.frequency * fit.origin
        shifted = {
            f"phase_{n}": float((p - n * turn + np.pi) % PERIOD - np.pi)
            for n, _, p in table.harmonics
        }
        return MeasuredTable(
            table.at(**shifted),
            float(largest / gravity),
            float(error / gravity),
            fit.frequency,
            fit.frequency_error,
            fit.residual,
        )

    @classmethod
    def _of_accelerations(cls, k: Values, pulls: Values) -> tuple["Table", float]:
        """Return the table and Λ for ΛW″ = Re Σ p e^{ikτ}, scaled so that the maximum |W″| is 1."""
        kept = np.abs(pulls) > 1e-12 * np.abs(pulls).max()
        sizes = np.abs(pulls) / k**2
        # -Re p e^{ikτ} = |p| sin(kτ + φ) with φ = arg(-p) + π/2.
        waves = zip(k[kept], sizes[kept], np.angle(-pulls[kept]) + np.pi / 2, strict=True)
        unscaled = cls(waves)
        scale = unscaled.acceleration
        return cls((k, a / scale, p) for k, a, p in unscaled.harmonics), scale

    def __repr__(self) -> str:
        return f"Table([{', '.join(f'({k}, {a!r}, {p!r})' for k, a, p in self.harmonics)}])"

    @property
    def parameters(self) -> dict[str, Values]:
        """Sizes and phases of the harmonics, by name."""
        sizes = {f"harmonic_{k}": a for k, a in zip(self.orders, self.sizes, strict=True)}
        return sizes | {f"phase_{k}": p for k, p in zip(self.orders, self.phases, strict=True)}

    def at(self, **values: Values) -> Any:
        """Return the table with other sizes or phases.

        The values may be arrays or complex, and are not checked. Raises ValueError if the table
        does not have a parameter of this name.
        """
        new = self.parameters | values
        if len(new) > len(self.parameters):
            known = ", ".join(self.parameters) or "none"
            raise ValueError(f"{', '.join(values)}: must be a parameter of the table: {known}")
        table = object.__new__(type(self))
        vars(table).update(
            orders=self.orders,
            sizes=tuple(new[f"harmonic_{k}"] for k in self.orders),
            phases=tuple(new[f"phase_{k}"] for k in self.orders),
        )
        return table

    def rows(self, which: Any) -> Any:
        """Return the table with x[which] instead of each parameter x that is an array."""
        arrays = {name: x[which] for name, x in self.parameters.items() if np.ndim(x)}
        return self.at(**arrays) if arrays else self

    @property
    def harmonics(self) -> Values:
        """(k, a, p) of each harmonic."""
        return zip(self.orders, self.sizes, self.phases, strict=True)

    def __call__(self, tau: Values, order: int = 0) -> Values:
        """Return W, or its derivative of the given order, at the phase ``tau``."""
        sign = -1 if order % 4 > 1 else 1
        function = CYCLE[order % 2]
        return sum(sign * k**order * a * function(k * tau + p) for k, a, p in self.harmonics)

    def displacement(self, start: Values, time: Values) -> tuple:
        """Return W(start + time) - W(start) and the same difference of W′, without cancellation."""
        height = rate = 0.0
        for k, a, p in self.harmonics:
            half = k * time / 2
            middle = k * start + p + half
            part = 2 * a * np.sin(half)
            height = height + part * np.cos(middle)
            rate = rate - k * part * np.sin(middle)
        return height, rate

    # The methods below represent the table at the start of a motion by two numbers per harmonic:
    # x = Λa cos(kτ + p) and y = Λa sin(kτ + p).

    def waves(self, phase: Values, amplitude: Values) -> list:
        """Return x and y of each harmonic: [x₁, y₁, x₂, y₂, …]."""
        waves = []
        for k, a, p in self.harmonics:
            sine, versine = swing(k * phase + p)
            scale = amplitude * a
            waves += [scale * (1 - versine), scale * sine]
        return waves

    def each_wave(self, waves: Values) -> Values:
        """Iterate over k, x and y of each harmonic."""
        return zip(self.orders, waves[::2], waves[1::2], strict=True)

    def pulls(self, waves: Values) -> Values:
        """Return w′, -w″ and -w‴ at the start."""
        waves = list(self.each_wave(waves))
        return tuple(
            sum(part)
            for part in zip(*((k * x, k * k * y, k**3 * x) for k, x, y in waves), strict=True)
        )

    def flights(self, t: Values, gap: Values, w: Values, waves: Values) -> tuple:
        """Return δ, δ′ and δ″ at the time t after a release. Short flights keep all digits.

        ``gap`` and ``w`` are δ and δ′ at the release.
        """
        position = gap + t * (w - t / 2)
        rate = w - t
        second = -1.0
        for k, x, y in self.each_wave(waves):
            angle = t if k == 1 else k * t
            sine, versine = swing(angle)
            position = position + (y * versine + x * (angle - sine))
            change = y * sine + x * versine
            bend = y + (x * sine - y * versine)
            rate = rate + (change if k == 1 else k * change)
            second = second + (bend if k == 1 else k * k * bend)
        return position, rate, second

    def third(self, t: Values, w: Values, rate: Values, waves: Values) -> Values:
        """Return δ‴ at the time t after a release."""
        third = 0.0
        for k, x, y in self.each_wave(waves):
            sine, versine = swing(k * t)
            third = third + k**3 * (x * (1 - versine) - y * sine)
        return third

    # Sizes

    @cached_property
    def grid(self) -> Values:
        """Phases of one period, with `SAMPLES` phases in each period of the highest harmonic."""
        return np.linspace(0, PERIOD, SAMPLES * self.orders[-1] + 1)

    @cached_property
    def bounds(self) -> Values:
        """Six upper bounds: of |W|, and of the moduli of its first five derivatives."""
        remainder = (self.grid[1] / 2) ** 2 / 2
        sums = [sum(abs(a) * k**m for k, a, _ in self.harmonics) for m in range(8)]
        table = self.rows(np.s_[..., np.newaxis])
        samples = [np.abs(table(self.grid, m)).max(axis=-1) for m in range(6)]
        return tuple(np.minimum(samples[m] + remainder * sums[m + 2], sums[m]) for m in range(6))

    def _top(self, order: int, sign: int = 1) -> float:
        """Phase at which a derivative of W is largest (``sign`` 1) or smallest (-1)."""
        start = self.grid[np.argmax(sign * self(self.grid, order))]
        return float(self._zero(start, lambda tau: (self(tau, order + 1), self(tau, order + 2)), 6))

    def _zero(self, phase: Values, function: Callable, steps: int = 4) -> Values:
        """Find a zero near a phase by Newton's method. ``function`` returns value and slope."""
        most = 0.1 / self.orders[-1]
        for _ in range(steps):
            value, slope = function(phase)
            step = np.divide(value, slope, where=slope != 0, out=np.zeros_like(value))
            # Limit the step, because Newton's first step leads far away where the slope vanishes.
            phase = phase - np.clip(step, -most, most)
        return phase

    @cached_property
    def lift(self) -> Values:
        """Maximum of -W″. Above Λ = 1/lift the table falls faster than a ball."""
        return float(-self(self._top(2, -1), 2))

    @cached_property
    def acceleration(self) -> Values:
        """Maximum of |W″|."""
        return max(self.lift, float(self(self._top(2), 2)))

    @cached_property
    def peaks(self) -> Values:
        """Maximum and minimum of W."""
        return float(self(self._top(0))), float(self(self._top(0, -1)))

    @cached_property
    def steepest(self) -> Values:
        """Phase at which W′ is largest."""
        return self._top(1)

    @cached_property
    def slope(self) -> Values:
        """Maximum of W′."""
        return float(self(self.steepest, 1))

    @cached_property
    def _sides(self) -> dict:
        """Samples of W′ on both sides of the steepest phase, up to the next minimum of W′.

        The key 1 is the side after the steepest phase, and the key -1 is the side before this
        phase. The values are phases and W′.
        """
        sides = {}
        for side in (1, -1):
            phase = self.steepest + side * np.linspace(0, PERIOD, 4 * len(self.grid) - 3)
            rises = side * self(phase, 2) > 0
            rises[0] = False
            phase = phase[: int(np.argmax(rises)) or len(phase)]
            sides[side] = phase, self(phase, 1)
        return sides

    @cached_property
    def next_low_slope(self) -> float:
        """W′ at its first minimum after the steepest phase."""
        return float(self._sides[1][1][-1])

    @cached_property
    def _turns(self) -> tuple:
        """Sampled phases from the steepest phase to the zero of W′, and angles of (W′, -W″)."""
        phase = self.steepest + np.linspace(0, PERIOD, 4 * len(self.grid) - 3)
        phase = phase[: int(np.argmax(self(phase, 1) <= 0)) + 1]
        angles = np.arctan2(-self(phase, 2), self(phase, 1))
        return phase, np.maximum.accumulate(np.maximum(angles, 0))

    def phase_of_slope(self, slope: Values, side: int = 1) -> Values:
        """Find the phase at which W′ equals a slope.

        The phase is after the steepest phase (``side`` 1) or before it (-1). If W′ does not reach
        the slope, the phase is where W′ is nearest to the slope.
        """
        phase, slopes = self._sides[side]
        slope = np.clip(slope, slopes[-1], slopes[0])
        # Next to the steepest phase W′ falls with the square of the distance.
        start = np.interp(np.sqrt(slopes[0] - slope), np.sqrt(slopes[0] - slopes), phase)
        zero = self._zero(start, lambda tau: (self(tau, 1) - slope, self(tau, 2)))
        # At the steepest phase W″ consists of rounding errors, and Newton's method leads away.
        nearer = np.abs(self(zero, 1) - slope) <= np.abs(self(start, 1) - slope)
        return np.where(nearer, zero, start)

    def phase_of_angle(self, angle: Values) -> Values:
        """Find the phase after the steepest phase at which (W′, -W″) has a given angle ≤ π/2."""
        phase, turned = self._turns
        x, y = np.cos(angle), np.sin(angle)

        def apart(tau: Values) -> tuple:
            return x * self(tau, 2) + y * self(tau, 1), x * self(tau, 3) + y * self(tau, 2)

        return self._zero(np.interp(angle, turned, phase), apart)

    def instant(self, speed: Values, amplitude: Values) -> tuple:
        """Find the phase after the steepest phase at which w′ has fallen to a speed.

        The speed may be complex. Returns the phase, w, -w″ and -w‴; NaN if w′ does not reach the
        speed.
        """
        slope = speed / amplitude
        phase = self.phase_of_slope(np.real(slope))
        if np.iscomplexobj(slope):
            with np.errstate(divide="ignore", invalid="ignore"):
                phase = phase + np.divide(1j * np.imag(slope), self(phase, 2))
        inside = np.abs(self(np.real(phase), 1) - np.real(slope)) < 1e-9
        phase = np.where(inside, phase, np.nan)
        return phase, amplitude * self(phase), *(-amplitude * self(phase, m) for m in (2, 3))

    def amplitude_at(self, speed: Values, push: Values) -> tuple:
        """Return Λ and the phase for which w′ = speed and -w″ = push."""
        phase = self.phase_of_angle(np.arctan2(push, speed))
        return np.hypot(speed, push) / np.hypot(self(phase, 1), self(phase, 2)), phase

    # Where the table falls as fast as a ball

    def levels(self, amplitude: Values) -> Values:
        """Phases at which ΛW″ = -1, shape (*amplitude.shape, phases). Missing phases are NaN."""
        amplitude = np.asarray(amplitude, float)[..., np.newaxis]
        table = self.rows(np.s_[..., np.newaxis])
        values = 1 + amplitude * table(self.grid, 2)
        crossed = values[..., 1:] * values[..., :-1] < 0
        most = int(crossed.sum(axis=-1).max(initial=0))
        if not most:
            return np.full((*crossed.shape[:-1], 1), np.nan)
        at = np.argsort(~crossed, axis=-1, kind="stable")[..., :most]
        phase = self.grid[at] + self.grid[1] / 2
        for _ in range(4):
            step = (1 + amplitude * table(phase, 2)) / (amplitude * table(phase, 3))
            phase = phase - np.clip(step, -self.grid[1], self.grid[1])
        return np.where(np.take_along_axis(crossed, at, axis=-1), phase, np.nan)

    def lift_offs(self, amplitude: Values) -> Values:
        """Phases in [0, 2π) at which a resting ball leaves, shape (*amplitude.shape, phases).

        At these phases 1 + ΛW″ falls to zero. The phases are sorted, and missing phases are NaN.
        """
        phases = self.levels(amplitude)
        falls = self(phases, 3) < 0
        # The function `levels` misses a fall of the table that is shorter than the distance of
        # samples.
        short = ~falls.any(axis=-1) & (np.asarray(amplitude) * self.lift > 1)
        phases[short, 0] = self._top(2, -1)
        falls[short, 0] = True
        return np.sort(np.where(falls, phases % PERIOD, np.nan))


class Sine(Table):
    """The table of the paper, W = sin τ, with closed formulas."""

    is_sine = True

    def __init__(self) -> None:
        super().__init__([(1, 1.0, 0.0)])

    parameters = {}  # noqa: RUF012
    bounds = (1.0,) * 6
    lift = slope = acceleration = 1.0
    peaks = (1.0, -1.0)
    steepest = 0.0

    def __repr__(self) -> str:
        return "Sine()"

    def at(self, **values: Values) -> Any:
        return super().at(**values) if values else self

    def __call__(self, tau: Values, order: int = 0) -> Values:
        value = CYCLE[order % 2](tau)
        return -value if order % 4 > 1 else value

    def displacement(self, start: Values, time: Values) -> tuple:
        half = time / 2
        middle = start + half
        part = 2 * np.sin(half)
        return part * np.cos(middle), -part * np.sin(middle)

    def waves(self, phase: Values, amplitude: Values) -> list:
        """Return [Λ cos τ, Λ sin τ]."""
        sine, versine = swing(phase)
        return [amplitude * (1 - versine), amplitude * sine]

    def pulls(self, waves: Values) -> tuple:
        return waves[0], waves[1], waves[0]

    def flights(self, t: Values, gap: Values, w: Values, waves: Values) -> tuple:
        x, y = waves
        sine, versine = swing(t)
        position = gap + t * (w - t / 2) + (y * versine + x * (t - sine))
        rate = (w - t) + (y * sine + x * versine)
        return position, rate, (y - 1) + (x * sine - y * versine)

    def phase_of_slope(self, slope: Values, side: int = 1) -> Values:
        return side * np.arccos(np.clip(slope, -1, 1))

    def phase_of_angle(self, angle: Values) -> Values:
        return angle

    def instant(self, speed: Values, amplitude: Values) -> tuple:
        with np.errstate(invalid="ignore"):
            height = np.sqrt((amplitude - speed) * (amplitude + speed))
            if np.iscomplexobj(speed):
                phase = np.arccos(speed / amplitude)
            else:
                phase = np.arctan2(height, speed)
        return phase, height, height, speed

    def amplitude_at(self, speed: Values, push: Values) -> tuple:
        return np.hypot(speed, push), np.arctan2(push, speed)

    def levels(self, amplitude: Values) -> Values:
        """The two phases at which Λ sin τ = 1. If Λ ≤ 1, both are π/2."""
        level = np.arcsin(np.minimum(1, 1 / np.asarray(amplitude, float)))
        return np.stack([level, np.pi - level], axis=-1)

    def lift_offs(self, amplitude: Values) -> Values:
        level = np.asarray(1 / np.maximum(amplitude, 1.0))
        return np.arcsin(np.where(level < 1, level, np.nan))[..., np.newaxis]


SINE = Sine()
"""The table of the paper, and the default of all functions."""


def check_table(table: Table) -> None:
    """Raise ValueError unless ``table`` is a Table whose parameters are single numbers."""
    if not isinstance(table, Table):
        raise ValueError(f"table = {table!r:.60}: must be a Table, such as Table([(1, 1.0, 0.0)])")
    for name, value in table.parameters.items():
        if np.ndim(value):
            raise ValueError(
                f"table: its {name} is an array, but must be a number: give one table at a time"
            )
    if table is not SINE:
        Table(table.harmonics)
