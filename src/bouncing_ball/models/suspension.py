r"""What moves a ball between its impacts: gravity, a linear drag of the air, or a spring.

All of them are linear. With δ = z - w, the distance from the table, a flight obeys ::

    drag:      z″ = -1 - c z′
    spring:    δ″ = -2ζν δ′ - ν² (δ - σ) - w″

The air is at rest. The spring stands on the table, with its free length at the distance σ, so that
the mass of the classical impact oscillator ``x″ + 2ζν x′ + ν² x = Λ sin τ`` hits a stop at the
distance σ from its rest: -w″ = Λ sin τ is the force. For σ < 0 the mass is pressed on the stop.

Both have the form ::

    δ = p - W,    p″ + l p′ + q p = b

with a motion W that has the period of the table: W = w for drag, with l = c, q = 0, b = -1. For a
spring it is the solution of ``W″ + l W′ + q W = w″`` with this period, where l = 2ζν, q = ν² and
b = ν²σ.
Its harmonics are those of w times ``-k²/(q - k² + ilk)``.

The free responses are the impulse response g and ``G = ∫ g``, ``H = ∫ G``, with
``p(s) = p₀ (1 - q G) + p′₀ g + b G``.
"""

from abc import abstractmethod
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np

from bouncing_ball.errors import DAMPING_RATIO, ParameterError, Range, shortened
from bouncing_ball.models.waveform import Waveform
from bouncing_ball.numerics.arrays import Batch, as_numbers
from bouncing_ball.numerics.elementary import exponential, sine_and_cosine

DRAG = Range(0, ends="[)")
SPRING_FREQUENCY = Range(0)
# Below this s max(√q, l) the responses are power series, of which this number of terms is enough
# for double precision; above it the closed forms lose less than two digits.
_SHORT, _TERMS = 0.5, 16
# A harmonic of the spring that is nearer to its resonance than this has no periodic motion W within
# the range of doubles.
_RESONANCE = 1e-8


class FreeResponses(NamedTuple):
    """g, g′, G and H at a time, arrays of one shape."""

    impulse: np.ndarray
    impulse_rate: np.ndarray
    step: np.ndarray
    ramp: np.ndarray


@dataclass(frozen=True, repr=False)
class Suspension(Batch):
    """What moves a ball between its impacts, a frozen dataclass of its parameters."""

    @property
    @abstractmethod
    def loss(self) -> Any:
        """l, the rate at which flights contract areas."""

    @property
    @abstractmethod
    def stiffness(self) -> Any:
        """q."""

    @property
    @abstractmethod
    def load(self) -> Any:
        """b."""

    @property
    def is_free(self) -> bool:
        """Whether gravity alone acts on all balls: l = q = 0 and b = -1."""
        changed = self.loss, self.stiffness, np.asarray(self.load) + 1
        return not any(np.any(each) for each in changed)

    @property
    def natural_frequency(self) -> Any:
        """√q, the natural frequency."""
        return np.sqrt(np.asarray(self.stiffness, dtype=float))

    def off_resonance(self, orders: np.ndarray) -> np.ndarray:
        """q - k² + ilk, with a last axis for the orders k of harmonics."""
        frequency = np.asarray(self.natural_frequency, dtype=float)[..., np.newaxis]
        loss = np.asarray(self.loss, dtype=float)[..., np.newaxis]
        return (frequency - orders) * (frequency + orders) + 1j * orders * loss

    def coefficients(self, waveform: Waveform) -> np.ndarray:
        """The harmonics of W, over Λ, shape (N,) or (balls, N)."""
        return waveform.coefficients

    def check(self, waveform: Waveform) -> None:
        """Raise an error if there is no motion W of this table."""


@dataclass(frozen=True, repr=False)
class Drag(Suspension):
    """A ball that falls under gravity and a linear drag, z″ = -1 - c z′.

    Parameters
    ----------
    drag : float
        c ≥ 0, in units of Ω: the speed at which a ball falls in the end is 1/c. c = 0 is a free
        flight.

    Raises
    ------
    ModelError
        If c is no finite number ≥ 0.

    Examples
    --------
    >>> Drag(0.1)
    Drag(drag=0.1)
    """

    drag: Any = 0.0

    def __post_init__(self) -> None:
        _check("drag", self.drag, DRAG)

    @property
    def loss(self) -> Any:
        """c."""
        return self.drag

    @property
    def stiffness(self) -> Any:
        """0."""
        return 0.0

    @property
    def load(self) -> Any:
        """-1, gravity."""
        return -1.0


