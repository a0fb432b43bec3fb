"""The motion of the table: ΛW(τ) with a waveform W of period 2π, a sum of harmonics.

Everything that the other modules know of the waveform is here. The sine of the paper is
:data:`SINE`. W is analytic in τ and in its parameters, the sizes and phases of the harmonics, so
that complex steps give all derivatives.
"""

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise
from typing import Any

import numpy as np

from bouncing_ball_beyond.one_ball import CHATTER, PERIOD

SAMPLES = 64
"""Samples in a period of the highest harmonic."""

JUMP = 2.0
"""The step from the last sample to the first, over all other steps, up to which a period is
smooth.
"""
UPPER_SHARE = 0.1
"""The share of the upper harmonics in the acceleration above which samples do not tell how many are
meant.
"""

FUNDAMENTAL = {"harmonic_1": 1.0, "phase_1": 0.0}
"""What is not said of a fundamental: Λ is its size, and the phase is counted from it."""

Values = Any
"""Numbers or arrays, real or complex: complex steps go through all functions."""

REAL = np.dtype(float)

CYCLE = (np.sin, np.cos)
"""sin and its derivatives, which repeat with the opposite sign."""


def swing(x: Values) -> tuple[Values, Values]:
    """sin x and 1 - cos x, which loses no digits for a small x."""
    half = x / 2
    if getattr(x, "dtype", REAL).kind == "c" or isinstance(x, complex):
        sine = np.sin(half)
        twice = 2 * sine
        return twice * np.cos(half), twice * sine
    half = np.tan(half)
    sine = 2 * half / (1 + half * half)
    return sine, half * sine


FRACTIONS = (
    "; frequencies in a ratio of whole numbers have a common period, of which their k are multiples"
)


def checked_harmonic(each: Any) -> tuple[int, float, float]:
    """(k, a, p) with a whole k and finite a, p; ValueError otherwise."""
    fraction = False
    try:
        k, a, p = each
        fraction = bool(k % 1)
        good = int(k) == k >= 1 and bool(np.isfinite([a, p]).all())
    except (TypeError, ValueError):
        good = False
    if not good:
        raise ValueError(
            f"harmonics: {each!r}: must be (k, a, p) with a whole number k from 1 and numbers a, p"
            " of a sin(kτ + p)" + (FRACTIONS if fraction else "")
        )
    return int(k), float(a), float(p)


def finite_row(name: str, values: Values) -> Values:
    """Values as an array with one axis; ValueError otherwise."""
    try:
        row = np.asarray(values, float)
    except (TypeError, ValueError):
        row = np.empty(0)
    if row.ndim != 1 or not row.size or not np.isfinite(row).all():
        raise ValueError(f"{name}: must be a row of finite numbers")
    return row


def highest(value: Any) -> int:
    """The number of a harmonic; ValueError otherwise."""
    number = isinstance(value, int | float | np.integer) and not isinstance(value, bool)
    if not number or value % 1 or value < 1:
        raise ValueError("harmonics: must be whole numbers from 1")
    return int(value)