@dataclass(frozen=True, repr=False)
class Spring(Suspension):
    """A mass on a spring, whose stop shakes with the foot of the spring: the impact oscillator.

    Parameters
    ----------
    spring_frequency : float
        ν > 0, the natural frequency of the mass over that of the table.
    spring_damping : float
        ζ in [0, 1), the damping ratio of the free oscillations.
    gap : float
        σ, the distance of the mass at rest from the stop; negative if the spring presses it on.
        If the spring alone presses the mass on the stop with the acceleration g, σ is -1/ν².

    Raises
    ------
    ModelError
        If a parameter is out of its range.

    Examples
    --------
    >>> Spring(0.5, 0.05, gap=1.0)
    Spring(spring_frequency=0.5, spring_damping=0.05, gap=1)
    """

    spring_frequency: Any
    spring_damping: Any = 0.0
    gap: Any = 0.0

    def __post_init__(self) -> None:
        _check("spring_frequency", self.spring_frequency, SPRING_FREQUENCY)
        _check("spring_damping", self.spring_damping, DAMPING_RATIO)
        _check("gap", self.gap, Range())
        self.check_shape()

    @property
    def loss(self) -> Any:
        """2ζν."""
        return 2 * self.spring_damping * self.spring_frequency

    @property
    def stiffness(self) -> Any:
        """ν²."""
        return self.spring_frequency * self.spring_frequency

    @property
    def load(self) -> Any:
        """ν²σ."""
        return self.stiffness * self.gap

    @property
    def natural_frequency(self) -> Any:
        """ν."""
        return self.spring_frequency

    def coefficients(self, waveform: Waveform) -> np.ndarray:
        """The harmonics of W, over Λ, shape (N,) or (balls, N)."""
        k = waveform.orders
        return -(k * k) * waveform.coefficients / self.off_resonance(k)

    def check(self, waveform: Waveform) -> None:
        """Raise :class:`ParameterError` at an undamped resonance with a harmonic of the table."""
        k = waveform.orders
        near = np.abs(self.off_resonance(k)) < _RESONANCE * k**2
        near = near & (waveform.coefficients != 0)
        if np.any(near):
            raise ParameterError(
                "an undamped spring must not be in resonance with a harmonic of the table: its "
                "frequency ν is a whole number that the table has"
            )


def _check(name: str, value: Any, allowed: Range) -> None:
    """Raise :class:`ParameterError` unless all values of a parameter are in its range."""
    for each in np.ravel(as_numbers(value, name, str(allowed))).tolist():
        if each not in allowed:
            raise ParameterError(f"{{{name}}} = {{}} is not {_text(allowed)}", shortened(each))


def _text(allowed: Range) -> str:
    return "a finite number ≥ 0" if allowed is DRAG else str(allowed)


def free_responses(time: np.ndarray, loss: Any, stiffness: Any) -> FreeResponses:
    """g, g′, G and H for an underdamped oscillator, or for drag with q = 0.

    H is needed for q > 0 only, and is that of a short time otherwise.

    Examples
    --------
    A free mass, and one with drag:

    >>> [float(x) for x in free_responses(np.array(2.0), 0.0, 0.0)[:3]]
    [2.0, 1.0, 2.0]
    >>> fall = free_responses(np.array(3.0), 2.0, 0.0)
    >>> bool(abs(fall.impulse - (1 - np.exp(-6)) / 2) < 1e-15)
    True
    """
    s, loss, q = np.broadcast_arrays(
        np.asarray(time, dtype=float), np.asarray(loss, float), np.asarray(stiffness, float)
    )
    if not loss.any() and not q.any():
        half = s * s / 2
        return FreeResponses(s, np.ones(s.shape), half, half * s / 3)
    short = s * np.maximum(np.sqrt(q), loss) < _SHORT
    if short.all():
        return _series(s, loss, q)
    known = _closed_form(s, loss, q)
    if not short.any():
        return known
    small = _series(np.where(short, s, 0.0), loss, q)
    return FreeResponses(*(np.where(short, a, b) for a, b in zip(small, known, strict=True)))


def _series(s: np.ndarray, loss: np.ndarray, q: np.ndarray) -> FreeResponses:
    """Power series of the responses, from G″ = 1 - l G′ - q G."""
    before = np.zeros(s.shape)
    term = np.full(s.shape, 0.5)
    step = 0.5 * s * s
    ramp = step * s / 3
    impulse = s.copy()
    power = s
    for n in range(1, _TERMS):
        # The coefficient of s^(n + 2) of G.
        following = -(loss * (n + 1) * term + q * before) / ((n + 1) * (n + 2))
        before = term
        term = following
        power = power * s
        impulse = impulse + (n + 2) * term * power
        of_step = term * power * s
        step = step + of_step
        ramp = ramp + of_step * s / (n + 3)
    return FreeResponses(impulse, 1 - loss * impulse - q * step, step, ramp)


def _closed_form(s: np.ndarray, loss: np.ndarray, q: np.ndarray) -> FreeResponses:
    half = loss / 2
    damped = np.sqrt(np.maximum(q - half * half, 0.0))
    springs = q > 0
    frequency = np.where(springs, damped, 1.0)
    sine, cosine = sine_and_cosine(frequency * s)
    decay = exponential(-half * s)
    swing = decay * sine / frequency
    with np.errstate(divide="ignore", invalid="ignore"):
        dragged = (1 - exponential(-loss * s)) / loss
        impulse = np.where(springs, swing, dragged)
        impulse_rate = np.where(springs, decay * cosine - half * swing, exponential(-loss * s))
        step = np.where(springs, (1 - impulse_rate - loss * impulse) / q, (s - impulse) / loss)
        ramp = np.where(springs, (s - impulse - loss * step) / q, 0.0)
    return FreeResponses(impulse, impulse_rate, step, ramp)