@dataclass(frozen=True, init=False, eq=True)
class Table:
    """A periodic waveform W(τ) = Σ a sin(kτ + p).

    ``harmonics`` are (k, a, p): the order k ≥ 1, the size a and the phase p of each. The amplitude
    Λ of a call is the scale: the table is at ΛW(τ), in units of g/Ω². Its greatest acceleration
    over gravity is Λ times ``acceleration``, which is 1 for the sine and for tables made of
    samples. Sizes and phases are parameters along which orbits are followed, ``harmonic_k`` and
    ``phase_k``.

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
    """Whether the loops of :mod:`.one_ball` follow single balls."""

    def __init__(self, harmonics: Any) -> None:
        if not isinstance(harmonics, Iterable):
            raise ValueError(f"harmonics = {harmonics!r}: must be a list of (k, a, p)")
        harmonics = sorted(checked_harmonic(each) for each in harmonics)
        orders = tuple(k for k, _, _ in harmonics)
        if not any(a for _, a, _ in harmonics):
            raise ValueError("harmonics: one of a size other than 0 is needed")
        for k, after in pairwise(orders):
            if k == after:
                raise ValueError(f"harmonics: the order {k} is there twice")
        values = orders, *zip(*((a, p) for _, a, p in harmonics), strict=True)
        for name, value in zip(("orders", "sizes", "phases"), values, strict=True):
            object.__setattr__(self, name, value)

    @classmethod
    def of_samples(
        cls, values: Values, harmonics: Any = None, *, acceleration: bool = False
    ) -> "Table":
        """The table through equally spaced samples of one period, without their mean, with a
        greatest |W″| of 1, so that Λ is the greatest acceleration over gravity.

        Parameters
        ----------
        values : array_like, shape (samples,)
            Heights, or accelerations, in any unit: what counts is their shape.
        harmonics : int, optional
            The highest harmonic that is kept, by default all that the samples tell apart. Noise
            of heights counts k² times in the acceleration: give it for measured ones.
        acceleration : bool
            Whether the values are accelerations.

        Raises
        ------
        ValueError
            If the first and the last sample do not join, or, without ``harmonics``, if the upper
            half of all harmonics has more than a tenth of the acceleration.

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
        if not isinstance(acceleration, bool | np.bool):
            raise ValueError(f"acceleration = {acceleration!r}: must be True or False")
        last = (len(values) - 1) // 2
        if harmonics is not None:
            last = min(highest(harmonics), last)
        steps = np.abs(np.diff(values))
        jump = abs(values[0] - values[-1])
        if jump > JUMP * steps.max():
            raise ValueError(
                f"values: the first and the last sample do not join: the step between them is"
                f" {jump:.3g}, and others are {steps.max():.3g} at most; they must be of exactly"
                " one period, with its jumps inside (Table.of_record takes any length)"
            )
        series = np.fft.rfft(values) / len(values)
        k = np.arange(1, last + 1)
        pulls = 2 * series[1 : last + 1] * (1.0 if acceleration else -(k**2))
        size = np.linalg.norm(pulls)
        if size <= 1e-12 * np.abs(values).max():
            raise ValueError("values: are all the same: the table would be at rest")
        upper = np.linalg.norm(pulls[k > max(last / 2, 2)]) / size
        if harmonics is None and upper > UPPER_SHARE:
            raise ValueError(
                f"values: harmonics above {max(last // 2, 2)} have {upper:.0%} of the acceleration,"
                " by noise, by a jump, or because the end of the period is there twice; give the"
                " highest harmonic that is meant, such as 5"
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
    ) -> tuple["Table", float]:
        """The table of a measured acceleration by least squares, with a greatest |W″| of 1, and its
        Λ.

        Parameters
        ----------
        time : array_like, shape (samples,)
            In seconds; the phase of the table is 0 at the time 0.
        acceleration : array_like, shape (samples,)
            Upwards, in m/s²; a constant part, such as gravity, does not count.
        frequency : float
            That of the table in Hz; of two frequencies the greatest of which both are multiples.
        harmonics : int or list of int
            The highest harmonic, or the orders of all that are fitted, such as [12, 17].
        gravity : float
            In m/s².

        Examples
        --------
        >>> time = np.arange(0.0, 0.83, 1e-3)
        >>> signal = 9.81 + 7.0 * np.sin(157.08 * time) + 2.0 * np.sin(471.24 * time)
        >>> known = {"frequency": 157.08 / PERIOD, "harmonics": [1, 3]}
        >>> table, amplitude = Table.of_record(time, signal, **known)
        >>> round(amplitude * 9.80665 * table.sizes[0], 4), table.orders
        (7.0, (1, 3))
        """
        time = finite_row("time", time)
        acceleration = finite_row("acceleration", acceleration)
        for name, value in (("frequency", frequency), ("gravity", gravity)):
            if not (isinstance(value, int | float | np.number) and 0 < value < np.inf):
                raise ValueError(f"{name} = {value!r}: must be a positive number")
        orders = harmonics
        if np.ndim(harmonics) == 0:
            orders = range(1, highest(harmonics) + 1)
        k = np.array(sorted({highest(each) for each in orders}), int)
        if not k.size:
            raise ValueError("harmonics: one at least must be fitted")
        if len(time) != len(acceleration):
            raise ValueError(
                f"time, acceleration: have {len(time)} and {len(acceleration)} samples"
            )
        if len(time) < 2 * len(k) + 2 or np.ptp(time) * frequency < 1 - 1 / len(time):
            raise ValueError(
                f"time: {len(time)} samples of {np.ptp(time) * frequency:.3g} periods are too few"
                f" for {len(k)} harmonics"
            )
        angles = PERIOD * frequency * np.multiply.outer(time, k)
        columns = np.hstack([np.ones((len(time), 1)), np.cos(angles), np.sin(angles)])
        fitted, _, rank, _ = np.linalg.lstsq(columns, acceleration, rcond=1e-6)
        if rank < columns.shape[1]:
            raise ValueError("time: the samples do not tell all of the harmonics apart")
        cosines, sines = np.split(fitted[1:] / gravity, 2)
        if np.ptp(acceleration) <= 1e-12 * np.abs(acceleration).max():
            raise ValueError("acceleration: is constant: the table would be at rest")
        left = np.var(acceleration - columns @ fitted) / np.var(acceleration)
        if left > 0.5:
            raise ValueError(
                f"frequency, harmonics: leave {left:.0%} of the variance of the acceleration over;"
                " is the frequency right, and are all harmonics there?"
            )
        return cls._of_accelerations(k, cosines - 1j * sines)

    @classmethod
    def _of_accelerations(cls, k: Values, pulls: Values) -> tuple["Table", float]:
        """The table whose ΛW″ is the real part of Σ p e^{ikτ} and whose |W″| reaches 1, and Λ."""
        kept = np.abs(pulls) > 1e-12 * np.abs(pulls).max()
        sizes = np.abs(pulls) / k**2
        # -Re p e^{ikτ} = |p| sin(kτ + φ) with φ = arg(-p) + π/2.
        waves = zip(k[kept], sizes[kept], np.angle(-pulls[kept]) + np.pi / 2, strict=True)
        found = cls(waves)
        scale = found.acceleration
        return cls((k, a / scale, p) for k, a, p in found.harmonics), scale

    def __repr__(self) -> str:
        harmonics = zip(self.orders, self.sizes, self.phases, strict=True)
        return f"Table([{', '.join(f'({k}, {a!r}, {p!r})' for k, a, p in harmonics)}])"

    @property
    def parameters(self) -> dict[str, Values]:
        """Names and values of the sizes and phases of the harmonics."""
        sizes = {f"harmonic_{k}": a for k, a in zip(self.orders, self.sizes, strict=True)}
        return sizes | {f"phase_{k}": p for k, p in zip(self.orders, self.phases, strict=True)}

    def at(self, **values: Values) -> Any:
        """The same table with other sizes or phases, also arrays and complex ones, which are not
        checked.
        """
        new = self.parameters | values
        if len(new) > len(self.parameters):
            known = ", ".join(self.parameters) or "none"
            raise ValueError(f"{', '.join(values)}: no parameter of the table, which has {known}")
        found = object.__new__(type(self))
        vars(found).update(
            orders=self.orders,
            sizes=tuple(new[f"harmonic_{k}"] for k in self.orders),
            phases=tuple(new[f"phase_{k}"] for k in self.orders),
        )
        return found

    def rows(self, which: Any) -> Any:
        """The same table with x[which] in place of each parameter x that is an array."""
        arrays = {name: x[which] for name, x in self.parameters.items() if np.ndim(x)}
        return self.at(**arrays) if arrays else self

    @property
    def harmonics(self) -> Values:
        """(k, a, p) of each harmonic."""
        return zip(self.orders, self.sizes, self.phases, strict=True)

    def __call__(self, tau: Values, order: int = 0) -> Values:
        """W or a derivative of it."""
        sign = -1 if order % 4 > 1 else 1
        function = CYCLE[order % 2]
        return sum(sign * k**order * a * function(k * tau + p) for k, a, p in self.harmonics)

    def rise(self, start: Values, time: Values) -> tuple:
        """W and W′ at a time after a start, less those there, without cancellation."""
        height = rate = 0.0
        for k, a, p in self.harmonics:
            half = k * time / 2
            middle = k * start + p + half
            part = 2 * a * np.sin(half)
            height = height + part * np.cos(middle)
            rate = rate - k * part * np.sin(middle)
        return height, rate

    # Motions from a start, as sums of x and y of each harmonic: Λa cos and Λa sin of kτ + p there.

    def waves(self, phase: Values, amplitude: Values) -> list:
        """x and y of each harmonic: [x₁, y₁, x₂, y₂, …]."""
        found = []
        for k, a, p in self.harmonics:
            sine, versine = swing(k * phase + p)
            scale = amplitude * a
            found += [scale * (1 - versine), scale * sine]
        return found

    def each_wave(self, waves: Values) -> Values:
        """k, x and y of each harmonic."""
        return zip(self.orders, waves[::2], waves[1::2], strict=True)

    def pulls(self, waves: Values) -> Values:
        """w′, -w″ and -w‴ at the start."""
        waves = list(self.each_wave(waves))
        return tuple(
            sum(part)
            for part in zip(*((k * x, k * k * y, k**3 * x) for k, x, y in waves), strict=True)
        )

    def turned(self, waves: Values) -> Values:
        """The waves of w′ in place of those of w."""
        return [each for k, x, y in self.each_wave(waves) for each in (-k * y, k * x)]

    def flights(self, t: Values, gap: Values, w: Values, waves: Values) -> tuple:
        """δ, δ′ and δ″ a time t after a release; short flights lose no digits."""
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
        """δ‴ a time t after a release, where the relative speed is the rate."""
        found = 0.0
        for k, x, y in self.each_wave(waves):
            sine, versine = swing(k * t)
            found = found + k**3 * (x * (1 - versine) - y * sine)
        return found

    # Sizes

    @cached_property
    def grid(self) -> Values:
        """Phases of a period, 64 in each of the highest harmonic."""
        return np.linspace(0, PERIOD, SAMPLES * self.orders[-1] + 1)

    @cached_property
    def bounds(self) -> Values:
        """What |W| and its first five derivatives do not exceed."""
        remainder = (self.grid[1] / 2) ** 2 / 2
        sums = [sum(abs(a) * k**m for k, a, _ in self.harmonics) for m in range(8)]
        largest = [np.abs(self(self.grid, m)).max() + remainder * sums[m + 2] for m in range(6)]
        return tuple(float(min(a, b)) for a, b in zip(largest, sums, strict=False))

    def _top(self, order: int, sign: int = 1) -> float:
        """The phase at which a derivative of W, or its negative, is largest."""
        start = self.grid[np.argmax(sign * self(self.grid, order))]
        return float(self._zero(start, lambda tau: (self(tau, order + 1), self(tau, order + 2)), 6))

    def _zero(self, phase: Values, function: Callable, steps: int = 4) -> Values:
        """The zero beside a sample of a function with a slope, by Newton's method."""
        most = 0.1 / self.orders[-1]
        for _ in range(steps):
            value, slope = function(phase)
            step = np.divide(value, slope, where=slope != 0, out=np.zeros_like(value))
            # Where the slope vanishes as well, samples are a better guess than Newton's first step.
            phase = phase - np.clip(step, -most, most)
        return phase

    @cached_property
    def lift(self) -> Values:
        """The greatest -W″: above Λ = 1/lift the table falls faster than a ball."""
        return float(-self(self._top(2, -1), 2))

    @cached_property
    def acceleration(self) -> Values:
        """The greatest |W″|."""
        return max(self.lift, float(self(self._top(2), 2)))

    @cached_property
    def peaks(self) -> Values:
        """The greatest and the least W."""
        return float(self(self._top(0))), float(self(self._top(0, -1)))

    @cached_property
    def steepest(self) -> Values:
        """The phase at which W′ is largest."""
        return self._top(1)

    @cached_property
    def slope(self) -> Values:
        """The greatest W′."""
        return float(self(self.steepest, 1))

    @cached_property
    def _sides(self) -> dict:
        """Phases after the steepest one (1) and before it (-1), up to a minimum of W′, and W′."""
        found = {}
        for side in (1, -1):
            phase = self.steepest + side * np.linspace(0, PERIOD, 4 * len(self.grid) - 3)
            rises = side * self(phase, 2) > 0
            rises[0] = False
            phase = phase[: int(np.argmax(rises)) or len(phase)]
            found[side] = phase, self(phase, 1)
        return found

    @cached_property
    def _turns(self) -> tuple:
        """Samples from the steepest phase to where W′ is zero, and angles of (W′, -W″)."""
        phase = self.steepest + np.linspace(0, PERIOD, 4 * len(self.grid) - 3)
        phase = phase[: int(np.argmax(self(phase, 1) <= 0)) + 1]
        angles = np.arctan2(-self(phase, 2), self(phase, 1))
        return phase, np.maximum.accumulate(np.maximum(angles, 0))

    def phase_of_slope(self, slope: Values, side: int = 1) -> Values:
        """The phase after the steepest one, or before it (-1), at which W′ is a slope, if there
        is one.
        """
        phase, slopes = self._sides[side]
        slope = np.clip(slope, slopes[-1], slopes[0])
        # Next to the steepest phase W′ falls with the square of the distance.
        start = np.interp(np.sqrt(slopes[0] - slope), np.sqrt(slopes[0] - slopes), phase)
        found = self._zero(start, lambda tau: (self(tau, 1) - slope, self(tau, 2)))
        # At the steepest phase itself W″ is nothing but rounding, and leads away.
        nearer = np.abs(self(found, 1) - slope) <= np.abs(self(start, 1) - slope)
        return np.where(nearer, found, start)

    def phase_of_angle(self, angle: Values) -> Values:
        """The phase after the steepest one at which (W′, -W″) has turned by an angle up to π/2."""
        phase, turned = self._turns
        x, y = np.cos(angle), np.sin(angle)

        def apart(tau: Values) -> tuple:
            return x * self(tau, 2) + y * self(tau, 1), x * self(tau, 3) + y * self(tau, 2)

        return self._zero(np.interp(angle, turned, phase), apart)

    def instant(self, speed: Values, amplitude: Values) -> tuple:
        """Where w′ has fallen to a speed, which may be complex: the phase, w, -w″ and -w‴ there,
        or NaN.
        """
        slope = speed / amplitude
        phase = self.phase_of_slope(np.real(slope))
        if np.iscomplexobj(slope):
            phase = phase + 1j * np.imag(slope) / self(phase, 2)
        inside = np.abs(self(np.real(phase), 1) - np.real(slope)) < 1e-9
        phase = np.where(inside, phase, np.nan)
        return phase, amplitude * self(phase), *(-amplitude * self(phase, m) for m in (2, 3))

    def amplitude_at(self, speed: Values, push: Values) -> tuple:
        """Λ and the phase at which w′ is a speed and -w″ a push."""
        phase = self.phase_of_angle(np.arctan2(push, speed))
        return np.hypot(speed, push) / np.hypot(self(phase, 1), self(phase, 2)), phase

    # Where the table falls as fast as a ball

    def levels(self, amplitude: Values) -> Values:
        """Phases at which ΛW″ = -1, in an array beside Λ, NaN where there are fewer."""
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
        """Phases in [0, 2π) at which a resting ball leaves, where 1 + ΛW″ falls to zero, in an
        array beside Λ, NaN where there are fewer."""
        phases = self.levels(amplitude)
        falls = self(phases, 3) < 0
        # The samples step over a short fall of the table.
        short = ~falls.any(axis=-1) & (np.asarray(amplitude) * self.lift > 1)
        phases[short, 0] = self._top(2, -1)
        falls[short, 0] = True
        return np.sort(np.where(falls, phases % PERIOD, np.nan))

    def until_lift_off(self, phase: Values, amplitude: Values) -> tuple:
        """How long balls that rest stay on the table, and the phases at which they leave."""
        phases = self.lift_offs(amplitude)
        wait = (phases - np.asarray(phase)[..., np.newaxis]) % PERIOD
        # Rounding must not postpone the lift-off by a turn.
        wait = np.where(wait > PERIOD - CHATTER**2, 0.0, wait)
        wait = np.where(np.isnan(wait), np.inf, wait)
        first = wait.argmin(axis=-1)[..., np.newaxis]
        leaves = np.take_along_axis(phases, first, -1)[..., 0]
        return wait.min(axis=-1), leaves - PERIOD * np.floor(leaves / PERIOD + 0.5)


class Sine(Table):
    """W = sin τ, the table of the paper: the functions of a table by closed formulas."""

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

    def rise(self, start: Values, time: Values) -> tuple:
        half = time / 2
        middle = start + half
        part = 2 * np.sin(half)
        return part * np.cos(middle), -part * np.sin(middle)

    def waves(self, phase: Values, amplitude: Values) -> list:
        """Λ cos τ and Λ sin τ."""
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
        """The two phases at which Λ sin τ = 1. If there are none, both are π/2."""
        level = np.arcsin(np.minimum(1, 1 / np.asarray(amplitude, float)))
        return np.stack([level, np.pi - level], axis=-1)

    def lift_offs(self, amplitude: Values) -> Values:
        level = np.asarray(1 / np.maximum(amplitude, 1.0))
        return np.arcsin(np.where(level < 1, level, np.nan))[..., np.newaxis]


SINE = Sine()
"""The table of the paper, and the default everywhere."""


def check_table(table: Table) -> None:
    """Raise ValueError with one line for what is no table, or not one table."""
    if not isinstance(table, Table):
        raise ValueError(f"table = {table!r:.60}: must be a Table, such as Table([(1, 1.0, 0.0)])")
    for name, value in table.parameters.items():
        if np.ndim(value):
            raise ValueError(
                f"table: its {name} is an array, and must be a number: give one table at a time"
            )
    if table is not SINE:
        Table(table.harmonics)
